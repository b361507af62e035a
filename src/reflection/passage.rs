//! The passage of light through a surface.

use std::ops::BitOr;

use super::{Declaration, EquationPart, Term};

/// The transmitted term at the end of the sum of the terms.
const SUMMAND: &str = " + I_t";

/// The passage of light through surfaces, for which a renderer must be ready. Most models
/// [declare](Declaration::passage) it; if it depends on the parameters, a shader contains only the code that its
/// materials need, so that an opaque one costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Passage {
    /// True if light from below the surface counts.
    pub transmits: bool,
    /// True if there may be directions in which light does not spread.
    pub sharp: bool,
    /// True if light follows the mesh of the object.
    pub solid: bool,
}

impl Passage {
    /// No light passes.
    pub const NONE: Self = Self { transmits: false, sharp: false, solid: false };
    /// Light passes through a sheet.
    pub const SHEET: Self = Self { transmits: true, sharp: true, solid: false };
    /// Light passes through a body.
    pub const BODY: Self = Self { transmits: true, sharp: false, solid: true };

    /// A number for each passage.
    #[must_use]
    pub const fn bits(self) -> u8 {
        self.transmits as u8 | (self.sharp as u8) << 1 | (self.solid as u8) << 2
    }
}

/// The needs of two surfaces together.
impl BitOr for Passage {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self {
            transmits: self.transmits | other.transmits,
            sharp: self.sharp | other.sharp,
            solid: self.solid | other.solid,
        }
    }
}

impl Declaration {
    /// The passage that is declared: of a model whose parameters decide, all that may be needed.
    #[must_use]
    pub const fn passage(&self) -> Passage {
        Passage { transmits: self.transmits, sharp: self.sharp, solid: self.solid }
    }

    /// The parts of the equation of surfaces with this passage: of opaque ones, if light passes through others of the
    /// model, those without the transmitted term.
    #[must_use]
    pub fn equation_of(&self, passage: Passage) -> Vec<EquationPart> {
        let opaque = self.transmits && passage == Passage::NONE;
        let part = |part: &EquationPart| match part.term {
            Term::Transmitted if opaque => None,
            Term::Total if opaque => {
                let text = part.text.strip_suffix(SUMMAND).unwrap_or(part.text);
                Some(EquationPart { text, ..*part })
            }
            _ => Some(*part),
        };
        self.equation.iter().filter_map(part).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{
        optics::{Frame, TermSelection, colour::Encoding},
        parameter::Value,
        registry::Registry,
        testing::{direction, random_values},
    };

    #[test]
    fn passages_differ_in_their_numbers_and_join() {
        let all = [Passage::NONE, Passage::SHEET, Passage::BODY, Passage::SHEET | Passage::BODY];
        assert_eq!(all.map(Passage::bits), [0, 3, 5, 7]);
        assert_eq!(Passage::NONE | Passage::SHEET, Passage::SHEET);
    }

    #[test]
    fn the_equation_of_an_opaque_surface_has_no_transmitted_term() {
        let symbol = Term::Transmitted.symbol();
        let mut varied = 0;
        for model in Registry::builtin().models() {
            let d = model.declaration;
            for passage in model.passages() {
                let parts = d.equation_of(passage);
                let opaque = passage == Passage::NONE;
                assert!(opaque || parts == d.equation, "{}", d.id);
                let named =
                    |part: &EquationPart| part.term == Term::Transmitted || part.text.contains(symbol);
                assert!(!opaque || !parts.iter().any(named), "{}: {parts:?}", d.id);
                varied += usize::from(parts != d.equation);
            }
        }
        assert!(varied > 0);
    }

    #[test]
    fn the_parameters_of_a_model_tell_what_its_surfaces_do() {
        let mut seed = 41;
        let mut varied = 0;
        for model in Registry::builtin().models() {
            let declared = model.declaration.passage();
            for i in 0..12 {
                let mut values = random_values(model, &mut seed);
                if i % 3 == 0 {
                    values = crate::parameter::Values::default();
                }
                let passage = model.passage(&values);
                assert!(model.passages().contains(&passage), "{}: {values:?}", model.declaration.id);
                assert_eq!(passage | declared, declared, "{}: {values:?}", model.declaration.id);
                varied += usize::from(passage != declared);
                let surface = model.instantiate(&values, Encoding::Srgb);
                assert_eq!(surface.transmits(), passage.transmits, "{}: {values:?}", model.declaration.id);
                let v = direction(&mut seed);
                let sharp = !surface.sharp(v, &Frame::LOCAL).is_empty();
                assert!(passage.sharp || !sharp, "{}: {values:?}", model.declaration.id);
                assert_eq!(
                    surface.interior().is_some(),
                    passage.solid,
                    "{}: {values:?}",
                    model.declaration.id
                );
                let below = -direction(&mut seed);
                let through = surface.response(below, v, &Frame::LOCAL).transmitted;
                assert!(passage.transmits || through == glam::Vec3::ZERO, "{}", model.declaration.id);
            }
        }
        assert!(varied > 6, "{varied}");
    }

    #[test]
    fn what_does_not_spread_light_answers_nowhere() {
        let mut seed = 5;
        let mut sharp = 0;
        for model in Registry::builtin().models() {
            for i in 0..12 {
                let mut values = random_values(model, &mut seed);
                if i % 2 == 0 && model.declaration.sharp && model.parameter("roughness").is_some() {
                    values.set("roughness", Value::Number(0.0));
                }
                let surface = model.instantiate(&values, Encoding::Srgb);
                let answers = (0..40).any(|_| {
                    let v = direction(&mut seed);
                    let l =
                        direction(&mut seed) * Vec3::new(1.0, 1.0, if seed % 2 == 0 { 1.0 } else { -1.0 });
                    surface.response(l, v, &Frame::LOCAL).select(TermSelection::All) != Vec3::ZERO
                });
                assert!(surface.spreads() || !answers, "{}: {values:?}", model.declaration.id);
                // Quick answers for the others are right too.
                assert!(model.is_by_chance(&values) || !surface.spreads(), "{}", model.declaration.id);
                sharp += usize::from(!surface.spreads());
            }
        }
        assert!(sharp > 2, "{sharp}");
    }
}
