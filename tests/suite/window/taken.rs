//! Pictures saved by the window.

use std::{fs, path::Path};

use bevy::{app::App, ecs::message::Messages};
use bevy_egui::egui::{Key, Modifiers, Rect, pos2, vec2};
use lights_camera_models::{
    panel::state::{Cell, Effect, PictureArea, Question, Session, Severity, ViewChange},
    parameter::Value,
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults},
    },
    window::LabPlugins,
};

use crate::{
    helpers::screen::Picture, library::plugins::app, renderers::linear::read_exr, window::panels::Bench,
};

/// A red sphere that view B shows in blue.
const SCENE: &str = r#"{
  "scene_size": { "height": 10, "width": 10, "depth": 10 },
  "name": "Two colours",
  "reflection_model": "lambert",
  "shading_model": "phong",
  "lights": [{ "type": "ambient", "intensity": 1 }],
  "observer": { "position": [5, 5, 9.5], "direction": [0, 0, -1] },
  "objects": [{ "type": "sphere", "position": [5, 5, 5], "size": 3, "material": { "base_colour": [255, 0, 0] } }],
  "variants": [{ "name": "in blue", "material": { "base_colour": [0, 0, 255] } }]
}"#;

const RED: fn([u8; 3]) -> bool = |p| p[0] > 200 && p[1] < 30 && p[2] < 30;
const BLUE: fn([u8; 3]) -> bool = |p| p[2] > 200 && p[1] < 30 && p[0] < 30;

/// A windowless lab with this scene, and views of 120×90 pixels.
fn lab(folder: &Path) -> App {
    let scene = folder.join("room.json");
    fs::write(&scene, SCENE).expect("writable");
    let plugins = LabPlugins::default().scene(&scene).size(120, 90).exit_after(100_000).headless();
    app(bevy::app::PluginGroup::build(plugins), |_| ())
}

/// Takes a picture in a lab, until it reports the result or asks something.
fn take(app: &mut App, view: Option<usize>, file: &Path, overwrite: bool) -> Vec<(Severity, String)> {
    // Repeated messages do not count.
    session(app).messages.clear();
    let effect = Effect::Picture { view, file: Some(file.to_owned()), overwrite };
    app.world_mut().resource_mut::<Messages<Effect>>().write(effect);
    for _ in 0..3000 {
        app.update();
        let session = app.world().resource::<Session>();
        if !session.messages.is_empty() || session.questions.open.is_some() {
            return session.messages.iter().map(|m| (m.severity, m.text.clone())).collect();
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the picture is never taken");
}

fn session(app: &mut App) -> bevy::ecs::change_detection::Mut<'_, Session> {
    app.world_mut().resource_mut::<Session>()
}

/// The scene in a picture.
fn opened(file: &Path) -> Scene {
    load::file(file, &Registry::builtin(), Defaults::Refuse).expect("the picture holds its scene").scene
}

/// Shows both views side by side, as panels would.
fn side_by_side(app: &mut App) {
    let cell = |view: usize| {
        let rect = Rect::from_min_size(pos2(130.0 * view as f32, 0.0), vec2(120.0, 90.0));
        Cell { view, rect, part: rect }
    };
    app.insert_resource(PictureArea { cells: vec![cell(0), cell(1)], ..PictureArea::default() });
}

#[test]
fn a_picture_of_the_window_is_that_of_lcm_render_and_opens_as_its_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    session(&mut app).settings.picture_caption = false;
    // Without the extension, which is added.
    let saved = take(&mut app, None, &folder.path().join("taken"), false);
    let file = folder.path().join("taken.png");
    assert_eq!(saved, [(Severity::Info, format!("Saved the picture to {}.", file.display()))]);
    let picture = Picture::read(&file);
    assert_eq!((picture.width, picture.height), (120, 90));
    assert!(picture.count(0..120, 0..90, RED) > 500 && picture.count(0..120, 0..90, BLUE) == 0);
    let scene = opened(&file);
    assert_eq!(scene.variants[0].name.as_deref(), Some("in blue"));
    assert_eq!(scene.observer, session(&mut app).document.observer);
    // With a caption it has the same width, and is taller.
    session(&mut app).settings.picture_caption = true;
    let _ = take(&mut app, None, &file, true);
    let captioned = Picture::read(&file);
    assert!(captioned.width == 120 && captioned.height > 100, "{}", captioned.height);
    assert_eq!(captioned.at(60, 45), picture.at(60, 45));
    // Seen from another position, it opens from there.
    session(&mut app).facts.eye.x += 1.0;
    session(&mut app).facts.camera_is_free = true;
    let _ = take(&mut app, None, &file, true);
    let scene = opened(&file);
    assert_eq!(scene.observer.position.x, session(&mut app).document.observer.position.x + 1.0);
}

#[test]
fn views_are_taken_together_or_one_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    session(&mut app).settings.picture_caption = false;
    let file = folder.path().join("b.png");
    // Nobody sees view B yet.
    let said = take(&mut app, Some(1), &file, false);
    assert_eq!(said.len(), 1);
    assert!(said[0].0 == Severity::Error && said[0].1.contains("view B is not on screen"), "{said:?}");
    assert!(!file.exists());
    side_by_side(&mut app);
    session(&mut app).document.change(
        "Layout",
        lights_camera_models::document::Extent::Rest,
        Default::default(),
        |scene| scene.comparison.layout = lights_camera_models::scene::comparison::Layout::SideBySide,
    );
    let _ = take(&mut app, Some(1), &file, false);
    let alone = Picture::read(&file);
    assert_eq!((alone.width, alone.height), (120, 90));
    assert!(alone.count(0..120, 0..90, BLUE) > 500 && alone.count(0..120, 0..90, RED) == 0);
    let scene = opened(&file);
    assert!(scene.variants.is_empty());
    let colour = scene.objects[0].material.0.get("base_colour");
    assert_eq!(colour, Some(&Value::Colour([0, 0, 255])));
    let _ = take(&mut app, None, &file, true);
    let both = Picture::read(&file);
    assert_eq!((both.width, both.height), (242, 90));
    assert!(both.count(0..120, 0..90, RED) > 500 && both.count(122..242, 0..90, BLUE) > 500);
    assert!(both.count(0..120, 0..90, BLUE) + both.count(122..242, 0..90, RED) == 0);
}

#[test]
fn nothing_is_replaced_unasked_and_only_pictures_are_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    let file = folder.path().join("taken.png");
    let _ = take(&mut app, None, &file, false);
    let before = fs::read(&file).expect("it is there");
    assert_eq!(take(&mut app, None, &file, false), []);
    let asked = session(&mut app).questions.open.take();
    assert_eq!(asked, Some(Question::ReplacePicture { view: None, path: file.clone() }));
    assert_eq!(fs::read(&file).expect("it is there"), before);
    let said = take(&mut app, None, &folder.path().join("taken.jpg"), true);
    let formats = "only PNG, OpenEXR (.exr) and Radiance (.hdr) files can be written; name it taken.png";
    assert!(said[0].1.contains(formats), "{said:?}");
    let notes = folder.path().join("notes.png");
    fs::write(&notes, "no picture").expect("writable");
    let said = take(&mut app, None, &notes, true);
    assert!(said[0].0 == Severity::Error && said[0].1.starts_with("The picture was not saved"), "{said:?}");
    assert_eq!(fs::read(&notes).expect("it is there"), b"no picture");
}

#[test]
fn the_ending_of_a_name_asks_for_linear_light() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    let at = |name: &str| folder.path().join(name);
    // The camera is elsewhere, which is where the picture opens.
    session(&mut app).facts.eye.x += 0.5;
    session(&mut app).facts.camera_is_free = true;
    for name in ["a.exr", "a.hdr"] {
        let saved = take(&mut app, None, &at(name), false);
        assert_eq!(saved, [(Severity::Info, format!("Saved the picture to {}.", at(name).display()))]);
        let scene = opened(&at(name));
        assert_eq!(scene.observer.position.x, session(&mut app).document.observer.position.x + 0.5);
        assert_eq!(take(&mut app, None, &at(name), false), []);
        let asked = session(&mut app).questions.open.take();
        assert_eq!(asked, Some(Question::ReplacePicture { view: None, path: at(name) }));
    }
    let channels = read_exr(&at("a.exr"));
    assert_eq!(channels["R"].len(), 120 * 90);
    assert!(channels.contains_key("depth.Z") && channels.contains_key("light_1.G"));
    // Uniform light of 1 lx on a red sphere.
    assert_eq!([channels["R"][45 * 120 + 60], channels["G"][45 * 120 + 60]], [1.0, 0.0]);
    assert_eq!([channels["A"][0], channels["R"][0]], [0.0; 2], "the background is no light");
    // The light of several views is several pictures.
    side_by_side(&mut app);
    session(&mut app).document.change(
        "Layout",
        lights_camera_models::document::Extent::Rest,
        Default::default(),
        |scene| scene.comparison.layout = lights_camera_models::scene::comparison::Layout::SideBySide,
    );
    let said = take(&mut app, None, &at("both.exr"), false);
    let expected = format!(
        "The picture was not saved to {}: it holds the light of one view; save the view alone.",
        at("both.exr").display()
    );
    assert_eq!(said, [(Severity::Error, expected)]);
    assert!(!at("both.exr").exists());
    let _ = take(&mut app, Some(1), &at("b.exr"), false);
    assert_eq!(read_exr(&at("b.exr"))["B"][45 * 120 + 60], 1.0, "the sphere is blue there");
    let notes = at("notes.exr");
    fs::write(&notes, "no picture").expect("writable");
    let said = take(&mut app, None, &notes, true);
    assert!(said[0].1.contains("notes.exr exists and is not an OpenEXR file"), "{said:?}");
}

#[test]
fn the_menu_saves_and_copies_pictures() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    bench.key(Key::P, Modifiers { shift: true, ..Modifiers::COMMAND });
    assert_eq!(bench.effects, [Effect::Picture { view: None, file: None, overwrite: false }]);
    bench.click("File");
    bench.click("Picture ⏵");
    assert!(bench.find("Save view").is_none(), "there is one view");
    bench.click("With a caption");
    assert!(!bench.session.settings.picture_caption);
    bench.apply(lights_camera_models::panel::state::Action::View(ViewChange::PictureCaption(true)));
    bench.key(Key::P, Modifiers::COMMAND);
    bench.settle();
    assert!(bench.find("Save the picture").is_some());
}
