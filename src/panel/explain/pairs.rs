//! The vectors of a surface that a symbol stands for: `N` for one, `θ_i` for the two between which it is.

use bevy_egui::egui::Context;

use crate::{
    explain::Model,
    panel::{
        linked::{Domain, lit_in},
        maths::{definition, same_symbol},
    },
};

/// The vectors that are drawn.
const LETTERS: [&str; 5] = ["N", "L", "V", "H", "R"];

/// Angles, and cosines of angles, each between two vectors.
const ANGLES: [(&str, [&str; 2]); 10] = [
    ("θ_i", ["N", "L"]),
    ("μ_i", ["N", "L"]),
    ("μ_l", ["N", "L"]),
    ("μ_0", ["N", "L"]),
    ("θ_r", ["N", "V"]),
    ("θ_o", ["N", "V"]),
    ("μ_o", ["N", "V"]),
    ("μ_v", ["N", "V"]),
    ("θ_h", ["N", "H"]),
    ("θ_d", ["H", "L"]),
];

/// The symbols of the angle between two vectors.
pub(super) fn angles(a: &str, b: &str) -> impl Iterator<Item = &'static str> {
    let is = move |pair: [&str; 2]| pair == [a, b] || pair == [b, a];
    ANGLES.into_iter().filter(move |(_, pair)| is(*pair)).map(|(symbol, _)| symbol)
}

/// True if the equation of a model has a letter for something of its own, which then is no vector.
fn is_own(model: &Model, letter: &str) -> bool {
    definition(model.declaration.equation, letter).is_some()
        || model.settings.iter().any(|setting| same_symbol(setting.parameter.symbol, letter))
}

/// The letters of vectors that are their symbols in the equation of a model.
pub(super) fn symbols<'l>(model: &Model, letters: &[&'l str]) -> Vec<&'l str> {
    letters.iter().copied().filter(|letter| !is_own(model, letter)).collect()
}

/// The vectors that the symbols which light stand for.
pub(super) fn lit(ctx: &Context, model: &Model) -> Vec<&'static str> {
    let symbols = lit_in(ctx, Domain::Surface);
    let named = |symbol: &str| symbols.iter().any(|lit| same_symbol(lit, symbol)) && !is_own(model, symbol);
    let between = |letter: &str| ANGLES.iter().any(|(angle, pair)| pair.contains(&letter) && named(angle));
    LETTERS.into_iter().filter(|letter| named(letter) || between(letter)).collect()
}

/// True if just these vectors light.
pub(super) fn are_lit(ctx: &Context, model: &Model, letters: &[&str]) -> bool {
    let lit = lit(ctx, model);
    lit.len() == letters.len() && letters.iter().all(|letter| lit.contains(letter))
}
