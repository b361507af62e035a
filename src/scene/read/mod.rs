//! From JSON to a [`Scene`](super::Scene): types, unknown, missing and repeated keys are found here; ranges and relations
//! are [`check`](super::check)'s. Every problem gets the place of its value.

use std::{collections::HashSet, path::Path as FilePath};

use super::{
    Scene,
    error::Path,
    field::Kind,
    formats::{Located, Parsed, Source},
    part::{Fields as _, Structure as _},
    problem::{MAX_PROBLEMS, Problem},
    reading::Missing,
};
use crate::{
    parameter::Outside,
    registry::Registry,
    text::{
        json::{self, Ast, Cursor, ObjectProp, STRICT},
        place::Lines,
    },
};
use jsonc_parser::common::Ranged as _;

pub(super) mod keys;
mod parts;
mod values;

/// Maximum number of unknown keys with a suggestion; more would take too long in a hostile file.
pub(super) const MAX_SUGGESTIONS: usize = 200;

/// The scene in a tree of values, from JSON or made by another format. `before` are problems found while the
/// tree was made, each with its byte index.
pub(super) fn parsed<'a>(
    text: &'a str,
    root: Ast<'a>,
    source: &Source<'a>,
    registry: &'a Registry,
    before: (Vec<(usize, Problem)>, usize),
) -> Parsed<'a> {
    let mut reader = Reader::new(text, (source.folder, source.outside), registry);
    (reader.problems, reader.unlisted) = before;
    let scene = reader.scene(Cursor::root(&root));
    let Reader { problems, reported, missing, unlisted, lines, .. } = reader;
    let placed = |(at, problem): (usize, Problem)| Problem { place: Some(lines.place(at)), ..problem };
    let mut parsed = Parsed::new(scene).with_missing(missing);
    parsed.problems = problems.into_iter().map(placed).collect();
    (parsed.unread, parsed.unlisted, parsed.end) = (reported, unlisted, Some(lines.place(text.len())));
    parsed.located(move |path| {
        let (at, value) = json::locate(&root, path);
        let found = value.map(|value| json::describe(value, text));
        Located { place: Some(lines.place(at)), found }
    })
}

/// Reads a single part of a scene from JSON with checked syntax; only types and keys are checked.
pub(super) fn alone<T>(
    text: &str,
    registry: &Registry,
    read: impl FnOnce(&mut Reader, Cursor) -> T,
) -> Result<T, Vec<Problem>> {
    let root = json::parse(text, &STRICT).ok().flatten();
    let root = root.ok_or_else(|| vec![Problem::about(Path::root(), "is not JSON")])?;
    let mut reader = Reader::new(text, (FilePath::new(""), Outside::NONE), registry);
    let part = read(&mut reader, Cursor::root(&root));
    let problems: Vec<_> = reader.problems.into_iter().map(|(_, problem)| problem).collect();
    if problems.is_empty() { Ok(part) } else { Err(problems) }
}

/// The state of reading.
pub(super) struct Reader<'a> {
    text: &'a str,
    /// The folder of the files that the scene names.
    folder: &'a FilePath,
    /// The files outside that folder that it may name.
    outside: &'a Outside,
    registry: &'a Registry,
    /// Problems, each with its byte index.
    problems: Vec<(usize, Problem)>,
    /// Paths of unreadable values: their placeholders are not checked.
    reported: HashSet<Path>,
    missing: Vec<Missing>,
    /// The number of problems beyond [`MAX_PROBLEMS`].
    unlisted: usize,
    suggestions: usize,
    light_keys: Vec<&'static str>,
    object_keys: Vec<&'static str>,
    material_keys: Vec<&'static str>,
    lines: Lines<'a>,
}

impl<'a> Reader<'a> {
    fn new(text: &'a str, (folder, outside): (&'a FilePath, &'a Outside), registry: &'a Registry) -> Self {
        Self {
            text,
            folder,
            outside,
            registry,
            problems: Vec::new(),
            reported: HashSet::new(),
            missing: Vec::new(),
            unlisted: 0,
            suggestions: 0,
            light_keys: keys::light_keys(registry),
            object_keys: keys::object_keys(registry),
            material_keys: registry.material_parameters().map(|p| p.name).collect(),
            lines: Lines::new(text),
        }
    }

    fn add(&mut self, at: usize, problem: Problem) {
        if self.problems.len() < MAX_PROBLEMS {
            self.problems.push((at, problem));
        } else {
            self.unlisted += 1;
        }
    }

    /// Excludes a value from the checks.
    fn unread(&mut self, path: Path) {
        self.reported.insert(path);
    }

    /// The end of the message about a key that exactly one other part has. Variants do not count: they repeat the keys of others.
    fn home(&self, written: &str) -> Option<String> {
        let mut homes = Vec::new();
        if json::canonical(written, &Scene::keys()).is_some() {
            homes.push("; it is a key of the scene itself".to_owned());
        }
        if json::canonical(written, &self.material_keys).is_some() {
            homes.push("; it is a material parameter: write it in \"material\" of an object".to_owned());
        }
        Scene::default().each(&mut |field, held, _| {
            let mut keys = Vec::new();
            match field.key {
                key if key == Scene::lights.key => keys.clone_from(&self.light_keys),
                key if key == Scene::objects.key => keys.clone_from(&self.object_keys),
                _ => held.parts().iter().for_each(|part| part.each(&mut |field, _, _| keys.push(field.key))),
            }
            let Some(key) = json::canonical(written, &keys) else { return };
            let part = field.key;
            homes.push(match field.kind {
                Kind::Parts => format!("; it is a key of the entries of \"{part}\""),
                _ => format!("; it is a key of \"{part}\": {part}.{key}"),
            });
        });
        homes.pop().filter(|_| homes.is_empty())
    }

    /// Records a missing part with a default.
    fn missing(&mut self, path: Path, at: usize, default: String) {
        self.missing.push(Missing { path, default, place: Some(self.lines.place(at)) });
    }
}

impl json::Reader for Reader<'_> {
    fn text(&self) -> &str {
        self.text
    }

    /// Adds a problem and excludes its path from checks.
    fn report(&mut self, at: usize, path: Path, found: Option<String>, rule: &str) {
        if self.problems.len() < MAX_PROBLEMS {
            self.reported.insert(path.clone());
        }
        self.add(at, Problem { place: None, path, found, rule: rule.to_owned() });
    }

    fn twice(&self, first: &ObjectProp, again: &ObjectProp) -> String {
        let at = self.lines.place(first.start());
        let written = again.name.as_str();
        let spelt = if first.name.as_str() == written { String::new() } else { format!(" as {written}") };
        format!("{spelt}; first given at {at}")
    }

    /// The nearest known key, or the part to which the key belongs.
    fn hint(&mut self, written: &str, known: &[&'static str], what: &str) -> String {
        self.suggestions += 1;
        if self.suggestions > MAX_SUGGESTIONS {
            return String::new();
        }
        if what == "an object" && json::canonical(written, &self.material_keys).is_some() {
            return "; it is a material parameter: write it in \"material\"".to_owned();
        }
        let others = keys::OTHER_WORDS.iter().copied().filter(|(_, key)| known.contains(key));
        if !others.clone().any(|(word, _)| word == written)
            && let Some(home) = self.home(written)
        {
            return home;
        }
        let parameters = self.registry.material_parameters();
        let labels = parameters.flat_map(|p| [(p.label, p.name), (p.symbol, p.name)]);
        let labels = labels.filter(|_| what == "a material");
        json::nearest_key(written, known, others.chain(labels), what)
    }
}
