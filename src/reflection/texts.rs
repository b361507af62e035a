//! The texts of the built-in models: each model has a file of them beside its code, which the compiler reads.
//!
//! A line has a key and a text. Lines that begin with `#`, and empty ones, are for the reader:
//!
//! ```text
//! author: G. J. Ward 1992
//! source: G. J. Ward (1992), Measuring and Modeling Anisotropic Reflection, SIGGRAPH '92, 265–272
//! summary: A Gaussian highlight made to fit measurements.
//! synonyms: anisotropic, brushed metal
//! laws: reciprocal, non-negative
//!
//! total: I = I_d + I_s
//! diffuse: I_d = (1 − k_s) C_b N·L
//!
//! # Light that does not spread, along the path of the ray of view:
//! path specular: I_s = π F(N·V) L(R)
//!
//! # A quantity of the equation, its label, its source, and the choices with which it is used:
//! where: c = 1/N·V
//! is: division by both cosines, times N·L
//! by: A. Dür 2006
//! when: ward_form = duer
//! ```
//!
//! Each function returns what it finds, up to `N` of it, and the number of all: with `N` = 0 it counts.

use super::{
    declaration::{Declaration, EquationPart, Laws, Term},
    quantity::Quantity,
};

/// A list with its name: synonyms, which have none, or choices, which have that of their parameter.
pub(super) type List = (&'static str, &'static [&'static str]);

/// A line of a file, and the lines after it.
struct Line {
    key: &'static [u8],
    text: &'static str,
    rest: &'static str,
}

/// The text before a mark, and the text after it.
const fn cut(text: &'static str, mark: &[u8]) -> (&'static str, &'static str) {
    let bytes = text.as_bytes();
    let mut at = 0;
    while at + mark.len() <= bytes.len() {
        let mut same = 0;
        while same < mark.len() && bytes[at + same] == mark[same] {
            same += 1;
        }
        if same == mark.len() {
            let (before, rest) = text.split_at(at);
            return (before, rest.split_at(same).1);
        }
        at += 1;
    }
    (text, "")
}

/// The first line that has a key.
const fn line(text: &'static str) -> Option<Line> {
    let (line, rest) = cut(text, b"\n");
    match line.as_bytes() {
        [] if rest.is_empty() => None,
        [] | [b'#', ..] => self::line(rest),
        _ => {
            let (key, text) = cut(line, b": ");
            Some(Line { key: key.as_bytes(), text, rest })
        }
    }
}

/// The list in a line: its name and its words.
const fn list(line: &Line) -> Option<(&'static str, &'static str)> {
    match line.key {
        b"synonyms" => Some(("", line.text)),
        b"when" => Some(cut(line.text, b" = ")),
        _ => None,
    }
}

/// The words of all lists.
pub(super) const fn words<const N: usize>(text: &'static str) -> ([&'static str; N], usize) {
    let (mut all, mut count, mut rest) = ([""; N], 0, text);
    while let Some(line) = line(rest) {
        if let Some((_, mut words)) = list(&line) {
            while !words.is_empty() {
                let (word, others) = cut(words, b", ");
                if count < N {
                    all[count] = word;
                }
                (count, words) = (count + 1, others);
            }
        }
        rest = line.rest;
    }
    (all, count)
}

/// The lists, of the words of all.
pub(super) const fn lists<const N: usize>(
    text: &'static str,
    mut words: &'static [&'static str],
) -> ([List; N], usize) {
    let (mut all, mut count, mut rest) = ([("", &[] as &[_]); N], 0, text);
    while let Some(line) = line(rest) {
        if let Some((name, mut own)) = list(&line) {
            if count < N {
                let mut length = 0;
                while !own.is_empty() {
                    (length, own) = (length + 1, cut(own, b", ").1);
                }
                (all[count], words) = ((name, words.split_at(length).0), words.split_at(length).1);
            }
            count += 1;
        }
        rest = line.rest;
    }
    (all, count)
}

/// The parts of the equation.
pub(super) const fn equation<const N: usize>(text: &'static str) -> ([EquationPart; N], usize) {
    let (mut all, mut count, mut rest) = ([EquationPart::new(Term::Total, ""); N], 0, text);
    while let Some(Line { key, text, rest: after }) = line(rest) {
        let part = match key {
            b"total" => Some(EquationPart::new(Term::Total, text)),
            b"ambient" => Some(EquationPart::new(Term::Ambient, text)),
            b"diffuse" => Some(EquationPart::new(Term::Diffuse, text)),
            b"specular" => Some(EquationPart::new(Term::Specular, text)),
            b"transmitted" => Some(EquationPart::new(Term::Transmitted, text)),
            b"path specular" => Some(EquationPart::along_path(Term::Specular, text)),
            b"path transmitted" => Some(EquationPart::along_path(Term::Transmitted, text)),
            _ => None,
        };
        if let Some(part) = part {
            if count < N {
                all[count] = part;
            }
            count += 1;
        }
        rest = after;
    }
    (all, count)
}

/// The quantities; their conditions are the lists after the synonyms.
pub(super) const fn quantities<const N: usize>(
    text: &'static str,
    lists: &'static [List],
) -> ([Quantity; N], usize) {
    let (mut all, mut count, mut rest) = ([Quantity::new("", ""); N], 0, text);
    let mut conditions = if let [_, conditions @ ..] = lists { conditions } else { &[] };
    while let Some(Line { key, text, rest: after }) = line(rest) {
        if let b"where" = key {
            if 0 < count && count <= N {
                conditions = conditions.split_at(all[count - 1].when.len()).1;
            }
            count += 1;
        }
        if 0 < count && count <= N {
            let quantity = &mut all[count - 1];
            match key {
                b"where" => quantity.text = text,
                b"is" => quantity.label = text,
                b"by" => quantity.source = text,
                _ => quantity.when = conditions.split_at(quantity.when.len() + 1).0,
            }
        }
        rest = after;
    }
    (all, count)
}

impl Declaration {
    /// Sets the texts of a file, with the parts of it that are lists.
    pub(super) const fn texts(self, text: &'static str, lists: &'static [List]) -> Self {
        let mut all = Self { synonyms: lists[0].1, ..self };
        let mut rest = text;
        while let Some(Line { key, text, rest: after }) = line(rest) {
            match key {
                b"author" => all.author = text,
                b"source" => all.source = text,
                b"summary" => all.summary = text,
                b"laws" => all.laws = laws(text),
                b"synonyms" | b"total" | b"ambient" | b"diffuse" | b"specular" | b"transmitted" => {}
                b"path specular" | b"path transmitted" | b"where" | b"is" | b"by" | b"when" => {}
                _ => panic!("a line of the texts begins with another word"),
            }
            rest = after;
        }
        all
    }
}

/// The laws of a list.
const fn laws(list: &'static str) -> Laws {
    let (mut laws, mut rest) = (Laws::NONE, list);
    while !rest.is_empty() {
        let (law, others) = cut(rest, b", ");
        match law.as_bytes() {
            b"reciprocal" => laws.reciprocal = true,
            b"energy conserving" => laws.energy_conserving = true,
            b"non-negative" => laws.non_negative = true,
            _ => panic!("there is no law of that name"),
        }
        rest = others;
    }
    laws
}

/// The declaration of a built-in model: its id, name and family, with its WGSL and the texts of `ID.txt`.
macro_rules! built_in {
    ($id:literal, $name:literal, $Family:ident) => {{
        use $crate::{
            reflection::{EquationPart, Family, Quantity, texts},
            shader::Source,
        };
        const TEXT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/src/reflection/", $id, ".txt"));
        const WORDS: &[&str] = &texts::words::<{ texts::words::<0>(TEXT).1 }>(TEXT).0;
        const LISTS: &[texts::List] = &texts::lists::<{ texts::lists::<0>(TEXT, &[]).1 }>(TEXT, WORDS).0;
        const EQUATION: &[EquationPart] = &texts::equation::<{ texts::equation::<0>(TEXT).1 }>(TEXT).0;
        const QUANTITIES: &[Quantity] =
            &texts::quantities::<{ texts::quantities::<0>(TEXT, &[]).1 }>(TEXT, LISTS).0;
        const WGSL: &str =
            include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/shaders/reflection/", $id, ".wgsl"));
        Declaration::new($id, $name, Source::new(concat!("reflection/", $id, ".wgsl"), WGSL))
            .family(Family::$Family)
            .equation(EQUATION)
            .quantities(QUANTITIES)
            .texts(TEXT, LISTS)
    }};
}

pub(super) use built_in;

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "author: A. Author 2000\nsource: A. Author (2000): Title\nsummary: It shines.\n\
        synonyms: metal, brushed metal\nlaws: reciprocal, energy conserving\n\n# The equation.\n\
        total: I = I_d + I_t\ndiffuse: I_d = c F\npath transmitted: I_t = c\n\n\
        where: c = 1\nis: first: one\nby: B. Author 2001\nwhen: form = a, b\nwhen: shape = d\n\n\
        where: c = 2\nis: second\n\nwhere: F\nis: third\nwhen: form = e\n";

    #[test]
    fn a_file_has_the_texts_of_a_declaration() {
        const WORDS: &[&str] = &words::<{ words::<0>(TEXT).1 }>(TEXT).0;
        const LISTS: &[List] = &lists::<{ lists::<0>(TEXT, &[]).1 }>(TEXT, WORDS).0;
        assert_eq!(WORDS, ["metal", "brushed metal", "a", "b", "d", "e"]);
        let d = Declaration::new("one", "One", crate::shader::Source::new("", "")).texts(TEXT, LISTS);
        assert_eq!((d.author, d.source), ("A. Author 2000", "A. Author (2000): Title"));
        assert_eq!((d.summary, d.synonyms), ("It shines.", &["metal", "brushed metal"][..]));
        assert_eq!(d.laws, Laws { reciprocal: true, energy_conserving: true, non_negative: false });
        let (parts, _) = equation::<3>(TEXT);
        let path = EquationPart::along_path(Term::Transmitted, "I_t = c");
        let [total, diffuse] = [(Term::Total, "I = I_d + I_t"), (Term::Diffuse, "I_d = c F")];
        let [total, diffuse] = [total, diffuse].map(|(term, text)| EquationPart::new(term, text));
        assert_eq!(parts, [total, diffuse, path]);
        let (all, count) = quantities::<3>(TEXT, LISTS);
        assert_eq!(count, 3);
        let first = Quantity::new("c = 1", "first: one").source("B. Author 2001");
        assert_eq!(
            all,
            [
                first.when(&[("form", &["a", "b"]), ("shape", &["d"])]),
                Quantity::new("c = 2", "second"),
                Quantity::new("F", "third").when(&[("form", &["e"])]),
            ]
        );
    }
}
