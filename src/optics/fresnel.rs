//! Fresnel reflectance: the fraction of light that a smooth boundary reflects, by angle.
//!
//! Twin: `assets/shaders/optics/fresnel.wgsl`. `cos_i` is the cosine between the light and the normal of
//! the (micro)facet, 0 to 1; every reflectance is 1 at grazing incidence.

use glam::Vec3;

/// `(1 − cos θ)⁵`, C. Schlick (1994).
#[must_use]
pub fn schlick_weight(cos_i: f32) -> f32 {
    let m = (1.0 - cos_i).clamp(0.0, 1.0);
    let m2 = m * m;
    m2 * m2 * m
}

/// Schlick's approximation, `F = F₀ + (1 − F₀)(1 − cos θ)⁵`: C. Schlick (1994), *An Inexpensive BRDF
/// Model for Physically-based Rendering*.
#[must_use]
pub fn schlick(f0: Vec3, cos_i: f32) -> Vec3 {
    f0 + (Vec3::ONE - f0) * schlick_weight(cos_i)
}

/// The reflectance of a dielectric of relative refractive index `n` for unpolarised light, exact (A.
/// Fresnel 1823): the mean of
/// `r_s = (c − g)/(c + g)` and `r_p = (n² c − g)/(n² c + g)`, squared, `g = √(n² − 1 + c²)`. Beyond the
/// critical angle (n < 1) everything is reflected.
#[must_use]
pub fn dielectric(n: f32, cos_i: f32) -> f32 {
    let c = cos_i.clamp(0.0, 1.0);
    // n² − 1 in factors, which keeps the last digits where n is close to 1.
    let g2 = (n - 1.0) * (n + 1.0) + c * c;
    if g2 <= 0.0 {
        // Total reflection; for n = 1 at exactly grazing incidence, the limit.
        return 1.0;
    }
    let g = g2.sqrt();
    let n2c = n * n * c;
    let (s, p) = ((c - g) / (c + g), (n2c - g) / (n2c + g));
    0.5 * (s * s + p * p)
}

/// The reflectance of a conductor of relative refractive index `n + ik` for unpolarised light, exact, one
/// channel; equal to [`dielectric`] where k = 0.
///
/// With `a² + b²` for the squared modulus of `√((n + ik)² − sin² θ)` (M. Born, E. Wolf, *Principles of
/// Optics*, 14.2; the real form as in S. Lagarde 2013, *Memo on Fresnel Equations*):
/// `R_s = (a² + b² − 2a c + c²)/(a² + b² + 2a c + c²)`,
/// `R_p = R_s (c²(a² + b²) − 2a c s² + s⁴)/(c²(a² + b²) + 2a c s² + s⁴)`, c = cos θ, s = sin θ.
#[must_use]
pub fn conductor(n: f32, k: f32, cos_i: f32) -> f32 {
    let c = cos_i.clamp(0.0, 1.0);
    if k == 0.0 {
        return dielectric(n, c);
    }
    let c2 = c * c;
    let s2 = 1.0 - c2;
    // (n + ik)² − sin² θ = t + i·2nk.
    let t = (n - k) * (n + k) - s2;
    let modulus = t.hypot(2.0 * n * k);
    // a = Re √…: the form without cancellation.
    let a = if t > 0.0 {
        (0.5 * (modulus + t)).sqrt()
    } else if modulus - t > 0.0 {
        n * k / (0.5 * (modulus - t)).sqrt()
    } else {
        0.0
    };
    let twice = 2.0 * a * c;
    let s = (modulus + c2 - twice) / (modulus + c2 + twice).max(f32::MIN_POSITIVE);
    let even = c2 * modulus + s2 * s2;
    let odd = twice * s2;
    let p = s * (even - odd) / (even + odd).max(f32::MIN_POSITIVE);
    (0.5 * (s + p)).clamp(0.0, 1.0)
}

/// [`conductor`] for the three channels.
#[must_use]
pub fn conductor_rgb(n: Vec3, k: Vec3, cos_i: f32) -> Vec3 {
    Vec3::new(conductor(n.x, k.x, cos_i), conductor(n.y, k.y, cos_i), conductor(n.z, k.z, cos_i))
}

/// [`dielectric`] for the three channels.
#[must_use]
pub fn dielectric_rgb(n: Vec3, cos_i: f32) -> Vec3 {
    Vec3::new(dielectric(n.x, cos_i), dielectric(n.y, cos_i), dielectric(n.z, cos_i))
}

/// The reflectance at normal incidence of a boundary to refractive index `n + ik`:
/// `F₀ = ((n − 1)² + k²)/((n + 1)² + k²)`.
#[must_use]
pub fn normal_reflectance(n: f32, k: f32) -> f32 {
    let k2 = k * k;
    ((n - 1.0) * (n - 1.0) + k2) / ((n + 1.0) * (n + 1.0) + k2)
}

/// [`normal_reflectance`] for the three channels.
#[must_use]
pub fn normal_reflectance_rgb(n: Vec3, k: Vec3) -> Vec3 {
    Vec3::new(normal_reflectance(n.x, k.x), normal_reflectance(n.y, k.y), normal_reflectance(n.z, k.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(degrees: f32) -> f32 {
        degrees.to_radians().cos()
    }

    #[test]
    fn glass_has_the_textbook_reflectances() {
        for (angle, expected) in [
            (0.0, 0.04),
            (45.0, 0.050_239_91),
            (60.0, 0.089_186_71),
            (75.0, 0.253_060_56),
            (80.0, 0.387_704_35),
            (85.0, 0.612_799_65),
            (89.0, 0.904_184_95),
        ] {
            let f = dielectric(1.5, at(angle));
            assert!((f - expected).abs() < 1e-5 * expected, "{angle}°: {f} instead of {expected}");
            assert!((conductor(1.5, 1e-6, at(angle)) - expected).abs() < 1e-4 * expected, "{angle}°, k → 0");
        }
        // Schlick's approximation fails.
        assert!((schlick(Vec3::splat(0.04), at(75.0)).x - 0.253_060_56).abs() > 1e-3);
    }

    #[test]
    fn gold_dips_before_it_rises() {
        let gold = |angle| conductor(0.188_36, 3.403_4, at(angle));
        for (angle, expected) in [(0.0, 0.942_02), (60.0, 0.936_38), (89.0, 0.992_76)] {
            assert!((gold(angle) - expected).abs() < 2e-5, "{angle}°: {}", gold(angle));
        }
        assert!((normal_reflectance(0.188_36, 3.403_4) - gold(0.0)).abs() < 1e-5);
    }

    /// Cosine-weighted mean over the hemisphere, `2 ∫ F(μ) μ dμ`.
    fn average(f: impl Fn(f32) -> f32) -> f64 {
        let n = 20_000;
        (0..n)
            .map(|i| (i as f64 + 0.5) / f64::from(n))
            .map(|mu| 2.0 * f64::from(f(mu as f32)) * mu / f64::from(n))
            .sum()
    }

    #[test]
    fn averages_over_the_hemisphere_are_the_closed_forms() {
        assert!((average(|mu| dielectric(1.5, mu)) - 0.091_778).abs() < 1e-5);
        assert!((average(|mu| dielectric(1.33, mu)) - 0.065_930_8).abs() < 1e-5);
        let f0 = 0.3;
        let mean = average(|mu| schlick(Vec3::splat(f0), mu).x);
        assert!((mean - f64::from(f0 + (1.0 - f0) / 21.0)).abs() < 1e-5);
    }

    #[test]
    fn everything_is_reflected_at_grazing_and_nothing_is_more_than_everything() {
        for n in [0.01, 0.2, 0.9, 1.0 + 1e-6, 1.33, 1.5, 2.4, 6.0] {
            for k in [0.0, 1e-6, 0.1, 3.0, 12.0] {
                assert!((conductor(n, k, 0.0) - 1.0).abs() < 1e-5, "n {n} k {k}");
                for i in 0..=1000 {
                    let f = conductor(n, k, i as f32 / 1000.0);
                    assert!((0.0..=1.0).contains(&f), "n {n} k {k}: {f}");
                }
            }
        }
        assert_eq!(schlick(Vec3::splat(0.04), 0.0), Vec3::ONE);
        assert_eq!(dielectric(1.0, 0.5), 0.0);
    }
}
