//! Fitting a reflection model to reflectance data.
//!
//! Every model is fitted with the same three numbers: `f = d/π + s · lobe(l, v; w)`, a diffuse reflectance d, a scale s
//! of the model's own specular lobe, and the width w of that lobe. The fit minimises the root mean square of `ln f − ln
//! f_data`, which weighs relative errors equally for large and small values; the same measure as J. Löw, J. Kronander,
//! A. Ynnerman, J. Unger (2012), *BRDF Models for Accurate and Efficient Rendering of Glossy Surfaces*, without their
//! weights.
//!
//! For each width the two scales are found by [least squares](crate::matching::least_squares) in their logarithms, so
//! that they stay positive. The width is found by trying
//! a series of widths and narrowing the best interval by golden-section search (J. Kiefer 1953, *Sequential Minimax
//! Search for a Maximum*).

use std::f64::consts::FRAC_1_PI;

use glam::Vec3;

use crate::matching::least_squares::{Limits, Residuals, Stop, descend};

/// One value of a BRDF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Direction to the light.
    pub l: Vec3,
    /// Direction to the viewer.
    pub v: Vec3,
    /// `f_r` in sr⁻¹, greater than 0.
    pub value: f64,
}

/// The result of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// Diffuse reflectance d.
    pub diffuse: f64,
    /// Scale s of the specular lobe.
    pub specular: f64,
    /// Width w of the specular lobe.
    pub width: f64,
    /// Root mean square of `ln f − ln f_data`.
    pub error: f64,
}

/// The model `d/π + s · lobe`.
fn model(diffuse: f64, specular: f64, lobe: f64) -> f64 {
    diffuse * FRAC_1_PI + specular * lobe
}

/// The smallest value for logarithms.
const FLOOR: f64 = 1e-12;

/// Root mean square of `ln f − ln f_data`.
#[must_use]
pub fn error(fit: &Fit, values: &[f64], lobe: &[f64]) -> f64 {
    let sum: f64 = values
        .iter()
        .zip(lobe)
        .map(|(y, q)| (model(fit.diffuse, fit.specular, *q).max(FLOOR) / y).ln().powi(2))
        .sum();
    (sum / values.len().max(1) as f64).sqrt()
}

/// The best constant `d/π`: the error of a purely diffuse surface.
#[must_use]
pub fn diffuse_only(values: &[f64]) -> Fit {
    let n = values.len().max(1) as f64;
    let mean = values.iter().map(|y| y.ln()).sum::<f64>() / n;
    let fit = Fit { diffuse: mean.exp() / FRAC_1_PI, specular: 0.0, width: 0.0, error: 0.0 };
    Fit { error: error(&fit, values, &vec![0.0; values.len()]), ..fit }
}

/// The best scales for a lobe whose values are given for every sample.
#[must_use]
pub fn scales(values: &[f64], lobe: &[f64], width: f64) -> Fit {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let (peak, at_peak) =
        values.iter().zip(lobe).fold((0.0, 0.0), |best, (y, q)| if *q > best.1 { (*y, *q) } else { best });
    let mut best = Fit {
        diffuse: low / FRAC_1_PI,
        specular: if at_peak > 0.0 { peak / at_peak } else { 0.0 },
        width,
        error: 0.0,
    };
    if best.specular <= 0.0 {
        return Fit { width, ..diffuse_only(values) };
    }
    let mut at = [best.diffuse.ln(), best.specular.ln()];
    // Nothing ends it early.
    let _ = descend(&mut Scales { values, lobe }, &mut at, &[RANGE; 2], LIMITS);
    [best.diffuse, best.specular] = at.map(f64::exp);
    Fit { error: error(&best, values, lobe), ..best }
}

/// The logarithms of the scales.
const RANGE: (f64, f64) = (-27.0, 27.0);
/// The end of the search for the scales.
const LIMITS: Limits = Limits { steps: 60, least_gain: 1e-8, least_move: 1e-9, first_step: 1.0 };

/// `ln f − ln f_data` as a function of ln d and ln s.
struct Scales<'a> {
    values: &'a [f64],
    lobe: &'a [f64],
}

impl Residuals for Scales<'_> {
    fn count(&self) -> usize {
        self.values.len()
    }

    fn at(&mut self, point: &[f64], residuals: &mut [f64]) -> Result<(), Stop> {
        let (d, s) = (point[0].exp(), point[1].exp());
        for ((to, y), q) in residuals.iter_mut().zip(self.values).zip(self.lobe) {
            *to = (model(d, s, *q).max(FLOOR) / y).ln();
        }
        Ok(())
    }

    fn derivatives(
        &mut self,
        point: &[f64],
        residuals: &mut [f64],
        columns: &mut [Vec<f64>],
    ) -> Result<(), Stop> {
        let (d, s) = (point[0].exp(), point[1].exp());
        for (i, q) in self.lobe.iter().enumerate() {
            let f = model(d, s, *q).max(FLOOR);
            columns[0][i] = d * FRAC_1_PI / f;
            columns[1][i] = s * q / f;
        }
        self.at(point, residuals)
    }
}

/// The best width and scales. `lobe` returns the specular lobe with a width at every sample.
#[must_use]
pub fn fit(samples: &[Sample], widths: (f64, f64), lobe: impl Fn(f64, &[Sample]) -> Vec<f64>) -> Fit {
    let values: Vec<f64> = samples.iter().map(|s| s.value).collect();
    let at = |x: f64| scales(&values, &lobe(x.exp(), samples), x.exp());
    let (from, to) = (widths.0.ln(), widths.1.ln());
    let count = 25;
    let x = |i: usize| from + (to - from) * i as f64 / (count - 1) as f64;
    let row: Vec<Fit> = (0..count).map(|i| at(x(i))).collect();
    let best = (0..count).min_by(|i, j| row[*i].error.total_cmp(&row[*j].error)).unwrap_or(0);
    let (mut low, mut high) = (x(best.saturating_sub(1)), x((best + 1).min(count - 1)));
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| (high - golden * (high - low), low + golden * (high - low));
    let (a, b) = inner(low, high);
    let (mut left, mut right) = (at(a), at(b));
    for _ in 0..12 {
        if left.error < right.error {
            high = right.width.ln();
            right = left;
            left = at(inner(low, high).0);
        } else {
            low = left.width.ln();
            left = right;
            right = at(inner(low, high).1);
        }
    }
    [row[best], left, right].into_iter().min_by(|a, b| a.error.total_cmp(&b.error)).unwrap_or(left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{distribution, geometry::half_vector};
    use glam::Vec2;

    fn lobe(width: f64, samples: &[Sample]) -> Vec<f64> {
        let d = |s: &Sample| distribution::ggx(half_vector(s.l, s.v), Vec2::splat(width as f32));
        samples.iter().map(|s| f64::from(d(s)) / f64::from(4.0 * s.l.z * s.v.z)).collect()
    }

    fn directions() -> Vec<Sample> {
        let mut samples = Vec::new();
        for i in 0..6u8 {
            for j in 0..10u8 {
                for k in 0..6u8 {
                    let (ti, to, phi) =
                        (f32::from(i) * 0.2, f32::from(j) * 0.12, f32::from(k) * std::f32::consts::PI / 5.0);
                    let l = Vec3::new(ti.sin(), 0.0, ti.cos());
                    let v = Vec3::new(to.sin() * phi.cos(), to.sin() * phi.sin(), to.cos());
                    samples.push(Sample { l, v, value: 1.0 });
                }
            }
        }
        samples
    }

    #[test]
    fn a_fit_finds_the_parameters_that_made_the_data() {
        for (d, s, w) in [(0.3, 0.04, 0.16), (0.02, 0.9, 0.45), (0.5, 0.002, 0.05)] {
            let mut samples = directions();
            let q = lobe(w, &samples);
            samples.iter_mut().zip(&q).for_each(|(sample, q)| sample.value = model(d, s, *q));
            let found = fit(&samples, (0.01, 1.0), lobe);
            assert!(found.error < 2e-3, "{found:?}");
            for (name, a, b) in [("d", found.diffuse, d), ("s", found.specular, s), ("w", found.width, w)] {
                assert!((a / b - 1.0).abs() < 0.02, "{name}: {a} instead of {b}");
            }
            // The lobe of another distribution does not fit as well, which the error shows.
            let beckmann = |width: f64, samples: &[Sample]| {
                let d = |s: &Sample| distribution::beckmann(half_vector(s.l, s.v), Vec2::splat(width as f32));
                samples.iter().map(|s| f64::from(d(s)) / f64::from(4.0 * s.l.z * s.v.z)).collect()
            };
            let wrong = fit(&samples, (0.01, 1.0), beckmann);
            assert!(wrong.error > 3.0 * found.error.max(1e-3), "{wrong:?}");
        }
    }

    #[test]
    fn a_diffuse_surface_is_found_to_be_one() {
        let values = vec![0.1; 50];
        let found = diffuse_only(&values);
        assert!((found.diffuse - 0.1 * std::f64::consts::PI).abs() < 1e-9 && found.error < 1e-9);
        // A factor e up and down gives an error of 1.
        let values = [1f64.exp(), (-1f64).exp()];
        assert!((diffuse_only(&values).error - 1.0).abs() < 1e-12);
        // A lobe that is zero everywhere changes nothing.
        assert_eq!(scales(&values, &[0.0, 0.0], 0.1).specular, 0.0);
    }
}
