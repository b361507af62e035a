//! Functions of the panels and of the window are short, and flat.

use std::collections::BTreeMap;

use crate::code::modules::{Files, module, source};

/// The most lines of a function, without blank lines and comments.
const LINES: usize = 60;
/// The most blocks within each other.
const DEPTH: usize = 4;
/// The modules whose functions are measured.
const MODULES: [&str; 2] = ["panel", "window"];

/// The most lines, and the most blocks within each other, of the functions with one name in one file.
type Sizes<'a> = BTreeMap<(&'a str, &'a str), (usize, usize)>;

/// The name of the function that a line begins.
fn begins(line: &str) -> Option<&str> {
    let (before, after) = line.split_once("fn ")?;
    let word =
        |word: &str| word.starts_with("pub") || word.ends_with(')') || ["async", "const"].contains(&word);
    before.split_whitespace().all(word).then(|| after.split(['(', '<']).next().unwrap_or_default())
}

/// Sizes of the functions of a file.
fn measure<'a>(path: &'a str, text: &'a str, to: &mut Sizes<'a>) {
    let lines: Vec<_> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    for (i, first) in lines.iter().enumerate() {
        let Some(name) = begins(first) else { continue };
        let end = format!("{}}}", &first[..first.len() - first.trim_start().len()]);
        let one_line = first.ends_with('}') || first.ends_with(';');
        let length =
            if one_line { 0 } else { lines[i..].iter().take_while(|l| !l.starts_with(&end)).count() };
        let (mut open, mut deepest) = (0_usize, 0);
        for line in &lines[i..i + length] {
            open -= usize::from(line.trim_start().starts_with('}')).min(open);
            open += usize::from(line.ends_with('{'));
            deepest = deepest.max(open);
        }
        let size = to.entry((path, name)).or_default();
        // The body itself is no depth.
        *size = (size.0.max(length + 1), size.1.max(deepest.saturating_sub(1)));
    }
}

/// The functions that are too large.
fn wrong(all: &Files) -> Vec<String> {
    let mut sizes = Sizes::new();
    for (path, text) in all.iter().filter(|(path, _)| MODULES.contains(&module(path))) {
        measure(path, text, &mut sizes);
    }
    let large = sizes.iter().filter(|(_, (lines, depth))| *lines > LINES || *depth > DEPTH);
    let text = |((path, name), (lines, depth)): (&(&str, &str), &(usize, usize))| {
        format!("{path}: {name} has {lines} lines and a depth of {depth}")
    };
    large.map(text).collect()
}

#[test]
fn functions_of_the_panels_and_of_the_window_are_short_and_flat() {
    let wrong = wrong(&source());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_long_function_and_a_deep_one_are_found() {
    let with = |body: String| {
        let text = format!("impl X {{\n    pub(super) fn f(&self) {{\n{body}    }}\n}}\n");
        wrong(&[("panel/x.rs".to_owned(), text)].into())
    };
    let long = |lines: usize| "        go();\n\n".repeat(lines - 2);
    let deep = |depth: usize| format!("{}{}", "if x {\n".repeat(depth), "}\n".repeat(depth));
    assert!(with(long(60)).is_empty() && with(deep(4)).is_empty());
    assert_eq!(with(long(61)), ["panel/x.rs: f has 61 lines and a depth of 0"]);
    assert_eq!(with(deep(5)), ["panel/x.rs: f has 12 lines and a depth of 5"]);
}
