//! Light with extent in explanations: an integral over many directions instead of the equation for one.

use super::{Geometry, Line, Lit, Model, lines::of_terms, measured, numbers::colour, rounded};
use crate::{
    optics::{TermSelection, Terms},
    reflection::Term,
};
use glam::Vec3;

/// The basis of the terms of a light with extent: each is the integral of the equation's term times the
/// luminance over the directions of the light.
#[derive(Clone, Copy, Debug)]
pub struct Integral {
    /// The standard error of each term.
    pub errors: Terms,
    /// Standard error of the light to the observer.
    pub error: Vec3,
    /// Number of samples of the light, and of the model's lobes.
    pub samples: u32,
    /// The solid angle of the light, sr, and its standard error.
    pub solid_angle: [f32; 2],
    /// The sampled direction that contributes most; none if all are dark.
    pub brightest: Option<Brightest>,
}

/// One direction of a light with extent, treated like a light without extent.
#[derive(Clone, Copy, Debug)]
pub struct Brightest {
    /// The direction and its cosines.
    pub geometry: Geometry,
    /// The luminance from this direction, cd/m²: red, green and blue, including the colour of the light.
    pub luminance: Vec3,
    /// The response of the model to light of unit intensity from this direction.
    pub response: Terms,
}

impl Integral {
    /// Describes the samples behind the integral.
    #[must_use]
    pub fn basis(&self) -> String {
        let count = self.samples;
        let samples = if count == 1 { "sample" } else { "samples" };
        format!(
            "An integral over the directions of the light, by {count} {samples} of the light and {count} of the lobes."
        )
    }

    /// Describes the solid angle of the light.
    #[must_use]
    pub fn filled(&self) -> String {
        let [angle, error] = self.solid_angle;
        format!("As seen from the point it fills {} sr.", measured(Vec3::splat(angle), Vec3::splat(error)))
    }

    /// A line for each term that is not 0.
    pub(super) fn lines(&self, terms: &Terms) -> Vec<Line> {
        let all = of_terms(terms).into_iter().zip(of_terms(&self.errors));
        let line = |((term, value), (_, error)): ((Term, Vec3), (Term, Vec3))| Line {
            term,
            text: format!("{0} = ∫ {0}(l) L(l) dω", term.symbol()),
            numbers: None,
            symbols: Vec::new(),
            value: Some(colour(value)),
            error: Some(error),
            quantity: None,
        };
        all.filter(|((_, value), _)| *value != Vec3::ZERO).map(line).collect()
    }
}

impl Brightest {
    /// The equation for light from this direction, line by line: see [`Lit::lines`].
    #[must_use]
    pub fn lines(&self, model: &Model, digits: usize) -> Vec<Line> {
        model.lines(Some(&self.geometry), &self.response, digits)
    }

    /// The contribution of this direction, per steradian.
    #[must_use]
    pub fn gives(&self, terms: TermSelection) -> Vec3 {
        self.response.select(terms) * self.luminance
    }
}

impl Lit {
    /// The directions at the point: those of the light, or of the direction of a light with extent that
    /// contributes most.
    #[must_use]
    pub fn leading(&self) -> Option<Geometry> {
        let brightest = || Some(self.integral?.brightest?.geometry);
        self.geometry.or_else(brightest)
    }

    /// The light to the observer as written: with this many digits, or those that its standard error allows.
    #[must_use]
    pub fn outcome(&self, digits: usize) -> String {
        super::told(self.contribution, self.error(), digits)
    }
}

/// The significant digits that a relative error allows: from one to `most`.
pub(super) fn digits_within(relative: f32, most: usize) -> usize {
    match relative {
        r if r > 0.0 && r.is_finite() => ((-r.log10()).floor().max(0.0) as usize + 1).clamp(1, most),
        _ => most,
    }
}

/// A number with its standard error, both with their significant digits: one for the error, or two if it
/// begins with 1.
pub(super) fn with_error(value: f32, error: f32) -> [String; 2] {
    /// The digits of a 32-bit number.
    const MOST: i32 = 7;
    let (value, error) = (f64::from(value), f64::from(error));
    if error <= 0.0 || !error.is_finite() || !value.is_finite() {
        return [rounded(value, super::numbers::DIGITS), rounded(error, 1)];
    }
    let place = |v: f64| v.abs().log10().floor() as i32;
    let lead = error / 10f64.powi(place(error));
    let of_error = if (1.0..1.95).contains(&lead) { 2 } else { 1 };
    let last = place(error) + 1 - of_error;
    let digits = if value == 0.0 { 1 } else { (place(value) - last + 1).clamp(1, MOST) };
    // Digits before the decimal point are written whether significant or not.
    let unit = 10f64.powi(last.max(0));
    let value = if last > 0 { (value / unit).round() * unit } else { value };
    [rounded(value, digits as usize), rounded(error, of_error as usize)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_their_errors_allow() {
        for (value, error, expected) in [
            (0.512_345, 0.0031, ["0.512", "0.003"]),
            (0.512_345, 0.0012, ["0.5123", "0.0012"]),
            (12.345, 2.0, ["12", "2"]),
            (12_345.0, 300.0, ["12300", "300"]),
            (0.01, 0.3, ["0.01", "0.3"]),
            (0.3, 0.0, ["0.3", "0"]),
            (1.0 / 3.0, 0.0, ["0.3333", "0"]),
            (0.0, 0.1, ["0", "0.1"]),
        ] {
            assert_eq!(with_error(value, error), expected, "{value} {error}");
        }
        assert_eq!([1e-5, 0.003, 0.2, 3.0, 0.0].map(|r| digits_within(r, 4)), [4, 3, 1, 1, 4]);
    }
}
