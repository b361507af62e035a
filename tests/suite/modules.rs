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
type Files = BTreeMap<String, String>;

fn files(folder: &Path, at: &str, to: &mut Files) {
    for entry in fs::read_dir(folder).expect("readable") {
        let entry = entry.expect("readable");
        let name = entry.file_name().into_string().expect("Unicode");
        let path = format!("{at}{name}");
        if entry.path().is_dir() {
            files(&entry.path(), &format!("{path}/"), to);
        } else if name.ends_with(".rs") && name != "tests.rs" {
            let text = fs::read_to_string(entry.path()).expect("readable");
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
            to.insert(path, lines.collect::<Vec<_>>().join("\n"));
        }
    }
}

/// The words that follow `prefix` in a text, those of a group in braces each.
fn heads(text: &str, prefix: &str) -> BTreeSet<String> {
    let word = |text: &str| -> String {
        text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let mut found = BTreeSet::new();
    for (at, _) in text.match_indices(prefix) {
        if text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '$') {
            continue;
        }
        let rest = &text[at + prefix.len()..];
        let Some(group) = rest.strip_prefix('{') else {
            found.insert(word(rest));
            continue;
        };
        let mut depth = 0;
        let mut begins = true;
        for (i, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => begins = true,
                c if begins && !c.is_whitespace() => {
                    found.insert(word(&group[i..]));
                    begins = false;
                }
                _ => {}
            }
        }
    }
    found.remove("");
    found
}

/// The module of a file.
fn module(path: &str) -> &str {
    path.split('/').next().unwrap_or_default().trim_end_matches(".rs")
}

/// The modules that `lib.rs` lists, in its order.
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
        for to in heads(text, "crate::") {
            let blind = BLIND.iter().any(|(m, unseen)| *m == from && unseen.contains(&to.as_str()));
            // Macros are at the root.
            if blind || place(&to).is_some_and(|there| there > here) {
                wrong.push(format!("{path} uses {to}"));
            }
        }
    }
    wrong
}

fn source() -> Files {
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
        let mut all = source();
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
        assert!(order.contains(&module(path)), "{path}");
    }
}
