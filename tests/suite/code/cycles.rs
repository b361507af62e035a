//! Files of one module depend on each other in one direction. A file and the `mod.rs` of its folder are one
//! unit: `impl Session` may be next to the file that declares the session.

use std::collections::{BTreeMap, BTreeSet};

use crate::code::modules::{Files, module, paths, source, tokens};

/// The words before the name of what a file defines.
const DEFINES: [&str; 8] = ["fn", "struct", "enum", "trait", "type", "const", "static", "union"];

/// The segments of a path, from the root or from a file.
type Names<'a> = &'a [&'a str];

/// A source: its words, and the paths in it.
struct Text<'a> {
    tokens: Vec<&'a str>,
    paths: Vec<Vec<&'a str>>,
}

/// The files by the names of their modules: `["panel", "state"]` for `panel/state/mod.rs`.
struct Sources<'a>(BTreeMap<Vec<&'a str>, (&'a str, Text<'a>)>);

impl<'a> Sources<'a> {
    fn of(all: &'a Files) -> Self {
        let text = |text: &'a str| Text { tokens: tokens(text), paths: paths(text) };
        let names = |path: &'a str| {
            let path = path.trim_end_matches(".rs");
            path.strip_suffix("/mod").unwrap_or(path).split('/').collect()
        };
        Self(all.iter().map(|(path, code)| (names(path), (path.as_str(), text(code)))).collect())
    }

    /// The module to which a path in a file of the module `at` leads, and the rest of the path.
    fn walk<'p>(&self, at: &[&'p str], path: Names<'p>) -> Option<(Vec<&'p str>, Names<'p>)> {
        let mut here = if path[0] == "crate" { Vec::new() } else { at.to_vec() };
        let mut rest = path;
        while let [name, tail @ ..] = rest {
            match *name {
                "crate" | "self" => {}
                "super" => _ = here.pop(),
                name => {
                    here.push(name);
                    if !self.0.contains_key(&here) {
                        here.pop();
                        break;
                    }
                }
            }
            rest = tail;
        }
        // An unresolved path belongs to another crate, or begins with a type.
        (rest.len() < path.len() && self.0.contains_key(&here)).then_some((here, rest))
    }

    /// The file that defines the target of a path in a file of the module `at`, through any number of
    /// re-exports.
    fn target<'p>(&'p self, at: Names<'p>, path: Names<'p>) -> Option<&'a str> {
        let (mut here, mut rest) = self.walk(at, path)?;
        loop {
            let (file, text) = &self.0[&here];
            let defines = |name| text.tokens.windows(2).any(|w| DEFINES.contains(&w[0]) && w[1] == name);
            let Some(name) = rest.first().filter(|name| !defines(**name)) else { return Some(file) };
            let handed = text.paths.iter().filter(|path| path.last() == Some(name));
            let further =
                handed.filter_map(|path| self.walk(&here, path)).find(|(module, _)| *module != here);
            let Some(further) = further else { return Some(file) };
            (here, rest) = further;
        }
    }
}

/// The files of a module, each with those that it uses and a path that does; files without any are left out.
fn edges<'a>(all: &'a Sources, within: &str) -> BTreeMap<&'a str, BTreeMap<&'a str, String>> {
    let mut edges = BTreeMap::<_, BTreeMap<_, _>>::new();
    for (at, (from, text)) in all.0.iter().filter(|(at, _)| at[0] == within) {
        for path in &text.paths {
            let Some(to) = all.target(at, path).filter(|to| module(to) == within) else { continue };
            let parent = to.strip_suffix("mod.rs").is_some_and(|folder| from.starts_with(folder));
            if to != *from && !parent {
                edges.entry(*from).or_default().insert(to, path.join("::"));
            }
        }
    }
    edges
}

/// A cycle of files within a module, and the path that closes it.
fn cycle(all: &Sources, within: &str) -> Option<String> {
    let mut edges = edges(all, within);
    // What uses nothing that is left is in no cycle.
    loop {
        let left: Vec<_> = edges.keys().copied().collect();
        edges.retain(|_, uses| {
            uses.retain(|to, _| left.contains(to));
            !uses.is_empty()
        });
        if edges.len() == left.len() {
            break;
        }
    }
    // Any way onwards returns.
    let mut way = vec![*edges.keys().next()?];
    loop {
        let last = way[way.len() - 1];
        let (next, path) = edges[last].first_key_value()?;
        if let Some(begin) = way.iter().position(|file| file == next) {
            return Some(format!("{} → {next}, since {last} uses {path}", way[begin..].join(" → ")));
        }
        way.push(next);
    }
}

#[test]
fn files_of_a_module_form_no_cycle() {
    let all = source();
    let modules: BTreeSet<_> = all.keys().map(|path| module(path)).collect();
    let all = Sources::of(&all);
    let users: usize = modules.iter().map(|module| edges(&all, module).len()).sum();
    assert!(modules.len() > 30 && users > 400, "{} {users}", modules.len());
    for module in modules {
        assert_eq!(cycle(&all, module), None);
    }
}

#[test]
fn a_cycle_of_files_is_found_however_its_names_are_handed_on() {
    let files = |files: &[(&str, &str)]| -> Files {
        files.iter().map(|(path, code)| ((*path).to_owned(), (*code).to_owned())).collect()
    };
    let session = "use super::{Place, theme::Palette};\npub use note::Note;\npub struct Session(Note);";
    let mut all = files(&[
        (
            "panel/mod.rs",
            "pub mod state;\npub mod top;\nuse state::Session;\nuse top::Top;\npub enum Place {}",
        ),
        ("panel/state/mod.rs", session),
        ("panel/state/note.rs", "use super::Session;\npub struct Note;\nimpl Session {}"),
        ("panel/theme.rs", "use std::state::Session;\npub struct Palette;"),
        ("panel/top.rs", "use super::{Place, state};\nfn f(_: state::Note) {}\npub struct Top;"),
    ]);
    assert_eq!(cycle(&Sources::of(&all), "panel"), None, "a file and its folder are one");
    all.extend(files(&[(
        "panel/theme.rs",
        "use crate::{a::B, panel::{x, state::{Note as N}}};\npub struct Palette;",
    )]));
    assert_eq!(cycle(&Sources::of(&all), "panel"), None, "a note knows no palette");
    all.extend(files(&[(
        "panel/state/note.rs",
        "pub struct Note;\nfn f() {\n    super::super::theme::Palette::here();\n}",
    )]));
    assert_eq!(
        cycle(&Sources::of(&all), "panel").as_deref(),
        Some(
            "panel/state/note.rs → panel/theme.rs → panel/state/note.rs, since panel/theme.rs uses \
             crate::panel::state::Note"
        )
    );
    assert_eq!(cycle(&Sources::of(&all), "render"), None);
}
