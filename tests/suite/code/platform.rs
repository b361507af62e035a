//! What a desktop and a browser do differently is in one module, whose two implementations have one interface.

use std::collections::BTreeSet;

use crate::code::modules::{Files, source};

/// Files that stand for what another crate has on a desktop: the compiler compares what is used of them.
const LIKE_OTHERS: [&str; 2] = ["/fs.rs", "/temporary.rs"];

/// The lines outside the module that ask for a browser.
fn asking(all: &Files) -> Vec<String> {
    let outside = all.iter().filter(|(path, _)| !path.starts_with("platform/"));
    let lines = outside.flat_map(|(path, text)| text.lines().map(move |line| (path, line)));
    lines
        .filter(|(_, line)| line.contains("wasm") || line.contains("target_arch"))
        .map(|(path, line)| format!("{path}: {}", line.trim()))
        .collect()
}

/// The public functions and constants of an implementation. Names of arguments may say that they are not used.
fn interface(all: &Files, folder: &str) -> BTreeSet<String> {
    let files = all.iter().filter(|(path, _)| path.starts_with(folder));
    let mut found = BTreeSet::new();
    for (_, text) in files.filter(|(path, _)| !LIKE_OTHERS.iter().any(|other| path.ends_with(other))) {
        for item in text.split("pub fn ").skip(1) {
            let head = item.split('{').next().unwrap_or_default();
            let head = head.replace("(_", "(").replace(", _", ", ").replace("mut ", "");
            found.insert(head.split_whitespace().collect::<Vec<_>>().join(" "));
        }
        let constants = text.split("pub const ").skip(1).filter_map(|item| item.split(" =").next());
        found.extend(constants.map(str::to_owned));
    }
    found
}

#[test]
fn one_module_alone_asks_where_the_program_runs() {
    let mut all = source();
    assert_eq!(asking(&all), Vec::<String>::new());
    // The wrong twin.
    all.insert("panel/x.rs".to_owned(), "#[cfg(target_arch = \"wasm32\")]\nmod y;".to_owned());
    assert_eq!(asking(&all).len(), 1);
}

#[test]
fn one_module_alone_asks_for_the_folders_of_the_operating_system() {
    // There are none in a browser, where what is kept in them would be lost.
    let asking = |all: &Files| {
        let of_system = all.iter().filter(|(_, text)| text.contains("ProjectDirs"));
        of_system.map(|(path, _)| path.clone()).collect::<Vec<_>>()
    };
    assert_eq!(asking(&source()), ["platform/desktop/mod.rs"]);
}

#[test]
fn a_desktop_and_a_browser_have_one_interface() {
    let all = source();
    let desktop = interface(&all, "platform/desktop/");
    assert!(desktop.len() > 25 && desktop.contains("SHARES_FILES: bool"), "{desktop:#?}");
    assert_eq!(desktop, interface(&all, "platform/browser/"));
    // The wrong twin.
    let mut twin = all;
    twin.insert("platform/browser/x.rs".to_owned(), "pub fn now(of: &Clock) -> SystemTime {".to_owned());
    assert_ne!(desktop, interface(&twin, "platform/browser/"));
}
