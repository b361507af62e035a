// Shadowing and masking of microfacets, the twin of src/optics/masking.rs: the visibility
// V = G / (4 (n·l)(n·v)). l and v are in the local frame, above the surface.

// G = (n·l)(n·v).
fn implicit() -> f32 {
    return 0.25;
}

// K. Torrance, E. Sparrow (1967): G = min(1, 2 (n·h)(n·v)/(v·h), 2 (n·h)(n·l)/(v·h)).
fn v_cavity(cos_l: f32, cos_v: f32, cos_h: f32, cos_d: f32) -> f32 {
    let most = 1.0 / (4.0 * cos_l * cos_v);
    let shadowed = cos_h / (2.0 * max(cos_d, 1.2e-38) * cos_v);
    let masked = cos_h / (2.0 * max(cos_d, 1.2e-38) * cos_l);
    return min(most, min(shadowed, masked));
}

// L. Neumann et al. (1999): G = (n·l)(n·v)/max(n·l, n·v).
fn neumann(cos_l: f32, cos_v: f32) -> f32 {
    return 0.25 / max(cos_l, cos_v);
}

// C. Kelemen, L. Szirmay-Kalos (2001): G = (n·l)(n·v)/(v·h)².
fn kelemen(cos_d: f32) -> f32 {
    return 0.25 / max(cos_d * cos_d, 1e-12);
}

// C. Schlick (1994): G1 = c/(c(1 − k) + k).
fn schlick_smith(cos_l: f32, cos_v: f32, k: f32) -> f32 {
    return 0.25 / (mix(k, 1.0, cos_l) * mix(k, 1.0, cos_v));
}

// B. Karis (2013): k = (r + 1)²/8, r = √α.
fn karis_k(alpha: f32) -> f32 {
    let r = sqrt(alpha);
    return (r + 1.0) * (r + 1.0) / 8.0;
}

// cos θ Λ of Smith's theory for GGX.
fn smith_ggx(d: vec3<f32>, alpha: vec2<f32>) -> f32 {
    let stretched = alpha * d.xy;
    let q = dot(stretched, stretched);
    return 0.5 * q / max(sqrt(d.z * d.z + q) + d.z, 1.2e-38);
}

// cos θ Λ of Smith's theory for Beckmann's distribution, exact.
fn smith_beckmann(d: vec3<f32>, alpha: vec2<f32>) -> f32 {
    let root = length(alpha * d.xy);
    if d.z > 6.0 * root {
        return 0.0;
    }
    let a = d.z / max(root, 1.2e-38);
    return max(0.5 * (root * exp(-a * a) / sqrt(PI) - d.z * erfc(a)), 0.0);
}

// G = 1/((1 + Λ(l))(1 + Λ(v))).
fn separable(cos_l: f32, cos_v: f32, lambda_l: f32, lambda_v: f32) -> f32 {
    return 0.25 / ((cos_l + lambda_l) * (cos_v + lambda_v));
}

// E. Heitz (2014): G = 1/(1 + Λ(l) + Λ(v)).
fn height_correlated(cos_l: f32, cos_v: f32, lambda_l: f32, lambda_v: f32) -> f32 {
    return 0.25 / (cos_l * cos_v + cos_v * lambda_l + cos_l * lambda_v);
}

// The complementary error function for x ≥ 0 (M. Abramowitz, I. Stegun 1964, 7.1.26).
fn erfc(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.3275911 * x);
    let series = ((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t - 0.284496736) * t + 0.254829592) * t;
    return series * exp(-x * x);
}
