//! The atoms of an equation in readable mathematics: `_x` is a subscript, `^x` a superscript, braces group. A
//! second superscript of one atom belongs to the first, as powers are read: `x^y^z` is `x^{y^z}`; so do
//! subscripts.

/// Maximum length of a line of an equation, in characters. The longest line in the shipped models has a tenth
/// of it.
pub const LONGEST_LINE: usize = 2000;
/// Maximum nesting of brackets in an equation, which also bounds the recursion of typesetting.
pub const MAX_DEPTH: usize = 24;

/// The sentence about brackets nested deeper than a limit, in equations and in WGSL.
#[must_use]
pub fn nested_beyond(most: usize) -> String {
    format!("this is nested more than {most} brackets deep, the most allowed")
}

/// The first position at which an equation exceeds a limit: its byte, and a sentence.
#[must_use]
pub fn beyond_limits(equation: &str) -> Option<(usize, String)> {
    let mut open: Vec<char> = Vec::new();
    let mut length = 0;
    for (at, c) in equation.char_indices() {
        length = if c == '\n' { 0 } else { length + 1 };
        match c {
            // The second of two bars closes.
            '|' if open.last() == Some(&'|') => _ = open.pop(),
            '(' | '[' | '{' | '⟨' | '|' => open.push(c),
            ')' | ']' | '}' | '⟩' => while open.pop() == Some('|') {},
            _ => {}
        }
        if open.len() > MAX_DEPTH {
            return Some((at, nested_beyond(MAX_DEPTH)));
        }
        if length > LONGEST_LINE {
            let what = format!("this line of the equation has more than {LONGEST_LINE} characters; break it");
            return Some((at, what));
        }
    }
    let mut start = 0;
    for line in equation.split_inclusive('\n') {
        if stands_beyond(line, 0) {
            return Some((start, format!("powers or indices are nested more than {MAX_DEPTH} deep")));
        }
        start += line.len();
    }
    None
}

/// True if the scripts of a text, itself nested this deep, exceed the maximum depth.
fn stands_beyond(text: &str, depth: usize) -> bool {
    depth > MAX_DEPTH
        || parse(text).iter().any(|atom| {
            [atom.sub(), atom.sup()].into_iter().any(|s| !s.is_empty() && stands_beyond(s, depth + 1))
        })
}

/// An unbreakable piece of an equation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Atom {
    /// A variable, possibly with a subscript and a power: `k_d`, `d^2`.
    Symbol {
        /// The letter.
        base: String,
        /// Subscript.
        sub: String,
        /// Superscript.
        sup: String,
    },
    /// A function name, a number, an operator or a bracket, possibly with a subscript and a power.
    Upright {
        /// The characters.
        base: String,
        /// Subscript.
        sub: String,
        /// Superscript.
        sup: String,
    },
    /// A space, where a line may be broken.
    Space,
}

impl Atom {
    /// A function name, a number, an operator or a bracket, without subscript and power.
    #[must_use]
    pub fn upright(base: &str) -> Self {
        Self::Upright { base: base.to_owned(), sub: String::new(), sup: String::new() }
    }

    /// The symbol as written in declarations (`k_d`), if the atom is one.
    #[must_use]
    pub fn symbol(&self) -> Option<String> {
        match self {
            Self::Symbol { base, sub, .. } if sub.is_empty() => Some(base.clone()),
            Self::Symbol { base, sub, .. } => Some(format!("{base}_{sub}")),
            _ => None,
        }
    }

    /// The letter, word or sign, the subscript and the power.
    fn parts(&self) -> [&str; 3] {
        match self {
            Self::Symbol { base, sub, sup } | Self::Upright { base, sub, sup } => [base, sub, sup],
            Self::Space => [""; 3],
        }
    }

    /// The letter, word or sign; empty for a space.
    #[must_use]
    pub fn base(&self) -> &str {
        self.parts()[0]
    }

    /// The subscript; often empty.
    #[must_use]
    pub fn sub(&self) -> &str {
        self.parts()[1]
    }

    /// The power; often empty.
    #[must_use]
    pub fn sup(&self) -> &str {
        self.parts()[2]
    }

    /// The symbol that is the power of the atom, if any: the `α` of `(N·H)^α`.
    #[must_use]
    pub fn power(&self) -> Option<String> {
        is_variable(self.sup()).then(|| self.sup().to_owned())
    }
}

/// Splits an equation into atoms. A hyphen is read as a minus.
#[must_use]
pub fn parse(text: &str) -> Vec<Atom> {
    let chars: Vec<char> = text.chars().map(|c| if c == '-' { '−' } else { c }).collect();
    let mut atoms = Vec::new();
    let mut i = 0;
    while i < chars.len() {
        let c = chars[i];
        if c.is_whitespace() {
            if atoms.last() != Some(&Atom::Space) {
                atoms.push(Atom::Space);
            }
            i += 1;
            continue;
        }
        let start = i;
        let ascii_word = |c: &char| c.is_ascii_alphabetic();
        if c.is_ascii_alphabetic() {
            i += chars[i..].iter().take_while(|c| ascii_word(c)).count();
            // A unit, no variable: square or cubic metres.
            if chars[start..i] == ['m'] && matches!(chars.get(i), Some('²' | '³')) {
                i += 1;
            }
        } else if c.is_ascii_digit() {
            i += chars[i..].iter().take_while(|c| c.is_ascii_digit() || **c == '.').count();
        } else {
            i += 1;
        }
        let base: String = chars[start..i].iter().collect();
        let (mut sub, mut sup) = (String::new(), String::new());
        // True for the power and the subscript if it is a group so far.
        let mut grouped = [false; 2];
        while let Some(mark @ ('_' | '^')) = chars.get(i).copied() {
            let (inside, next) = script(&chars, i + 1);
            let written: String = chars[i + 1..next].iter().collect();
            i = next;
            let place = if mark == '_' { &mut sub } else { &mut sup };
            let grouped = &mut grouped[usize::from(mark == '_')];
            if place.is_empty() {
                *place = inside;
                *grouped = written.starts_with(['{', '(']);
            } else {
                nest(place, mark, &written, std::mem::take(grouped));
            }
        }
        atoms.push(if is_variable(&base) {
            Atom::Symbol { base, sub, sup }
        } else {
            Atom::Upright { base, sub, sup }
        });
    }
    atoms
}

/// Adds a script to a script: to its last atom, or to all of it if it was a group of several or already has
/// one.
fn nest(script: &mut String, mark: char, own: &str, grouped: bool) {
    let atoms = if grouped { parse(script) } else { Vec::new() };
    let taken = |atom: &Atom| !(if mark == '_' { atom.sub() } else { atom.sup() }).is_empty();
    if atoms.len() > 1 || atoms.first().is_some_and(taken) {
        *script = format!("({script})");
    }
    script.push(mark);
    script.push_str(own);
}

/// The definitions in a part of an equation, separated by commas.
#[must_use]
pub fn definitions(text: &str) -> Vec<&str> {
    let (mut pieces, mut start, mut depth) = (Vec::new(), 0, 0);
    for (i, c) in text.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            ',' if depth == 0 && defines(&text[i + 1..]) => {
                pieces.push(text[start..i].trim());
                start = i + 1;
            }
            _ => {}
        }
    }
    pieces.push(text[start..].trim());
    pieces
}

/// True if a text begins with a single term and an equals sign: `F_0 = …`, `cos g = …`.
fn defines(text: &str) -> bool {
    text.split_once('=').is_some_and(|(head, _)| {
        !head.contains([',', '+', '−', '·', '/', '<', '>'])
            && (1..=2).contains(&head.split_whitespace().count())
    })
}

/// A symbol for comparison: without the braces that group its subscript.
#[must_use]
pub fn plain_symbol(symbol: &str) -> String {
    symbol.replace(['{', '}'], "")
}

/// Atoms as text.
#[must_use]
pub fn write(atoms: &[Atom]) -> String {
    let mut out = String::new();
    for atom in atoms {
        if *atom == Atom::Space {
            out.push(' ');
            continue;
        }
        out.push_str(atom.base());
        for (mark, script) in [('_', atom.sub()), ('^', atom.sup())] {
            match script.chars().count() {
                0 => {}
                1 => out.extend([mark].into_iter().chain(script.chars())),
                _ => {
                    out.extend([mark, '{']);
                    out.push_str(script);
                    out.push('}');
                }
            }
        }
    }
    out.trim().to_owned()
}

/// True for a variable: a single letter. Several are a word, such as `max`.
#[must_use]
pub fn is_variable(text: &str) -> bool {
    let mut chars = text.chars();
    chars.next().is_some_and(char::is_alphabetic) && chars.next().is_none()
}

/// A superscript or subscript: a group in braces or brackets, a number, possibly with a sign, or a single
/// character.
fn script(chars: &[char], start: usize) -> (String, usize) {
    match chars.get(start) {
        Some(open @ ('{' | '(')) => {
            let (close, mut depth) = (if *open == '{' { '}' } else { ')' }, 0);
            let closes = |c: &char| {
                depth += i32::from(c == open) - i32::from(*c == close);
                depth == 0
            };
            let end = chars[start..].iter().position(closes).map_or(chars.len(), |n| start + n);
            (chars[start + 1..end].iter().collect(), (end + 1).min(chars.len()))
        }
        Some(c) if c.is_ascii_digit() || *c == '−' => {
            let digit = |i: usize| chars.get(i).is_some_and(char::is_ascii_digit);
            let mut end = start + 1;
            // A point belongs to a number if a digit follows.
            while digit(end) || chars.get(end) == Some(&'.') && digit(end + 1) {
                end += 1;
            }
            (chars[start..end].iter().collect(), end)
        }
        Some(c) => (c.to_string(), start + 1),
        None => (String::new(), start),
    }
}

/// The symbol of a parameter, which is a single symbol: everything after `_` is its subscript.
#[must_use]
pub fn parse_symbol(symbol: &str) -> Atom {
    let (base, sub) = symbol.split_once('_').unwrap_or((symbol, ""));
    let sub = sub.trim_matches(['{', '}']).to_owned();
    Atom::Symbol { base: base.to_owned(), sub, sup: String::new() }
}

/// True if two notations stand for the same symbol.
#[must_use]
pub fn same_symbol(a: &str, b: &str) -> bool {
    let plain = |c: &char| !matches!(c, '{' | '}');
    a == b || a.chars().filter(plain).eq(b.chars().filter(plain))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn symbol(base: &str, sub: &str, sup: &str) -> Atom {
        Atom::Symbol { base: base.to_owned(), sub: sub.to_owned(), sup: sup.to_owned() }
    }

    #[test]
    fn subscripts_superscripts_and_words_are_told_apart() {
        let atoms = parse("I_d = max(0, N·L)^{p+1} d^2");
        assert_eq!(atoms[0], symbol("I", "d", ""));
        assert_eq!(atoms[0].symbol().as_deref(), Some("I_d"));
        assert!(atoms.contains(&Atom::Upright {
            base: "max".to_owned(),
            sub: String::new(),
            sup: String::new()
        }));
        assert!(atoms.contains(&Atom::Upright {
            base: ")".to_owned(),
            sub: String::new(),
            sup: "p+1".to_owned()
        }));
        assert_eq!(atoms.last(), Some(&symbol("d", "", "2")));
    }

    #[test]
    fn a_hyphen_is_a_minus() {
        assert_eq!(parse("e^{-x^2}")[0], symbol("e", "", "−x^2"));
        assert_eq!(parse("x^-2 - 1"), parse("x^−2 − 1"));
    }

    #[test]
    fn units_are_upright() {
        let symbols = |text: &str| parse(text).iter().filter_map(Atom::symbol).collect::<Vec<_>>();
        assert_eq!(symbols("Φ = L · 1.286 sr m² = 3 lm"), ["Φ", "L"]);
        assert_eq!(symbols("L = Φ / (2 sr m²) = 3 cd/m²"), ["L", "Φ"]);
        assert_eq!(symbols("m^2 · n²"), ["m", "n"]);
        assert_eq!(write(&parse("2 sr m²")), "2 sr m²");
    }

    #[test]
    fn equations_have_a_longest_line_and_a_deepest_bracket() {
        let nested = |n: usize, open: &str, close: &str| format!("{}x{}", open.repeat(n), close.repeat(n));
        for (open, close) in [("(", ")"), ("[", "]"), ("⟨", "⟩"), ("{", "}"), ("|(", ")|")] {
            let n = MAX_DEPTH / open.chars().count();
            assert_eq!(beyond_limits(&nested(n, open, close)), None, "{open}");
            let (at, what) = beyond_limits(&nested(20_000, open, close)).expect("too deep");
            assert!(
                at <= open.len() * (n + 1) && what.contains("more than 24 brackets deep"),
                "{at}: {what}"
            );
        }
        assert_eq!(beyond_limits(&"|x| (y) ".repeat(100)), None);
        let line = "x".repeat(LONGEST_LINE);
        assert_eq!(beyond_limits(&format!("{line}\n{line}")), None);
        assert_eq!(beyond_limits(&format!("{line}\n{line}x")).map(|(at, _)| at), Some(2 * LONGEST_LINE + 1));
    }

    #[test]
    fn a_part_is_split_where_another_definition_begins() {
        assert_eq!(
            definitions("a = max(x, y = z), cos g = L·V , y_{ab} = 2"),
            ["a = max(x, y = z)", "cos g = L·V", "y_{ab} = 2"]
        );
        assert_eq!(definitions("t = max(a, b), or 1 where s < 0"), ["t = max(a, b), or 1 where s < 0"]);
        assert_eq!(definitions("x = ), y = 1"), ["x = ), y = 1"]);
    }

    #[test]
    fn atoms_are_written_as_they_were() {
        for (text, power) in
            [("x^(1/(2 a)) y", "1/(2 a)"), ("x^1.98 + 1", "1.98"), ("x^2.", "2"), ("x^−2", "−2")]
        {
            assert_eq!(parse(text)[0].sup(), power, "{text}");
        }
        for text in ["I_d = k_d max(0, N·L)^α", "F_{90} = 2^{a + 1} x_0^2", "tan^2 θ_h/π", "e^{x_{ab}^{2 y}}"]
        {
            assert_eq!(write(&parse(text)), text);
        }
    }

    #[test]
    fn a_second_script_is_that_of_the_first() {
        for (text, expected) in [
            ("x^y^z", "x^{y^z}"),
            ("x_a_b", "x_{a_b}"),
            ("x_a^2_b^n", "x_{a_b}^{2^n}"),
            ("x^{y^z}", "x^{y^z}"),
            ("x^y^z^w", "x^{y^z^w}"),
            ("x^y^{a + b}", "x^{y^{a + b}}"),
            // The group is raised as a whole.
            ("x^{a + b}^2", "x^{(a + b)^2}"),
            ("x^(a^b)^c", "x^{(a^b)^c}"),
            ("x^{n}^2^3 y", "x^{n^2^3} y"),
            ("x^{a + b}^2^3", "x^{(a + b)^2^3}"),
            ("x^−2^3", "x^{−2^3}"),
        ] {
            let written = write(&parse(text));
            assert_eq!(written, expected, "{text}");
            assert_eq!(write(&parse(&written)), expected, "{text}, read again");
        }
        assert_eq!(parse("x_a_b")[0].symbol().as_deref(), Some("x_a_b"), "as declarations write it");
    }

    #[test]
    fn powers_of_powers_have_a_limit() {
        let tower = |n: usize, mark: char| format!("a = b\nx{}", format!("{mark}x").repeat(n));
        for mark in ['^', '_'] {
            assert_eq!(beyond_limits(&tower(MAX_DEPTH, mark)), None);
            let (at, what) = beyond_limits(&tower(MAX_DEPTH + 1, mark)).expect("too high");
            assert!(at == 6 && what.contains("more than 24 deep"), "{at}: {what}");
            assert!(beyond_limits(&tower(900, mark)).is_some());
        }
    }

    #[test]
    fn the_index_of_a_symbol_alone_may_be_long() {
        assert_eq!(parse_symbol("α_GGX"), symbol("α", "GGX", ""));
        assert!(same_symbol("F_{90}", "F_90"));
    }

    #[test]
    fn unfinished_mathematics_is_no_reason_to_stop() {
        for text in ["", "_", "a_", "a^{", "{}", "x__y", "∑_{i=1}^n", "a^b^", "a_b__", "a^{b}^{c", "a^(b^(c^"]
        {
            let _ = parse(text);
        }
    }
}
