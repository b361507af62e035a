//! A thin plate: two parallel boundaries, between which light goes back and forth.
//!
//! Twin: `assets/shaders/optics/slab.wgsl`.

use glam::Vec3;

/// The fractions of light that a plate reflects and transmits, in red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab {
    /// The light that comes back.
    pub reflectance: Vec3,
    /// The light that goes through.
    pub transmittance: Vec3,
}

/// A plate whose boundaries reflect the fraction `r`, and of whose light `a` is left after each crossing. All orders of
/// reflection are included, added up by brightness (the plate is thick compared with the waves, so they do not interfere):
/// `T = (1 − r)² a/(1 − r² a²)`, `R = r + r a T`. Without absorption `R = 2r/(1 + r)` and `T = (1 − r)/(1 + r)`, whose sum
/// is 1. All light is reflected at r = 1, and absorbed or reflected once at a = 0.
///
/// G. G. Stokes (1862), *On the Intensity of the Light Reflected from or Transmitted through a Pile of Plates*, Proceedings
/// of the Royal Society of London 11, 545–556.
#[must_use]
pub fn slab(r: Vec3, a: Vec3) -> Slab {
    let r = r.clamp(Vec3::ZERO, Vec3::ONE);
    let a = a.clamp(Vec3::ZERO, Vec3::ONE);
    let through = 1.0 - r;
    // (1 − r)²/(1 − r a), where 1 − r a = (1 − r) + r (1 − a) without cancellation; zero for r = 1.
    let once = through * through / (through + r * (Vec3::ONE - a)).max(Vec3::splat(f32::MIN_POSITIVE));
    let transmittance = a * once / (1.0 + r * a);
    Slab { reflectance: r + r * a * transmittance, transmittance }
}

/// The part of the light left after crossing a plate at an angle whose cosine within the plate is `cosine`, from the part
/// `a` left along the normal: the way is longer by 1/cos θ, and light decays exponentially (P. Bouguer 1729; J. H. Lambert
/// 1760; A. Beer 1852).
#[must_use]
pub fn oblique(a: Vec3, cosine: f32) -> Vec3 {
    let longer = 1.0 / cosine.clamp(1e-4, 1.0);
    a.map(|a| if a > 0.0 { a.min(1.0).powf(longer) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{fresnel::dielectric, refraction::refracted_cosine};

    /// The orders of reflection one by one.
    fn orders(r: f64, a: f64) -> [f64; 2] {
        let (mut back, mut through, mut inside) = (r, 0.0, (1.0 - r) * a);
        for order in 0..20_000 {
            let out = inside * (1.0 - r);
            if order % 2 == 0 {
                through += out
            } else {
                back += out
            }
            inside *= r * a;
        }
        [back, through]
    }

    #[test]
    fn all_orders_add_up_to_the_closed_form() {
        for r in [0.0f32, 0.04, 0.3, 0.9, 0.999] {
            for a in [0.0f32, 0.2, 0.9, 1.0] {
                let found = slab(Vec3::splat(r), Vec3::splat(a));
                let [back, through] = orders(f64::from(r), f64::from(a));
                assert!((f64::from(found.reflectance.x) - back).abs() < 1e-6, "{r} {a}: {found:?} {back}");
                assert!((f64::from(found.transmittance.y) - through).abs() < 1e-6, "{r} {a}: {through}");
                // The first order alone is less.
                let first = (1.0 - r) * (1.0 - r) * a;
                assert!(r < 0.3 || a < 0.2 || found.transmittance.x / first > 1.003, "{r} {a}");
            }
        }
    }

    #[test]
    fn clear_plates_lose_nothing_and_no_plate_gains() {
        for i in 0..=1000 {
            let r = i as f32 / 1000.0;
            let clear = slab(Vec3::splat(r), Vec3::ONE);
            assert!((clear.reflectance - 2.0 * r / (1.0 + r)).abs().max_element() < 1e-6, "{r}");
            assert!((clear.transmittance - (1.0 - r) / (1.0 + r)).abs().max_element() < 1e-6, "{r}");
            assert!((clear.reflectance + clear.transmittance - 1.0).abs().max_element() < 1e-6, "{r}");
            let tinted = slab(Vec3::splat(r), Vec3::new(0.1, 0.7, 0.999));
            let sum = tinted.reflectance + tinted.transmittance;
            assert!(sum.max_element() <= 1.0 + 1e-6 && tinted.transmittance.min_element() >= 0.0, "{r}");
        }
    }

    #[test]
    fn the_ends_of_all_ranges_are_finite() {
        assert_eq!(slab(Vec3::ONE, Vec3::ONE), Slab { reflectance: Vec3::ONE, transmittance: Vec3::ZERO });
        let thick = slab(Vec3::splat(0.04), Vec3::ZERO);
        assert_eq!((thick.transmittance, thick.reflectance), (Vec3::ZERO, Vec3::splat(0.04)));
        for r in [-1.0, 0.0, f32::MIN_POSITIVE, 1.0 - f32::EPSILON, 1.0, 2.0] {
            for a in [-1.0, 0.0, f32::MIN_POSITIVE, 1.0, 1e30] {
                let found = slab(Vec3::splat(r), Vec3::splat(a));
                assert!(found.reflectance.is_finite() && found.transmittance.is_finite(), "{r} {a}");
                assert!(found.reflectance.max_element() <= 1.0 + 1e-6, "{r} {a}: {found:?}");
                for cosine in [0.0, 1e-9, 0.5, 1.0, 2.0] {
                    let left = oblique(Vec3::splat(a), cosine);
                    assert!(left.min_element() >= 0.0 && left.max_element() <= 1.0, "{a} {cosine}: {left}");
                }
            }
        }
    }

    #[test]
    fn window_glass_has_its_textbook_values() {
        // 4 % at each face: 92.3 % pass a pane.
        let pane = slab(Vec3::splat(dielectric(1.5, 1.0)), Vec3::ONE);
        assert!((pane.transmittance.x - 0.923_077).abs() < 1e-5);
        let oblique_pane = slab(Vec3::splat(dielectric(1.5, 0.5)), Vec3::ONE);
        assert!((oblique_pane.transmittance.x - (1.0 - 0.089_187) / (1.0 + 0.089_187)).abs() < 1e-5);
        // Along the way at 60°, the cosine within is √(1 − 3/4/2.25).
        let cosine = refracted_cosine(0.5, 1.5);
        assert!((cosine - 0.816_497).abs() < 1e-5);
        assert!((oblique(Vec3::splat(0.5), cosine).x - 0.5f32.powf(1.0 / 0.816_497)).abs() < 1e-6);
        assert_eq!(oblique(Vec3::ONE, 0.0), Vec3::ONE);
    }
}
