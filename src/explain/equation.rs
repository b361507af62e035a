//! Equations with numbers in the place of their symbols.

use super::{
    Geometry, Lit, Model, Setting, angle, number,
    numbers::{DIGITS, rounded, rounded_triple},
    triple,
};
use crate::{
    optics::TermSelection,
    parameter::{Parameter, ParameterKind, Value},
    reflection::Term,
    text::mathematics::{Atom, parse, same_symbol},
};
use glam::Vec3;

/// The symbols of an equation whose values are known.
#[derive(Clone, Debug, Default)]
pub struct Symbols {
    known: Vec<(String, String)>,
}

impl Symbols {
    /// The parameters of a model and, for light from a direction, cosines and angles.
    #[must_use]
    pub fn of(model: &Model, geometry: Option<&Geometry>) -> Self {
        Self::rounded(model, geometry, DIGITS)
    }

    /// The same with so many significant digits.
    #[must_use]
    pub fn rounded(model: &Model, geometry: Option<&Geometry>, digits: usize) -> Self {
        let mut symbols = Self::default();
        let number = |v: f32| rounded(v, digits);
        for Setting { parameter, value, linear } in &model.settings {
            match (value, linear) {
                (_, Some(linear)) => symbols.put(parameter.symbol, rounded_triple(*linear, digits)),
                // Equations take angles as angles: σ = 20°.
                (Value::Number(v), _) if parameter.unit == "°" => {
                    symbols.put_angle(parameter.symbol, number(*v))
                }
                (Value::Number(v), _) => symbols.put(parameter.symbol, number(*v)),
                (Value::Integer(v), _) => symbols.put(parameter.symbol, v.to_string()),
                _ => {}
            }
        }
        if let Some(geometry) = geometry {
            for (name, cosine) in geometry.cosines {
                symbols.put(name, number(cosine));
            }
            for (symbol, cosine) in [("θ_i", "N·L"), ("θ_r", "N·V"), ("θ_o", "N·V"), ("θ_h", "N·H")] {
                symbols.put_angle(symbol, number(angle(geometry.cosine(cosine))));
            }
        }
        symbols
    }

    /// Makes a symbol known, with its value as it is to be written: `k_d`, or a scalar product such as `N·L`. The first
    /// value of a symbol is kept.
    pub fn put(&mut self, symbol: &str, value: String) {
        if !symbol.is_empty() {
            self.known.push((symbol.to_owned(), value));
        }
    }

    fn put_angle(&mut self, symbol: &str, degrees: String) {
        self.put(symbol, format!("{degrees}°"));
    }

    fn get(&self, symbol: &str) -> Option<&str> {
        self.known.iter().find(|(known, _)| same_symbol(known, symbol)).map(|(_, value)| value.as_str())
    }

    /// The scalar product of two vectors, in either order.
    fn product(&self, a: &Atom, b: &Atom) -> Option<&str> {
        let bare = |atom: &Atom| matches!(atom, Atom::Symbol { sub, .. } if sub.is_empty());
        let (x, y) = (a.base(), b.base());
        (bare(a) && bare(b) && a.sup().is_empty())
            .then(|| self.get(&format!("{x}·{y}")).or_else(|| self.get(&format!("{y}·{x}"))))
            .flatten()
    }

    /// The value of the symbol or the scalar product that begins these atoms, and the number of its atoms. Brackets
    /// around a scalar product alone are part of it.
    fn first(&self, atoms: &[Atom]) -> Option<(&str, usize)> {
        match atoms {
            [open, a, dot, b, close, ..]
                if (open.base(), dot.base(), close.base()) == ("(", "·", ")")
                    && close.sup().is_empty()
                    && b.sup().is_empty() =>
            {
                self.product(a, b).map(|value| (value, 5))
            }
            [a, dot, b, ..] if dot.base() == "·" && self.product(a, b).is_some() => {
                self.product(a, b).map(|value| (value, 3))
            }
            [atom, after @ ..] if !is_defined(after) => Some((self.get(&atom.symbol()?)?, 1)),
            _ => None,
        }
    }
}

/// An equation with the values of known symbols in their place; none if there is none of them. What stands before an
/// equals sign stays.
#[must_use]
pub fn put_in(text: &str, symbols: &Symbols) -> Option<String> {
    let atoms = parse(text);
    let mut out = String::new();
    let (mut i, mut found) = (0, false);
    while let Some(atom) = atoms.get(i) {
        if *atom == Atom::Space {
            let product = i > 0 && ends(&atoms[i - 1]) && atoms.get(i + 1).is_some_and(begins);
            out.push_str(if product { " × " } else { " " });
            i += 1;
            continue;
        }
        let value = symbols.first(&atoms[i..]);
        let last = value.map_or(i, |(_, count)| i + count - 1);
        if let Some((value, count)) = value {
            found = true;
            // Functions such as F(N·L) keep their brackets.
            let applied = count == 5 && i > 0 && applies(&atoms[i - 1]);
            if i > 0 && !applied && ends(&atoms[i - 1]) {
                out.push_str(" × ");
            }
            let raised = !atoms[last].sup().is_empty();
            let after_sign = out.trim_end().ends_with(['+', '−', '×', '/', '·']);
            let bracketed =
                value.starts_with('−') && (raised || after_sign) || raised && value.ends_with('°') || applied;
            out += &if bracketed { format!("({value})") } else { value.to_owned() };
        } else {
            out += &plain(atom);
        }
        if let Some((sup, known)) = power(&atoms[last], symbols) {
            found |= known;
            out += &sup;
        }
        i = last + 1;
    }
    found.then_some(out)
}

/// The base of an atom and its index.
fn plain(atom: &Atom) -> String {
    match atom.sub() {
        "" => atom.base().to_owned(),
        sub if sub.chars().count() == 1 => format!("{}_{sub}", atom.base()),
        sub => format!("{}_{{{sub}}}", atom.base()),
    }
}

/// The power of an atom, and true if a symbol of it is known.
fn power(atom: &Atom, symbols: &Symbols) -> Option<(String, bool)> {
    let sup = Some(atom.sup()).filter(|sup| !sup.is_empty())?;
    let put = put_in(sup, symbols);
    let (text, known) = put.map_or((sup.to_owned(), false), |text| (text, true));
    let simple = text.chars().all(|c| c.is_alphanumeric() || c == '.');
    Some((if simple { format!("^{text}") } else { format!("^({text})") }, known))
}

/// True if a symbol before these atoms is being defined.
fn is_defined(after: &[Atom]) -> bool {
    after.iter().find(|atom| **atom != Atom::Space).is_some_and(|atom| atom.base() == "=")
}

/// True if a factor may end with this atom.
fn ends(atom: &Atom) -> bool {
    match atom {
        Atom::Symbol { .. } => true,
        Atom::Upright { base, .. } => base.ends_with(|c: char| c.is_ascii_digit() || ")]".contains(c)),
        Atom::Space => false,
    }
}

/// True if a bracket right after this atom holds the argument of a function.
fn applies(atom: &Atom) -> bool {
    atom.base().ends_with(|c: char| c.is_alphabetic() || c == '√')
}

/// True if a factor may begin with this atom.
fn begins(atom: &Atom) -> bool {
    const FUNCTIONS: &[&str] = &["max", "min", "exp", "sin", "cos", "tan", "(", "[", "√"];
    match atom {
        Atom::Symbol { .. } => true,
        Atom::Upright { base, .. } => {
            FUNCTIONS.contains(&base.as_str()) || base.starts_with(|c: char| c.is_ascii_digit())
        }
        Atom::Space => false,
    }
}

/// A line of the equation of a model for one light: as it is written, with numbers, and its value where the model gives
/// one.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// The term that it belongs to.
    pub term: Term,
    /// As the model writes it; empty for a term about which its equation says nothing.
    pub text: &'static str,
    /// The same with numbers, if there are any to put in.
    pub numbers: Option<String>,
    /// The value of the term, in the line that defines it.
    pub value: Option<Vec3>,
}

impl Lit {
    /// The equation of the model for this light, line by line. Every term that is not zero has a line with its value.
    #[must_use]
    pub fn lines(&self, model: &Model) -> Vec<Line> {
        self.rounded_lines(model, DIGITS)
    }

    /// The same with so many significant digits.
    #[must_use]
    pub fn rounded_lines(&self, model: &Model, digits: usize) -> Vec<Line> {
        let symbols = Symbols::rounded(model, self.geometry.as_ref(), digits);
        let mut lines = Vec::new();
        for (term, symbol, value) in [
            (Term::Ambient, "I_a", self.response.ambient),
            (Term::Diffuse, "I_d", self.response.diffuse),
            (Term::Specular, "I_s", self.response.specular),
        ] {
            // An equation is for light from a direction, except for its ambient term.
            let said = term == Term::Ambient || self.geometry.is_some();
            let parts = model.declaration.equation.iter().filter(|part| part.term == term && said);
            let before = lines.len();
            for part in parts {
                let defines = part.text.split_once('=').is_some_and(|(head, _)| head.trim() == symbol);
                lines.push(Line {
                    term,
                    text: part.text,
                    numbers: put_in(part.text, &symbols),
                    value: defines.then_some(value),
                });
            }
            let unsaid = lines[before..].iter().all(|line| line.value.is_none());
            if unsaid && (value != Vec3::ZERO || lines.len() > before) {
                lines.insert(before, Line { term, text: "", numbers: None, value: Some(value) });
            }
        }
        // A model may have one formula for all of its light.
        for part in model.declaration.equation.iter().filter(|part| part.term == Term::Total) {
            if let Some(numbers) = put_in(part.text, &symbols).filter(|_| self.geometry.is_some()) {
                let defines = part.text.split_once('=').is_some_and(|(head, _)| head.trim() == "I");
                let value = defines.then(|| self.response.select(TermSelection::All));
                lines.push(Line { term: Term::Total, text: part.text, numbers: Some(numbers), value });
            }
        }
        lines
    }
}

impl Line {
    /// The symbol of its term: `I_d`.
    #[must_use]
    pub fn symbol(&self) -> &'static str {
        match self.term {
            Term::Total => "I",
            Term::Ambient => "I_a",
            Term::Diffuse => "I_d",
            Term::Specular => "I_s",
        }
    }
}

/// A parameter in an explanation: `k_d = 0.8, diffuse coefficient`.
pub(super) fn setting(setting: &Setting) -> String {
    let p = setting.parameter;
    let value = match (&setting.value, setting.linear) {
        (Value::Number(v), _) => number(*v),
        (Value::Colour([r, g, b]), Some(linear)) => {
            return format!("{} = {}, {}, {r},{g},{b} in sRGB", p.symbol, triple(linear), p.label);
        }
        (_, Some(linear)) => triple(linear),
        (Value::Choice(id), _) => choice(p, id).to_owned(),
        (value, _) => value.to_string(),
    };
    let space = if p.unit.is_empty() || p.unit == "°" { "" } else { " " };
    match p.symbol {
        "" => format!("{}: {value}{space}{}", p.label, p.unit),
        symbol => format!("{symbol} = {value}{space}{}, {}", p.unit, p.label),
    }
}

/// The name of a choice.
fn choice<'a>(parameter: &Parameter, id: &'a str) -> &'a str {
    match &parameter.kind {
        ParameterKind::Choice { options, .. } => {
            options.iter().find(|(known, _)| *known == id).map_or(id, |(_, name)| name)
        }
        _ => id,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn symbols() -> Symbols {
        let mut symbols = Symbols::default();
        for (symbol, value) in [
            ("k_d", "0.8"),
            ("C_b", "(1, 0.5, 0)"),
            ("α", "32"),
            ("m", "−2"),
            ("σ", "20°"),
            ("N·L", "−0.25"),
            ("N·H", "0.5"),
            ("", "9"),
        ] {
            symbols.put(symbol, value.to_owned());
        }
        symbols
    }

    #[test]
    fn symbols_become_their_values() {
        for (text, expected) in [
            ("I_d = k_d max(0, N·L) C_b", "I_d = 0.8 × max(0, −0.25) × (1, 0.5, 0)"),
            ("I_s = (N·H)^α F", "I_s = (0.5)^32 × F"),
            ("I_s = G (4 (N·H)) F(N·H) (N·L)", "I_s = G × (4 × 0.5) × F(0.5) × (−0.25)"),
            ("C = σ^2/(σ^2 + 0.33) cos σ", "C = (20°)^2/((20°)^2 + 0.33) × cos 20°"),
            ("D = 1 − m", "D = 1 − (−2)"),
            ("x = m^2/2 H·N", "x = (−2)^2/2 × 0.5"),
            ("y = 2α + α^{k_d − 1}", "y = 2 × 32 + 32^(0.8 − 1)"),
            ("F_{90} = 1/2 + 2 r (L·H)^2", ""),
            ("α = m, or 1 where s < 0", "α = −2, or 1 where s < 0"),
        ] {
            assert_eq!(put_in(text, &symbols()).unwrap_or_default(), expected, "{text}");
        }
    }

    #[test]
    fn what_is_unknown_stays_as_it_is_written() {
        let mut symbols = Symbols::default();
        symbols.put("r", "0.5".to_owned());
        assert_eq!(
            put_in("F_{90} = 1/2 + 2 r tan^2 θ_h/π f_{ms}", &symbols).as_deref(),
            Some("F_{90} = 1/2 + 2 × 0.5 × tan^2 θ_h/π × f_{ms}")
        );
        assert_eq!(put_in("I_d = F G", &symbols), None);
        for text in ["", "_", "r^{", "{}", "x__y ·", "N·"] {
            let _ = put_in(text, &symbols);
        }
    }
}
