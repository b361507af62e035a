//! Solid models on meshes that are not solids, and smooth glass through which no light is seen: every command and the
//! window say so, with the reason.

use std::fs;

use bevy::app::PluginGroup as _;
use lights_camera_models::{
    panel::state::{Session, Severity},
    window::LabPlugins,
};

use crate::{helpers::support::lcm_in, library::plugins::app};

/// A pyramid; without its base it is open.
const PYRAMID: &str = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1 0\nf 2 1 5\nf 3 2 5\nf 4 3 5\nf 1 4 5\n";
const BASE: &str = "f 1 2 3 4\n";

/// A scene with a pyramid and a teapot of a model.
fn scene(model: &str) -> String {
    format!(
        r#"{{
  "reflection_model": "{model}", "shading_model": "phong",
  "scene_size": {{ "height": 10, "width": 10, "depth": 10 }},
  "lights": [{{ "type": "environment", "source": "uniform", "intensity": 0.2 }}],
  "observer": {{ "position": [5, 5, 9], "direction": [0, 0, -1] }},
  "objects": [
    {{ "type": "mesh", "name": "tent", "path": "pyramid.obj", "position": [4, 5, 5] }},
    {{ "type": "teapot", "position": [6, 5, 5] }}
  ]
}}"#
    )
}

const TENT: &str = "objects[0] (\"tent\") is drawn as thin glass, since its mesh is not a solid: it is open: 4 edges with a triangle \
                    on one side only, in 1 rim around (";
const TEAPOT: &str = "objects[1] is drawn as thin glass, since its mesh is not a solid: it is open: 160 edges with a triangle on one \
                      side only, in 6 rims, the longest around (";

#[test]
fn check_and_render_say_what_is_wrong_with_a_mesh_and_go_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("pyramid.obj", PYRAMID);
    write("room.json", &scene("glass"));
    for command in
        [&["check", "room.json"][..], &["render", "room.json", "--size", "32x18", "--renderer", "cpu"]]
    {
        let run = lcm_in(folder.path(), command, b"");
        assert_eq!(run.status, Some(0), "{command:?}: {}", run.err);
        for begins in [TENT, TEAPOT] {
            let line = run.err.lines().find(|line| line.contains(begins));
            assert!(line.is_some_and(|line| line.starts_with("room.json: ")), "{command:?}: {}", run.err);
        }
        assert!(run.err.contains("; close the holes, or merge vertices that nearly meet"), "{}", run.err);
    }
    // With a base it is a solid; a pane needs none.
    write("pyramid.obj", &format!("{PYRAMID}{BASE}"));
    let run = lcm_in(folder.path(), &["check", "room.json"], b"");
    assert!(!run.err.contains("objects[0]") && run.err.contains(TEAPOT), "{}", run.err);
    write("room.json", &scene("thin_glass"));
    assert_eq!(lcm_in(folder.path(), &["check", "room.json"], b"").err, "");
    // Faces that point inwards.
    write("pyramid.obj", &format!("{PYRAMID}f 4 3 2 1\n"));
    write("room.json", &scene("glass"));
    let run = lcm_in(folder.path(), &["check", "room.json"], b"");
    assert!(run.err.contains("the triangles on both sides of 4 edges face opposite ways"), "{}", run.err);
}

#[test]
fn the_window_says_once_what_is_drawn_as_thin_glass() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("room.json");
    fs::write(folder.path().join("pyramid.obj"), PYRAMID).expect("written");
    fs::write(&file, scene("glass")).expect("written");
    let plugins = LabPlugins::default().scene(&file).size(120, 90).exit_after(100_000).headless();
    let mut app = app(plugins.build(), |_| ());
    for _ in 0..5 {
        app.update();
    }
    let session = app.world().resource::<Session>();
    let said: Vec<_> = session.messages.iter().filter(|m| m.text.contains("thin glass")).collect();
    assert_eq!(said.len(), 2, "{:?}", session.messages);
    assert!(said.iter().all(|message| message.severity == Severity::Warning));
    assert!(said[0].text.starts_with(TENT) && said[1].text.starts_with(TEAPOT), "{said:?}");
}

/// A ball of smooth glass, a light without extent, and another light, if any.
fn ball(light: &str) -> String {
    format!(
        r#"{{
  "reflection_model": "glass", "shading_model": "phong",
  "scene_size": {{ "height": 10, "width": 10, "depth": 10 }},
  "lights": [{{ "type": "point", "position": [3, 8, 9], "intensity": 60 }}{light}],
  "observer": {{ "position": [5, 5, 9], "direction": [0, 0, -1] }},
  "objects": [{{ "type": "sphere", "name": "ball", "position": [5, 5, 5] }}]
}}"#
    )
}

const ENVIRONMENT: &str = r#", { "type": "environment", "source": "uniform", "intensity": 0.2 }"#;
const DARK: &str = "objects[0] (\"ball\") is smooth glass and looks dark: lights without extent are not seen through it; add a light \
                    with extent or an environment, or make the glass rough";

#[test]
fn commands_say_why_smooth_glass_is_dark() {
    let folder = tempfile::tempdir().expect("a folder");
    let commands =
        [&["check", "room.json"][..], &["render", "room.json", "--size", "32x18", "--renderer", "cpu"]];
    for (light, dark) in [("", true), (ENVIRONMENT, false)] {
        fs::write(folder.path().join("room.json"), ball(light)).expect("written");
        for command in commands {
            let run = lcm_in(folder.path(), command, b"");
            assert_eq!(run.status, Some(0), "{command:?}: {}", run.err);
            let count = run.err.lines().filter(|line| *line == format!("room.json: {DARK}")).count();
            assert_eq!(count, usize::from(dark), "{command:?}: {}", run.err);
        }
        let explained =
            lcm_in(folder.path(), &["explain", "room.json", "--at", "32,18", "--size", "64x36"], b"");
        assert_eq!(
            explained.out.contains("It is smooth glass: lights without extent"),
            dark,
            "{}",
            explained.out
        );
    }
}

#[test]
fn the_window_says_once_why_smooth_glass_is_dark() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("room.json");
    for (light, count) in [("", 1), (ENVIRONMENT, 0)] {
        fs::write(&file, ball(light)).expect("written");
        let plugins = LabPlugins::default().scene(&file).size(120, 90).exit_after(100_000).headless();
        let mut app = app(plugins.build(), |_| ());
        for _ in 0..5 {
            app.update();
        }
        let session = app.world().resource::<Session>();
        let said = session.messages.iter().filter(|message| message.text == format!("{DARK}.")).count();
        assert_eq!(said, count, "{:?}", session.messages);
    }
}
