// What the debug channels share: the values that lead to the colour of a pixel, drawn as colours; the twin of
// `src/reference/channel.rs`. The formulas of the channels are in `src/debug`. Colours are linear: their display codes
// are those of the legend.

// From here on the shading model has no part in the picture. Must equal `OF_GEOMETRY` in src/debug/mod.rs (a test compares
// them).
const CHANNEL_OF_GEOMETRY: u32 = 64u;

// Wherever something is not a number.
const CHANNEL_NAN: vec3<f32> = vec3(255.0, 0.0, 200.0) / 255.0;
const CHANNEL_YELLOW: vec3<f32> = vec3(240.0, 228.0, 66.0) / 255.0;
const CHANNEL_BLUE: vec3<f32> = vec3(86.0, 180.0, 233.0) / 255.0;
const CHANNEL_RED: vec3<f32> = vec3(213.0, 94.0, 0.0) / 255.0;
const CHANNEL_GREY: vec4<f32> = vec4(120.0 / 255.0, 120.0 / 255.0, 120.0 / 255.0, 1.0);

// Display codes from 0 to 1 as the light that shows them.
fn channel_shown(codes: vec3<f32>) -> vec3<f32> {
    return select(pow((codes + 0.055) / 1.055, vec3(2.4)), codes / 12.92, codes <= vec3(0.04045));
}

// Viridis: S. van der Walt, N. Smith (2015), mpl-colormaps.
const CHANNEL_VIRIDIS: array<u32, 33> = array<u32, 33>(
    0x440154u, 0x470d60u, 0x48186au, 0x482374u, 0x472d7bu, 0x453681u, 0x424086u, 0x3f4989u,
    0x3b528bu, 0x375a8du, 0x33638du, 0x2f6a8eu, 0x2c728eu, 0x297a8eu, 0x26818eu, 0x23898eu,
    0x21908cu, 0x1f988bu, 0x1f9f88u, 0x21a685u, 0x28ae80u, 0x31b57bu, 0x3ebc74u, 0x4cc26cu,
    0x5dc963u, 0x6ece58u, 0x82d34cu, 0x96d83fu, 0xabdc32u, 0xc0df24u, 0xd5e21au, 0xeae51au,
    0xfde725u
);

fn channel_viridis(place: f32) -> vec3<f32> {
    var table = CHANNEL_VIRIDIS;
    let at = clamp(place, 0.0, 1.0) * 32.0;
    let first = min(u32(at), 31u);
    let low = unpack4x8unorm(table[first]).bgr;
    let high = unpack4x8unorm(table[first + 1u]).bgr;
    return mix(low, high, at - f32(first));
}

// What a channel makes of a pixel: display codes, light, in x a place on the scale, or a direction; w says which. The steps that follow
// are taken once, at the end: each would stand in every shader as often as it is written.
const CHANNEL_LIGHT: f32 = 0.0;
const CHANNEL_CODES: f32 = 1.0;
const CHANNEL_PLACE: f32 = 2.0;
const CHANNEL_DIRECTION: f32 = 3.0;

// A cosine; those below 0 are grey, which viridis has not.
fn channel_cosine(cosine: f32) -> vec4<f32> {
    return select(vec4(cosine, 0.0, 0.0, CHANNEL_PLACE), CHANNEL_GREY, cosine < 0.0);
}

// The direction to the light of the channel; 0 if there is none. All lights shine from where they are, or along their
// direction. To ask their types would cost every shader as much as the light loop does.
fn channel_to_light(position: vec3<f32>) -> vec3<f32> {
    if illumination.channel_light >= illumination.count {
        return vec3(0.0);
    }
    let light = light_at(illumination.channel_light);
    let from_position = illumination.channel_low > 0.5;
    return select(-light.direction, unit_or_zero(light.position - position), from_position);
}

// A cosine with the light; it is grey if there is none.
fn channel_lit(cosine: f32) -> vec4<f32> {
    if illumination.channel_light >= illumination.count {
        return CHANNEL_GREY;
    }
    return channel_cosine(cosine);
}

// The colour of a pixel in the channel that is shown.
fn channel_colour(light: vec3<f32>, position: vec3<f32>, normal: vec3<f32>, face_normal: vec3<f32>, pixel: vec2<f32>) -> vec3<f32> {
    var made: vec4<f32>;
    if illumination.channel >= CHANNEL_OF_GEOMETRY {
        let to_eye = observer_position() - position;
        made = channel_of_geometry(position, normal, face_normal, to_eye, unit_or_zero(to_eye));
    } else if any((bitcast<vec3<u32>>(light) & vec3(0x7fffffffu)) > vec3(0x7f800000u)) {
        // Above the bits of infinity there is no number.
        made = vec4(CHANNEL_NAN, CHANNEL_CODES);
    } else {
        let luminance = dot(clamp(light, vec3(-1e30), vec3(1e30)), vec3(0.2126, 0.7152, 0.0722));
        made = channel_of_light(light, luminance, light * illumination.exposure, pixel);
    }
    if illumination.look == LOOK_NUMBERS {
        return made.xyz;
    }
    if made.w == CHANNEL_DIRECTION {
        made = vec4(0.5 + 0.5 * made.xyz, CHANNEL_CODES);
    }
    if made.w == CHANNEL_PLACE {
        made = vec4(channel_viridis(made.x), CHANNEL_CODES);
    }
    return select(channel_shown(made.rgb), made.rgb, made.w == CHANNEL_LIGHT);
}
