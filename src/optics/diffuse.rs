//! Diffuse reflection of rough surfaces: factors that multiply Lambert's `ρ/π`.
//!
//! Twin: `assets/shaders/optics/diffuse.wgsl`.

use super::fresnel::schlick_weight;

/// The factor of B. Burley (2012), *Physically Based Shading at Disney*, on Lambert's diffuse BRDF:
/// `(1 + (F_D90 − 1)(1 − cos θ_l)⁵)(1 + (F_D90 − 1)(1 − cos θ_v)⁵)`, `F_D90 = 1/2 + 2 r cos² θ_d`, where
/// θ_d is the angle between the light and the half vector. Smooth surfaces darken at grazing angles, rough
/// ones brighten.
#[must_use]
pub fn burley(cos_l: f32, cos_v: f32, cos_d: f32, roughness: f32) -> f32 {
    let grazing = 2.0 * roughness * cos_d * cos_d - 0.5;
    (1.0 + grazing * schlick_weight(cos_l)) * (1.0 + grazing * schlick_weight(cos_v))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn burley_at_normal_incidence_is_lambert_and_at_grazing_the_square_of_the_fresnel_factor() {
        assert_eq!(burley(1.0, 1.0, 1.0, 0.3), 1.0);
        // Retro-reflection at grazing: F_D90² = (1/2 + 2r)².
        assert!((burley(0.0, 0.0, 1.0, 1.0) - 6.25).abs() < 1e-6);
        assert!((burley(0.0, 0.0, 1.0, 0.0) - 0.25).abs() < 1e-6);
    }
}
