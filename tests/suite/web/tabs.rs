//! Several tabs share the files, and the room for them ends.

use serde_json::Value;

use super::laboratory::{CONTROL, ENTER, F8, Laboratory, SIZE, copies, text};

const FILE: &str = "/Files/default-scene.json";

fn shading(scene: &str) -> Value {
    let scene: Value = serde_json::from_str(scene).expect("JSON");
    scene["shading_model"].clone()
}

/// Saves the scene to a new file.
fn save(lab: &Laboratory) {
    lab.press(&[CONTROL, 's']);
    lab.press(&[ENTER]);
    lab.wait_for_files(|files| files[FILE].is_string());
    lab.wait_for_title(|title| title.starts_with("default-scene –"));
}

#[test]
fn two_tabs_follow_each_other_and_neither_overwrites_the_other() {
    let Some(lab) = Laboratory::open() else { return };
    save(&lab);
    // The settings have the list of recent files.
    lab.wait_for_files(|files| files["/Data/settings.json"].as_str().is_some_and(|text| text.contains(FILE)));
    let one = lab.browser.tab();
    let two = lab.browser.new_tab();
    lab.browser.show_tab(&two);
    lab.browser.run_first(include_str!("first.js"));
    let [width, height] = SIZE;
    lab.browser.resize(width, height);
    lab.visit("");
    lab.press(&[F8]);
    let said = lab.messages();
    assert!(said.contains("open in another tab"), "{said}");
    lab.press(&[F8]);
    lab.press(&[CONTROL, 'o']);
    lab.browser.click(445, 250);
    lab.frames();
    lab.press(&[ENTER]);
    lab.wait_for_title(|title| title.starts_with("default-scene –"));
    lab.press(&['p']);
    lab.wait_for_unsaved(true);
    lab.press(&[CONTROL, 's']);
    lab.wait_for_files(|files| shading(&text(&files[FILE])) == "phong");
    lab.wait_for_unsaved(false);
    // The first tab has no changes, and follows; then it has some.
    lab.browser.show_tab(&one);
    lab.frames();
    lab.press(&['v']);
    lab.wait_for_unsaved(true);
    let files = lab.wait_for_files(|files| copies(files).len() == 1);
    let copy = copies(&files).remove(0);
    assert_eq!(shading(&copy), "phong");
    assert!(copy.contains("\"visible\": false"), "{copy}");
    // What the second saves meanwhile leaves them alone.
    lab.browser.show_tab(&two);
    lab.frames();
    lab.press(&['d']);
    lab.wait_for_unsaved(true);
    lab.press(&[CONTROL, 's']);
    lab.wait_for_files(|files| shading(&text(&files[FILE])) == "derivative");
    lab.wait_for_unsaved(false);
    lab.browser.show_tab(&one);
    lab.frames();
    lab.press(&[CONTROL, 's']);
    assert!(lab.title().contains('•'), "it asks first");
    let files = lab.files();
    assert_eq!(shading(&text(&files[FILE])), "derivative");
    assert!(copies(&files).contains(&copy), "{files}");
}

#[test]
fn what_the_browser_has_no_room_for_is_said_and_stays_unsaved() {
    let Some(lab) = Laboratory::open() else { return };
    save(&lab);
    lab.browser.run("seen.isFull = true");
    // The copy of this change is the last that has room; then the page asks how much is left.
    lab.press(&['p']);
    lab.wait_for_unsaved(true);
    lab.wait_for_files(|files| copies(files).len() == 1);
    lab.frames();
    lab.press(&[CONTROL, 's']);
    lab.frames();
    assert!(lab.title().contains('•'), "{}", lab.title());
    assert_eq!(shading(&text(&lab.files()[FILE])), "gouraud");
    // An error opens the panel of messages.
    let said = lab.messages();
    assert!(said.contains("/Files/default-scene.json was not written: the browser has no room"), "{said}");
}
