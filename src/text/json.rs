//! Reads JSON manually, with a path and a byte offset for every error. Used for scenes and for the
//! declarations of custom models.
//!
//! A [`Cursor`] points at a value and knows its path; a [`Reader`] returns the value as a type, and reports a
//! value of another type with its path, the value and the rule.

use jsonc_parser::{
    CollectOptions, ParseOptions,
    common::Ranged,
    errors::{ParseError, ParseErrorKind},
    parse_to_ast,
};

pub use jsonc_parser::ast::{ObjectProp, Value as Ast};

use super::{
    did_you_mean, listed,
    path::{Path, Segment},
    shortened,
};

/// Options for strict JSON.
pub const STRICT: ParseOptions = ParseOptions {
    allow_comments: false,
    allow_loose_object_property_names: false,
    allow_trailing_commas: false,
    allow_missing_commas: false,
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

/// The message about half a pair of UTF-16 surrogates, which is no character.
const HALF_PAIR: &str =
    "an escape from \\ud800 to \\udfff is half a character; write the character itself, or both halves";

/// The value in a text, if there is one.
///
/// # Errors
/// Returns the byte at which the text stops being JSON, and the reason.
pub fn parse<'a>(text: &'a str, options: &ParseOptions) -> Result<Option<Ast<'a>>, (usize, String)> {
    let parsed = parse_to_ast(text, &CollectOptions::default(), options);
    parsed.map(|p| p.value).map_err(|e| explained(text, &e))
}

/// The byte and the reason of an error of the parser.
fn explained(text: &str, error: &ParseError) -> (usize, String) {
    let (at, said) = (error.range().start, error.kind().to_string());
    // Words in a text are no values.
    let in_text = matches!(error.kind(), ParseErrorKind::String(_));
    let (start, word) = word_at(text, at);
    let is_key = text[start + word.len()..].trim_start().starts_with(':');
    if let Some(what) = slip(word).filter(|_| !is_key && !in_text) {
        return (start, what);
    }
    if said.contains("surrogate") {
        return (at, HALF_PAIR.to_owned());
    }
    let mut letters = said.chars();
    let first = letters.next().into_iter().flat_map(char::to_lowercase);
    (at, first.chain(letters).collect())
}

/// The word around a byte, such as `NaN`, `-Infinity`, `0x1F` or `.5`, and the byte where it begins; empty if there is none.
#[must_use]
pub fn word_at(text: &str, mut at: usize) -> (usize, &str) {
    let part_of_word = |c: char| c.is_alphanumeric() || "+-._".contains(c);
    at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let start = text[..at].char_indices().rev().take_while(|(_, c)| part_of_word(*c)).last();
    let start = start.map_or(at, |(i, _)| i);
    let word = &text[start..];
    (start, &word[..word.find(|c| !part_of_word(c)).unwrap_or(word.len())])
}

/// The message about a word that is meant as a value and is none in JSON, if the slip is a common one.
#[must_use]
pub fn slip(word: &str) -> Option<String> {
    let unsigned = word.trim_start_matches(['+', '-']);
    let lower = unsigned.to_lowercase();
    let what = match lower.as_str() {
        "nan" | "inf" | "infinity" => " is not a number in JSON; write a finite number",
        "true" | "false" | "null" | "none" | "undefined" if !["true", "false", "null"].contains(&word) => {
            " is not JSON; true, false and null are written in lower case"
        }
        _ if word.starts_with('+') => ": numbers have no plus sign",
        _ if unsigned.starts_with('.') => ": numbers begin with a digit: 0.5, not .5",
        _ if lower.starts_with("0x") => ": numbers are decimal",
        _ => return None,
    };
    Some(format!("{word}{what}"))
}

/// A value, and its path. The path is built on demand: most values are valid, and there may be many.
#[derive(Clone, Copy)]
pub struct Cursor<'p, 'a> {
    /// The value.
    pub value: &'p Ast<'a>,
    way: Way<'p, 'a>,
}

/// The last step to a value.
#[derive(Clone, Copy)]
enum Way<'p, 'a> {
    Root,
    Key(&'p Cursor<'p, 'a>, &'static str),
    Index(&'p Cursor<'p, 'a>, usize),
}

impl<'p, 'a> Cursor<'p, 'a> {
    /// The outermost value.
    #[must_use]
    pub fn root(value: &'p Ast<'a>) -> Self {
        Self { value, way: Way::Root }
    }

    /// The path from the outermost value.
    #[must_use]
    pub fn path(&self) -> Path {
        match self.way {
            Way::Root => Path::root(),
            Way::Key(from, key) => from.path().then(Segment::Key(key.into())),
            Way::Index(from, i) => from.path().then(Segment::Index(i)),
        }
    }

    /// Another value, with this one's name in messages.
    #[must_use]
    pub fn holding(self, value: &'p Ast<'a>) -> Self {
        Self { value, ..self }
    }

    /// The byte at which the value begins.
    #[must_use]
    pub fn start(&self) -> usize {
        self.value.start()
    }

    /// The text, if it is one.
    #[must_use]
    pub fn text(&self) -> Option<&'p str> {
        match self.value {
            Ast::StringLit(text) => Some(&text.value),
            _ => None,
        }
    }

    /// The number in 32 bits, rounded once; infinite if it is too large.
    #[must_use]
    pub fn number(&self) -> Option<f32> {
        match self.value {
            Ast::NumberLit(number) => number.value.parse().ok(),
            _ => None,
        }
    }

    /// The rule that a number breaks which is too large for 32 bits: [`TOO_LARGE`].
    #[must_use]
    pub fn too_large(&self) -> Option<&'static str> {
        self.number().is_some_and(f32::is_infinite).then_some(TOO_LARGE)
    }

    /// The number as written, if it is one.
    #[must_use]
    pub fn literal(&self) -> Option<&'p str> {
        match self.value {
            Ast::NumberLit(number) => Some(number.value),
            _ => None,
        }
    }

    /// The [integer](whole).
    #[must_use]
    pub fn integer(&self) -> Option<i64> {
        whole(self.literal()?)
    }

    /// The entries, if it is a list.
    #[must_use]
    pub fn list(&'p self) -> Option<impl ExactSizeIterator<Item = Self>> {
        let Ast::Array(list) = self.value else { return None };
        Some(list.elements.iter().enumerate().map(|(i, value)| Self { value, way: Way::Index(self, i) }))
    }

    /// The properties, if it is an object.
    #[must_use]
    pub fn properties(&self) -> Option<&'p [ObjectProp<'a>]> {
        match self.value {
            Ast::Object(object) => Some(&object.properties),
            _ => None,
        }
    }

    /// A value of this object, under a key.
    #[must_use]
    pub fn entry(&'p self, key: &'static str, value: &'p Ast<'a>) -> Self {
        Self { value, way: Way::Key(self, key) }
    }

    /// The first value under a key, as spelled in the text.
    #[must_use]
    pub fn get(&'p self, key: &'static str) -> Option<Self> {
        let property = self.properties()?.iter().find(|p| p.name.as_str() == key)?;
        Some(self.entry(key, &property.value))
    }
}

/// The largest integer that may be written as a real number: beyond it, neighbouring integers are equal in 64 bits.
pub const EXACT: i64 = 1 << 53;

/// The rule of numbers without a range of their own.
pub const TOO_LARGE: &str = "numbers must be between -3.4e38 and 3.4e38, the largest of 32 bits";

/// An integer. `32.0` and `3.2e1` are integers: JSON does not distinguish them from `32`.
#[must_use]
pub fn whole(number: &str) -> Option<i64> {
    let fraction = |v: &f64| v.fract() == 0.0 && v.abs() <= EXACT as f64;
    let of_real = || number.parse::<f64>().ok().filter(fraction).map(|v| v as i64);
    number.parse().ok().or_else(of_real)
}

/// The known fields of an object, each key once.
pub struct Fields<'p, 'a> {
    /// The object.
    pub of: Cursor<'p, 'a>,
    fields: Vec<(&'static str, &'p ObjectProp<'a>)>,
}

impl<'a> Fields<'_, 'a> {
    /// The value of a field, if given.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<Cursor<'_, 'a>> {
        self.iter().find(|(k, _)| *k == key).map(|(_, value)| value)
    }

    /// The given fields, in the order of the text.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, Cursor<'_, 'a>)> {
        self.fields.iter().map(|(k, p)| (*k, Cursor { value: &p.value, way: Way::Key(&self.of, k) }))
    }

    /// The path of a field, given or not.
    #[must_use]
    pub fn path(&self, key: &'static str) -> Path {
        self.of.path().key(key)
    }
}

/// A reader of one kind of text. Values that break a rule are reported, and `None` is returned.
pub trait Reader {
    /// The text that is read.
    fn text(&self) -> &str;

    /// Records a problem at a byte: a value as written and the rule that it breaks, or a whole predicate.
    fn report(&mut self, at: usize, path: Path, found: Option<String>, rule: &str);

    /// True after so many errors that unknown keys need not be listed any more.
    fn has_enough(&self) -> bool {
        false
    }

    /// The end of the message about a key given twice.
    fn twice(&self, _first: &ObjectProp, _again: &ObjectProp) -> String {
        String::new()
    }

    /// The end of the message about an unknown key, for example with the nearest known key.
    fn hint(&mut self, written: &str, known: &[&'static str], what: &str) -> String;

    /// A value as shown in messages.
    fn shown(&self, value: &Ast) -> String {
        describe(value, self.text())
    }

    /// Reports a value that breaks a rule.
    fn wrong(&mut self, value: Cursor, rule: &str) {
        let found = self.shown(value.value);
        self.report(value.start(), value.path(), Some(found), rule);
    }

    /// Reports that a required field is missing.
    fn lacking(&mut self, fields: &Fields, key: &'static str, why: &str) {
        self.report(fields.of.start(), fields.path(key), None, &format!("is missing; {why}"));
    }

    /// The fields of an object. Reports a value that is not an object, unknown keys, and repeated keys.
    fn fields<'p, 'a>(
        &mut self,
        of: Cursor<'p, 'a>,
        known: &[&'static str],
        what: &str,
    ) -> Option<Fields<'p, 'a>> {
        let Some(properties) = of.properties() else {
            self.wrong(of, &format!("{what} must be an object, with the keys {}", listed(known, "and")));
            return None;
        };
        let mut fields: Vec<(&'static str, &ObjectProp)> = Vec::with_capacity(properties.len().min(16));
        for property in properties {
            if self.has_enough() {
                break;
            }
            let written = property.name.as_str();
            let (path, predicate) = match canonical(written, known) {
                None => {
                    let hint = self.hint(written, known, what);
                    (of.path().key(shortened(written)), format!("is not a key of {what}{hint}"))
                }
                Some(key) => match fields.iter().find(|(k, _)| *k == key) {
                    None => {
                        fields.push((key, property));
                        continue;
                    }
                    Some((_, first)) => {
                        (of.path().key(key), format!("is given twice{}", self.twice(first, property)))
                    }
                },
            };
            self.report(property.start(), path, None, &predicate);
        }
        Some(Fields { of, fields })
    }

    /// A number in 32 bits; a number that is too large becomes infinite, so that its rule rejects it.
    fn number(&mut self, value: Cursor, rule: &str) -> Option<f32> {
        let number = value.number();
        if number.is_none() {
            self.wrong(value, &needs("a number", value, rule));
        }
        number
    }

    /// A whole number.
    fn integer(&mut self, value: Cursor, rule: &str) -> Option<i64> {
        let integer = value.integer();
        if integer.is_none() {
            let rule = match value.value {
                Ast::NumberLit(_) => rule.to_owned(),
                _ => needs("a whole number", value, rule),
            };
            self.wrong(value, &rule);
        }
        integer
    }

    /// A text.
    fn string<'p>(&mut self, value: Cursor<'p, '_>, rule: &str) -> Option<&'p str> {
        value.text().or_else(|| {
            self.wrong(value, rule);
            None
        })
    }

    /// A boolean, or the default if the field is missing.
    fn flag(&mut self, fields: &Fields, key: &str, default: bool, rule: &str) -> bool {
        match fields.get(key) {
            None => default,
            Some(Cursor { value: Ast::BooleanLit(flag), .. }) => flag.value,
            Some(value) => {
                self.wrong(value, rule);
                default
            }
        }
    }
}

/// The message that a value of another type is needed.
fn needs(what: &str, value: Cursor, rule: &str) -> String {
    match value.text() {
        Some(text) if text.trim().parse::<f64>().is_ok() => {
            format!("it must be {what}, without quotes: {rule}")
        }
        _ => format!("it must be {what}: {rule}"),
    }
}

/// A known key in its standard spelling: `color` is read as `colour`, `base_color` as `base_colour`.
#[must_use]
pub fn canonical<'k>(written: &str, known: &[&'k str]) -> Option<&'k str> {
    let find = |key: &str| known.iter().find(|k| **k == key).copied();
    find(written).or_else(|| written.contains("color").then(|| find(&written.replace("color", "colour")))?)
}

/// A value as written if it is short, and otherwise its type.
#[must_use]
pub fn describe(value: &Ast, text: &str) -> String {
    match value {
        Ast::Array(list) => {
            let short = list.elements.len() <= 4;
            let scalar = |e: &Ast| !matches!(e, Ast::Array(_) | Ast::Object(_));
            if short && list.elements.iter().all(scalar) {
                let elements: Vec<_> = list.elements.iter().map(|e| shortened(e.text(text))).collect();
                return format!("[{}]", elements.join(", "));
            }
            format!("a list of {}", list.elements.len())
        }
        Ast::Object(object) if object.properties.is_empty() => "{}".to_owned(),
        Ast::Object(_) => "an object".to_owned(),
        _ => shortened(value.text(text)),
    }
}

/// The byte and the value at a path; if the value is missing, the byte of the enclosing object, which lacks
/// it.
#[must_use]
pub fn locate<'b, 'a>(root: &'b Ast<'a>, path: &Path) -> (usize, Option<&'b Ast<'a>>) {
    let mut value = root;
    for segment in path.segments() {
        let next = match (segment, value) {
            (Segment::Index(i), Ast::Array(list)) => list.elements.get(*i),
            (Segment::Key(key), Ast::Object(object)) => {
                let same = |p: &&ObjectProp| canonical(p.name.as_str(), &[key]).is_some();
                object.properties.iter().find(same).map(|p| &p.value)
            }
            _ => None,
        };
        match next {
            Some(next) => value = next,
            None => return (value.start(), None),
        }
    }
    (value.start(), Some(value))
}

/// The end of the message about an unknown key: the nearest known key, or a list of all.
#[must_use]
pub fn nearest_key<'k>(
    written: &str,
    known: &[&'k str],
    other_words: impl Iterator<Item = (&'k str, &'k str)>,
    what: &str,
) -> String {
    let candidates = known.iter().map(|k| (*k, *k)).chain(other_words);
    match did_you_mean(&written.replace("color", "colour"), candidates) {
        none if none.is_empty() => format!("; {what} has the keys {}", listed(known, "and")),
        hint => hint,
    }
}
