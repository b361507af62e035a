// The debug channels: the values that lead to the colour of a pixel, drawn as colours; the twin of
// `src/reference/channel.rs`. Colours are linear: their display codes are those of the legend.

// Must equal `DebugChannel::code` in src/channel/mod.rs (a test compares the pictures).
const CHANNEL_LUMINANCE: u32 = 1u;
const CHANNEL_CLIPPED: u32 = 2u;
const CHANNEL_NOT_A_NUMBER: u32 = 3u;
// From here on the shading model has no part in the picture.
const CHANNEL_FACE_NORMALS: u32 = 4u;
const CHANNEL_NORMALS: u32 = 5u;
const CHANNEL_N_DOT_L: u32 = 6u;
const CHANNEL_N_DOT_V: u32 = 7u;
const CHANNEL_N_DOT_H: u32 = 8u;
const CHANNEL_FACING: u32 = 9u;
const CHANNEL_DEPTH: u32 = 10u;

// Wherever something is not a number.
const CHANNEL_NAN: vec3<f32> = vec3(255.0, 0.0, 200.0) / 255.0;

// Display codes from 0 to 1 as the light that shows them.
fn channel_shown(codes: vec3<f32>) -> vec3<f32> {
    return vec3(srgb_decode(codes.r), srgb_decode(codes.g), srgb_decode(codes.b));
}

// Viridis: S. van der Walt, N. Smith (2015), mpl-colormaps.
fn channel_viridis(place: f32) -> vec3<f32> {
    var table = array<u32, 33>(
        0x440154u, 0x470d60u, 0x48186au, 0x482374u, 0x472d7bu, 0x453681u, 0x424086u, 0x3f4989u,
        0x3b528bu, 0x375a8du, 0x33638du, 0x2f6a8eu, 0x2c728eu, 0x297a8eu, 0x26818eu, 0x23898eu,
        0x21908cu, 0x1f988bu, 0x1f9f88u, 0x21a685u, 0x28ae80u, 0x31b57bu, 0x3ebc74u, 0x4cc26cu,
        0x5dc963u, 0x6ece58u, 0x82d34cu, 0x96d83fu, 0xabdc32u, 0xc0df24u, 0xd5e21au, 0xeae51au,
        0xfde725u
    );
    let at = clamp(place, 0.0, 1.0) * 32.0;
    let first = min(u32(at), 31u);
    let low = unpack4x8unorm(table[first]).bgr;
    let high = unpack4x8unorm(table[first + 1u]).bgr;
    return mix(low, high, at - f32(first));
}

// A cosine; those below 0 are grey, which viridis has not.
fn channel_cosine(cosine: f32) -> vec3<f32> {
    if cosine < 0.0 {
        return vec3(120.0 / 255.0);
    }
    return channel_viridis(cosine);
}

fn channel_is_nan(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u;
}

fn channel_is_infinite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7fffffffu) == 0x7f800000u;
}

// The channels of the light that leaves a point.
fn channel_of_light(light: vec3<f32>, pixel: vec2<f32>) -> vec3<f32> {
    if channel_is_nan(light.r) || channel_is_nan(light.g) || channel_is_nan(light.b) {
        return channel_shown(CHANNEL_NAN);
    }
    let infinite = channel_is_infinite(light.r) || channel_is_infinite(light.g) || channel_is_infinite(light.b);
    let luminance = dot(clamp(light, vec3(-1e30), vec3(1e30)), vec3(0.2126, 0.7152, 0.0722));
    if illumination.channel == CHANNEL_LUMINANCE {
        if luminance <= 0.0 {
            return vec3(0.0);
        }
        // Four decades, from 0.001 to 10.
        return channel_shown(channel_viridis((log2(luminance) * 0.30103 + 3.0) * 0.25));
    }
    let exposed = light * illumination.exposure;
    if illumination.channel == CHANNEL_CLIPPED {
        if any(exposed > vec3(1.0005)) {
            let stripe = (u32(pixel.x) + u32(pixel.y)) / 4u % 2u;
            return channel_shown(select(vec3(240.0, 228.0, 66.0) / 255.0, vec3(0.0), stripe == 1u));
        }
        let shown = clamp(exposed, vec3(0.0), vec3(1.0));
        if illumination.gamma_naive != 0u {
            return channel_shown(shown);
        }
        return shown;
    }
    if infinite {
        return channel_shown(vec3(240.0, 228.0, 66.0) / 255.0);
    }
    if any(light < vec3(0.0)) {
        return channel_shown(vec3(86.0, 180.0, 233.0) / 255.0);
    }
    return vec3(0.25 * clamp(luminance * illumination.exposure, 0.0, 1.0));
}

// The channels of the geometry at a point, as display codes.
fn channel_of_geometry(position: vec3<f32>, normal: vec3<f32>, face_normal: vec3<f32>) -> vec3<f32> {
    let to_eye = observer_position() - position;
    let v = unit_or_zero(to_eye);
    if illumination.channel == CHANNEL_FACE_NORMALS {
        return 0.5 + 0.5 * face_normal;
    }
    if illumination.channel == CHANNEL_NORMALS {
        return 0.5 + 0.5 * normal;
    }
    if illumination.channel == CHANNEL_N_DOT_V {
        return channel_cosine(dot(normal, v));
    }
    if illumination.channel == CHANNEL_FACING {
        let facing = dot(normal, v);
        let colour = select(vec3(86.0, 180.0, 233.0), vec3(213.0, 94.0, 0.0), facing < 0.0);
        return (0.5 + 0.5 * abs(facing)) * colour / 255.0;
    }
    if illumination.channel == CHANNEL_DEPTH {
        let range = illumination.channel_high - illumination.channel_low;
        return channel_viridis((length(to_eye) - illumination.channel_low) / range);
    }
    if illumination.channel_light >= illumination.count {
        return vec3(120.0 / 255.0);
    }
    let l = incident(illumination.lights[illumination.channel_light], position).l;
    if illumination.channel == CHANNEL_N_DOT_L {
        return channel_cosine(dot(normal, l));
    }
    return channel_cosine(dot(normal, half_vector(l, v)));
}

// The colour of a pixel in the channel that is shown.
fn channel_colour(light: vec3<f32>, position: vec3<f32>, normal: vec3<f32>, face_normal: vec3<f32>, pixel: vec2<f32>) -> vec3<f32> {
    if illumination.channel < CHANNEL_FACE_NORMALS {
        return channel_of_light(light, pixel);
    }
    return channel_shown(channel_of_geometry(position, normal, face_normal));
}
