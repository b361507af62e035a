// Refractive index by wavelength, and the colour of wavelengths in nanometres: the twin of src/optics/dispersion.rs.

// A. L. Cauchy (1836): n_d + B (1/λ² − 1/λ_d²), B in µm², λ_d = 587.56 nm.
fn cauchy(n_d: f32, b: f32, nm: f32) -> f32 {
    let inverse = 1000.0 / nm;
    return max(n_d + b * (inverse * inverse - 2.8966469), 0.01);
}

// B for an Abbe number; 0 for numbers that are not positive.
fn cauchy_of_abbe(n_d: f32, abbe: f32) -> f32 {
    if abbe > 0.0 {
        return (n_d - 1.0) / (1.9097247 * abbe);
    }
    return 0.0;
}

struct Wavelength {
    nm: f32,
    weight: vec3<f32>,
}

// Red, green and blue at 400 nm + 20 nm · i, in thousandths; each adds up to 16 000.
fn spectral_colour(i: u32) -> vec3<f32> {
    switch i {
        case 1u: { return vec3(222.0, 0.0, 2081.0); }
        case 2u: { return vec3(487.0, 0.0, 5508.0); }
        case 3u: { return vec3(0.0, 0.0, 5276.0); }
        case 4u: { return vec3(0.0, 546.0, 2481.0); }
        case 5u: { return vec3(0.0, 1726.0, 654.0); }
        case 6u: { return vec3(0.0, 3488.0, 0.0); }
        case 7u: { return vec3(0.0, 4192.0, 0.0); }
        case 8u: { return vec3(777.0, 3524.0, 0.0); }
        case 9u: { return vec3(2978.0, 2057.0, 0.0); }
        case 10u: { return vec3(4438.0, 460.0, 0.0); }
        case 11u: { return vec3(3975.0, 0.0, 0.0); }
        case 12u: { return vec3(2182.0, 0.0, 0.0); }
        case 13u: { return vec3(756.0, 0.0, 0.0); }
        case 14u: { return vec3(164.0, 0.0, 0.0); }
        case 15u: { return vec3(21.0, 7.0, 0.0); }
        default: { return vec3(0.0); }
    }
}

// The wavelength at a fraction of the visible range; the weights of a multiple of 16 equally spaced ones have the mean 1.
fn spectrum(u: f32) -> Wavelength {
    let at = clamp(u, 0.0, 1.0) * 16.0;
    let part = min(u32(at), 15u);
    let weight = mix(spectral_colour(part), spectral_colour(part + 1u), at - f32(part));
    return Wavelength(400.0 + 20.0 * at, weight / 1000.0);
}
