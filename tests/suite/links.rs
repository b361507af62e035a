//! The documents quote nothing that is not there: links, headings, commands, names and paths.

use std::{
    collections::{BTreeMap, BTreeSet, HashMap},
    fs,
    path::Path,
};

use crate::support::{lcm, root};

/// The documents by their paths from the root.
fn documents() -> BTreeMap<String, String> {
    let mut paths: Vec<_> =
        ["README.md", "CONTRIBUTING.md", "CREDITS.md", "CHANGELOG.md"].map(str::to_owned).into();
    for entry in fs::read_dir(root().join("docs")).expect("the folder docs is there") {
        let name = entry.expect("readable").file_name().into_string().expect("Unicode");
        paths.extend(name.ends_with(".md").then(|| format!("docs/{name}")));
    }
    let read = |path: String| {
        let text = fs::read_to_string(root().join(&path)).unwrap_or_else(|e| panic!("{path}: {e}"));
        (path, text)
    };
    paths.into_iter().map(read).collect()
}

/// The lines of a document with their numbers, and true for those within a fence.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str, bool)> {
    let mut fenced = false;
    text.lines().enumerate().map(move |(i, line)| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        (i + 1, line, fenced || fence)
    })
}

/// The anchors of the headings of a document, as forges and mdBook make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut seen = HashMap::<String, usize>::new();
    let headings = lines(text).filter(|(_, line, fenced)| !fenced && line.starts_with('#'));
    headings
        .map(|(_, line, _)| {
            let kept = line.trim_start_matches('#').trim().to_lowercase();
            let kept = kept.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
            let anchor = kept.collect::<String>().replace(' ', "-");
            let before = seen.entry(anchor.clone()).or_default();
            *before += 1;
            if *before == 1 { anchor } else { format!("{anchor}-{}", *before - 1) }
        })
        .collect()
}

/// A path without `.` and `..`.
fn plain(path: &str) -> String {
    let mut parts = Vec::new();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// The links within the repository that lead nowhere, or from the book to a document outside it.
fn lost_links(documents: &BTreeMap<String, String>) -> Vec<String> {
    let mut lost = Vec::new();
    for (document, text) in documents {
        let folder = document.rsplit_once('/').map_or("", |(folder, _)| folder);
        for (number, line, _) in lines(text).filter(|(.., fenced)| !fenced) {
            // A link may span lines up to its target, never within it.
            let targets = line.split("](").skip(1).filter_map(|rest| rest.split(')').next());
            for target in targets.filter(|t| !t.contains("://")) {
                let (file, heading) = target.split_once('#').map_or((target, None), |(f, h)| (f, Some(h)));
                let file =
                    if file.is_empty() { document.clone() } else { plain(&format!("{folder}/{file}")) };
                let in_book = |path: &str| path.starts_with("docs/");
                let leaves = in_book(document) && file.ends_with(".md") && !in_book(&file);
                let known =
                    heading.is_none_or(|h| documents.get(&file).is_some_and(|t| anchors(t).contains(h)));
                if leaves || !known || !root().join(&file).exists() {
                    lost.push(format!("{document}:{number}: {target}"));
                }
            }
        }
    }
    lost
}

#[test]
fn every_link_of_a_document_leads_to_a_file_and_a_heading_that_exist() {
    assert_eq!(lost_links(&documents()), Vec::<String>::new());
}

#[test]
fn a_lost_link_is_found() {
    let page = "# A\n\n## Of `two`, words\n\n[a](window.md#none) [b](window.md#of-two-words) [c](#a) [d](none.md)\n\
                [e](../README.md) [f](../src/lib.rs)\n```\n[g](none)\n```\n";
    let documents = ["docs/scenes.md", "docs/window.md"].map(|path| (path.to_owned(), page.to_owned()));
    let found = lost_links(&BTreeMap::from(documents));
    let expected = ["5: window.md#none", "5: none.md", "6: ../README.md"];
    let all = ["docs/scenes.md", "docs/window.md"].map(|path| expected.map(|e| format!("{path}:{e}")));
    assert_eq!(found, all.concat());
}

#[test]
fn the_summary_lists_every_page_once() {
    let documents = documents();
    let summary = &documents["docs/SUMMARY.md"];
    for page in documents.keys().filter_map(|path| path.strip_prefix("docs/")).filter(|p| *p != "SUMMARY.md")
    {
        assert_eq!(summary.matches(&format!("]({page})")).count(), 1, "{page}");
    }
}

/// The text of every file below a folder that people write.
fn source(folder: &Path, to: &mut String) {
    for entry in fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            source(&path, to);
        } else if path.extension().is_some_and(|e| e == "rs" || e == "wgsl") {
            *to += &fs::read_to_string(&path).expect("readable");
        }
    }
}

#[test]
fn every_name_and_path_that_a_page_quotes_is_there() {
    let mut text = String::new();
    for folder in ["src", "assets", "examples", "tests"] {
        source(&root().join(folder), &mut text);
    }
    let words = |text: &str| -> BTreeSet<String> {
        text.split(|c: char| !c.is_alphanumeric() && c != '_')
            .filter(|w| w.len() > 2)
            .map(str::to_owned)
            .collect()
    };
    let known = words(&text);
    let mut missing = Vec::new();
    for document in ["docs/architecture.md", "docs/extending.md", "CONTRIBUTING.md"] {
        let page = fs::read_to_string(root().join(document)).expect("there");
        for (number, line, _) in lines(&page).filter(|(.., fenced)| !fenced) {
            for span in line.split('`').skip(1).step_by(2) {
                // The file that a reader is to write is called x, or after its id.
                let to_write =
                    ["/x.", "toon.", "/ID", "_ID", "NAME", "renders/"].iter().any(|name| span.contains(name));
                let commands = ["cargo ", "lcm ", "mdbook ", "xvfb-run ", "LCM_UPDATE"];
                let is_command = commands.iter().any(|command| span.contains(command));
                if to_write || is_command || root().join(span).exists() {
                    continue;
                }
                if span.contains('/') && !span.contains(' ') || !words(span).is_subset(&known) {
                    missing.push(format!("{document}:{number}: {span}"));
                }
            }
        }
    }
    assert_eq!(missing, Vec::<String>::new());
}

#[test]
fn every_command_of_the_documents_is_one_of_the_program() {
    let mut helps = HashMap::new();
    let mut count = 0;
    for (document, text) in documents() {
        let blocks = lines(&text).filter(|(.., fenced)| *fenced).map(|(n, line, _)| (n, line));
        let spans = lines(&text)
            .filter(|(.., fenced)| !fenced)
            .flat_map(|(n, line, _)| line.split('`').skip(1).step_by(2).map(move |span| (n, span)));
        for (number, text) in blocks.chain(spans) {
            let command = text.split_once(" | ").map_or(text, |(_, after)| after);
            let command = command.split_once(" #").map_or(command, |(before, _)| before);
            let Some(rest) = command.strip_prefix("lcm ") else { continue };
            let words: Vec<_> = rest.split_whitespace().filter(|w| *w != "help").collect();
            let nested = |w: &str| matches!(w, "models" | "assets");
            let path: Vec<_> = match words.as_slice() {
                [a, b, ..] if nested(a) && !b.starts_with('-') => vec![*a, *b],
                [a, ..] if a.chars().all(|c| c.is_ascii_lowercase()) => vec![*a],
                _ => vec![],
            };
            let help = helps.entry(path.join(" ")).or_insert_with(|| {
                let run = lcm(&[path.as_slice(), &["--help"]].concat(), "");
                assert_eq!(run.status, Some(0), "{document}:{number}: {command}: {}", run.err);
                run.out
            });
            for flag in words.iter().filter(|w| w.starts_with('-') && w.len() > 1) {
                let name = flag.split('=').next().unwrap_or_default();
                let offers = help.split(|c: char| c.is_whitespace() || c == ',').any(|w| w == name);
                assert!(offers, "{document}:{number}: {command}: there is no {name}");
            }
            count += 1;
        }
    }
    assert!(count > 30, "{count}");
}
