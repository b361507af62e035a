//! Builder methods for declarations of reflection models: adding a field to [`Declaration`] does not break
//! existing declarations.

use super::{
    declaration::{Ambient, Declaration, EquationPart, Family, Laws, Term},
    quantity::Quantity,
};
use crate::shader::Source;

impl Declaration {
    /// A model with an id, a name, and its twin in WGSL. By default it claims no laws, responds to uniform
    /// light by a formula, is isotropic, and belongs to the custom models.
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

    /// Sets the id.
    #[must_use]
    pub const fn id(self, id: &'static str) -> Self {
        Self { id, ..self }
    }

    /// Sets the twin in WGSL.
    #[must_use]
    pub const fn wgsl(self, wgsl: Source) -> Self {
        Self { wgsl, ..self }
    }

    /// Sets the family.
    #[must_use]
    pub const fn family(self, family: Family) -> Self {
        Self { family, ..self }
    }

    /// Sets author and year, in short, and the publication.
    #[must_use]
    pub const fn published(self, author: &'static str, source: &'static str) -> Self {
        Self { author, source, ..self }
    }

    /// Sets the summary: purpose and look, in one or two sentences.
    #[must_use]
    pub const fn summary(self, summary: &'static str) -> Self {
        Self { summary, ..self }
    }

    /// Sets other names by which people search for it.
    #[must_use]
    pub const fn synonyms(self, synonyms: &'static [&'static str]) -> Self {
        Self { synonyms, ..self }
    }

    /// Sets the equation.
    #[must_use]
    pub const fn equation(self, equation: &'static [EquationPart]) -> Self {
        Self { equation, ..self }
    }

    /// Sets the quantities of the equation.
    #[must_use]
    pub const fn quantities(self, quantities: &'static [Quantity]) -> Self {
        Self { quantities, ..self }
    }

    /// Claims reciprocity: the path of light may be reversed.
    #[must_use]
    pub const fn reciprocal(self) -> Self {
        Self { laws: Laws { reciprocal: true, ..self.laws }, ..self }
    }

    /// Claims energy conservation: no light is created.
    #[must_use]
    pub const fn energy_conserving(self) -> Self {
        Self { laws: Laws { energy_conserving: true, ..self.laws }, ..self }
    }

    /// Claims that no light is negative.
    #[must_use]
    pub const fn non_negative(self) -> Self {
        Self { laws: Laws { non_negative: true, ..self.laws }, ..self }
    }

    /// Makes the directional albedo the response to uniform light: the model has no ambient function.
    #[must_use]
    pub const fn ambient_by_albedo(self) -> Self {
        Self { ambient: Ambient::Albedo, ..self }
    }

    /// Makes the response depend on the tangent.
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
