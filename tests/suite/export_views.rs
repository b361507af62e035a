//! Exports of scenes with views: which view they hold, and how another is chosen.

use std::fs;

use serde_json::{Value, json};

use crate::support::{lcm_in, root};

/// A scene with Lambert's model in view A and Phong's in view B.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let text = fs::read_to_string(root().join("scenes/default.json")).expect("readable");
    let mut scene: Value = serde_json::from_str(&text).expect("JSON");
    scene["reflection_model"] = json!("lambert");
    scene["variants"] = json!([{ "name": "half", "reflection_model": "phong" }]);
    fs::write(folder.path().join("two.json"), scene.to_string()).expect("written");
    folder
}

#[test]
fn an_export_says_which_view_it_holds_and_another_can_be_chosen() {
    let folder = folder();
    let at = folder.path();
    for form in ["html", "bevy", "wgsl"] {
        let mut made = Vec::new();
        for (view, said) in [
            (&[][..], "it holds view A of the scene, not B (\"half\"); --view chooses another"),
            (&["--view", "a"], "it holds view A of the scene, not B (\"half\"); --view chooses another"),
            (&["--view", "B"], "it holds view B (\"half\") of the scene, not A; --view chooses another"),
            (&["--view", "half"], "it holds view B (\"half\") of the scene, not A; --view chooses another"),
        ] {
            let name = format!("{form}{}", made.len());
            let arguments = [&["export", "two.json", "--as", form, "-o", &name], view].concat();
            let run = lcm_in(at, &arguments, b"");
            assert_eq!(run.status, Some(0), "{form}: {}", run.err);
            assert!(run.err.lines().any(|line| line == said), "{form}: {}", run.err);
            made.push(content(&at.join(&name)));
        }
        // The one that is not named is view A, and B differs.
        assert!(made[0] == made[1] && made[2] == made[3] && made[0] != made[2], "{form}");
    }
    let page = fs::read_to_string(at.join("html2")).expect("a page");
    assert!(page.contains("view B (&quot;half&quot;)"), "the page has the view in its title");
}

/// All that an export wrote.
fn content(place: &std::path::Path) -> Vec<u8> {
    if place.is_file() {
        return fs::read(place).expect("readable");
    }
    let mut paths: Vec<_> =
        fs::read_dir(place).expect("a folder").map(|e| e.expect("an entry").path()).collect();
    paths.sort();
    paths.iter().flat_map(|path| content(path)).collect()
}

#[test]
fn a_view_that_is_not_there_is_named_with_those_that_are() {
    let folder = folder();
    let run = lcm_in(folder.path(), &["export", "two.json", "--as", "html", "--view", "halb"], b"");
    assert_eq!(run.status, Some(1));
    assert!(run.err.contains("there is no view \"halb\"; it must be A or B (half)"), "{}", run.err);
    assert!(!folder.path().join("exports").exists());
}
