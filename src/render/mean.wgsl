// The mean of the frames of a picture that converges, and the picture of it. `srgb_decode` comes before it.

// The beginning of `Illumination` in lights.wgsl.
struct Header {
    count: u32,
    terms: u32,
    exposure: f32,
    gamma_naive: u32,
    channel: u32,
}

@group(0) @binding(0) var frame: texture_2d<f32>;
@group(0) @binding(1) var known: texture_2d<f32>;
// The sum of squares about the mean luminance, and that before the last block of samples.
@group(0) @binding(2) var known_squares: texture_2d<f32>;
// No uniform buffers: software Vulkan (Mesa) compiles a shader again whenever a uniform is bound that it branches on, and
// keeps every version.
@group(0) @binding(3) var<storage, read> illumination: Header;
// The part that the frame has in the mean, 1 in a picture that begins; the weight of the square of the change of the
// luminance since the last block began, 0 unless the frame completes it; and 1 if the frame ends it.
@group(0) @binding(4) var<storage, read> weights: vec4<f32>;

// As in display.wgsl, whose last step this is for the mean.
const CUT_OFF: f32 = 254.0 / 255.0;
const WHITE: f32 = 1.0005;
// The opacity of a pixel that a light with extent is in, which does not count as clipped.
const LAMP: f32 = 253.0 / 255.0;
const LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

struct Drawn {
    @location(0) picture: vec4<f32>,
    @location(1) mean: vec4<f32>,
    @location(2) squares: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2(f32(index >> 1u), f32(index & 1u));
    return vec4(corner * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4<f32>) -> Drawn {
    let pixel = vec2<u32>(position.xy);
    var mean = textureLoad(frame, pixel, 0);
    var squares = vec2(0.0, dot(mean.rgb, LUMINANCE));
    if weights.x < 1.0 {
        let before = textureLoad(known, pixel, 0);
        // Where frames agree, this leaves the mean as it is, to the bit.
        mean = before + (mean - before) * weights.x;
        let luminance = dot(mean.rgb, LUMINANCE);
        let of_block = textureLoad(known_squares, pixel, 0).rg;
        let change = luminance - of_block.g;
        squares = vec2(
            of_block.r + weights.y * change * change,
            select(of_block.g, luminance, weights.z > 0.0),
        );
    }
    // The opacity of the mean is 0 where something is seen, 1 where nothing is, and in a channel everywhere; negative where
    // a light with extent is in sight.
    let opacity = max(mean.a, 0.0);
    var colour = mean.rgb;
    var is_cut_off = opacity < 1.0 && any(colour > vec3(WHITE));
    if illumination.gamma_naive != 0u && illumination.channel == 0u {
        is_cut_off = opacity < 1.0 && any(colour >= vec3(1.0));
        let c = clamp(colour, vec3(0.0), vec3(1.0));
        colour = mix(vec3(srgb_decode(c.r), srgb_decode(c.g), srgb_decode(c.b)), colour, opacity);
    }
    let mark = select(select(1.0, CUT_OFF, is_cut_off), LAMP, mean.a < 0.0);
    return Drawn(vec4(colour, mark), mean, squares);
}
