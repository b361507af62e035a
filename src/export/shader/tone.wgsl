// The sRGB encoding of linear light (IEC 61966-2-1).
fn srgb_encode(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3(0.0), vec3(1.0));
    return select(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3(0.0031308));
}

// No curve: values above 1 are clipped.
fn tone_none(c: vec3<f32>) -> vec3<f32> {
    return c;
}

// E. Reinhard, M. Stark, P. Shirley, J. Ferwerda (2002), Photographic Tone Reproduction for Digital Images.
fn tone_reinhard(c: vec3<f32>) -> vec3<f32> {
    return c / (1.0 + c);
}

// The same curve on luminance alone.
fn tone_reinhard_luminance(c: vec3<f32>) -> vec3<f32> {
    let luminance = dot(c, vec3(0.2126, 0.7152, 0.0722));
    if luminance <= 0.0 {
        return vec3(0.0);
    }
    return c / (1.0 + luminance);
}

// S. Hill's fit of the ACES transforms (2017, in M. Pettineo's BakingLab).
fn tone_aces(c: vec3<f32>) -> vec3<f32> {
    let input = mat3x3<f32>(
        vec3(0.59719, 0.07600, 0.02840),
        vec3(0.35458, 0.90834, 0.13383),
        vec3(0.04823, 0.01566, 0.83777),
    );
    let output = mat3x3<f32>(
        vec3(1.60475, -0.10208, -0.00327),
        vec3(-0.53108, 1.10813, -0.07276),
        vec3(-0.07367, -0.00605, 1.07602),
    );
    let v = input * c;
    let a = v * (v + 0.0245786) - 0.000090537;
    let b = v * (0.983729 * v + 0.4329510) + 0.238081;
    return clamp(output * (a / b), vec3(0.0), vec3(1.0));
}

// The Khronos Group (2024), PBR Neutral Tone Mapping.
fn tone_khronos_pbr_neutral(colour: vec3<f32>) -> vec3<f32> {
    let start = 0.8 - 0.04;
    let x = min(colour.r, min(colour.g, colour.b));
    let c = colour - select(0.04, x - 6.25 * x * x, x < 0.08);
    let peak = max(c.r, max(c.g, c.b));
    if peak < start {
        return c;
    }
    let d = 1.0 - start;
    let compressed = 1.0 - d * d / (peak + d - start);
    let pale = 1.0 - 1.0 / (0.15 * (peak - compressed) + 1.0);
    return mix(c * (compressed / peak), vec3(compressed), pale);
}
