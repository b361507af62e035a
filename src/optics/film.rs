//! The reflectance of thin films, in which light interferes: soap bubbles, oil on water, tempered steel.
//!
//! Twin: `assets/shaders/optics/film.wgsl`.

use std::f32::consts::PI;

/// A complex number, with the four operations that a film needs.
#[derive(Clone, Copy)]
struct Complex(f32, f32);

impl Complex {
    fn times(self, o: Self) -> Self {
        Self(self.0 * o.0 - self.1 * o.1, self.0 * o.1 + self.1 * o.0)
    }

    fn squared(self) -> f32 {
        self.0 * self.0 + self.1 * self.1
    }

    /// `(a − self)/(a + self)`, `a` being real.
    fn reflected(self, a: f32) -> Self {
        let scale = ((a + self.0) * (a + self.0) + self.1 * self.1).max(f32::MIN_POSITIVE).recip();
        Self((a * a - self.squared()) * scale, -2.0 * a * self.1 * scale)
    }

    /// The square root with a non-negative imaginary part; that of `self` must not be negative.
    fn root(self) -> Self {
        // The larger part first, and the other from it, without cancellation.
        let large = (0.5 * (self.squared().sqrt() + self.0.abs())).sqrt();
        let small = 0.5 * self.1 / large.max(1e-30);
        if self.0 >= 0.0 { Self(large, small) } else { Self(small, large) }
    }
}

/// The reflectance of a film of index `n_2` between media of the indices `n_1` and `n + ik`, for unpolarised light that
/// meets it at the cosine `c`. `turns` is its thickness over the wavelength in vacuum.
///
/// With the amplitudes r₁₂ and r₂₃ of both boundaries by A. Fresnel's formulas, it is G. Airy's sum
/// `|(r₁₂ + r₂₃ e^{iφ})/(1 + r₁₂ r₂₃ e^{iφ})|²`, `φ = 4π n₂ d cos θ₂/λ`, the mean of both polarisations (M. Born, E. Wolf,
/// *Principles of Optics*, 1.6). Beyond the critical angle of the film everything is reflected.
#[must_use]
pub fn thin_film(n_1: f32, n_2: f32, n: f32, k: f32, turns: f32, c: f32) -> f32 {
    let sin2 = 1.0 - c * c;
    let cos2 = 1.0 - (n_1 / n_2) * (n_1 / n_2) * sin2;
    if cos2 <= 0.0 {
        return 1.0;
    }
    let c_2 = cos2.sqrt();
    // Without whole periods, of which thick films have many: this preserves the last digits of the angle.
    let phase = 2.0 * n_2 * turns * c_2;
    let (sin, cos) = (2.0 * PI * (phase - phase.round())).sin_cos();
    let n2 = Complex((n - k) * (n + k), 2.0 * n * k);
    // n₃ cos θ₃, and the admittance n₃/cos θ₃ = n₃²/(n₃ cos θ₃) of the other polarisation.
    let q = Complex(n2.0 - n_1 * n_1 * sin2, n2.1).root();
    let scale = q.squared().max(1e-30).recip();
    let other = n2.times(Complex(q.0 * scale, -q.1 * scale));
    // |r₁₂ + r₂₃ w|² and |1 + r₁₂ r₂₃ w|²: r₁₂ is real, |w| = 1.
    let sum = |first: f32, second: Complex| {
        let (first2, second2) = (first * first, second.squared());
        let crossed = 2.0 * first * (second.0 * cos - second.1 * sin);
        (first2 + second2 + crossed) / (1.0 + first2 * second2 + crossed).max(1e-30)
    };
    let real = |a: f32, b: f32| (a - b) / (a + b).max(f32::MIN_POSITIVE);
    let s = sum(real(n_1 * c, n_2 * c_2), q.reflected(n_2 * c_2));
    let p = sum(real(n_1 / c.max(1e-9), n_2 / c_2), other.reflected(n_2 / c_2));
    (0.5 * (s + p)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::fresnel::{conductor, dielectric};

    const COSINES: [f32; 6] = [1.0, 0.9, 0.6, 0.3, 0.1, 0.01];

    #[test]
    fn no_film_is_the_bare_boundary() {
        for c in COSINES {
            for (n, k) in [(1.5, 0.0), (0.4, 2.4), (2.9, 3.1)] {
                let bare = if k == 0.0 { dielectric(n, c) } else { conductor(n, k, c) };
                // A film of zero thickness, one with the index of the medium above, and whole periods at
                // normal incidence.
                assert!((thin_film(1.0, 1.7, n, k, 0.0, c) - bare).abs() < 1e-5, "{n} {k} {c}");
                assert!((thin_film(1.0, 1.0, n, k, 0.37, c) - bare).abs() < 1e-5, "{n} {k} {c}");
            }
        }
        assert!((thin_film(1.0, 1.7, 1.5, 0.0, 3.0 / (2.0 * 1.7), 1.0) - 0.04).abs() < 1e-5);
    }

    #[test]
    fn a_quarter_of_a_wavelength_of_the_root_of_the_index_reflects_nothing() {
        let n = 1.5f32.sqrt();
        assert!(thin_film(1.0, n, 1.5, 0.0, 0.25 / n, 1.0) < 1e-6);
        // A quarter of a wavelength more, and the boundary is bare; a wrong phase would not show there.
        assert!((thin_film(1.0, n, 1.5, 0.0, 0.5 / n, 1.0) - 0.04).abs() < 1e-6);
        // A dense film: ((n² − n_g)/(n² + n_g))².
        let expected = ((4.0 - 1.5) / (4.0 + 1.5f32)).powi(2);
        assert!((thin_film(1.0, 2.0, 1.5, 0.0, 0.125, 1.0) - expected).abs() < 1e-5);
    }

    #[test]
    fn reflectances_stay_between_0_and_1_and_reach_1_at_grazing_incidence() {
        for (n_1, n_2) in [(1.0, 0.1), (1.0, 6.0), (1.6, 1.1), (6.0, 1.0)] {
            for (n, k) in [(0.1, 0.0), (1.0, 0.0), (6.0, 0.0), (0.2, 9.0)] {
                for turns in [0.0, 0.1, 1.7, 22.0] {
                    for c in COSINES {
                        let r = thin_film(n_1, n_2, n, k, turns, c);
                        assert!((0.0..=1.0).contains(&r), "{n_1} {n_2} {n} {k} {turns} {c}: {r}");
                    }
                    // Without a film, equal indices do not reflect.
                    if turns > 0.0 || n != n_1 {
                        assert!(thin_film(n_1, n_2, n, k, turns, 0.0) > 0.99, "{n_1} {n_2} {n} {k} {turns}");
                    }
                }
            }
        }
        // Total reflection within the film.
        assert_eq!(thin_film(1.6, 1.1, 1.5, 0.0, 0.5, 0.5), 1.0);
    }
}
