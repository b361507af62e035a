//! The feature `window` is confined behind boundaries: a few files declare the modules that belong to it, and
//! everything else is built without it.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use crate::{
    code::modules::{Files, paths, source},
    helpers::support::root,
};

/// The feature, as attributes name it.
const FEATURE: &str = "feature = \"window\"";
/// The files that may name it.
const BOUNDARIES: [&str; 7] = [
    "lib.rs",
    "prelude.rs",
    "program.rs",
    "testing/mod.rs",
    "cli/engine/mod.rs",
    "platform/browser/mod.rs",
    "platform/desktop/mod.rs",
];
/// The only lines that name it in another way than before a module or an import: what serves the window alone is not
/// dead, and messages say what is missing.
const OTHERS: [&str; 2] = [
    "#![cfg_attr(not(feature = \"window\"), allow(dead_code, unused_imports))]",
    "pub const HAS_WINDOW: bool = cfg!(feature = \"window\");",
];

/// All files of the sources, whole.
fn whole() -> Files {
    fn read(folder: &Path, at: &str, to: &mut Files) {
        for entry in fs::read_dir(folder).expect("readable") {
            let path = entry.expect("readable").path();
            let name = path.file_name().expect("named").to_string_lossy().into_owned();
            if path.is_dir() {
                read(&path, &format!("{at}{name}/"), to);
            } else if name.ends_with(".rs") {
                to.insert(format!("{at}{name}"), fs::read_to_string(&path).expect("text"));
            }
        }
    }
    let mut all = Files::new();
    read(&root().join("src"), "", &mut all);
    all
}

/// True for a line that declares a module or begins an import.
fn is_boundary(line: &str) -> bool {
    let line = line.strip_prefix("pub(super) ").or(line.strip_prefix("pub ")).unwrap_or(line);
    line.starts_with("mod ") || line.starts_with("use ")
}

/// The lines that name the feature where it must not stand.
fn stray(all: &Files) -> Vec<String> {
    let mut stray = Vec::new();
    for (path, text) in all {
        let lines: Vec<_> = text.lines().collect();
        for (i, line) in lines.iter().enumerate().filter(|(_, line)| line.contains(FEATURE)) {
            let next = lines[i + 1..].iter().find(|next| !next.starts_with("#[")).unwrap_or(&"");
            let before = line.starts_with("#[cfg(") && is_boundary(next) || OTHERS.contains(line);
            if !(BOUNDARIES.contains(&path.as_str()) && before) {
                stray.push(format!("{path}:{}: {line}", i + 1));
            }
        }
    }
    stray
}

/// The modules that belong to the feature, as the beginnings of their files' paths.
fn of_window(all: &Files) -> Vec<String> {
    let mut found = Vec::new();
    for (path, text) in all {
        let folder = path.rsplit_once('/').map_or(String::new(), |(folder, _)| format!("{folder}/"));
        let lines: Vec<_> = text.lines().collect();
        for pair in lines.windows(2).filter(|pair| pair[0] == format!("#[cfg({FEATURE})]")) {
            let name = pair[1].trim_start_matches("pub ").strip_prefix("mod ");
            found.extend(name.map(|name| format!("{folder}{}", name.trim_end_matches(';'))));
        }
    }
    found
}

/// The crates that only the feature brings, as code names them.
fn crates(manifest: &str) -> BTreeSet<String> {
    let (_, list) = manifest.split_once("\nwindow = [").expect("the feature");
    let list = list.split(']').next().unwrap_or_default();
    list.split('"').filter_map(|part| part.strip_prefix("dep:")).map(|name| name.replace('-', "_")).collect()
}

/// The uses of the feature's crates and modules outside its modules.
fn leaks(all: &Files, own: &[String], crates: &BTreeSet<String>) -> Vec<String> {
    let is = |path: &str, module: &String| {
        path.strip_prefix(module.as_str()).is_some_and(|rest| rest.starts_with(['/', '.']))
    };
    let modules: BTreeSet<_> = own.iter().filter(|module| !module.contains('/')).cloned().collect();
    let mut leaks = Vec::new();
    for (path, text) in all.iter().filter(|(path, _)| !own.iter().any(|module| is(path, module))) {
        if BOUNDARIES.contains(&path.as_str()) {
            continue;
        }
        for used in paths(text) {
            let names = |names: &BTreeSet<String>, i: usize| used.get(i).is_some_and(|n| names.contains(*n));
            // Modules of files may be called like a crate.
            let own_module = all.contains_key(&format!(
                "{}/{}/mod.rs",
                path.rsplit_once('/').unwrap_or_default().0,
                used[0]
            ));
            if names(crates, 0) && used.len() > 1 && !own_module || used[0] == "crate" && names(&modules, 1) {
                leaks.push(format!("{path}: {}", used.join("::")));
            }
        }
    }
    leaks
}

fn manifest() -> String {
    fs::read_to_string::<PathBuf>(root().join("Cargo.toml")).expect("text")
}

#[test]
fn the_feature_stands_before_modules_and_imports_of_few_files_alone() {
    let all = whole();
    assert_eq!(stray(&all), Vec::<String>::new());
    let all_named = BOUNDARIES.iter().all(|path| all[*path].contains(FEATURE));
    assert!(all_named, "a boundary that is none");
    // The wrong twins.
    for (path, text) in [
        ("panel/x.rs", "#[cfg(feature = \"window\")]\nmod y;\n"),
        ("cli/mod.rs", "fn f() {\n    if cfg!(feature = \"window\") {}\n}\n"),
        ("lib.rs", "#[cfg(feature = \"window\")]\nfn f() {}\n"),
        ("lib.rs", "#[cfg(not(feature = \"window\"))]\npub struct Window;\n"),
    ] {
        let mut twin = whole();
        twin.insert(path.to_owned(), text.to_owned());
        assert_eq!(stray(&twin).len(), 1, "{path} {text}");
    }
}

#[test]
fn nothing_outside_uses_what_the_feature_brings() {
    let (all, crates) = (source(), crates(&manifest()));
    let own = of_window(&all);
    let expected = [
        "cli/engine/pictures",
        "cli/engine/present",
        "cli/engine/window",
        "panel",
        "platform/browser/window",
        "platform/desktop/window",
        "render",
        "testing/gpu",
        "window",
    ];
    let mut sorted = own.clone();
    sorted.sort();
    assert_eq!(sorted, expected);
    assert!(["bevy", "bevy_egui", "wgpu", "arboard"].iter().all(|name| crates.contains(*name)), "{crates:?}");
    assert_eq!(leaks(&all, &own, &crates), Vec::<String>::new());
    // The wrong twins.
    for (path, text) in [
        ("scene/x.rs", "use bevy::prelude::*;"),
        ("curves/x.rs", "fn f() { wgpu::Instance::new() }"),
        ("cli/x.rs", "use crate::{scene::Scene, render::view::View};"),
        ("cli/engine/x.rs", "use crate::window::view;"),
    ] {
        let mut twin = source();
        twin.insert(path.to_owned(), text.to_owned());
        assert_eq!(leaks(&twin, &own, &crates).len(), 1, "{path} {text}");
    }
}
