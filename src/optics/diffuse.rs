//! Diffuse reflection of rough surfaces: factors that multiply Lambert's `ρ/π`.
//!
//! Twin: `assets/shaders/optics/diffuse.wgsl`.

use std::f32::consts::{FRAC_2_PI, FRAC_PI_2, PI};

use glam::Vec3;

use super::fresnel::schlick_weight;

/// The lower bound of cosines in divisions, which keeps the results finite.
const GRAZING: f32 = 1e-12;

/// The factor of B. Burley (2012), *Physically Based Shading at Disney*, on Lambert's diffuse BRDF:
/// `(1 + (F_D90 − 1)(1 − cos θ_l)⁵)(1 + (F_D90 − 1)(1 − cos θ_v)⁵)`, `F_D90 = 1/2 + 2 r cos² θ_d`, where
/// θ_d is the angle between the light and the half vector. Smooth surfaces darken at grazing angles, rough
/// ones brighten.
#[must_use]
pub fn burley(cos_l: f32, cos_v: f32, cos_d: f32, roughness: f32) -> f32 {
    let grazing = 2.0 * roughness * cos_d * cos_d - 0.5;
    (1.0 + grazing * schlick_weight(cos_l)) * (1.0 + grazing * schlick_weight(cos_v))
}

/// The factor of M. Oren, S. K. Nayar (1994), *Generalization of Lambert's Reflectance Model*, on Lambert's
/// diffuse BRDF, in their short form without interreflection ("qualitative model"):
/// `A + B max(0, cos φ) sin α tan β`, `A = 1 − σ²/2 / (σ² + 0.33)`, `B = 0.45 σ² / (σ² + 0.09)`, where φ is the
/// azimuth between light and view, α the larger and β the smaller of their polar angles.
///
/// `cos_lv` is `L·V`; `sigma` is σ, the standard deviation of the angle of the facets' slopes, in radians.
/// cos φ sin α tan β is `(L·V − cos θ_l cos θ_v) / max(cos θ_l, cos θ_v)`, so no angle is needed.
#[must_use]
pub fn oren_nayar_qualitative(cos_l: f32, cos_v: f32, cos_lv: f32, sigma: f32) -> f32 {
    let s2 = sigma * sigma;
    let (a, b) = (1.0 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09));
    let across = cos_lv - cos_l * cos_v;
    a + b * across.max(0.0) / cos_l.max(cos_v).max(GRAZING)
}

/// The factor of M. Oren, S. K. Nayar (1994) on Lambert's diffuse BRDF, in full: single reflection, in three parts with
/// C₁, C₂, C₃, plus interreflection between two facets, `0.17 ρ σ²/(σ² + 0.13) (1 − cos φ (2β/π)²)`. For φ beyond 90°,
/// `C₂ = 0.45 σ²/(σ² + 0.09) (sin α − (2β/π)³)`.
///
/// Arguments and angles as for [`oren_nayar_qualitative`]; `rho` is the reflectance of the facets. Negative for σ above
/// 36° where light and view are at grazing angles from opposite sides.
#[must_use]
pub fn oren_nayar_full(cos_l: f32, cos_v: f32, cos_lv: f32, sigma: f32, rho: Vec3) -> Vec3 {
    let s2 = sigma * sigma;
    let near = cos_l.max(cos_v).clamp(GRAZING, 1.0);
    let far = cos_l.min(cos_v).clamp(0.0, 1.0);
    let alpha = far.acos();
    let sine = |cosine: f32| ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    let (sin_alpha, sin_beta) = (sine(far), sine(near));

    let across = cos_lv - cos_l * cos_v;
    let both = sin_alpha * sin_beta;
    let cos_phi = if both > 0.0 { (across / both).clamp(-1.0, 1.0) } else { 0.0 };
    // 2β/π from its distance to 1, which keeps its digits where both angles are grazing.
    let rise = near.asin() * FRAC_2_PI;
    let turned = 1.0 - rise;
    // C₂ / sin α: the sine is already in `across`. sin α − (2β/π)³ is the difference of their distances from
    // 1, which `across / near` keeps finite at the horizon; at the normal `across` vanishes.
    let forward = if across < 0.0 {
        let lacking = rise * (1.0 + turned + turned * turned) - far * far / (1.0 + sin_alpha);
        lacking / sin_alpha.max(1e-4)
    } else {
        1.0
    };
    let c1 = 1.0 - 0.5 * s2 / (s2 + 0.33);
    let c2 = 0.45 * s2 / (s2 + 0.09) * forward;
    let c3 = 0.125 * s2 / (s2 + 0.09) * (turned * alpha / FRAC_PI_2).powi(2);
    // tan((α + β)/2)
    let tan_mean = (sin_alpha + sin_beta) / (far + near);
    let once = c1 + c2 * across / near + c3 * (1.0 - cos_phi.abs()) * tan_mean;
    let twice = 0.17 * s2 / (s2 + 0.13) * (1.0 - cos_phi * turned * turned);
    once + twice * rho
}

/// `1/2 − 2/(3π)`: dividing the FON BRDF by 1 + r times this gives it an albedo of 1 at grazing angles.
const FON_1: f32 = 0.5 - 2.0 / (3.0 * PI);
/// `2/3 − 28/(15π)`: the average albedo of the FON BRDF is (1 + r times this) / (1 + r FON_1).
const FON_2: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// The factor of J. Portsmouth, P. Kutz, S. Hill (2024), *EON: A Practical Energy-Preserving Rough Diffuse BRDF*, on
/// Lambert's diffuse BRDF: Y. Fujii's variant of Oren–Nayar for single reflection, `A (1 + r s/t)`, plus a lobe that
/// restores the lost energy, `ρ ⟨E⟩ / (1 − ρ (1 − ⟨E⟩)) · (1 − E(l)) (1 − E(v)) / (1 − ⟨E⟩)`, with its exact albedo E
/// and average ⟨E⟩.
///
/// `cos_lv` is `L·V`, `roughness` r is 0–1, `rho` the reflectance of the facets.
#[must_use]
pub fn eon(cos_l: f32, cos_v: f32, cos_lv: f32, roughness: f32, rho: Vec3) -> Vec3 {
    let a = 1.0 / (1.0 + FON_1 * roughness);
    let across = cos_lv - cos_l * cos_v;
    let stretched = if across > 0.0 { across / cos_l.max(cos_v).max(GRAZING) } else { across };
    let once = a * (1.0 + roughness * stretched);
    let average = a * (1.0 + FON_2 * roughness);
    // (1 − E(l)) (1 − E(v)) / (1 − ⟨E⟩), where each bracket is A r times a function of the angle: as
    // differences of numbers near 1 they would lose all digits for small r.
    let lost = a * roughness * fon_loss(cos_l) * fon_loss(cos_v) / (FON_1 - FON_2);
    once + rho * average / (1.0 - rho * (1.0 - average)) * lost
}

/// `(1 − E(μ)) / (A r)` of the FON BRDF: `1/2 − 2/(3π) − G(μ)/π`,
/// `G = sin θ (θ − sin θ cos θ) + 2/3 (tan θ (1 − sin³ θ) − sin θ)`.
fn fon_loss(mu: f32) -> f32 {
    let mu = mu.clamp(0.0, 1.0);
    let s = ((1.0 - mu) * (1.0 + mu)).sqrt();
    // tan θ (1 − sin³ θ), with the cosine cancelled.
    let tangent_part = s * mu * (1.0 + s + s * s) / (1.0 + s);
    let g = s * (mu.acos() - s * mu) + (tangent_part - s) * (2.0 / 3.0);
    (FON_1 - g / PI).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn burley_at_normal_incidence_is_lambert_and_at_grazing_the_square_of_the_fresnel_factor() {
        assert_eq!(burley(1.0, 1.0, 1.0, 0.3), 1.0);
        // Retroreflection at grazing angles: F_D90² = (1/2 + 2r)².
        assert!((burley(0.0, 0.0, 1.0, 1.0) - 6.25).abs() < 1e-6);
        assert!((burley(0.0, 0.0, 1.0, 0.0) - 0.25).abs() < 1e-6);
    }

    #[test]
    fn without_roughness_all_are_lambert() {
        for (l, v, lv) in [(1.0, 1.0, 1.0), (0.3, 0.8, -0.2), (0.0, 0.0, -1.0), (0.0, 1e-30, 1.0)] {
            assert_eq!(oren_nayar_qualitative(l, v, lv, 0.0), 1.0);
            assert_eq!(oren_nayar_full(l, v, lv, 0.0, Vec3::ONE), Vec3::ONE);
            assert_eq!(eon(l, v, lv, 0.0, Vec3::ONE), Vec3::ONE);
        }
    }

    #[test]
    fn rough_surfaces_shine_back_to_where_the_light_comes_from() {
        // Light and view at 60° on the same side and on opposite sides.
        let (back, forward) = ((0.5, 0.5, 1.0), (0.5, 0.5, -0.5));
        assert!(
            oren_nayar_qualitative(back.0, back.1, back.2, 0.4)
                > oren_nayar_qualitative(forward.0, forward.1, forward.2, 0.4) + 0.1
        );
        let full = |(l, v, lv)| oren_nayar_full(l, v, lv, 0.4, Vec3::ONE).x;
        assert!(full(back) > full(forward) + 0.1);
        let eon = |(l, v, lv)| eon(l, v, lv, 0.4, Vec3::ONE).x;
        assert!(eon(back) > eon(forward) + 0.1);
    }

    #[test]
    fn oren_nayar_in_full_is_itself_down_to_the_horizon() {
        // Light and view at this height, on opposite sides: cos φ = −1.
        let published = |height: f64, sigma: f64| {
            let (s2, cosine, sine) = (sigma * sigma, height.sin(), height.cos());
            // 1 − (2β/π)³ from the height, since β itself has no digits left for it.
            let e = 2.0 * height / std::f64::consts::PI;
            let bracket = e * (3.0 - e * (3.0 - e)) - (1.0 - sine);
            1.0 - 0.5 * s2 / (s2 + 0.33) - 0.45 * s2 / (s2 + 0.09) * bracket * sine / cosine
                + 0.17 * s2 / (s2 + 0.13) * (1.0 + (1.0 - e).powi(2))
        };
        for sigma in [0.2, 0.6] {
            for height in [1e-9f64, 1e-7, 1e-5, 1e-3, 0.1, 0.7] {
                let (c, lv) = (height.sin() as f32, -(2.0 * height).cos() as f32);
                let got = f64::from(oren_nayar_full(c, c, lv, sigma as f32, Vec3::ONE).x);
                let expected = published(height, sigma);
                assert!((got - expected).abs() < 1e-4, "{height} {sigma}: {got} instead of {expected}");
            }
        }
        // Without the bracket's limit at the horizon.
        assert!((published(1e-9, 0.6) - published(1e-9, 0.4)).abs() > 0.05);
        assert!(published(1e-9, 0.6) > 0.0);
    }

    #[test]
    fn nothing_is_lost_at_grazing() {
        assert!(fon_loss(0.0) < 1e-7);
        assert!((fon_loss(1.0) - FON_1).abs() < 1e-7);
    }
}
