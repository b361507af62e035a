//! The reader of declarations: the common code of its parts, one for each key.

use jsonc_parser::common::Ranged as _;

use super::{intern, text::Mistake};
use crate::{
    parameter::Parameter,
    reflection::ModelEntry,
    registry::Registry,
    text::{
        behind, did_you_mean,
        json::{self, Ast, Cursor, Fields, Reader as _},
        one_of,
        path::Path,
        shortened,
    },
};

/// Other words for keys, for suggestions.
const OTHER_WORDS: &[(&str, &str)] =
    &[("title", "name"), ("description", "summary"), ("options", "choices"), ("params", "parameters")];
/// The longest name of a model, symbol or label, characters.
pub(super) const LONGEST_NAME: usize = 60;
/// The most errors reported; in longer lists, later errors follow from an early one.
pub(super) const MOST_MISTAKES: usize = 50;
/// The longest text, characters.
pub(super) const LONGEST_TEXT: usize = 2000;

/// The state of reading.
pub(super) struct Reader<'a> {
    pub(super) json: &'a str,
    pub(super) start: usize,
    pub(super) id: &'a str,
    pub(super) registry: &'a Registry,
    pub(super) mistakes: Vec<Mistake>,
}

impl json::Reader for Reader<'_> {
    fn text(&self) -> &str {
        self.json
    }

    fn report(&mut self, at: usize, path: Path, found: Option<String>, rule: &str) {
        let place = if path == Path::root() { "the declaration".to_owned() } else { path.to_string() };
        let said = match found {
            Some(found) => format!("is {found}, but {}", behind(path.last_key(), rule)),
            None => rule.to_owned(),
        };
        self.mistake(at, format!("{place} {said}"));
    }

    /// Short lists as written.
    fn shown(&self, value: &Ast) -> String {
        match value {
            Ast::Array(list) if list.elements.len() <= 4 => shortened(value.text(self.json)),
            _ => json::describe(value, self.json),
        }
    }

    fn has_enough(&self) -> bool {
        self.mistakes.len() >= MOST_MISTAKES
    }

    fn hint(&mut self, written: &str, known: &[&'static str], what: &str) -> String {
        let words = OTHER_WORDS.iter().copied().filter(|(_, key)| known.contains(key));
        json::nearest_key(written, known, words, what)
    }
}

impl Reader<'_> {
    pub(super) fn mistake(&mut self, at: usize, what: impl Into<String>) {
        self.mistakes.push((self.start + at, what.into()));
    }

    /// A given key that is superfluous or wrong.
    pub(super) fn misplaced(&mut self, value: Cursor, predicate: &str) {
        self.report(value.start(), value.path(), None, predicate);
    }

    /// A text of limited length, if given.
    pub(super) fn words(&mut self, fields: &Fields, key: &str, longest: usize) -> Option<&'static str> {
        let value = fields.get(key)?;
        let fits = |text: &&str| text.chars().count() <= longest && !text.contains(char::is_control);
        match value.text().filter(fits) {
            Some(text) if key == "name" && text.trim().is_empty() => {
                self.wrong(value, "a name must not be blank");
                None
            }
            Some(text) => Some(intern::text(text)),
            None => {
                let rule = format!("it must be one line of text, of at most {longest} characters");
                self.wrong(value, &rule);
                None
            }
        }
    }

    /// One of several words, each with its value.
    pub(super) fn word<T: Copy>(
        &mut self,
        value: Cursor,
        what: &str,
        known: &[(&'static str, T)],
    ) -> Option<T> {
        let words = known.iter().map(|(word, _)| *word);
        let rule = one_of(what, words.clone());
        let text = self.string(value, &rule)?;
        let found = known.iter().find(|(word, _)| *word == text).map(|(_, meaning)| *meaning);
        if found.is_none() {
            let hint = did_you_mean(&text.replace("color", "colour"), words.map(|word| (word, word)));
            self.wrong(value, &format!("{rule}{hint}"));
        }
        found
    }

    pub(super) fn built_in_models(&self) -> impl Iterator<Item = &ModelEntry> {
        self.registry.models().iter().filter(|m| self.registry.custom_file(m.declaration.id).is_none())
    }

    /// The parameter of that name in some built-in model.
    pub(super) fn built_in(&self, name: &str) -> Option<&'static Parameter> {
        self.built_in_models().find_map(|m| m.parameter(name))
    }
}
