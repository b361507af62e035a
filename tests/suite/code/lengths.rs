//! Functions of the panels and of the window are short, and flat.

use std::collections::BTreeMap;

use crate::code::modules::{Files, module, source};

/// The most lines of a function, without blank lines and comments.
const LINES: usize = 60;
/// The most blocks within each other.
const DEPTH: usize = 4;
/// The modules whose functions are measured.
const MODULES: [&str; 2] = ["panel", "window"];

/// Functions that are longer or deeper still: file, name, and the lines and depth that they may have.
const EXCEPTIONS: [(&str, &str, usize, usize); 43] = [
    ("panel/chooser.rs", "list", 93, 4),
    ("panel/compare.rs", "header", 97, 4),
    ("panel/compare/bar.rs", "bar", 85, 4),
    ("panel/compare/wipe.rs", "wipe", 64, 4),
    ("panel/explain/beside.rs", "beside", 60, 5),
    ("panel/explain/lights.rs", "lights", 65, 4),
    ("panel/explain/mod.rs", "columns", 67, 4),
    ("panel/explain/probe.rs", "update", 72, 4),
    ("panel/export.rs", "copy_menu", 60, 5),
    ("panel/help.rs", "key_list", 60, 5),
    ("panel/inspector/light.rs", "light", 85, 5),
    ("panel/inspector/material.rs", "material", 62, 4),
    ("panel/inspector/measured.rs", "measured", 72, 4),
    ("panel/inspector/observer.rs", "observer", 61, 4),
    ("panel/inspector/room.rs", "room", 97, 4),
    ("panel/inspector/variant.rs", "variant", 64, 4),
    ("panel/knob/choice.rs", "choice_with_help", 60, 5),
    ("panel/knob/colour.rs", "colour_knob", 62, 4),
    ("panel/knob/field.rs", "field", 72, 5),
    ("panel/knob/slider.rs", "slider", 87, 4),
    ("panel/labels.rs", "labels", 70, 4),
    ("panel/lesson/task.rs", "predict", 60, 5),
    ("panel/marks/edge.rs", "arrows", 66, 4),
    ("panel/marks/mod.rs", "lamp", 65, 4),
    ("panel/menu.rs", "walk", 63, 4),
    ("panel/messages.rs", "show", 60, 6),
    ("panel/mod.rs", "show", 188, 4),
    ("panel/model_override.rs", "control", 74, 4),
    ("panel/picture.rs", "stale", 76, 4),
    ("panel/picture.rs", "views", 74, 4),
    ("panel/plots/handle.rs", "show", 86, 4),
    ("panel/plots/legend.rs", "row", 60, 5),
    ("panel/plots/legend.rs", "style", 62, 4),
    ("panel/presentation/mod.rs", "laid_out", 62, 4),
    ("panel/question.rs", "show", 60, 5),
    ("panel/shader/files.rs", "files", 60, 5),
    ("panel/sides.rs", "bottom", 69, 4),
    ("panel/state/action.rs", "carry_out", 133, 4),
    ("panel/state/matching.rs", "matched", 70, 4),
    ("panel/welcome.rs", "menu", 60, 5),
    ("window/difference.rs", "compare", 78, 4),
    ("window/effects.rs", "carry_out", 109, 4),
    ("window/pictures.rs", "take", 64, 4),
];

/// The most lines, and the most blocks within each other, of the functions with one name in one file.
type Sizes<'a> = BTreeMap<(&'a str, &'a str), (usize, usize)>;

/// The name of the function that a line begins.
fn begins(line: &str) -> Option<&str> {
    let (before, after) = line.split_once("fn ")?;
    let word = |word: &str| word.starts_with("pub") || ["async", "const"].contains(&word);
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

/// What is too large, beside the exceptions, and the exceptions that are not needed.
fn wrong(all: &Files, exceptions: &[(&str, &str, usize, usize)]) -> Vec<String> {
    let mut sizes = Sizes::new();
    for (path, text) in all.iter().filter(|(path, _)| MODULES.contains(&module(path))) {
        measure(path, text, &mut sizes);
    }
    let mut wrong = Vec::new();
    for ((path, name), (lines, depth)) in &sizes {
        let exception = exceptions.iter().find(|(file, function, ..)| (file, function) == (path, name));
        let (most, deepest) = exception.map_or((LINES, DEPTH), |(_, _, lines, depth)| (*lines, *depth));
        if *lines > most || *depth > deepest {
            wrong.push(format!("{path}: {name} has {lines} lines and a depth of {depth}"));
        }
    }
    for (path, name, ..) in exceptions {
        if sizes.get(&(*path, *name)).is_none_or(|(lines, depth)| *lines <= LINES && *depth <= DEPTH) {
            wrong.push(format!("{path}: {name} needs no exception"));
        }
    }
    wrong
}

#[test]
fn functions_of_the_panels_and_of_the_window_are_short_and_flat() {
    let wrong = wrong(&source(), &EXCEPTIONS);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_long_function_a_deep_one_and_an_exception_without_need_are_found() {
    let with = |body: String, exceptions: &[(&str, &str, usize, usize)]| {
        let text = format!("impl X {{\n    pub(super) fn f(&self) {{\n{body}    }}\n}}\n");
        wrong(&[("panel/x.rs".to_owned(), text)].into(), exceptions)
    };
    let long = |lines: usize| "        go();\n\n".repeat(lines - 2);
    let deep = |depth: usize| format!("{}{}", "if x {\n".repeat(depth), "}\n".repeat(depth));
    assert!(with(long(60), &[]).is_empty() && with(deep(4), &[]).is_empty());
    assert_eq!(with(long(61), &[]), ["panel/x.rs: f has 61 lines and a depth of 0"]);
    assert_eq!(with(deep(5), &[]), ["panel/x.rs: f has 12 lines and a depth of 5"]);
    assert!(with(long(61), &[("panel/x.rs", "f", 61, 0)]).is_empty());
    assert_eq!(
        with(long(62), &[("panel/x.rs", "f", 61, 0)]),
        ["panel/x.rs: f has 62 lines and a depth of 0"]
    );
    assert_eq!(with(long(60), &[("panel/x.rs", "f", 61, 0)]), ["panel/x.rs: f needs no exception"]);
    assert_eq!(with(long(60), &[("panel/x.rs", "g", 61, 0)]), ["panel/x.rs: g needs no exception"]);
}
