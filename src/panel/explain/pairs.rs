//! The vectors of a surface that a symbol refers to: `N` to one, `θ_i` to the two that enclose the angle.

use crate::{
    explain::Model,
    panel::{
        linked::{Domain, lit_in},
        maths::{definition, has_symbol, same_symbol},
        prelude::*,
    },
};

/// Letters of the drawn vectors.
const LETTERS: [&str; 5] = ["N", "L", "V", "H", "R"];

/// Symbols of angles and of their cosines, with the two vectors that enclose the angle.
const ANGLES: [(&[&str], [&str; 2]); 4] = [
    (&["θ_i", "μ_i", "μ_l", "μ_0"], ["N", "L"]),
    (&["θ_r", "θ_o", "μ_o", "μ_v"], ["N", "V"]),
    (&["θ_h"], ["N", "H"]),
    (&["θ_d"], ["H", "L"]),
];

/// Symbols of the angle between two vectors.
pub(super) fn angles(a: &str, b: &str) -> impl Iterator<Item = &'static str> {
    let is = move |pair: [&str; 2]| pair == [a, b] || pair == [b, a];
    ANGLES.into_iter().filter(move |(_, pair)| is(*pair)).flat_map(|(symbols, _)| symbols).copied()
}

/// Symbols of the angles that a vector encloses with others.
fn angles_at(letter: &str) -> impl Iterator<Item = &'static str> {
    ANGLES
        .into_iter()
        .filter(move |(_, pair)| pair.contains(&letter))
        .flat_map(|(symbols, _)| symbols)
        .copied()
}

/// True if the equation of a model uses a letter for a quantity of the model, and thus not for a vector.
fn is_own(model: &Model, letter: &str) -> bool {
    definition(&model.equation, letter).is_some()
        || model.settings.iter().any(|setting| same_symbol(setting.parameter.symbol, letter))
}

/// True if a vector belongs to the explanation of a model: always for normal, light and viewer; for half vector and
/// mirror direction if the equation uses them or an angle to them. An undeclared equation may use any vector.
pub(super) fn belongs(model: &Model, letter: &str) -> bool {
    let equation = &model.equation;
    if !matches!(letter, "H" | "R") || equation.is_empty() || is_own(model, letter) {
        return true;
    }
    // The microfacet distribution is a function of the half vector.
    let distribution = |symbol: &str| letter == "H" && (symbol == "D" || symbol.starts_with("D_"));
    let angle = |symbol: &str| angles_at(letter).any(|angle| same_symbol(symbol, angle));
    let is = |symbol: &str| same_symbol(symbol, letter) || angle(symbol) || distribution(symbol);
    has_symbol(equation, is)
}

/// The letters that denote vectors in the equation of a model.
pub(super) fn symbols<'l>(model: &Model, letters: &[&'l str]) -> Vec<&'l str> {
    letters.iter().copied().filter(|letter| !is_own(model, letter)).collect()
}

/// The vectors of the highlighted symbols.
pub(super) fn lit(ctx: &Context, model: &Model) -> Vec<&'static str> {
    let symbols = lit_in(ctx, Domain::Surface);
    let named = |symbol: &str| symbols.iter().any(|lit| same_symbol(lit, symbol)) && !is_own(model, symbol);
    LETTERS.into_iter().filter(|letter| named(letter) || angles_at(letter).any(named)).collect()
}

/// True if exactly these vectors are highlighted.
pub(super) fn are_lit(ctx: &Context, model: &Model, letters: &[&str]) -> bool {
    let lit = lit(ctx, model);
    lit.len() == letters.len() && letters.iter().all(|letter| lit.contains(letter))
}
