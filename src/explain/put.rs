//! Equations with numbers substituted for their symbols.

use super::numbers::of_value;
use crate::text::{
    expression::{Value, is_function},
    mathematics::{Atom, parse, same_symbol, write},
};

/// Symbols of an equation with known values.
#[derive(Clone, Debug, Default)]
pub struct Symbols {
    known: Vec<(String, String)>,
}

impl Symbols {
    /// Symbols with their values, to this many significant digits. A symbol stays if its unit cannot be
    /// written, such as the square of an angle.
    pub(super) fn of<'a>(values: impl Iterator<Item = (&'a str, Value)>, digits: usize) -> Self {
        let mut symbols = Self::default();
        for (name, value) in values.filter(|(_, value)| value.degrees < 2) {
            symbols.put(name, of_value(&value, digits));
        }
        symbols
    }

    /// Adds a symbol with its value as written: `k_d`, or a scalar product such as `N·L`. The first value of
    /// a symbol is kept.
    pub fn put(&mut self, symbol: &str, value: String) {
        if !symbol.is_empty() {
            self.known.push((symbol.to_owned(), value));
        }
    }

    /// The symbol as it was added, and its value.
    fn get(&self, symbol: &str) -> Option<(&str, &str)> {
        let known = self.known.iter().find(|(known, _)| same_symbol(known, symbol));
        known.map(|(known, value)| (known.as_str(), value.as_str()))
    }

    /// The scalar product of two vectors, in either order.
    fn product(&self, a: &Atom, b: &Atom) -> Option<(&str, &str)> {
        let bare = |atom: &Atom| matches!(atom, Atom::Symbol { sub, .. } if sub.is_empty());
        let (x, y) = (a.base(), b.base());
        (bare(a) && bare(b) && a.sup().is_empty())
            .then(|| self.get(&format!("{x}·{y}")).or_else(|| self.get(&format!("{y}·{x}"))))
            .flatten()
    }

    /// The value of a function of known arguments that begins these atoms, `F(N·L)`, and the number of its atoms.
    fn call(&self, atoms: &[Atom]) -> Option<((&str, &str), usize)> {
        let open = atoms.get(1).filter(|atom| atom.base() == "(")?;
        atoms[0].symbol().filter(|_| atoms[0].sup().is_empty() && open.sup().is_empty())?;
        let mut depth = 0;
        for (i, atom) in atoms.iter().enumerate() {
            match atom.base() {
                "(" => depth += 1,
                ")" if depth == 1 => {
                    let last = Atom::Upright { base: ")".to_owned(), sub: String::new(), sup: String::new() };
                    let call = write(&[&atoms[..i], &[last]].concat()).replace(' ', "");
                    return Some((self.get(&call)?, i + 1));
                }
                ")" => depth -= 1,
                _ => {}
            }
        }
        None
    }

    /// The name and the value of the symbol, function or scalar product that begins these atoms, and the
    /// number of its atoms. Brackets around a single scalar product belong to it.
    fn first(&self, atoms: &[Atom]) -> Option<((&str, &str), usize)> {
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
            [atom, ..] => self.call(atoms).or_else(|| Some((self.get(&atom.symbol()?)?, 1))),
            _ => None,
        }
    }
}

/// An equation with numbers, and the symbol that each number replaces, in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Put {
    /// The equation with numbers.
    pub text: String,
    /// The symbols of the numbers; `None` for a number of the equation itself. Powers are not counted.
    pub symbols: Vec<Option<String>>,
}

impl Put {
    fn push(&mut self, text: &str, symbol: Option<&str>) {
        self.text.push_str(text);
        let numbers = parse(text).iter().filter(|atom| is_number(atom)).count();
        self.symbols.extend(std::iter::repeat_n(symbol.map(str::to_owned), numbers));
    }
}

/// True for a digit of a number.
fn is_number(atom: &Atom) -> bool {
    atom.base().starts_with(|c: char| c.is_ascii_digit())
}

/// An equation with the values of known symbols substituted; `None` if it contains none of them. The left
/// side stays unchanged.
#[must_use]
pub fn put_in(text: &str, symbols: &Symbols) -> Option<String> {
    put(text, symbols).map(|put| put.text)
}

/// Like [`put_in`], with the symbols of the numbers.
#[must_use]
pub fn put(text: &str, symbols: &Symbols) -> Option<Put> {
    let atoms = parse(text);
    let mut out = Put::default();
    let (mut i, mut found) = (0, false);
    while let Some(atom) = atoms.get(i) {
        if *atom == Atom::Space {
            let product = i > 0 && ends(&atoms[i - 1]) && atoms.get(i + 1).is_some_and(begins);
            out.push(if product { " × " } else { " " }, None);
            i += 1;
            continue;
        }
        let before = atoms[..i].iter().rfind(|atom| **atom != Atom::Space);
        let begins_line = before.is_none_or(|atom| atom.base() == ",");
        let value =
            symbols.first(&atoms[i..]).filter(|(_, count)| !begins_line || !is_defined(&atoms[i + count..]));
        let last = value.map_or(i, |(_, count)| i + count - 1);
        if let Some(((symbol, value), count)) = value {
            found = true;
            // Functions such as F(N·L) keep their brackets.
            let applied = count == 5 && i > 0 && applies(&atoms[i - 1]);
            if i > 0 && !applied && ends(&atoms[i - 1]) {
                out.push(" × ", None);
            }
            let of_function = before.is_some_and(|atom| is_function(atom.base()));
            let raised = !atoms[last].sup().is_empty();
            // (−0.5)(1 − s): the sign would otherwise bind to what follows.
            let begun = atoms.get(last + 1).is_some_and(|next| next.base() == "(");
            let after_sign = out.text.trim_end().ends_with(['+', '−', '×', '/', '·']);
            let bracketed = value.starts_with('−') && (raised || after_sign || begun || of_function) || raised && value.ends_with('°') || applied
                    // A power of ten is one number.
                    || value.contains('·') && !value.starts_with('(') && (raised || out.text.ends_with('/'));
            if bracketed {
                out.push(&format!("({value})"), Some(symbol));
            } else {
                out.push(value, Some(symbol));
            }
        } else {
            out.push(&plain(atom), None);
        }
        if let Some((sup, known)) = power(&atoms[last], symbols) {
            found |= known;
            out.text += &sup;
        }
        i = last + 1;
    }
    found.then_some(out)
}

/// The base of an atom, with its index.
fn plain(atom: &Atom) -> String {
    let mut bare = atom.clone();
    if let Atom::Symbol { sup, .. } | Atom::Upright { sup, .. } = &mut bare {
        sup.clear();
    }
    write(&[bare])
}

/// The power of an atom, and true if it contains a known symbol.
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
        Atom::Upright { base, .. } => base.ends_with(|c: char| c.is_ascii_digit() || ")]°".contains(c)),
        Atom::Space => false,
    }
}

/// True if a bracket right after this atom holds the argument of a function.
fn applies(atom: &Atom) -> bool {
    atom.base().ends_with(|c: char| c.is_alphabetic() || c == '√')
}

/// True if a factor may begin with this atom.
fn begins(atom: &Atom) -> bool {
    match atom {
        Atom::Symbol { .. } => true,
        Atom::Upright { base, .. } => {
            is_function(base) || base.starts_with(|c: char| c.is_ascii_digit() || "([".contains(c))
        }
        Atom::Space => false,
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
    fn every_number_knows_its_symbol() {
        let put = put("I_d = 2 k_d max(0, N·L)^α C_b + 1/m", &symbols()).expect("known");
        assert_eq!(put.text, "I_d = 2 × 0.8 × max(0, −0.25)^32 × (1, 0.5, 0) + 1/(−2)");
        let symbols: Vec<_> = put.symbols.iter().map(|s| s.as_deref().unwrap_or("")).collect();
        assert_eq!(symbols, ["", "k_d", "", "N·L", "C_b", "C_b", "C_b", "", "m"]);
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
