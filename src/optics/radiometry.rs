//! Attenuation of light: distance and cones.

use std::f64::consts::PI;

use glam::{Vec2, Vec3};

/// The guard against division by zero in [`inverse_square`]: squared distances below (1 mm)² count as (1
/// mm)². Only visible on a surface that touches the light.
pub const MINIMUM_DISTANCE_SQUARED: f32 = 1e-6;

/// The intensity that reaches a point at distance `d` from a point source, `1 / d²` (CA DD7, intensity at a point; exact:
/// no window and no clamp but [`MINIMUM_DISTANCE_SQUARED`]). Metres in, 1/m² out.
#[must_use]
pub fn inverse_square(to_light: Vec3) -> f32 {
    1.0 / to_light.length_squared().max(MINIMUM_DISTANCE_SQUARED)
}

/// The outer and the inner edge of a spotlight's cone, as `1 − cos θ = 2 sin²(θ/2)`, for [`cone`]. Cosines near 1 have
/// too few bits for narrow cones.
///
/// `cone_angle` is the half angle of the cone in degrees (0 < a ≤ 90), and `penumbra` (0–1) the fraction of it over which
/// the light fades; 0 is a hard edge.
#[must_use]
pub fn cone_edges(cone_angle: f32, penumbra: f32) -> Vec2 {
    let of_angle = |degrees: f32| 2.0 * (0.5 * degrees.to_radians()).sin().powi(2);
    Vec2::new(of_angle(cone_angle), of_angle(cone_angle * (1.0 - penumbra)))
}

/// The profile of a spotlight: 1 inside, 0 outside, and smooth in between.
///
/// `axis` and `ray` are unit vectors away from the light, `edges` those of [`cone_edges`]. The fade is Hermite's cubic
/// `t²(3 − 2t)` of the **angle's cosine**, the convention of OpenGL and glTF spots. Of the ray, `1 − cos θ` is half the
/// square of the chord.
#[must_use]
pub fn cone(axis: Vec3, ray: Vec3, edges: Vec2) -> f32 {
    let rise = 0.5 * (ray - axis).length_squared();
    let [outer, inner] = edges.to_array();
    if inner >= outer {
        return if rise <= outer { 1.0 } else { 0.0 };
    }
    let t = ((outer - rise) / (outer - inner)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The solid angle of all directions, sr. It converts the intensity of a point light (cd) to its luminous flux (lm), `Φ
/// = 4π I`.
pub const SPHERE: f64 = 4.0 * PI;

/// The integral of [`cone`] over all directions, sr. It converts the intensity of a spotlight (cd) to its luminous flux
/// (lm), `Φ = I ∫ cone dω`.
///
/// With `c = cos θ` and `dω = 2π dc`, the inside contributes `2π (1 − c_inner)`; over the penumbra the
/// cubic is `½` on average, whatever its width, so `2π (c_inner − c_outer) / 2` is added. The sum
/// `2π (1 − (c_inner + c_outer) / 2)` is `2π (sin²(inner/2) + sin²(outer/2))`, which loses no digits for
/// narrow cones.
#[must_use]
pub fn cone_solid_angle(cone_angle: f32, penumbra: f32) -> f64 {
    let sin_squared = |degrees: f64| (0.5 * degrees.to_radians()).sin().powi(2);
    let outer = sin_squared(f64::from(cone_angle));
    let inner = sin_squared(f64::from(cone_angle) * (1.0 - f64::from(penumbra)));
    2.0 * PI * (inner + outer)
}

/// The light that arrives at a point from one direction of one light source, including its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arriving {
    /// Unit vector from the point to the light.
    pub l: Vec3,
    /// The intensity at the point, times the colour.
    pub light: Vec3,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ray with this `1 − cos θ` to the z-axis.
    fn by_rise(rise: f64) -> Vec3 {
        Vec3::new((rise * (2.0 - rise)).sqrt() as f32, 0.0, (1.0 - rise) as f32)
    }

    fn at(degrees: f64, cone_angle: f32, penumbra: f32) -> f32 {
        let ray = by_rise(2.0 * (0.5 * degrees.to_radians()).sin().powi(2));
        cone(Vec3::Z, ray, cone_edges(cone_angle, penumbra))
    }

    #[test]
    fn narrow_cones_fade_as_evenly_as_wide_ones() {
        for cone_angle in [1e-3, 0.02, 0.1, 0.5, 5.0] {
            for part in [0.905, 0.95, 0.99] {
                let degrees = f64::from(cone_angle as f32) * part;
                let rise = |degrees: f64| (0.5 * degrees.to_radians()).sin().powi(2);
                let [outer, inner] = [cone_angle, 0.9 * cone_angle].map(rise);
                let t = ((outer - rise(degrees)) / (outer - inner)).clamp(0.0, 1.0);
                let error = f64::from(at(degrees, cone_angle as f32, 0.1)) - t * t * (3.0 - 2.0 * t);
                assert!(error.abs() < 1e-4, "{cone_angle}° {part}: {error}");
            }
        }
    }

    #[test]
    fn the_flux_of_a_cone_is_the_integral_of_its_profile() {
        for cone_angle in [0.01, 1.0, 15.0, 30.0, 60.0, 90.0] {
            for penumbra in [0.0, 0.1, 0.5, 1.0] {
                // Midpoint rule over the cosine, from the edge to the axis.
                let n = 200_000;
                let depth = 2.0 * (0.5 * f64::from(cone_angle).to_radians()).sin().powi(2);
                let sum: f64 = (0..n)
                    .map(|i| depth * (f64::from(i) + 0.5) / f64::from(n))
                    .map(|rise| f64::from(cone(Vec3::Z, by_rise(rise), cone_edges(cone_angle, penumbra))))
                    .sum();
                let integral = 2.0 * PI * depth * sum / f64::from(n);
                let error = |solid_angle: f64| (solid_angle / integral - 1.0).abs();
                assert!(error(cone_solid_angle(cone_angle, penumbra)) < 1e-3, "{cone_angle}° {penumbra}");
                // A wrong twin: the cone without its soft edge.
                if penumbra > 0.0 {
                    assert!(error(cone_solid_angle(cone_angle, 0.0)) > 1e-2, "{cone_angle}° {penumbra}");
                }
            }
        }
    }

    #[test]
    fn cones_have_the_solid_angles_of_the_books() {
        // A hemisphere, and a cone whose half angle is 60°: 2π (1 − cos 60°).
        assert!((cone_solid_angle(90.0, 0.0) - 2.0 * PI).abs() < 1e-12);
        assert!((cone_solid_angle(60.0, 0.0) - PI).abs() < 1e-6);
        assert!((SPHERE - 12.566_370_6).abs() < 1e-6);
        assert!(cone_solid_angle(f32::MIN_POSITIVE, 0.5) > 0.0, "division by the narrowest cone is safe");
    }

    #[test]
    fn twice_the_distance_is_a_quarter_of_the_light() {
        let near = inverse_square(Vec3::new(0.0, 1.5, 0.0));
        let far = inverse_square(Vec3::new(0.0, 0.0, 3.0));
        assert!((near / far - 4.0).abs() < 1e-6);
        assert!((inverse_square(Vec3::X * 2.0) - 0.25).abs() < 1e-7);
        // Exact far away too: no window cuts the light off.
        assert!((inverse_square(Vec3::X * 100.0) - 1e-4).abs() < 1e-10);
    }

    #[test]
    fn a_surface_that_touches_the_light_gets_a_finite_answer() {
        assert_eq!(inverse_square(Vec3::ZERO), 1e6);
    }

    #[test]
    fn cones_are_full_inside_empty_outside_and_fade_between() {
        let at = |degrees| at(degrees, 30.0, 0.5);
        assert_eq!(at(0.0), 1.0);
        assert_eq!(at(14.9), 1.0);
        assert_eq!(at(30.1), 0.0);
        assert!(at(20.0) > at(25.0) && at(25.0) > 0.0 && at(20.0) < 1.0);
    }

    #[test]
    fn a_penumbra_of_zero_is_a_hard_edge() {
        assert_eq!([at(29.9, 30.0, 0.0), at(30.1, 30.0, 0.0)], [1.0, 0.0]);
    }
}
