// The background that a scene gives: a colour, or a gradient over the height of the picture. The twin of `Display::behind`
// in src/scene/display.rs; `srgb_decode` comes before it. SAMPLES and DEPTHS stand for the samples of a pixel and the type
// of their depths.

struct Backdrop {
    // sRGB codes, 0 to 1.
    top: vec4<f32>,
    bottom: vec4<f32>,
    // The first row of the picture that the observer sees, and the number of its rows.
    rows: vec4<f32>,
}

@group(0) @binding(0) var<uniform> backdrop: Backdrop;
@group(0) @binding(1) var picture: texture_2d<f32>;
@group(0) @binding(2) var depths: DEPTHS;

// As light, white is a little darker than that: light as bright as white counts as clipped. Its code is 255 all the same.
const WHITE: f32 = 0.9985;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2(f32(index >> 1u), f32(index & 1u));
    return vec4(corner * 4.0 - 1.0, 0.0, 1.0);
}

fn behind(row: f32) -> vec3<f32> {
    let down = clamp((row - backdrop.rows.x) / backdrop.rows.y, 0.0, 1.0);
    let code = mix(backdrop.top.rgb, backdrop.bottom.rgb, down);
    return vec3(srgb_decode(code.r), srgb_decode(code.g), srgb_decode(code.b));
}

fn behind_as_light(row: f32) -> vec3<f32> {
    return min(behind(row), vec3(WHITE));
}

// The fraction of a pixel in which something is seen.
fn covered(pixel: vec2<u32>) -> f32 {
    var seen = 0.0;
    for (var i = 0; i < SAMPLES; i++) {
        seen += select(0.0, 1.0, textureLoad(depths, pixel, i) > 0.0);
    }
    return seen / f32(SAMPLES);
}

// Before anything else is drawn.
@fragment
fn paint(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4(behind_as_light(position.y), 1.0);
}

// Before the tone curve: leaves the light of what is seen, without the background beside it.
@fragment
fn lift(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<u32>(position.xy);
    let here = textureLoad(picture, pixel, 0);
    let part = covered(pixel);
    if part == 0.0 || part == 1.0 {
        return here;
    }
    return vec4((here.rgb - (1.0 - part) * behind_as_light(position.y)) / part, here.a);
}

// After the tone curve: joins the background to its result.
@fragment
fn put(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<u32>(position.xy);
    let here = textureLoad(picture, pixel, 0);
    let part = covered(pixel);
    if part == 0.0 {
        return vec4(behind(position.y), here.a);
    }
    return vec4(mix(behind(position.y), here.rgb, part), here.a);
}
