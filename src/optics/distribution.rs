//! Distributions of microfacet normals: the part of the surface that faces a direction.
//!
//! Twin: `assets/shaders/optics/distribution.wgsl`. `h` is the half vector in the local frame (x along the
//! tangent, z along the normal), `alpha` the roughness along tangent and bitangent, from
//! [`MINIMUM_ALPHA`] to 1. Every `D` is normalised: `∫ D(h) cos θ_h dω = 1`.
//!
//! All are functions of the stretched square slope `e = (x/α_x)² + (y/α_y)²` and of `z`, in forms that
//! lose no digits where the lobe is narrow.

use glam::{Vec2, Vec3};

use std::f32::consts::FRAC_1_PI;

/// The smallest roughness used: below it, a lobe is narrower than the rounding of a half vector. Smaller roughness is
/// raised to this.
pub const MINIMUM_ALPHA: f32 = 1e-3;

/// The square of the slope of `h` in units of the roughness, times cos² θ_h.
fn stretched(h: Vec3, alpha: Vec2) -> f32 {
    (h.truncate() / alpha).length_squared()
}

/// The names of [`ggx`]: that of its second authors, by which models declare it, and that of its first.
pub const GGX: [&str; 2] = ["GGX", "Trowbridge–Reitz"];

/// Trowbridge–Reitz, or GGX: `D = 1 / (π α_x α_y (e + z²)²)`.
///
/// T. Trowbridge, K. Reitz (1975), *Average Irregularity Representation of a Rough Surface for Ray
/// Reflection*; B. Walter et al. (2007), *Microfacet Models for Refraction through Rough Surfaces*; anisotropic
/// form by B. Burley (2012).
#[must_use]
pub fn ggx(h: Vec3, alpha: Vec2) -> f32 {
    if h.z <= 0.0 {
        return 0.0;
    }
    let q = stretched(h, alpha) + h.z * h.z;
    FRAC_1_PI / (alpha.x * alpha.y) / (q * q)
}

/// Beckmann: `D = exp(−e/z²) / (π α_x α_y z⁴)`; α is √2 times the root mean square slope.
///
/// P. Beckmann, A. Spizzichino (1963), *The Scattering of Electromagnetic Waves from Rough Surfaces*; R. Cook,
/// K. Torrance (1982).
#[must_use]
pub fn beckmann(h: Vec3, alpha: Vec2) -> f32 {
    if h.z <= 0.0 {
        return 0.0;
    }
    let z2 = h.z * h.z;
    let exponent = stretched(h, alpha) / z2;
    // Beyond, the power has underflowed but z⁴ has not; far beyond, z⁴ has too.
    if exponent > 80.0 {
        return 0.0;
    }
    (-exponent).exp() * FRAC_1_PI / (alpha.x * alpha.y * z2 * z2)
}

/// Blinn–Phong as a distribution: `D = (n + 2)/(2π) cosⁿ θ_h`, n = 2/α² − 2; with two roughnesses the
/// exponent varies with the azimuth (M. Ashikhmin, P. Shirley 2000).
///
/// J. Blinn (1977), *Models of Light Reflection for Computer Synthesized Pictures*; the relation of n and α
/// equates the curvature of the lobe with Beckmann's (B. Walter et al. 2007).
#[must_use]
pub fn blinn_phong(h: Vec3, alpha: Vec2) -> f32 {
    if h.z <= 0.0 {
        return 0.0;
    }
    let s2 = h.truncate().length_squared();
    // cosⁿ = exp(−(e − s²) · (−ln(1 − s²)/s²)), since n_x x² + n_y y² = 2(e − s²).
    let exponent = (stretched(h, alpha) - s2) * log_ratio(s2, h.z);
    (-exponent).exp() * FRAC_1_PI / (alpha.x * alpha.y)
}

/// `−ln(1 − s²)/s²` for the sine s and cosine z of one angle.
fn log_ratio(s2: f32, z: f32) -> f32 {
    if s2 < 0.1 {
        // 1 + s²/2 + s⁴/3 + …
        1.0 + s2 * (0.5 + s2 * (1.0 / 3.0 + s2 * (0.25 + s2 * (0.2 + s2 * (1.0 / 6.0 + s2 / 7.0)))))
    } else {
        -2.0 * z.max(f32::MIN_POSITIVE).ln() / s2
    }
}

/// Generalised Trowbridge–Reitz: `D ∝ (α² (e + z²))^−γ`: γ = 2 is [`ggx`], γ = 1 is Berry's distribution with
/// longer tails. For γ ≠ 2 the norm is known for one roughness only, so the geometric mean of the two is
/// taken.
///
/// B. Burley (2012), *Physically Based Shading at Disney*, appendix B. The norm is written with
/// `φ(x) = (1 − e^−x)/x` and L = −2 ln α as `φ(L)/φ((γ − 1)L)/(π α²)`, which has no poles at γ = 1 and α = 1.
#[must_use]
pub fn gtr(h: Vec3, alpha: Vec2, gamma: f32) -> f32 {
    if h.z <= 0.0 {
        return 0.0;
    }
    let a2 = alpha.x * alpha.y;
    let l = -a2.ln();
    let q = h.truncate().length_squared() / a2 + h.z * h.z;
    mean_decay(l) / mean_decay((gamma - 1.0) * l) * FRAC_1_PI / a2 * q.powf(-gamma)
}

/// `(1 − e^−x)/x`, the mean of e^−t over 0 to x.
fn mean_decay(x: f32) -> f32 {
    if x.abs() < 1e-4 { 1.0 - 0.5 * x } else { -(-x).exp_m1() / x }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    type Distribution = fn(Vec3, Vec2) -> f32;

    /// `∫ D(h) cos θ dω` by the midpoint rule over θ = π/2 t³ and φ.
    fn norm(d: impl Fn(Vec3) -> f32) -> f64 {
        let (rows, columns) = (2000, 64);
        let mut sum = 0.0;
        for i in 0..rows {
            let t = (f64::from(i) + 0.5) / f64::from(rows);
            let (sin, cos) = (PI / 2.0 * t.powi(3)).sin_cos();
            let weight = PI / 2.0 * 3.0 * t * t / f64::from(rows) * TAU / f64::from(columns) * sin * cos;
            for j in 0..columns {
                let (s, c) = (TAU * (f64::from(j) + 0.5) / f64::from(columns)).sin_cos();
                let h = Vec3::new((sin * c) as f32, (sin * s) as f32, cos as f32);
                sum += weight * f64::from(d(h));
            }
        }
        sum
    }

    #[test]
    fn every_distribution_is_normalised() {
        let all: [(&str, Distribution); 6] = [
            ("ggx", ggx),
            ("beckmann", beckmann),
            ("blinn_phong", blinn_phong),
            ("gtr 1", |h, a| gtr(h, a, 1.0)),
            ("gtr 1.5", |h, a| gtr(h, a, 1.5)),
            ("gtr 10", |h, a| gtr(h, a, 10.0)),
        ];
        for (name, d) in all {
            for alpha in [0.02, 0.1, 0.3, 0.7, 1.0] {
                let n = norm(|h| d(h, Vec2::splat(alpha)));
                assert!((n - 1.0).abs() < 1e-3, "{name} {alpha}: {n}");
            }
            let n = norm(|h| d(h, Vec2::new(0.15, 0.6)));
            assert!((n - 1.0).abs() < 2e-3, "{name} anisotropic: {n}");
            // A wrong twin without the cosine's share.
            let wrong = norm(|h| d(h, Vec2::splat(0.7)) / h.z.max(1e-6));
            assert!((wrong - 1.0).abs() > 0.01, "{name}: the wrong twin passes");
        }
    }

    #[test]
    fn gtr_with_exponent_two_is_ggx_and_roughness_one_is_the_uniform_slope() {
        for i in 1..=50 {
            let (sin, cos) = (f32::from(i as u8) * 0.03).sin_cos();
            let h = Vec3::new(0.6 * sin, 0.8 * sin, cos);
            let a = Vec2::splat(0.3);
            assert!((gtr(h, a, 2.0) / ggx(h, a) - 1.0).abs() < 1e-4);
            assert!((gtr(h, Vec2::ONE, 1.7) - FRAC_1_PI).abs() < 1e-5);
            assert!((blinn_phong(h, Vec2::ONE) - FRAC_1_PI).abs() < 1e-6);
            // n = 2/0.09 − 2.
            let n = 2.0 / 0.09f32 - 2.0;
            let expected = (n + 2.0) / TAU as f32 * cos.powf(n);
            assert!((blinn_phong(h, a) - expected).abs() < 1e-4 * expected + 1e-9);
        }
    }

    #[test]
    fn nothing_faces_below_and_everything_is_finite() {
        for alpha in [Vec2::splat(MINIMUM_ALPHA), Vec2::ONE, Vec2::new(MINIMUM_ALPHA, 1.0)] {
            for h in [Vec3::Z, Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::ZERO, Vec3::new(1.0, 0.0, 1e-20)] {
                for d in [ggx(h, alpha), beckmann(h, alpha), blinn_phong(h, alpha), gtr(h, alpha, 1.0)] {
                    assert!(d.is_finite() && d >= 0.0, "{h} {alpha}: {d}");
                }
            }
        }
        assert_eq!(ggx(Vec3::NEG_Z, Vec2::ONE), 0.0);
    }
}
