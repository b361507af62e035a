//! Shadowing and masking of microfacets: the fraction of the facets along the half vector that is both lit
//! and visible.
//!
//! Twin: `assets/shaders/optics/masking.wgsl`. Every function gives the **visibility**
//! `V = G / (4 (n·l) (n·v))`, so that a microfacet BRDF is `D V F`: at grazing angles the cosines cancel
//! against those within G, and nothing is divided by zero. `G` itself is `4 (n·l) (n·v) V`.
//!
//! `l` and `v` are in the local frame (z along the normal) and above the surface, z > 0.

use std::f32::consts::FRAC_2_SQRT_PI;

use glam::{Vec2, Vec3};

/// No masking but the projection of the areas: `G = (n·l)(n·v)`, the implicit choice of models without G.
#[must_use]
pub fn implicit() -> f32 {
    0.25
}

/// V-shaped cavities: `G = min(1, 2 (n·h)(n·v)/(v·h), 2 (n·h)(n·l)/(v·h))`.
///
/// K. Torrance, E. Sparrow (1967), *Theory for Off-Specular Reflection from Roughened Surfaces*; in this form
/// J. Blinn (1977).
#[must_use]
pub fn v_cavity(cos_l: f32, cos_v: f32, cos_h: f32, cos_d: f32) -> f32 {
    // The least of the three, each divided by 4 (n·l)(n·v).
    let cavity = cos_h / (2.0 * cos_d.max(f32::MIN_POSITIVE));
    (0.25 / (cos_l * cos_v)).min(cavity / cos_l.max(cos_v))
}

/// `G = (n·l)(n·v)/max(n·l, n·v)`: L. Neumann et al. (1999), *Compact Metallic Reflectance Models*.
#[must_use]
pub fn neumann(cos_l: f32, cos_v: f32) -> f32 {
    0.25 / cos_l.max(cos_v)
}

/// `G = (n·l)(n·v)/(v·h)²`: C. Kelemen, L. Szirmay-Kalos (2001), *A Microfacet Based Coupled
/// Specular-Matte BRDF Model with Importance Sampling*.
#[must_use]
pub fn kelemen(cos_d: f32) -> f32 {
    0.25 / (cos_d * cos_d).max(1e-12)
}

/// Schlick's approximation to Smith's term, `G₁ = c/(c(1 − k) + k)` for both directions: C. Schlick (1994).
/// [`karis_k`] gives the usual k.
#[must_use]
pub fn schlick_smith(cos_l: f32, cos_v: f32, k: f32) -> f32 {
    0.25 / ((cos_l * (1.0 - k) + k) * (cos_v * (1.0 - k) + k))
}

/// `k = (r + 1)²/8` of perceptual roughness r = √α: B. Karis (2013), *Real Shading in Unreal Engine 4*,
/// for lights that are not images.
#[must_use]
pub fn karis_k(alpha: f32) -> f32 {
    let r = alpha.sqrt() + 1.0;
    r * r / 8.0
}

/// `cos θ · Λ(d)` of Smith's theory for GGX: `(√(z² + α_x²x² + α_y²y²) − z)/2`.
///
/// B. Smith (1967), *Geometrical Shadowing of a Random Rough Surface*; B. Walter et al. (2007).
#[must_use]
pub fn smith_ggx(d: Vec3, alpha: Vec2) -> f32 {
    let q = (alpha * d.truncate()).length_squared();
    // The difference of the root and z without cancellation.
    0.5 * q / ((d.z * d.z + q).sqrt() + d.z).max(f32::MIN_POSITIVE)
}

/// `cos θ · Λ(d)` of Smith's theory for Beckmann's distribution, exact:
/// `(√q e^(−a²)/√π − z erfc(a))/2` with q = α_x²x² + α_y²y² and a = z/√q.
///
/// B. Smith (1967); B. Walter et al. (2007). Often replaced by a rational approximation that is up to
/// 0.6 % off at grazing angles.
#[must_use]
pub fn smith_beckmann(d: Vec3, alpha: Vec2) -> f32 {
    let root = (alpha * d.truncate()).length();
    if d.z > 6.0 * root {
        return 0.0;
    }
    let a = d.z / root.max(f32::MIN_POSITIVE);
    (0.5 * (0.5 * FRAC_2_SQRT_PI * root * (-a * a).exp() - d.z * erfc(a))).max(0.0)
}

/// Both directions masked independently: `G = 1/((1 + Λ(l))(1 + Λ(v)))`. `lambda_…` are cos θ · Λ.
#[must_use]
pub fn separable(cos_l: f32, cos_v: f32, lambda_l: f32, lambda_v: f32) -> f32 {
    0.25 / ((cos_l + lambda_l) * (cos_v + lambda_v))
}

/// Height-correlated: high facets are likely both lit and seen, `G = 1/(1 + Λ(l) + Λ(v))`. `lambda_…` are cos θ · Λ.
///
/// E. Heitz (2014), *Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs*.
#[must_use]
pub fn height_correlated(cos_l: f32, cos_v: f32, lambda_l: f32, lambda_v: f32) -> f32 {
    0.25 / (cos_l * cos_v + cos_v * lambda_l + cos_l * lambda_v)
}

/// The complementary error function for x ≥ 0, absolute error below 1.5e-7: M. Abramowitz, I. Stegun
/// (1964), *Handbook of Mathematical Functions*, 7.1.26.
#[must_use]
pub fn erfc(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let p = t * (0.254_829_6 + t * (-0.284_496_74 + t * (1.421_413_7 + t * (-1.453_152 + t * 1.061_405_4))));
    p * (-x * x).exp()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::optics::distribution::{beckmann, ggx};

    #[test]
    fn the_error_function_is_that_of_the_tables() {
        for (x, expected) in [(0.0, 1.0), (0.5, 0.479_500_1), (1.0, 0.157_299_2), (2.0, 0.004_677_73)] {
            assert!((erfc(x) - expected).abs() < 3e-7, "erfc({x}) = {}", erfc(x));
        }
    }

    /// The weak white furnace: the viewer receives all the light from unmasked facets, `∫ G₁(v) max(0, v·h) D(h) dω =
    /// n·v` (E. Heitz 2014).
    fn furnace(v: Vec3, alpha: Vec2, d: fn(Vec3, Vec2) -> f32, lambda: f32) -> f64 {
        let (rows, columns) = (1500, 256);
        let mut sum = 0.0;
        for i in 0..rows {
            let t = (f64::from(i) + 0.5) / f64::from(rows);
            let (sin, cos) = (PI / 2.0 * t.powi(3)).sin_cos();
            let weight = PI / 2.0 * 3.0 * t * t / f64::from(rows) * TAU / f64::from(columns) * sin;
            for j in 0..columns {
                let (s, c) = (TAU * (f64::from(j) + 0.5) / f64::from(columns)).sin_cos();
                let h = Vec3::new((sin * c) as f32, (sin * s) as f32, cos as f32);
                sum += weight * f64::from(d(h, alpha) * v.dot(h).max(0.0));
            }
        }
        sum * f64::from(v.z / (v.z + lambda)) / f64::from(v.z)
    }

    #[test]
    fn smith_masking_keeps_the_weak_white_furnace() {
        for alpha in [Vec2::splat(0.1), Vec2::splat(0.5), Vec2::ONE, Vec2::new(0.2, 0.7)] {
            for theta in [0.0f32, 0.7, 1.2, 1.45] {
                let (sin, cos) = theta.sin_cos();
                let v = Vec3::new(0.6 * sin, 0.8 * sin, cos);
                let f = furnace(v, alpha, ggx, smith_ggx(v, alpha));
                assert!((f - 1.0).abs() < 2e-3, "GGX {alpha} {theta}: {f}");
                let f = furnace(v, alpha, beckmann, smith_beckmann(v, alpha));
                assert!((f - 1.0).abs() < 2e-3, "Beckmann {alpha} {theta}: {f}");
            }
        }
        // The masking of another distribution breaks it.
        let v = Vec3::new(1.2f32.sin(), 0.0, 1.2f32.cos());
        let wrong = furnace(v, Vec2::splat(0.5), ggx, smith_beckmann(v, Vec2::splat(0.5)));
        assert!((wrong - 1.0).abs() > 0.01, "{wrong}");
    }

    #[test]
    fn at_normal_incidence_nothing_is_masked() {
        let alpha = Vec2::splat(0.4);
        for lambda in [smith_ggx(Vec3::Z, alpha), smith_beckmann(Vec3::Z, alpha)] {
            assert_eq!(lambda, 0.0);
        }
        assert_eq!(separable(1.0, 1.0, 0.0, 0.0), 0.25);
        assert_eq!(height_correlated(1.0, 1.0, 0.0, 0.0), 0.25);
        for v in [v_cavity(1.0, 1.0, 1.0, 1.0), neumann(1.0, 1.0), kelemen(1.0), implicit()] {
            assert_eq!(v, 0.25);
        }
        assert_eq!(schlick_smith(1.0, 1.0, karis_k(0.3)), 0.25);
    }
}
