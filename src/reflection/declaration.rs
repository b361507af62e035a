//! The declaration of a reflection model: name, source, equation, laws.

use super::quantity::Quantity;
use crate::{declared::texts, optics::TermSelection, shader::Source};

/// The name, source and claims of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Declaration {
    /// Name in scene files: lower case, underscores.
    pub id: &'static str,
    /// Display name.
    pub name: &'static str,
    /// Family in lists of models.
    pub family: Family,
    /// Author and year, in short: "B. T. Phong 1975".
    pub author: &'static str,
    /// Author, year, title and place of publication.
    pub source: &'static str,
    /// Purpose and look, in one or two sentences.
    pub summary: &'static str,
    /// Other names by which people search for it: "GGX", "PBR", "plastic".
    pub synonyms: &'static [&'static str],
    /// The equation, one part per term so that the window can colour them.
    pub equation: &'static [EquationPart],
    /// The quantities used in the equation without a definition there, each with its own equation.
    pub quantities: &'static [Quantity],
    /// The physical laws that the model obeys for all directions and legal parameters.
    pub laws: Laws,
    /// The response to uniform light.
    pub ambient: Ambient,
    /// True if the response depends on the tangent: rotating the surface about its normal changes it.
    pub anisotropic: bool,
    /// True for a model without a highlight.
    pub matte: bool,
    /// True for a model of the whole sphere of directions (a BSDF), which light passes through.
    pub transmits: bool,
    /// True for an opaque model that answers to light from below the surface too, as no real surface does.
    pub lit_from_below: bool,
    /// True for a model of the boundary of a body, behind which the
    /// [refractive index](super::ReflectionModel::refractive_index) is another one. Others that transmit are sheets, alike
    /// on both sides.
    pub boundary: bool,
    /// True for a model with directions in which light does not spread; see
    /// [`sharp`](super::ReflectionModel::sharp).
    pub sharp: bool,
    /// True for a model whose response comes from a file: laws that it does not claim depend on the file.
    pub measured: bool,
    /// True for a model of a solid body; see [`interior`](super::ReflectionModel::interior).
    pub solid: bool,
    /// The twin in WGSL: `fn response` over a struct `Parameters`, and `fn ambient_response` for models
    /// that declare [`Ambient::Formula`].
    pub wgsl: Source,
}

/// The response of a model to uniform light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ambient {
    /// A formula: [`ambient_response`](super::ReflectionModel::ambient_response) and its twin in WGSL.
    Formula,
    /// The directional albedo `E(v) = ∫ f_r cos θ dω`, calculated from the response. The model has no ambient
    /// function, neither in Rust nor in WGSL.
    Albedo,
}

/// One part of an equation in readable mathematics: `I_d = k_d max(0, N·L) C_b`. `_x` is a
/// subscript and `^x` a superscript; braces group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EquationPart {
    /// Term of the equation, which determines its colour.
    pub term: Term,
    /// The mathematics.
    pub text: &'static str,
    /// True for light along a path, which has no value for a single direction of light: it is shown, not evaluated.
    pub along_path: bool,
}

texts! {
    /// A term of the equation of a model.
    Term(
        /// The word in files, JSON and web pages.
        id,
        /// The symbol in equations: `I_d`.
        symbol
    ) {
        /// The sum of the others.
        Total = "total" "I",
        /// `I_a`.
        Ambient = "ambient" "I_a",
        /// `I_d`.
        Diffuse = "diffuse" "I_d",
        /// `I_s`.
        Specular = "specular" "I_s",
        /// `I_t`.
        Transmitted = "transmitted" "I_t",
    }
}

impl Term {
    /// The selection that shows only this term; `None` for the sum.
    #[must_use]
    pub fn alone(self) -> Option<TermSelection> {
        // They have the order of the selections, where the sum is `All`.
        (self != Self::Total).then_some(TermSelection::ALL[self as usize])
    }
}

texts! {
    /// A family of models.
    Family(
        /// The heading in lists of models.
        name
    ) {
        /// The four models of the *Commonality Analysis*.
        Basic = "Basic",
        /// Other classical models.
        Classical = "Classical",
        /// Diffuse reflection of rough surfaces.
        Diffuse = "Rough diffuse",
        /// Microfacet theory.
        Microfacet = "Microfacet",
        /// The practical standard.
        Standard = "Standard",
        /// Surfaces that light passes through.
        Transmission = "Transmission",
        /// Measured surfaces.
        Measured = "Measured",
        /// Models written by users.
        Custom = "Custom models",
    }
}

/// The physical laws that a model claims to obey. Tests assert each claimed law, and the violation of each
/// other one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Laws {
    /// `f_r(l, v) = f_r(v, l)` (Helmholtz), and of light that passes `f_t(l, v)/n_v² = f_t(v, l)/n_l²`.
    pub reciprocal: bool,
    /// `E(μ) ≤ 1`: no more light leaves than arrives.
    pub energy_conserving: bool,
    /// `f_r ≥ 0`.
    pub non_negative: bool,
}

impl Laws {
    /// No laws.
    pub const NONE: Self = Self { reciprocal: false, energy_conserving: false, non_negative: false };

    /// The laws with their names, and true for each claimed one.
    #[must_use]
    pub fn list(self) -> [(&'static str, bool); 3] {
        [
            ("reciprocal", self.reciprocal),
            ("energy conserving", self.energy_conserving),
            ("non-negative", self.non_negative),
        ]
    }
}
