//! Builder methods for declarations of reflection models: adding a field to [`Declaration`] does not break
//! existing declarations.

use super::{
    declaration::{Ambient, Declaration, EquationPart, Family, Laws, Term},
    quantity::Quantity,
};
use crate::{declared::setters, shader::Source};

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
            matte: false,
            transmits: false,
            lit_from_below: false,
            boundary: false,
            sharp: false,
            measured: false,
            solid: false,
            wgsl,
        }
    }

    setters! {
        /// Sets the id.
        id(id: &'static str) { id }

        /// Sets the twin in WGSL.
        wgsl(wgsl: Source) { wgsl }

        /// Sets the family.
        family(family: Family) { family }

        /// Sets author and year, in short, and the publication.
        published(author: &'static str, source: &'static str) { author, source }

        /// Sets the summary: purpose and look, in one or two sentences.
        summary(summary: &'static str) { summary }

        /// Sets other names by which people search for it.
        synonyms(synonyms: &'static [&'static str]) { synonyms }

        /// Sets the equation.
        equation(equation: &'static [EquationPart]) { equation }

        /// Sets the quantities of the equation.
        quantities(quantities: &'static [Quantity]) { quantities }

        /// Makes the directional albedo the response to uniform light: the model has no ambient function.
        ambient_by_albedo() { ambient: Ambient::Albedo }

        /// Makes the response depend on the tangent.
        anisotropic() { anisotropic: true }

        /// Makes a cosine its lobe for sampling light with extent.
        matte() { matte: true }

        /// Makes it a model that light passes through: it has a transmitted term.
        transmitting() { transmits: true }

        /// Makes it a model that answers to light from below the surface too, though none passes through.
        lit_from_below() { lit_from_below: true }

        /// Makes it a model of the boundary of a body with another refractive index.
        boundary() { boundary: true }

        /// Makes it a model that also reflects or transmits without spreading.
        sharp() { sharp: true }

        /// Makes it a model whose response comes from a file, on which laws that it does not claim depend.
        measured() { measured: true }

        /// Makes it a model of a solid body, with an [`interior`](super::ReflectionModel::interior).
        solid() { solid: true }
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
}

impl EquationPart {
    /// One part of an equation.
    #[must_use]
    pub const fn new(term: Term, text: &'static str) -> Self {
        Self { term, text, along_path: false }
    }

    /// A part for light along the path of the ray of view.
    #[must_use]
    pub const fn along_path(term: Term, text: &'static str) -> Self {
        Self { along_path: true, ..Self::new(term, text) }
    }
}
