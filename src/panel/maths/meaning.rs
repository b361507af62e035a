//! The meanings of symbols, for tooltips.

use std::sync::LazyLock;

use crate::reflection::{EquationPart, Term};
use crate::text::mathematics::{self, Atom, parse, same_symbol};

/// Symbols shared by all equations, with their meanings.
static MEANINGS: LazyLock<Vec<(&str, &str)>> = LazyLock::new(|| {
    let table = include_str!("../../../assets/text/symbols.tsv");
    table.lines().filter_map(|line| line.split_once('\t')).collect()
});

/// The meaning of a symbol shared by all equations.
#[must_use]
pub fn meaning(symbol: &str) -> Option<&'static str> {
    MEANINGS.iter().find(|(s, _)| same_symbol(s, symbol)).map(|(_, m)| *m)
}

/// The definitions in an equation; a part may have several, separated by commas.
#[must_use]
pub fn definitions(parts: &[EquationPart]) -> Vec<(Term, &'static str)> {
    parts
        .iter()
        .flat_map(|part| mathematics::definitions(part.text).into_iter().map(|text| (part.term, text)))
        .collect()
}

/// True if an equation contains a matching symbol.
#[must_use]
pub fn has_symbol(parts: &[EquationPart], fits: impl Fn(&str) -> bool) -> bool {
    let of = |text: &str| parse(text).iter().filter_map(Atom::symbol).any(|symbol| fits(&symbol));
    parts.iter().any(|part| of(part.text))
}

/// The definition of a symbol in an equation: it starts with the symbol, alone or applied to an argument in brackets,
/// and an equals sign.
#[must_use]
pub fn definition(parts: &[EquationPart], symbol: &str) -> Option<&'static str> {
    let of = |text: &str| {
        let atoms: Vec<_> = parse(text).into_iter().filter(|a| *a != Atom::Space).collect();
        let named = atoms.first().and_then(Atom::symbol).is_some_and(|s| same_symbol(&s, symbol));
        let is = |i: usize, sign: &str| atoms.get(i).is_some_and(|a| a.base() == sign);
        named && (is(1, "=") || is(1, "(") && is(3, ")") && is(4, "="))
    };
    definitions(parts).into_iter().map(|(_, text)| text).find(|text| of(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_symbol_of_every_equation_is_explained() {
        let registry = crate::registry::Registry::builtin();
        let mut unexplained = Vec::new();
        for model in registry.models() {
            let d = model.declaration;
            for symbol in d.equation.iter().flat_map(|p| parse(p.text)).filter_map(|a| a.symbol()) {
                let known = model.parameters.iter().any(|p| same_symbol(p.symbol, &symbol))
                    || meaning(&symbol).is_some()
                    || definition(d.equation, &symbol).is_some()
                    || d.quantities.iter().any(|quantity| same_symbol(quantity.symbol(), &symbol));
                if !known {
                    unexplained.push(format!("{}: {symbol}", d.id));
                }
            }
        }
        assert_eq!(unexplained, [""; 0], "neither a parameter nor explained in `meaning`");
        let parts = [EquationPart::new(Term::Diffuse, "x = H·T / H·N , y_{ab} = x + z")];
        assert!(definition(&parts, "x").is_some() && definition(&parts, "y_ab").is_some());
        assert!(definition(&parts, "z").is_none() && definition(&parts, "H").is_none());
        let parts = [EquationPart::new(Term::Diffuse, "I_d = H(μ_l) C_b, H(μ) = 1 + μ")];
        assert_eq!(definition(&parts, "H"), Some("H(μ) = 1 + μ"), "not the half vector");
    }
}
