//! Pictures saved by the window.

use std::{fs, path::Path};

use bevy::{app::App, ecs::message::Messages};
use bevy_egui::egui::{Event, Key, Modifiers, Rect, pos2, vec2};
use lights_camera_models::{
    panel::state::{
        Action, Cell, Effect, PictureArea, PictureOptions, PictureSize, Question, Running, Session, Severity,
        SheetOf, SheetOptions, TakeCommand, Taken, Turning, ViewChange,
    },
    parameter::Value,
    registry::Registry,
    scene::{
        Background, Light, Object, Repeat, Repetition, Scene, Variant,
        comparison::Layout,
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
    for _ in 0..12_000 {
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
    session(app).document.change(
        "Layout",
        lights_camera_models::document::Extent::Rest,
        Default::default(),
        |scene| scene.comparison.layout = Layout::SideBySide,
    );
}

/// Options with a size.
fn of_size(width: u32, height: u32) -> PictureOptions {
    PictureOptions { size: PictureSize::Own, own: [width, height], ..PictureOptions::default() }
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
fn pictures_from_outside_the_room_open_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    side_by_side(&mut app);
    session(&mut app).settings.sheet =
        SheetOptions { size: [60, 40], labels: false, ..SheetOptions::default() };
    let own = session(&mut app).document.observer;
    let file = folder.path().join("outside.png");
    let outside = |app: &mut App, z: f32| {
        let facts = &mut session(app).facts;
        (facts.eye.z, facts.camera_is_free) = (z, true);
    };
    for (z, expected) in [(9.0, 9.0), (14.0, own.position.z)] {
        let takes: [&dyn Fn(&mut App) -> Vec<(Severity, String)>; 3] =
            [&|app| take(app, None, &file, true), &|app| take(app, Some(1), &file, true), &|app| {
                sheet(app, SheetOf::Views, &file)
            }];
        for (i, take) in takes.iter().enumerate() {
            outside(&mut app, z);
            let said = take(&mut app);
            assert_eq!(opened(&file).observer.position.z, expected, "{i}: {said:?}");
            let kept = said[0].1.contains("It opens with the observer’s view, not the one you turned to.");
            assert_eq!(kept, z > 10.0, "{i}: {said:?}");
        }
    }
}

#[test]
fn an_extension_behind_a_typed_one_is_left_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    let at = |name: &str| folder.path().join(name);
    let said = take(&mut app, None, &at("row.png.png"), true);
    assert!(
        said[0].1.contains("row.png.") && at("row.png").exists() && !at("row.png.png").exists(),
        "{said:?}"
    );
    // The dialog asked about another name.
    let _ = take(&mut app, None, &at("row.png.png"), true);
    let asked = session(&mut app).questions.open.take();
    assert_eq!(asked, Some(Question::ReplacePicture { view: None, path: at("row.png") }));
    let _ = take(&mut app, None, &at("light.exr.png"), false);
    assert!(at("light.exr").exists());
    session(&mut app).settings.sheet = SheetOptions { size: [60, 40], ..SheetOptions::default() };
    let _ = sheet(&mut app, SheetOf::Views, &at("views.gif.png"));
    assert!(fs::read(at("views.gif")).expect("written").starts_with(b"GIF89a"));
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
    bench.effects.clear();
    // Two keys suffice.
    bench.key(Key::P, Modifiers::COMMAND);
    assert!(bench.says("Save the picture") && !bench.dialogs.is_open());
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.dialogs.is_open() && bench.session.take_draft.is_none());
    assert_eq!(bench.effects, [], "nothing was changed");
}

#[test]
fn a_picture_has_the_size_and_the_background_that_were_chosen() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    session(&mut app).settings.picture_caption = false;
    session(&mut app).settings.picture =
        PictureOptions { background: Some([0, 255, 0]), ..of_size(200, 100) };
    let file = folder.path().join("taken.png");
    let _ = take(&mut app, None, &file, false);
    let picture = Picture::read(&file);
    assert_eq!((picture.width, picture.height), (200, 100));
    assert_eq!(picture.at(2, 2), [0, 255, 0]);
    assert!(picture.count(0..200, 0..100, RED) > 500);
    // The picture opens as it is, and the scene of the window stays as it was.
    assert_eq!(opened(&file).display.background, Background::Colour);
    assert_eq!(session(&mut app).document.display.background, Background::Environment);
    assert!(!session(&mut app).is_dirty());
    // A view need not be on screen.
    let _ = take(&mut app, Some(1), &file, true);
    assert!(Picture::read(&file).count(0..200, 0..100, BLUE) > 500);
    side_by_side(&mut app);
    session(&mut app).settings.picture = of_size(400, 100);
    let _ = take(&mut app, None, &file, true);
    let both = Picture::read(&file);
    assert_eq!((both.width, both.height), (400, 100));
    assert!(both.count(0..199, 0..100, RED) > 500 && both.count(201..400, 0..100, BLUE) > 500);
    // Layers that were not chosen are left out.
    session(&mut app).settings.picture =
        PictureOptions { layers: vec!["depth".to_owned()], ..of_size(60, 40) };
    let linear = folder.path().join("b.exr");
    let _ = take(&mut app, Some(1), &linear, false);
    let channels = read_exr(&linear);
    assert_eq!(channels["R"].len(), 60 * 40);
    assert!(channels.contains_key("depth.Z") && !channels.contains_key("light_1.G"));
}

#[test]
fn sizes_without_room_and_folders_that_cannot_be_written_are_errors() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    let file = folder.path().join("taken.png");
    side_by_side(&mut app);
    session(&mut app).settings.picture = of_size(2, 9);
    let said = take(&mut app, None, &file, false);
    let few = "No picture was taken: 2×9 pixels are too few for the views side by side.";
    assert_eq!(said, [(Severity::Error, few.to_owned())]);
    session(&mut app).settings.picture = of_size(20, 10);
    let within = folder.path().join("room.json").join("taken.png");
    let said = take(&mut app, Some(0), &within, false);
    assert!(said[0].0 == Severity::Error && said[0].1.contains("taken.png"), "{said:?}");
    session(&mut app).settings.picture = of_size(16_384, 16_384);
    let said = take(&mut app, Some(0), &folder.path().join("a.hdr"), false);
    assert!(said[0].1.contains("16384×16384 are more pixels than it can hold"), "{said:?}");
}

#[test]
fn numbers_stand_in_the_caption_and_legends_can_be_left_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    side_by_side(&mut app);
    let picture = |app: &mut App, options: PictureOptions| {
        session(app).settings.picture = options;
        let file = folder.path().join("taken.png");
        let _ = take(app, None, &file, true);
        Picture::read(&file)
    };
    // There is less room below small pictures.
    for (of, more) in [(PictureOptions::default(), 1), (of_size(640, 360), 20)] {
        let plain = picture(&mut app, of.clone());
        let said = picture(&mut app, PictureOptions { numbers: true, ..of });
        assert!(said.height >= plain.height && said.at(60, 45) == plain.at(60, 45));
        let ink =
            |p: &Picture| p.count(0..p.width, 0..p.height, |p| p[0] > 150 && p[0] == p[1] && p[1] == p[2]);
        assert!(ink(&said).abs_diff(ink(&plain)) >= more, "{} {}", ink(&said), ink(&plain));
    }
    session(&mut app).document.change(
        "Layout",
        lights_camera_models::document::Extent::Rest,
        Default::default(),
        |scene| scene.comparison.layout = Layout::Difference,
    );
    let with = picture(&mut app, of_size(640, 360));
    let without = picture(&mut app, PictureOptions { legend: false, ..of_size(640, 360) });
    let differs = |(x, y): &(u32, u32)| with.at(*x, *y) != without.at(*x, *y);
    let all = (0..640).flat_map(|x| (0..360).map(move |y| (x, y)));
    assert!(all.filter(differs).count() > 500, "the legend is left out");
}

#[test]
fn options_are_chosen_by_keys_and_kept() {
    let mut session = Session::default();
    session.settings.picture = of_size(1280, 720);
    let mut bench = Bench::new(session);
    bench.size = vec2(1280.0, 720.0);
    bench.key(Key::P, Modifiers::COMMAND);
    for wrong in ["0", "16385", "1.5", "many"] {
        bench.type_into("Width in pixels", wrong);
        assert!(bench.find("Choose a file…").is_some_and(|button| button.disabled), "{wrong}");
        bench.key(Key::Enter, Modifiers::NONE);
        assert!(bench.session.take_draft.is_some() && !bench.dialogs.is_open(), "{wrong}");
    }
    bench.type_into("Width in pixels", "640");
    bench.click("Another background");
    bench.click("Depth");
    assert_eq!(bench.session.settings.picture, of_size(1280, 720), "not before a file is chosen");
    bench.type_into("Height in pixels", "480");
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.dialogs.is_open());
    assert_eq!(bench.effects, [Effect::SaveSettings]);
    let kept = &bench.session.settings.picture;
    assert_eq!((kept.own, kept.background, kept.layers.len()), ([640, 480], Some([255; 3]), 4));
    assert!(!bench.session.is_dirty(), "the scene has no part in it");
}

#[test]
fn keys_stay_in_the_window_of_options() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    let before = bench.session.document.scene().clone();
    // The wrong twin: without the window it is a command.
    bench.letter(Key::F, "f");
    assert!(*bench.session.document.scene() != before);
    bench.key(Key::Z, Modifiers::COMMAND);
    assert!(*bench.session.document.scene() == before);
    bench.key(Key::P, Modifiers::COMMAND);
    bench.click("Caption");
    bench.letter(Key::F, "f");
    // Whatever Tab reaches is in the window.
    for _ in 0..25 {
        bench.key(Key::Tab, Modifiers::NONE);
        bench.letter(Key::F, "f");
    }
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(bench.session.take_draft.is_none() && *bench.session.document.scene() == before);
    // After a click on a box, Enter takes the options.
    bench.key(Key::P, Modifiers::COMMAND);
    bench.click("Caption");
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.dialogs.is_open() && !bench.session.settings.picture_caption);
}

#[test]
fn a_closed_window_changes_nothing() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.key(Key::P, Modifiers::COMMAND);
    bench.click("Smooth edges");
    bench.click("Caption");
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(bench.session.take_draft.is_none() && !bench.dialogs.is_open());
    assert_eq!(bench.session.settings.picture, PictureOptions::default());
    assert!(bench.session.settings.picture_caption && bench.effects.is_empty());
    // The view is gone.
    let ask = Action::Take(TakeCommand::Ask(Taken::Picture(Some(3))));
    bench.apply(ask);
    assert!(bench.session.take_draft.is_none());
}

#[test]
fn the_window_of_options_fits() {
    for scale in [100, 150] {
        let variants = vec![Variant::default()];
        let mut session = Session::new(Scene { variants, ..Scene::default() });
        session.settings.picture = PictureOptions { background: Some([9, 9, 9]), ..of_size(16_384, 16_384) };
        let mut bench = Bench::new(session);
        bench.size = vec2(1280.0, 720.0);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        let whole = Rect::from_min_size(pos2(0.0, 0.0), bench.size / (f32::from(scale) / 100.0));
        let turn = SheetOf::Turn(Turning::Objects);
        for of in [Taken::Picture(None), Taken::Sheet(SheetOf::Views), Taken::Sheet(turn)] {
            bench.apply(Action::Take(TakeCommand::Ask(of)));
            bench.settle();
            for label in ["Choose a file…", "Cancel", "Smooth edges"] {
                let place = bench.find(label).expect(label).rect;
                assert!(whole.contains_rect(place), "{scale} %, {label}: {place:?}");
            }
            bench.apply(Action::Take(TakeCommand::Close));
        }
    }
}

#[test]
fn tab_goes_through_the_options_from_above_to_below_and_around() {
    for (scale, row) in [(100, false), (150, false), (100, true), (150, true)] {
        let repeat = Repeat { columns: 3, spacing: [1.0, 0.0, 0.0].into(), ..Repeat::default() };
        let entry = Object { repeat: Repetition::Entry(Box::new(repeat)), ..Object::default() };
        let scene = Scene { objects: vec![entry], ..Scene::default() };
        let mut bench = Bench::new(Session::new(scene.expanded(&Registry::builtin()).expect("a row")));
        bench.size = vec2(1280.0, 720.0);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        let of = if row { Taken::Sheet(SheetOf::Row(0)) } else { Taken::Picture(None) };
        bench.apply(Action::Take(TakeCommand::Ask(of)));
        bench.settle();
        let whole = Rect::from_min_size(pos2(0.0, 0.0), bench.size / (f32::from(scale) / 100.0));
        let mut stops = Vec::new();
        for _ in 0..40 {
            bench.key(Key::Tab, Modifiers::NONE);
            bench.settle();
            let focused = bench.ctx.memory(|memory| memory.focused()).expect("something has the keys");
            if stops.first().is_some_and(|(first, _)| *first == focused) {
                break;
            }
            let rect = bench.ctx.read_response(focused).expect("shown").rect;
            assert!(whole.contains_rect(rect), "{of:?}, {scale} %: {rect:?}");
            stops.push((focused, rect));
        }
        assert!((6..40).contains(&stops.len()), "{of:?}, {scale} %: {stops:?}");
        // Only from the buttons below to the first option does it go up.
        let next = stops.iter().cycle().skip(1);
        let up = stops.iter().zip(next).filter(|((_, a), (_, b))| b.center().y < a.center().y - 60.0).count();
        assert_eq!(up, 1, "{of:?}, {scale} %: {stops:?}");
    }
}

#[test]
fn on_a_low_screen_the_options_scroll_and_the_buttons_stay_in_sight() {
    let variants = vec![Variant::default()];
    let mut session = Session::new(Scene { variants, ..Scene::default() });
    session.settings.picture = PictureOptions { background: Some([9, 9, 9]), ..of_size(16_384, 16_384) };
    let mut bench = Bench::new(session);
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Scale(200)));
    let whole = Rect::from_min_size(pos2(0.0, 0.0), bench.size / 2.0);
    for (of, last) in [(Taken::Picture(None), "Depth"), (Taken::Sheet(SheetOf::Views), "Smooth edges")] {
        bench.apply(Action::Take(TakeCommand::Ask(of)));
        bench.settle();
        let buttons = ["Choose a file…", "Cancel"].map(|label| bench.find(label).expect(label).rect);
        assert!(buttons.iter().all(|place| whole.contains_rect(*place)), "{of:?}: {buttons:?}");
        let place = |bench: &Bench| bench.find(last).expect("the last option").rect;
        // Tab scrolls to what it reaches.
        let is_reached = |bench: &Bench| {
            let focused = bench.ctx.memory(|memory| memory.focused());
            let on = focused.and_then(|id| bench.ctx.read_response(id));
            on.is_some_and(|on| on.rect.center().distance(place(bench).center()) < 2.0)
        };
        let reaches = (0..30).any(|_| {
            bench.key(Key::Tab, Modifiers::NONE);
            is_reached(&bench)
        });
        assert!(reaches, "{of:?}: {last}");
        bench.settle();
        bench.settle();
        let free = whole.with_max_y(buttons[0].top());
        assert!(free.contains_rect(place(&bench)), "{of:?}: {last}: {:?}", place(&bench));
        bench.apply(Action::Take(TakeCommand::Close));
    }
}

#[test]
fn options_that_cannot_be_used_say_why() {
    let mut bench = Bench::new(Session::default());
    bench.size = vec2(1280.0, 720.0);
    bench.key(Key::P, Modifiers::COMMAND);
    let reasons = [
        ("Smooth edges", "Pictures as the view have the edges of the view."),
        ("Legend", "The picture has no legend: it shows neither a debug channel nor a difference."),
        ("Numbers of the difference in the caption", "The picture shows one view; numbers compare several."),
    ];
    for (label, why) in reasons {
        let seen = bench.find(label).expect(label).clone();
        assert!(seen.disabled && !bench.says(why), "{label}");
        bench.hover(seen.rect.center());
        assert!(bench.says(why), "{label}: {:?}", bench.texts());
        bench.hover(pos2(1.0, 1.0));
    }
}

#[test]
fn the_progress_of_a_picture_is_shown_and_it_can_be_stopped() {
    let mut bench = Bench::new(Session::default());
    let now = Running { label: (), done: 0.4, step: "64 of 256 samples".to_owned() };
    bench.session.facts.picture = Some(now);
    bench.settle();
    assert!(bench.says("Drawing the picture"));
    bench.key(Key::P, Modifiers::COMMAND);
    assert!(bench.session.take_draft.is_none(), "one at a time");
    assert!(bench.session.messages.iter().any(|m| m.text.starts_with("A picture is still being drawn")));
    bench.click("Cancel");
    assert_eq!(bench.effects, [Effect::CancelPicture]);
}

/// Waits for a sheet, and returns the message about it.
fn sheet(app: &mut App, subject: SheetOf, path: &Path) -> Vec<(Severity, String)> {
    session(app).messages.clear();
    let effect = Effect::WriteSheet { subject, path: path.to_owned() };
    app.world_mut().resource_mut::<Messages<Effect>>().write(effect);
    for _ in 0..12_000 {
        app.update();
        let session = app.world().resource::<Session>();
        if !session.messages.is_empty() {
            return session.messages.iter().map(|m| (m.severity, m.text.clone())).collect();
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the sheet is never written");
}

#[test]
fn the_window_asks_what_a_sheet_shows_and_with_which_view_it_compares() {
    let variants = vec![Variant::default(), Variant::default()];
    let mut bench = Bench::new(Session::new(Scene { variants, ..Scene::default() }));
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::Take(TakeCommand::Ask(Taken::Sheet(SheetOf::Views))));
    bench.settle();
    bench.click("Compared with: view A");
    bench.click("view C");
    assert_eq!(bench.session.take_draft.as_ref().map(|draft| draft.sheet.against), Some(2));
    bench.click("Pictures of: The views");
    bench.click(Turning::Lights.name());
    let of = bench.session.take_draft.as_ref().map(|draft| draft.of);
    assert_eq!(of, Some(Taken::Sheet(SheetOf::Turn(Turning::Lights))));
    assert!(bench.find("Compared with: view C").is_none(), "a turn is compared with nothing");
    bench.type_into("Pictures", "12");
    bench.type_into("Pictures per second", "51");
    assert!(bench.find("Choose a file…").is_some_and(|button| button.disabled));
    bench.type_into("Pictures per second", "25");
    bench.key(Key::Enter, Modifiers::NONE);
    assert!(bench.dialogs.is_open());
    let kept = &bench.session.settings.sheet;
    assert_eq!((kept.turn, kept.rate, kept.against), (12, 25, 2));
    // Without views there is nothing that their sheet could show.
    bench.key(Key::Escape, Modifiers::NONE);
    bench.session.document.change(
        "No views",
        lights_camera_models::document::Extent::Rest,
        Default::default(),
        |scene| scene.variants.clear(),
    );
    bench.apply(Action::Take(TakeCommand::Ask(Taken::Sheet(SheetOf::Views))));
    bench.settle();
    assert!(bench.session.take_draft.is_none());
}

#[test]
fn a_sheet_has_its_options_and_may_show_a_row() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut app = lab(folder.path());
    let file = folder.path().join("sheet.png");
    session(&mut app).settings.sheet = SheetOptions {
        size: [60, 40],
        columns: 1,
        labels: false,
        differences: false,
        smooth: false,
        turn: 5,
        ..SheetOptions::default()
    };
    let _ = sheet(&mut app, SheetOf::Views, &file);
    let views = Picture::read(&file);
    assert!((60..80).contains(&views.width) && (80..110).contains(&views.height), "{}", views.height);
    // Compared with the other view, the map is below the other picture.
    let compared = |app: &mut App, against: u32| {
        let sheet_options = &mut session(app).settings.sheet;
        (sheet_options.differences, sheet_options.against) = (true, against);
        let _ = sheet(app, SheetOf::Views, &file);
        session(app).settings.sheet.differences = false;
        fs::read(&file).expect("written")
    };
    assert!(compared(&mut app, 0) != compared(&mut app, 1));
    let said = sheet(&mut app, SheetOf::Row(0), &file);
    assert_eq!(said, [(Severity::Error, "The sheet was not saved: objects[0] is in no row.".to_owned())]);
    session(&mut app).document.change(
        "Row",
        lights_camera_models::document::Extent::Rest,
        Default::default(),
        |scene| {
            let repeat = Repeat { columns: 3, spacing: [1.0, 0.0, 0.0].into(), ..Repeat::default() };
            let entry = Object { repeat: Repetition::Entry(Box::new(repeat)), ..scene.objects[0].clone() };
            let row = Scene { objects: vec![entry], ..Scene::default() };
            scene.objects = row.expanded(&Registry::builtin()).expect("a row").objects;
        },
    );
    let saved = sheet(&mut app, SheetOf::Row(1), &file);
    assert!(saved[0].1.starts_with("Saved the sheet to "), "{saved:?}");
    let copies = Picture::read(&file);
    assert!(copies.width == views.width && copies.height > views.height, "{}", copies.height);
    let said = sheet(&mut app, SheetOf::Turn(Turning::Lights), &file);
    assert!(said[0].1.contains("lights cannot turn: no position"), "{said:?}");
    session(&mut app).document.change(
        "Lamp",
        lights_camera_models::document::Extent::Light(0),
        Default::default(),
        |scene| scene.lights[0] = Light { position: Some([0.5, 9.0, 0.5].into()), ..Light::default() },
    );
    // The lamp is in a corner, from which it would leave the room.
    let said = sheet(&mut app, SheetOf::Turn(Turning::Lights), &file);
    assert!(said[0].1.contains("something would leave the room; move it nearer"), "{said:?}");
    // Five steps of a turn, below each other or in time.
    let turn = SheetOf::Turn(Turning::Objects);
    let saved = sheet(&mut app, turn, &file);
    assert!(saved[0].1.starts_with("Saved the sheet to "), "{saved:?}");
    assert!(Picture::read(&file).height > copies.height);
    for (name, mark) in [("turn.gif", &b"GIF89a"[..]), ("turn.apng", b"\x89PNG")] {
        let film = folder.path().join(name);
        let saved = sheet(&mut app, turn, &film);
        assert!(saved[0].1.starts_with("Saved the film to "), "{saved:?}");
        assert!(fs::read(&film).expect("written").starts_with(mark), "{name}");
    }
}

/// The actions of a user: each is a click, a chord of keys, or a value that is typed and confirmed.
struct Actions {
    bench: Bench,
    count: usize,
}

impl Actions {
    fn key(&mut self, key: Key, modifiers: Modifiers) {
        self.bench.key(key, modifiers);
        self.count += 1;
    }

    fn letter(&mut self, key: Key, text: &str) {
        self.bench.letter(key, text);
        self.count += 1;
    }

    fn type_text(&mut self, text: &str) {
        self.bench.frame(vec![Event::Text(text.to_owned())]);
        self.bench.settle();
        self.bench.key(Key::Enter, Modifiers::NONE);
        self.count += 1;
    }
}

#[test]
fn five_spheres_with_labels_are_a_picture_in_six_actions() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut start = Session::default();
    // Where the dialog begins.
    start.path = Some(folder.path().join("lecture.json"));
    let mut user = Actions { bench: Bench::new(start), count: 0 };
    user.bench.size = vec2(1280.0, 720.0);
    user.bench.settle();
    // As docs/figures.md says.
    user.letter(Key::R, "r");
    user.type_text("ggx rough");
    user.key(Key::R, Modifiers::COMMAND);
    user.key(Key::P, Modifiers::COMMAND);
    user.key(Key::Enter, Modifiers::NONE);
    // In place of the name that is proposed.
    user.bench.key(Key::A, Modifiers::COMMAND | Modifiers::CTRL);
    user.type_text("row");
    assert_eq!(user.count, 6);
    let asked = user.bench.effects.iter().find_map(|effect| match effect {
        Effect::Picture { view: None, file: Some(file), overwrite: false } => Some(file.clone()),
        _ => None,
    });
    let asked = asked.unwrap_or_else(|| panic!("{:?}", user.bench.effects));
    assert_eq!(asked.file_name().and_then(|name| name.to_str()), Some("row"));
    // The picture that is asked for, at the size of a test.
    let mut app = lab(folder.path());
    session(&mut app).document = user.bench.session.document.clone();
    let _ = take(&mut app, None, &asked, false);
    let scene = opened(&asked.with_extension("png"));
    let row = scene.row(0).expect("a row");
    assert_eq!(
        (row.count, row.repeat.labels, scene.reflection_model.as_str()),
        (5, true, "metallic_roughness")
    );
    let values: Vec<_> = scene.objects.iter().map(|o| o.material.0.get("roughness").cloned()).collect();
    assert_eq!(values, [0.1, 0.3, 0.5, 0.7, 0.9].map(|v| Some(Value::Number(v))));
}
