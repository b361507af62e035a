//! Light with extent in explanations: an integral over many directions instead of the equation for one.

use super::{
    Geometry, Line, Lit, Model,
    numbers::{DIGITS, colour, measured, rounded},
    workings::of_terms,
};
use crate::{
    optics::{TermSelection, Terms},
    reflection::{EquationPart, Term},
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
    /// The solid angle of the light, sr, and its standard error; 0 where a formula gives it.
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
        let angle = match error {
            0.0 => rounded(angle, DIGITS),
            _ => measured(Vec3::splat(angle), Vec3::splat(error)),
        };
        format!("As seen from the point it fills {angle} sr.")
    }

    /// A line for each term that is not 0.
    pub(super) fn lines(&self, terms: &Terms, model: &Model) -> Vec<Line> {
        let all = of_terms(terms).into_iter().zip(of_terms(&self.errors));
        let line = |((term, value), (_, error)): ((Term, Vec3), (Term, Vec3))| {
            // Light through a body has a path instead.
            let is_path =
                |part: &&EquationPart| part.along_path && part.term == term && !part.text.contains(" if ");
            let path = model.parts().find(is_path);
            let text = path.map_or_else(
                || format!("{0} = ∫ {0}(l) L(l) dω", term.symbol()),
                |path| path.text.to_owned(),
            );
            Line { error: Some(error), ..Line::new(term, text, colour(value)) }
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
