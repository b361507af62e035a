//! Refraction at a smooth boundary between two transparent media.
//!
//! Twin: `assets/shaders/optics/refraction.wgsl`. Directions point away from the boundary: `v` to the observer, a
//! refracted direction to where the observed light comes from. **η** is the refractive index on the other side of the
//! boundary, divided by that on the side of `v`: 1.5 from air into glass, 1/1.5 from glass into air. Light takes the
//! same path both ways, so statements about rays from the observer hold for light towards it.

use glam::Vec3;

use super::fresnel::dielectric;

/// Indices whose quotient differs from 1 by less count as equal: a boundary between them neither reflects nor bends light.
/// Closer to 1, directions of 32 bits have too few digits to tell which facet refracts from one to another.
pub const MATCHED: f32 = 1e-3;

/// True for two indices so close that the boundary is invisible; see [`MATCHED`].
#[must_use]
pub fn is_matched(eta: f32) -> bool {
    (eta - 1.0).abs() < MATCHED
}

/// η for a direction with this cosine to the normal of a body of refractive index `ior`: from outside, where the cosine
/// is positive, or from inside.
#[must_use]
pub fn relative_index(ior: f32, cosine: f32) -> f32 {
    if cosine >= 0.0 { ior } else { 1.0 / ior }
}

/// The cosine of the angle of refraction at an angle of incidence with this cosine, both to the normal, not negative:
/// `√(1 − sin² θ / η²)`; 0 beyond the angle of total reflection.
#[must_use]
pub fn refracted_cosine(cosine: f32, eta: f32) -> f32 {
    root(cosine.abs(), eta).map_or(0.0, |g| (g / eta).min(1.0))
}

/// `√(η² − sin² θ)`, unless the boundary reflects everything.
fn root(cosine: f32, eta: f32) -> Option<f32> {
    // η² − 1 in factors, which keeps the last digits where η is close to 1.
    let squared = (eta - 1.0) * (eta + 1.0) + cosine * cosine;
    (squared > 0.0).then(|| squared.sqrt())
}

/// The direction to which `v` is refracted at a boundary whose normal, on the side of `v`, is `n`: `((c − g) n − v)/η`,
/// c = n·v, `g = √(η² − 1 + c²)` (W. Snell about 1621, as a vector). For η = 1 it is `−v`. `None` where everything is reflected:
/// for η < 1, where the angle to the normal exceeds asin η.
#[must_use]
pub fn refracted(v: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let c = n.dot(v);
    let g = root(c, eta)?;
    // c − g without cancellation.
    let along = (1.0 - eta) * (1.0 + eta) / (c.max(0.0) + g);
    Some((along * n - v) / eta)
}

/// The largest angle to the normal at which light leaves the denser of two media of relative index η, in radians: asin 1/η,
/// or asin η from the other side. Beyond it, all light is reflected. A right angle for equal indices.
#[must_use]
pub fn critical_angle(eta: f32) -> f32 {
    eta.min(1.0 / eta).clamp(0.0, 1.0).asin()
}

/// The vector `±(v + η l)` along the normal of the facet that refracts `l` to `v`, on the side of the normal (z ≥ 0 in the
/// local frame): the generalised half vector, not normalised. Zero for opposite directions and η = 1.
///
/// B. Walter, S. Marschner, H. Li, K. Torrance (2007), *Microfacet Models for Refraction through Rough Surfaces*.
#[must_use]
pub fn across(l: Vec3, v: Vec3, eta: f32) -> Vec3 {
    // The sum of nearly opposite vectors first: it is exact.
    let sum = (l + v) + (eta - 1.0) * l;
    if sum.z < 0.0 { -sum } else { sum }
}

/// The reflectance of a dielectric boundary that refracts between directions with these cosines to its normal, from the
/// side of `v` with η: that of [`dielectric`], calculated on the side of the thinner medium, where it depends on the angle
/// less strongly.
#[must_use]
pub fn refracting_reflectance(cos_l: f32, cos_v: f32, eta: f32) -> f32 {
    if eta >= 1.0 { dielectric(eta, cos_v) } else { dielectric(1.0 / eta, cos_l) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::geometry::direction;

    /// The angle between the refracted direction and the inner normal, in degrees.
    fn angle(theta: f64, eta: f32) -> Option<f64> {
        let t = refracted(direction(theta, 40.0), Vec3::Z, eta)?;
        assert!((t.length() - 1.0).abs() < 1e-6, "{theta} {eta}: {t}");
        // In the plane of incidence, on the other side.
        assert!(t.dot(direction(90.0, 130.0)).abs() < 1e-6 && t.z <= 0.0);
        Some(f64::from(t.truncate().length()).atan2(f64::from(-t.z)).to_degrees())
    }

    #[test]
    fn angles_obey_snells_law() {
        for eta in [1.0f32, 1.000_1, 1.33, 1.5, 2.4, 0.9, 1.0 / 1.5, 0.4] {
            for theta in [0.0, 5.0, 30.0, 41.0, 42.0, 60.0, 89.0, 90.0f64] {
                let sine = theta.to_radians().sin() / f64::from(eta);
                match angle(theta, eta) {
                    Some(found) => {
                        assert!((found.to_radians().sin() - sine).abs() < 2e-6, "{theta} {eta}: {found}");
                        let cosine = refracted_cosine(direction(theta, 0.0).z, eta);
                        assert!((f64::from(cosine) - found.to_radians().cos()).abs() < 2e-4, "{theta} {eta}");
                    }
                    None => assert!(sine > 1.0 - 1e-6, "{theta} {eta}: nothing is refracted"),
                }
            }
        }
        // Textbook values; a wrong twin with the inverse index would bend away from the normal.
        assert!(angle(30.0, 1.5).is_some_and(|found| (found - 19.471).abs() < 1e-3));
        assert!(angle(30.0, 1.0 / 1.5).is_some_and(|found| (found - 48.590).abs() < 1e-3));
    }

    #[test]
    fn everything_is_reflected_beyond_the_critical_angle() {
        for (ior, expected) in [(1.5f32, 41.810), (1.33, 48.753), (2.4, 24.624), (1.0, 90.0)] {
            let critical = f64::from(critical_angle(ior)).to_degrees();
            assert!((critical - expected).abs() < 1e-3, "{ior}: {critical}");
            assert_eq!(critical_angle(ior), critical_angle(1.0 / ior));
            let inside = relative_index(ior, -1.0);
            assert!(refracted(direction(critical - 0.01, 0.0), Vec3::Z, inside).is_some());
            if ior > 1.0 {
                let beyond = direction(critical + 0.01, 0.0);
                assert_eq!(refracted(beyond, Vec3::Z, inside), None);
                assert_eq!(refracted_cosine(beyond.z, inside), 0.0);
                assert_eq!(dielectric(inside, beyond.z), 1.0);
            }
        }
    }

    #[test]
    fn a_ray_goes_back_the_way_it_came() {
        for eta in [1.001, 1.33, 1.5, 2.4] {
            for theta in [0.0, 20.0, 70.0, 89.9] {
                let n = direction(30.0, 200.0);
                let v = crate::optics::sampling::about(n, direction(theta, 60.0));
                let l = refracted(v, n, eta).expect("from the thinner medium");
                let back = refracted(l, -n, 1.0 / eta).expect("below the critical angle");
                assert!((back - v).length() < 2e-3 && back.dot(v) > 1.0 - 1e-5, "{eta} {theta}: {back} {v}");
            }
        }
    }

    #[test]
    fn equal_indices_let_light_go_straight_on() {
        for theta in [0.0, 30.0, 90.0] {
            let v = direction(theta, 25.0);
            if let Some(l) = refracted(v, Vec3::Z, 1.0) {
                assert!((l + v).length() < 1e-6, "{theta}");
            }
            assert!((refracted_cosine(v.z, 1.0) - v.z).abs() < 1e-6);
        }
        assert!(is_matched(1.0) && is_matched(1.0 / 1.000_5) && !is_matched(1.01) && !is_matched(f32::NAN));
    }

    #[test]
    fn the_half_vector_is_the_normal_that_refracts() {
        for eta in [1.05f32, 1.5, 2.4, 1.0 / 1.5] {
            for theta in [0.0, 20.0, 40.0] {
                let n = direction(12.0, 300.0);
                let v = crate::optics::sampling::about(n, direction(theta, 10.0));
                let l = refracted(v, n, eta).expect("below the critical angle");
                let h = across(l, v, eta).normalize();
                assert!((h - n).length() < 2e-5, "{eta} {theta}: {h} {n}");
                // The wrong twin weighs the wrong direction.
                let wrong = (eta * v + l).normalize();
                assert!(theta == 0.0 || (wrong.dot(n).abs() - 1.0).abs() > 1e-4, "{eta} {theta}");
                // The reflectance is that of Fresnel's equations from either side.
                let [cos_l, cos_v] = [l, v].map(|d| d.dot(n).abs());
                let found = refracting_reflectance(cos_l, cos_v, eta);
                assert!((found - dielectric(eta, cos_v)).abs() < 1e-5);
                assert!((found - dielectric(1.0 / eta, cos_l)).abs() < 1e-4);
            }
        }
        assert_eq!(across(Vec3::NEG_X, Vec3::X, 1.0), Vec3::ZERO);
    }

    #[test]
    fn hostile_numbers_give_finite_directions() {
        for eta in [f32::MIN_POSITIVE, 1e-3, 1.0, 1e3, 1e18] {
            for v in [Vec3::Z, Vec3::X, Vec3::NEG_Z, Vec3::ZERO] {
                assert!(refracted(v, Vec3::Z, eta).is_none_or(Vec3::is_finite), "{eta} {v}");
                assert!(refracted_cosine(v.z, eta).is_finite() && critical_angle(eta).is_finite());
            }
        }
    }
}
