//! The quantities of an equation, each with its definition.

use crate::declared::setters;

/// A quantity used in the equation of a model: explanations substitute its value, and show its derivation.
///
/// ```
/// use lights_camera_models::reflection::Quantity;
/// const D: Quantity = Quantity::new("D = α^2/(π (1 + (α^2 − 1) cos^2 θ_h)^2)", "distribution of the facets")
///     .source("B. Walter and others 2007")
///     .when(&[("distribution", &["ggx"])]);
/// assert_eq!(D.symbol(), "D");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Quantity {
    /// The definition in the notation of [`expression`](crate::text::expression): `D = α^2/…`, or that of a
    /// function, `H(μ) = (1 + 2 μ)/…`. Only a symbol, such as `E_V`, or `E(μ)`, for a quantity that the model
    /// itself provides ([`ReflectionModel::quantity`](super::ReflectionModel::quantity)), such as an albedo
    /// from a table.
    pub text: &'static str,
    /// Name in words.
    pub label: &'static str,
    /// Author and year; empty if they are those of the model.
    pub source: &'static str,
    /// The choices for which the quantity is valid: names of parameters, each with ids.
    pub when: &'static [(&'static str, &'static [&'static str])],
}

impl Quantity {
    /// A quantity with its definition and its name in words.
    #[must_use]
    pub const fn new(text: &'static str, label: &'static str) -> Self {
        Self { text, label, source: "", when: &[] }
    }

    setters! {
        /// Sets author and year.
        source(source: &'static str) { source }

        /// Restricts the quantity to certain choices: names of parameters, each with the ids for which it is
        /// valid.
        when(when: &'static [(&'static str, &'static [&'static str])]) { when }
    }

    /// The symbol, without the arguments of a function: `H` for `H(μ) = …`.
    #[must_use]
    pub fn symbol(&self) -> &'static str {
        let head = self.text.split_once('=').map_or(self.text, |(head, _)| head).trim();
        head.split_once('(').map_or(head, |(symbol, _)| symbol)
    }
}
