//! A scene without its size: the missing size is reported, not the parts outside the default room.

use serde_json::{Value, json};

use lights_camera_models::{
    registry::Registry,
    scene::load::{self, Defaults},
};

use crate::helpers::support::{changed, lcm_in};

/// The full scene without its size, changed further.
fn without_size(change: impl FnOnce(&mut Value)) -> String {
    changed(|s| {
        s.as_object_mut().expect("an object").remove("scene_size");
        // Everything else in the scene fits into the default room.
        s["lights"] = json!([{ "type": "ambient" }]);
        s["observer"]["position"] = json!([5, 5, 9.5]);
        s["objects"] = json!([{ "type": "sphere", "position": [5, 5, 5], "size": 2 }]);
        change(s);
    })
}

fn said(text: &str, defaults: Defaults) -> String {
    let read = load::from_text(text, "scene.json", &Registry::builtin(), defaults);
    read.err().map_or_else(String::new, |e| e.to_string())
}

#[test]
fn parts_beyond_the_default_room_ask_for_the_size() {
    let text = without_size(|s| s["objects"][0]["position"] = json!([14, 5, 22.5]));
    let expected = "scene.json:1:1: scene_size is missing, and the default, 10 × 10 × 10 m, is too small for \
         objects[0].position [14, 5, 22.5]; write \"scene_size\": { \"height\": 10, \"width\": 14, \"depth\": 23 } or more";
    for defaults in [Defaults::Ask, Defaults::Use, Defaults::Refuse] {
        assert_eq!(said(&text, defaults), expected, "{defaults:?}");
    }
    // The suggestion in the message is right.
    let mended = text.replacen('{', "{ \"scene_size\": { \"height\": 10, \"width\": 14, \"depth\": 23 },", 1);
    assert_eq!(said(&mended, Defaults::Refuse), "");
}

#[test]
fn many_parts_beyond_it_are_one_problem() {
    let text = without_size(|s| {
        s["lights"] = json!([{ "type": "point", "position": [5, 12, 5] }]);
        s["observer"]["position"] = json!([5, 5, 40]);
        s["objects"] = json!([{ "type": "cube", "position": [5, 5, 30] }]);
    });
    let said = said(&text, Defaults::Ask);
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("too small for lights[0].position [5, 12, 5] and 2 more positions"), "{said}");
    assert!(said.contains("\"height\": 12, \"width\": 10, \"depth\": 40"), "{said}");
}

#[test]
fn one_missing_extent_is_named_alone() {
    let text = without_size(|s| {
        s["scene_size"] = json!({ "height": 10 });
        s["objects"][0]["position"] = json!([5, 5, 22.5]);
    });
    assert!(
        said(&text, Defaults::Ask).contains(
            "scene_size.depth is missing, and the default, 10 m, is too small for objects[0].position \
             [5, 5, 22.5]; write \"depth\": 23 or more"
        ),
        "{}",
        said(&text, Defaults::Ask)
    );
}

#[test]
fn positions_that_no_size_mends_stay_and_the_default_is_named() {
    let text = without_size(|s| s["objects"][0]["position"] = json!([-1, 5, 22.5]));
    let said = said(&text, Defaults::Ask);
    assert!(
        said.contains("objects[0].position is [-1,5,22.5], but a position must be inside the room")
            || said.contains("objects[0].position is [-1, 5, 22.5], but a position must be inside the room"),
        "{said}"
    );
    assert!(said.ends_with("; scene_size is missing, and its default is 10 × 10 × 10 m"), "{said}");
}

#[test]
fn the_command_line_says_it_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = without_size(|s| s["objects"][0]["position"] = json!([14, 5, 5]));
    std::fs::write(folder.path().join("wide.json"), text).expect("writable");
    for command in
        [&["check", "wide.json"][..], &["render", "wide.json", "--use-defaults"], &["view", "wide.json"]]
    {
        let run = lcm_in(folder.path(), command, b"");
        assert_eq!(run.status, Some(1), "{command:?}: {}", run.err);
        assert!(
            run.err.contains("scene_size is missing, and the default, 10 × 10 × 10 m"),
            "{command:?}: {}",
            run.err
        );
    }
}
