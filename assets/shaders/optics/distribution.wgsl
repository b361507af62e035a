// Distributions of microfacet normals, the twin of src/optics/distribution.rs. h: half vector in the
// local frame; alpha: roughness along tangent and bitangent. Normalised: ∫ D cos θ_h dω = 1.

const MINIMUM_ALPHA: f32 = 1e-3;

// Trowbridge–Reitz, or GGX.
fn ggx(h: vec3<f32>, alpha: vec2<f32>) -> f32 {
    if h.z <= 0.0 {
        return 0.0;
    }
    let slope = h.xy / alpha;
    let q = dot(slope, slope) + h.z * h.z;
    return 1.0 / (PI * alpha.x * alpha.y * q * q);
}

// P. Beckmann, A. Spizzichino (1963).
fn beckmann(h: vec3<f32>, alpha: vec2<f32>) -> f32 {
    if h.z <= 0.0 {
        return 0.0;
    }
    let slope = h.xy / alpha;
    let z2 = h.z * h.z;
    let exponent = dot(slope, slope) / z2;
    if exponent > 80.0 {
        return 0.0;
    }
    return exp(-exponent) / (PI * alpha.x * alpha.y * z2 * z2);
}

// Blinn–Phong with the exponent n = 2/α² − 2 along each axis.
fn blinn_phong(h: vec3<f32>, alpha: vec2<f32>) -> f32 {
    if h.z <= 0.0 {
        return 0.0;
    }
    let slope = h.xy / alpha;
    let s2 = dot(h.xy, h.xy);
    // −ln(cos² θ)/sin² θ: a series where the logarithm would lose digits.
    var ratio: f32;
    if s2 < 0.1 {
        ratio = 1.0 + s2 / 2.0 + s2 * s2 / 3.0 + s2 * s2 * s2 / 4.0 + pow(s2, 4.0) / 5.0 + pow(s2, 5.0) / 6.0 + pow(s2, 6.0) / 7.0;
    } else {
        ratio = -2.0 * log(max(h.z, 1.2e-38)) / s2;
    }
    return exp((s2 - dot(slope, slope)) * ratio) / (PI * alpha.x * alpha.y);
}

// Generalised Trowbridge–Reitz (B. Burley 2012) of the mean roughness.
fn gtr(h: vec3<f32>, alpha: vec2<f32>, gamma: f32) -> f32 {
    if h.z <= 0.0 {
        return 0.0;
    }
    let a2 = alpha.x * alpha.y;
    let l = -log(a2);
    let norm = mean_decay(l) / (mean_decay((gamma - 1.0) * l) * PI * a2);
    return norm * pow(dot(h.xy, h.xy) / a2 + h.z * h.z, -gamma);
}

// (1 − e^−x)/x; by its series where the difference would lose digits.
fn mean_decay(x: f32) -> f32 {
    if abs(x) < 0.1 {
        return 1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0)));
    }
    return (1.0 - exp(-x)) / x;
}
