//! The manual in the Help menu: complete without the folder of the program.

use std::{collections::BTreeSet, fs, path::Path};

use bevy_egui::egui::{Key, PointerButton};
use lights_camera_models::{
    panel::{
        manual::{PAGES, page},
        state::{Effect, Session},
    },
    program,
    window::manual::{folder, write},
};

use crate::{helpers::support::root, window::panels::Bench};

/// Targets of internal links that are missing from a page: empty if the page is complete.
fn dead_links(page: &str) -> BTreeSet<String> {
    let attributes = |name: &str| -> BTreeSet<String> {
        page.split(&format!("{name}=\""))
            .skip(1)
            .filter_map(|rest| Some(rest.split_once('"')?.0.to_owned()))
            .collect()
    };
    let ids: BTreeSet<_> = attributes("id").into_iter().map(|id| format!("#{id}")).collect();
    attributes("href").into_iter().filter(|to| to.starts_with('#') && !ids.contains(to)).collect()
}

#[test]
fn the_manual_has_every_document_and_no_dead_link() {
    let page = page();
    for folder in ["", "extending/"] {
        for file in fs::read_dir(root().join("docs").join(folder)).expect("a folder").flatten() {
            let name = format!("{folder}{}", file.file_name().to_string_lossy());
            let Some(id) = name.strip_suffix(".md").filter(|id| *id != "SUMMARY") else { continue };
            assert!(PAGES.iter().any(|(known, _)| *known == id), "{name} is not in the manual");
            assert!(page.contains(&format!("<section id=\"{id}\">")), "{name}");
        }
    }
    assert_eq!(dead_links(&page), Default::default());
    assert_eq!(dead_links("<a href=\"#x\"> <b id=\"y\"> <a href=\"#y\">"), ["#x".to_owned()].into());
    assert!(page.len() > 150_000 && page.contains("<table>") && page.starts_with("<!DOCTYPE html>"));
    for absent in ["<!--", "<img", "<script", ".md\"", "href=\"..", "src=\""] {
        assert!(!page.contains(absent), "{absent}");
    }
}

#[test]
fn help_writes_the_manual_where_a_browser_finds_it() {
    let mut bench = Bench::new(Session::default());
    bench.click("Help");
    // There is space for a key after the word.
    let entry = bench.tree.iter().find(|seen| seen.label.trim() == "Manual").expect("an entry").rect;
    bench.click_at(entry.center(), PointerButton::Primary);
    assert_eq!(bench.effects, [Effect::OpenManual]);
    bench.key(Key::Escape, Default::default());
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("data");
    let file = write(&inner).expect("written");
    assert_eq!(fs::read_to_string(&file).expect("it is there"), page());
    // An older one is replaced, an identical one is left alone.
    fs::write(&file, "old").expect("written");
    assert_eq!(write(&inner), Ok(file.clone()));
    assert_eq!(fs::read_to_string(&file).expect("it is there"), page());
    // The obstacle is named.
    fs::write(folder.path().join("taken"), "").expect("written");
    let why = write(&folder.path().join("taken")).expect_err("a file is no folder");
    assert!(why.contains("taken"), "{why}");
}

#[test]
fn the_manual_of_another_program_has_its_name() {
    // The tests are such a program.
    let (page, name) = (page(), program::name());
    assert!(page.contains(&format!("<title>{name} – manual</title>")));
    assert!(!page.contains("Lights, Camera, Models!"));
    for command in ["render", "view", "check"] {
        assert!(page.contains(&format!("<code>{name} {command}")), "{command}");
        assert!(!page.contains(&format!("lcm {command} ")), "{command}");
    }
    assert!(!page.contains("<code>lcm</code>"));
    assert!(folder().ends_with(Path::new("programs").join(name)), "{:?}", folder());
}
