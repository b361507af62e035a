//! Modules depend on each other in one direction: each uses only those that `lib.rs` lists above it.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

/// The modules that a module must not use although they are above it.
const BLIND: [(&str, &[&str]); 3] =
    [("panel", &["render"]), ("study", &["panel", "window"]), ("reference", &["render"])];

/// The files of a module by their paths from `src`, without comments and test code.
pub type Files = BTreeMap<String, String>;

fn files(folder: &Path, at: &str, to: &mut Files) {
    for entry in fs::read_dir(folder).expect("readable") {
        let entry = entry.expect("readable");
        let name = entry.file_name().into_string().expect("Unicode");
        let path = format!("{at}{name}");
        if entry.path().is_dir() {
            files(&entry.path(), &format!("{path}/"), to);
        } else if name.ends_with(".rs") && name != "tests.rs" {
            let text = fs::read_to_string(entry.path()).expect("readable");
            let code = text.split("\n#[cfg(test)]\nmod tests").next().unwrap_or_default();
            let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
            to.insert(path, lines.collect::<Vec<_>>().join("\n"));
        }
    }
}

/// The words and signs of a text; `::` counts as one.
pub fn tokens(text: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let word = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let end = if rest.starts_with("::") { 2 } else { word.max(first.len_utf8()) };
        tokens.push(&rest[..end]);
        rest = rest[end..].trim_start();
    }
    tokens
}

/// The paths in a text, each as its segments: those of `use` with their groups expanded, and those within
/// code.
pub fn paths(text: &str) -> Vec<Vec<&str>> {
    let tokens = tokens(text);
    let (mut found, mut rest, mut before) = (Vec::new(), tokens.as_slice(), "");
    while let [first, tail @ ..] = rest {
        let path = before == "use" || tail.first() == Some(&"::") && !["::", "$"].contains(&before);
        before = first;
        rest = if path { unfold(rest, &[], &mut found) } else { tail };
    }
    found
}

/// Expands the path at the start of these tokens, with a given prefix; returns the tokens after it.
fn unfold<'t, 'a>(
    mut rest: &'t [&'a str],
    names: &[&'a str],
    found: &mut Vec<Vec<&'a str>>,
) -> &'t [&'a str] {
    let mut path = names.to_vec();
    while let [name, tail @ ..] = rest {
        rest = tail;
        if *name == "{" {
            while let [next, tail @ ..] = rest {
                rest = match *next {
                    "}" => return tail,
                    "," => tail,
                    _ => unfold(rest, &path, found),
                };
            }
        }
        path.push(name);
        match rest {
            ["::", next, ..] if *next == "{" || next.starts_with(char::is_alphabetic) => rest = &rest[1..],
            _ => break,
        }
    }
    found.push(path);
    rest.strip_prefix(&["as"]).map_or(rest, |rest| &rest[1..])
}

/// The module of a file.
pub fn module(path: &str) -> &str {
    path.split('/').next().unwrap_or_default().trim_end_matches(".rs")
}

/// The modules listed in `lib.rs`, in order.
fn listed(lib: &str) -> Vec<&str> {
    lib.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect()
}

/// The dependencies in the wrong direction.
fn wrong(all: &Files) -> Vec<String> {
    let order = listed(&all["lib.rs"]);
    let place = |name: &str| order.iter().position(|m| *m == name);
    let mut wrong = Vec::new();
    for (path, text) in all {
        let from = module(path);
        let Some(here) = place(from) else { continue };
        let uses: BTreeSet<_> = paths(text).iter().filter(|p| p[0] == "crate").map(|p| p[1]).collect();
        for to in uses {
            let blind = BLIND.iter().any(|(m, unseen)| *m == from && unseen.contains(&to));
            // Macros are at the root.
            if blind || place(to).is_some_and(|there| there > here) {
                wrong.push(format!("{path} uses {to}"));
            }
        }
    }
    wrong
}

pub fn source() -> Files {
    let mut all = Files::new();
    files(Path::new("src"), "", &mut all);
    all
}

#[test]
fn every_module_uses_only_modules_that_stand_above_it() {
    let all = source();
    assert!(listed(&all["lib.rs"]).len() > 15);
    assert_eq!(wrong(&all), Vec::<String>::new());
}

#[test]
fn a_wrong_arrow_is_found() {
    let with = |path: &str, text: &str| {
        // Of the source only the list of modules, so that a wrong arrow in it is reported by the test above alone.
        let mut all = source();
        all.retain(|path, _| path == "lib.rs");
        all.insert(path.to_owned(), text.to_owned());
        wrong(&all)
    };
    assert_eq!(with("optics/x.rs", "use crate::scene::Scene;"), ["optics/x.rs uses scene"]);
    let nested = "use crate::{\n    optics::{colour::Encoding, Frame},\n    render::view::View,\n};";
    assert_eq!(with("panel/x.rs", nested), ["panel/x.rs uses render"]);
    assert_eq!(with("light/x.rs", "fn f() -> crate::registry::Registry {}"), ["light/x.rs uses registry"]);
    assert!(with("cli/x.rs", nested).is_empty());
}

#[test]
fn every_file_belongs_to_a_module_that_is_listed() {
    let all = source();
    let order = listed(&all["lib.rs"]);
    for path in all.keys().filter(|path| !["lib.rs", "main.rs"].contains(&path.as_str())) {
        assert!(order.contains(&module(path)), "{path} is under no `pub mod` of lib.rs");
    }
}
