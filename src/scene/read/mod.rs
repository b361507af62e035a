//! From JSON to a [`Scene`]: types, unknown, missing and repeated keys are found here; ranges and relations are
//! [`check`]'s. Every problem gets the place of its value.

use std::{
    collections::{BTreeSet, HashSet},
    path::Path as FilePath,
};

use super::{
    Scene, beyond_room, check,
    error::{LoadError, Path, Problem},
    load::{Defaults, Missing},
};
use crate::{
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

/// The number of unknown keys with a suggestion; more would take long in a hostile file.
const MAX_SUGGESTIONS: usize = 200;

/// The most problems listed. A scene within the limits of lights and objects with errors in every field has fewer; a
/// hostile file could have millions.
const MAX_PROBLEMS: usize = 200_000;

/// Reads a scene from JSON with checked syntax.
pub(super) fn scene(
    text: &str,
    (name, folder): (&str, &FilePath),
    registry: &Registry,
    defaults: Defaults,
) -> Result<(Scene, Vec<Missing>), LoadError> {
    // The two parsers agree except for half surrogate pairs, which only this one refuses.
    let root = json::parse(text, &STRICT)
        .map_err(|(at, what)| LoadError::Syntax {
            name: name.to_owned(),
            place: Lines::new(text).place(at),
            what: what.to_lowercase(),
        })?
        .ok_or_else(|| LoadError::Empty { name: name.to_owned() })?;

    let mut reader = Reader::new(text, folder, registry);
    let scene = reader.scene(Cursor::root(&root));
    reader.check(&scene, &root);
    let Reader { mut problems, missing, unlisted, lines, .. } = reader;
    if problems.is_empty() {
        return Ok((scene, missing));
    }
    if defaults == Defaults::Refuse {
        // A missing size may be reported already.
        let reported = |m: &&Missing| problems.iter().any(|(_, p)| p.path == m.path);
        let more: Vec<_> = missing.iter().filter(|m| !reported(m)).map(|m| (0, m.problem())).collect();
        problems.extend(more);
    }
    problems.sort_by_key(|(at, _)| *at);
    if unlisted > 0 {
        let more = format!("has {unlisted} more problems, which are not listed");
        problems.push((text.len(), Problem::about(Path::root(), more)));
    }
    let problems = problems
        .into_iter()
        .map(|(at, problem)| Problem {
            place: Some(problem.place.unwrap_or_else(|| lines.place(at))),
            ..problem
        })
        .collect();
    Err(LoadError::Invalid { name: name.to_owned(), problems })
}

/// The reflection models that a scene names, from JSON with checked syntax.
pub(super) fn models_named(text: &str, registry: &Registry) -> BTreeSet<String> {
    let root = json::parse(text, &STRICT).ok().flatten();
    let scene = root.map(|root| Reader::new(text, FilePath::new(""), registry).scene(Cursor::root(&root)));
    scene.map_or_else(BTreeSet::new, |scene| scene.models().into_iter().map(str::to_owned).collect())
}

/// The state of reading.
struct Reader<'a> {
    text: &'a str,
    /// The folder in which files are that the scene names.
    folder: &'a FilePath,
    registry: &'a Registry,
    /// Problems, each with its byte.
    problems: Vec<(usize, Problem)>,
    /// Paths of unreadable values: their stand-ins are not checked.
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
    fn new(text: &'a str, folder: &'a FilePath, registry: &'a Registry) -> Self {
        Self {
            text,
            folder,
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

    /// Notes a missing part with a default.
    fn missing(&mut self, path: Path, at: usize, default: String) {
        self.missing.push(Missing { path, default, place: Some(self.lines.place(at)) });
    }

    /// Applies [`check`] and locates its findings.
    fn check(&mut self, scene: &Scene, root: &Ast) {
        let mut problems = check::scene(scene, self.registry);
        if !self.reported.is_empty() {
            problems.retain(|problem| !problem.path.ancestors().any(|p| self.reported.contains(&p)));
        }
        for mut problem in beyond_room::explain(problems, scene, &self.missing) {
            let (at, value) = json::locate(root, &problem.path);
            if let (Some(value), Some(found)) = (value, &mut problem.found) {
                *found = json::describe(value, self.text);
            }
            self.add(at, problem);
        }
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

    /// The nearest known key, or the object to which the key belongs.
    fn hint(&mut self, written: &str, known: &[&'static str], what: &str) -> String {
        self.suggestions += 1;
        if self.suggestions > MAX_SUGGESTIONS {
            return String::new();
        }
        if what == "an object" && json::canonical(written, &self.material_keys).is_some() {
            return "; it is a material parameter: write it in \"material\"".to_owned();
        }
        let others = keys::OTHER_WORDS.iter().copied().filter(|(_, key)| known.contains(key));
        let parameters = self.registry.material_parameters();
        let labels = parameters.flat_map(|p| [(p.label, p.name), (p.symbol, p.name)]);
        let labels = labels.filter(|_| what == "a material");
        json::nearest_key(written, known, others.chain(labels), what)
    }
}
