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

/// The vectors that the symbols which light stand for.
pub(super) fn lit(ctx: &Context, model: &Model) -> Vec<&'static str> {
    let symbols = lit_in(ctx, Domain::Surface);
    // A letter that the equation of the model uses for something of its own is no vector.
    let own = |symbol: &str| {
        definition(model.declaration.equation, symbol).is_some()
            || model.settings.iter().any(|s| same_symbol(s.parameter.symbol, symbol))
    };
    let named = |symbol: &str| symbols.iter().any(|lit| same_symbol(lit, symbol)) && !own(symbol);
    let between = |letter: &str| ANGLES.iter().any(|(angle, pair)| pair.contains(&letter) && named(angle));
    LETTERS.into_iter().filter(|letter| named(letter) || between(letter)).collect()
}

/// True if just these vectors light.
pub(super) fn is_lit(ctx: &Context, model: &Model, ends: &[&str]) -> bool {
    let lit = lit(ctx, model);
    lit.len() == ends.len() && ends.iter().all(|end| lit.contains(end))
}
