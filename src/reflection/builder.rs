//! Declarations of reflection models, step by step: another field of [`Declaration`] changes none of them.

use super::{
    declaration::{Ambient, Declaration, EquationPart, Family, Laws, Term},
    quantity::Quantity,
};
use crate::shader::Source;

impl Declaration {
    /// A model with an id and a name, and its twin in WGSL. It claims no law, answers uniform light by a formula, is
    /// isotropic, and stands among the custom models.
    ///
    /// ```
    /// use lights_camera_models::{reflection::Declaration, shader::Source};
    /// const MATTE: Declaration = Declaration::new("matte", "Matte", Source::new("matte.wgsl", "…"))
    ///     .summary("Scatters light evenly.")
    ///     .reciprocal()
    ///     .non_negative();
    /// assert!(MATTE.laws.reciprocal && !MATTE.laws.energy_conserving);
    /// ```
    #[must_use]
    pub const fn new(id: &'static str, name: &'static str, wgsl: Source) -> Self {
        Self {
            id,
            name,
            family: Family::Custom,
            author: "",
            source: "",
            summary: "",
            synonyms: &[],
            equation: &[],
            quantities: &[],
            laws: Laws::NONE,
            ambient: Ambient::Formula,
            anisotropic: false,
            wgsl,
        }
    }

    /// The same with another id.
    #[must_use]
    pub const fn id(self, id: &'static str) -> Self {
        Self { id, ..self }
    }

    /// The same with another twin in WGSL.
    #[must_use]
    pub const fn wgsl(self, wgsl: Source) -> Self {
        Self { wgsl, ..self }
    }

    /// The same in another family.
    #[must_use]
    pub const fn family(self, family: Family) -> Self {
        Self { family, ..self }
    }

    /// The same with author and year, in short, and the publication.
    #[must_use]
    pub const fn published(self, author: &'static str, source: &'static str) -> Self {
        Self { author, source, ..self }
    }

    /// The same with its purpose and look, in one or two sentences.
    #[must_use]
    pub const fn summary(self, summary: &'static str) -> Self {
        Self { summary, ..self }
    }

    /// The same with other names by which people look for it.
    #[must_use]
    pub const fn synonyms(self, synonyms: &'static [&'static str]) -> Self {
        Self { synonyms, ..self }
    }

    /// The same with its equation.
    #[must_use]
    pub const fn equation(self, equation: &'static [EquationPart]) -> Self {
        Self { equation, ..self }
    }

    /// The same with the quantities of its equation.
    #[must_use]
    pub const fn quantities(self, quantities: &'static [Quantity]) -> Self {
        Self { quantities, ..self }
    }

    /// The same with the claim that light may go backwards.
    #[must_use]
    pub const fn reciprocal(self) -> Self {
        Self { laws: Laws { reciprocal: true, ..self.laws }, ..self }
    }

    /// The same with the claim that no light is made.
    #[must_use]
    pub const fn energy_conserving(self) -> Self {
        Self { laws: Laws { energy_conserving: true, ..self.laws }, ..self }
    }

    /// The same with the claim that no light is negative.
    #[must_use]
    pub const fn non_negative(self) -> Self {
        Self { laws: Laws { non_negative: true, ..self.laws }, ..self }
    }

    /// The same, answering uniform light by its directional albedo: it has no ambient function.
    #[must_use]
    pub const fn ambient_by_albedo(self) -> Self {
        Self { ambient: Ambient::Albedo, ..self }
    }

    /// The same with a response that depends on the tangent.
    #[must_use]
    pub const fn anisotropic(self) -> Self {
        Self { anisotropic: true, ..self }
    }
}

impl EquationPart {
    /// One part of an equation.
    #[must_use]
    pub const fn new(term: Term, text: &'static str) -> Self {
        Self { term, text }
    }
}
