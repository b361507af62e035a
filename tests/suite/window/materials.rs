//! The panel *Materials*: materials are found, given to objects and saved, with the pointer and with the keyboard.

use std::{fs, thread::sleep, time::Duration};

use bevy_egui::egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, Shape, TouchPhase, vec2};
use glam::Vec3;
use lights_camera_models::{
    document::Selection,
    materials::{self, Material, Origin},
    panel::{
        marks::Lens,
        state::{
            Action, Answer, CompareCommand, Effect, MATERIALS_TAB, MaterialCommand, Question, Session,
            ViewChange,
        },
    },
    parameter::{Value, Values},
    registry::Registry,
    scene::{Object, Scene, comparison::Layout},
};

use crate::window::panels::Bench;

/// Three spheres beside each other, and the panel below them, with the user's folder of materials.
fn bench() -> (Bench, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let object =
        |i: usize| Object { position: Vec3::new(4.0 + i as f32, 5.0, 5.0), size: 0.6, ..Object::default() };
    let scene = Scene { objects: (0..3).map(object).collect(), ..Scene::default() };
    let mut session = Session::new(scene);
    session.view.unfold(MATERIALS_TAB);
    session.facts.eye = Vec3::new(5.0, 5.0, 11.0);
    let mut registry = Registry::builtin();
    registry.set_custom_folder(&folder.path().join("models"));
    let mut bench = Bench::with_registry(session, registry);
    bench.size = vec2(1280.0, 900.0);
    wait_for(&mut bench, "Material: Gold");
    (bench, folder)
}

/// Goes on until a thread has made this.
fn wait_for(bench: &mut Bench, label: &str) {
    for _ in 0..6000 {
        bench.settle();
        if bench.says(label) {
            return;
        }
        sleep(Duration::from_millis(10));
    }
    panic!("no {label}");
}

fn named(name: &str) -> Material {
    let all = materials::built_in(&Registry::builtin());
    all.into_iter().find(|material| material.name == name).expect("of the program")
}

/// True if an object has a material.
fn has(bench: &Bench, i: usize, name: &str) -> bool {
    let material = named(name);
    let scene = bench.session.scene();
    let object = &scene.objects[i];
    scene.model_of(object) == material.reflection_model
        && material.material.0.iter().all(|(name, value)| object.material.0.get(name) == Some(value))
}

fn which(bench: &Bench, name: &str) -> Vec<usize> {
    (0..3).filter(|i| has(bench, *i, name)).collect()
}

#[test]
fn a_click_gives_a_material_to_all_selected_objects_as_one_step() {
    let (mut bench, _folder) = bench();
    let before = bench.session.document.scene().clone();
    bench.apply(Action::SelectEach(vec![Selection::Object(0), Selection::Object(2)], false));
    let steps = bench.session.document.done();
    bench.type_into("Search materials", "gold");
    assert!(bench.find("Material: Car paint").is_none(), "the search leaves it out");
    bench.click("Material: Gold");
    assert_eq!(which(&bench, "Gold"), [0, 2]);
    assert!(which(&bench, "Silver").is_empty());
    assert_eq!(bench.session.document.done(), steps + 1);
    let said = &bench.session.messages.last().expect("a message").text;
    assert!(said.starts_with("Gold for 2 objects, which is ") && said.contains(" in place of "), "{said}");
    bench.apply(Action::Undo);
    assert!(*bench.session.document.scene() == before);
    // Without an object there is nothing to change.
    bench.apply(Action::Select(Selection::Room));
    bench.click("Material: Gold");
    assert!(*bench.session.document.scene() == before);
}

#[test]
fn the_keyboard_alone_finds_and_applies_and_the_panel_fits_when_everything_is_large() {
    let (mut bench, _folder) = bench();
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::View(ViewChange::Scale(150)));
    bench.apply(Action::Select(Selection::Object(1)));
    bench.type_into("Search materials", "silver");
    // Past the buttons beside the field.
    for _ in 0..3 {
        bench.key(Key::Tab, Modifiers::NONE);
    }
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(which(&bench, "Silver"), [1]);
    let screen = bench.size / bench.ctx.zoom_factor();
    let card = bench.find("Material: Silver").expect("found").rect;
    assert!(card.min.x >= 0.0 && card.max.x <= screen.x && card.min.y >= 0.0, "{card:?} in {screen:?}");
}

#[test]
fn a_material_dropped_on_an_object_is_given_to_that_one_alone() {
    let (mut bench, _folder) = bench();
    bench.apply(Action::Select(Selection::Object(0)));
    bench.type_into("Search materials", "gold");
    let from = bench.find("Material: Gold").expect("found").rect.center();
    let middle = bench.session.document.objects[2].position;
    let at = |bench: &Bench, p: Vec3| Lens::of(&bench.session, bench.area.frame).project(p).expect("seen");
    let to = at(&bench, middle);
    drag(&mut bench, from, to);
    assert_eq!(which(&bench, "Gold"), [2]);
    assert_eq!(bench.session.selection, Selection::Object(0));
    // Beside all objects nothing changes.
    let scene = bench.session.document.scene().clone();
    let beside = at(&bench, middle + 1.6 * Vec3::Y);
    drag(&mut bench, from, beside);
    assert!(*bench.session.document.scene() == scene);
}

fn drag(bench: &mut Bench, from: Pos2, to: Pos2) {
    carry(bench, from, to);
    drop_at(bench, to);
}

/// Takes what is there to another place, and holds it.
fn carry(bench: &mut Bench, from: Pos2, to: Pos2) {
    bench.frame(vec![Event::PointerMoved(from)]);
    bench.frame(vec![press(from, true)]);
    for k in 1..=5 {
        bench.frame(vec![Event::PointerMoved(from + (to - from) * (k as f32 / 5.0))]);
    }
}

fn drop_at(bench: &mut Bench, at: Pos2) {
    bench.frame(vec![press(at, false)]);
    bench.settle();
}

fn press(pos: Pos2, pressed: bool) -> Event {
    Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
}

#[test]
fn words_beside_a_dragged_material_name_what_would_get_it() {
    let (mut bench, _folder) = bench();
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)));
    bench.type_into("Search materials", "gold");
    let from = bench.find("Material: Gold").expect("found").rect.center();
    let cells = bench.area.cells.clone();
    let middle = bench.session.document.objects[2].position;
    for (view, words) in [(0, "Gold for Sphere 3"), (1, "Gold for all objects of view B")] {
        let cell = cells.iter().find(|cell| cell.view == view).expect("it is shown").rect;
        let to = Lens::of(&bench.session, cell).project(middle).expect("seen");
        carry(&mut bench, from, to);
        assert!(bench.texts().contains(&words.to_owned()), "{words}: {:?}", bench.texts());
        carry(&mut bench, to, cell.left_top() + vec2(6.0, 40.0));
        assert!(bench.texts().contains(&"No object here".to_owned()));
        bench.frame(vec![Event::PointerGone]);
        bench.key(Key::Escape, Modifiers::NONE);
        drop_at(&mut bench, cell.left_top());
        assert!(!bench.texts().iter().any(|text| text.starts_with("Gold for")));
    }
}

#[test]
fn in_another_view_a_material_is_that_of_the_view() {
    let (mut bench, _folder) = bench();
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)));
    bench.apply(Action::Compare(CompareCommand::Activate(1)));
    let objects = bench.session.document.objects.clone();
    let apply = MaterialCommand::Apply(Box::new(named("Gold")), None);
    bench.apply(Action::Select(Selection::Object(0)));
    bench.apply(Action::Material(apply));
    assert!(bench.session.document.objects == objects, "view A stays");
    assert_eq!(which(&bench, "Gold"), [0, 1, 2]);
    let variant = &bench.session.document.variants[0];
    assert_eq!(variant.reflection_model.as_deref(), Some(&*named("Gold").reflection_model));
}

#[test]
fn the_material_of_an_object_is_saved_listed_at_once_and_replaces_none_unasked() {
    let (mut bench, folder) = bench();
    let mut values = Values::default();
    values.set("alpha", Value::Integer(77));
    let scene = Scene {
        reflection_model: "phong".to_owned(),
        objects: vec![Object { material: values.clone(), ..Object::default() }],
        ..Scene::default()
    };
    bench.session = Session::new(scene);
    bench.session.view.unfold(MATERIALS_TAB);
    bench.apply(Action::Material(MaterialCommand::Ask));
    bench.type_into("Name of the material", "../x");
    assert!(bench.find("Save").is_some_and(|button| button.disabled), "no path, but a name");
    bench.type_into("Name of the material", "Shiny red");
    bench.effects.clear();
    bench.click("Save");
    // The settings of the window may be saved, too.
    let saves = |effect: &Effect| matches!(effect, Effect::SaveMaterial { .. });
    let effect = bench.effects.drain(..).find(saves).expect("an effect");
    let Effect::SaveMaterial { material, overwrite: false } = effect else { panic!("{effect:?}") };
    let own = folder.path().join("materials");
    let path = materials::save(&material, &own, &bench.registry).expect("written");
    bench.session.materials.was_saved(path.clone());
    wait_for(&mut bench, "Material: Shiny red");
    let library = materials::Library::read(Some(&own), &bench.registry);
    assert_eq!(library.materials[0].material, values);
    assert_eq!(library.materials[0].origin, Origin::File(path.clone()));
    // Another one of this name: the file stays until the user says otherwise.
    bench.session.questions.ask(Question::ReplaceMaterial { material: material.clone(), path: path.clone() });
    bench.apply(Action::Answer(Answer::Cancel));
    assert!(!bench.effects.iter().any(saves), "{:?}", bench.effects);
    assert!(bench.session.materials.draft.is_some(), "asks for another name");
    bench.apply(Action::Material(MaterialCommand::Cancel));
    bench.session.questions.ask(Question::ReplaceMaterial { material: material.clone(), path });
    bench.apply(Action::Answer(Answer::Overwrite));
    let saved: Vec<_> = bench.effects.drain(..).filter(saves).collect();
    assert_eq!(saved, [Effect::SaveMaterial { material: material.clone(), overwrite: true }]);
    let mut other = *material;
    other.material.set("alpha", Value::Integer(5));
    materials::replace(&other, &own, &bench.registry).expect("written");
    let library = materials::Library::read(Some(&own), &bench.registry);
    assert_eq!(library.materials[0].material, other.material);
}

#[test]
fn files_that_are_no_materials_are_listed_with_what_is_wrong() {
    let (mut bench, folder) = bench();
    let own = folder.path().join("materials");
    fs::create_dir(&own).expect("made");
    let text = r#"{ "name": "Bad", "reflection_model": "fong", "material": {} }"#;
    fs::write(own.join("bad.json"), text).expect("written");
    assert!(!bench.says("bad.json"));
    bench.click("Read again");
    wait_for(&mut bench, "bad.json was not read: 1:38: reflection_model is \"fong\"");
    assert!(bench.find("Material: Gold").is_some(), "it hides no other");
}

/// Files of the user with these names, each of Phong, read by the panel.
fn own(bench: &mut Bench, folder: &tempfile::TempDir, names: &[&str]) {
    let own = folder.path().join("materials");
    fs::create_dir_all(&own).expect("made");
    for (i, name) in names.iter().enumerate() {
        let material = Material {
            name: (*name).to_owned(),
            description: None,
            source: None,
            reflection_model: "phong".to_owned(),
            material: Values::default(),
            origin: Origin::Preset,
        };
        let text = materials::to_json(&material, &bench.registry);
        fs::write(own.join(format!("own_{i}.json")), text).expect("written");
    }
    bench.click("Read again");
    wait_for(bench, &format!("Material: {}", names[0]));
}

#[test]
fn many_broken_files_take_one_line_which_unfolds_and_leave_the_materials_their_place() {
    let (mut bench, folder) = bench();
    own(&mut bench, &folder, &["Apple"]);
    let top = |bench: &Bench| bench.find("Material: Apple").expect("it is listed").rect.top();
    let before = top(&bench);
    let text = r#"{ "name": "Bad", "reflection_model": "fong", "material": {} }"#;
    for i in 0..5 {
        fs::write(folder.path().join(format!("materials/bad{i}.json")), text).expect("written");
    }
    bench.click("Read again");
    wait_for(&mut bench, "5 files cannot be read");
    assert!(!bench.says("bad3.json"));
    assert!(top(&bench) - before < 32.0, "the materials moved from {before} to {}", top(&bench));
    let line = bench.find("5 files cannot be read").expect("a line").rect;
    bench.hover(line.center());
    assert!(bench.says("bad3.json was not read: 1:38"), "the tooltip lists them");
    bench.click("5 files cannot be read");
    assert!(bench.says("bad3.json was not read: 1:38"));
    assert!(top(&bench) - before < 160.0, "the list is scrolled");
    bench.click("5 files cannot be read");
    bench.hover(Pos2::ZERO);
    assert!(!bench.says("bad3.json"));
}

#[test]
fn tiles_are_reached_below_a_low_strip_with_large_type() {
    let (mut bench, folder) = bench();
    own(&mut bench, &folder, &["Apple"]);
    for i in 0..8 {
        fs::write(folder.path().join(format!("materials/bad{i}.json")), "{").expect("written");
    }
    bench.click("Read again");
    wait_for(&mut bench, "8 files cannot be read");
    bench.size = vec2(1280.0, 640.0);
    bench.apply(Action::View(ViewChange::Scale(200)));
    (0..3).for_each(|_| bench.settle());
    let at = bench.field("Search materials").rect.center();
    bench.frame(vec![Event::PointerMoved(at)]);
    let mut seen = false;
    for _ in 0..40 {
        let wheel = Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: vec2(0.0, -8.0),
            phase: TouchPhase::Move,
            modifiers: Modifiers::NONE,
        };
        bench.frame(vec![wheel]);
        bench.settle();
        seen |= bench.texts_in_sight().into_iter().any(|(text, _)| text == "Apple");
    }
    assert!(seen, "the name of a tile is never in sight");
}

#[test]
fn the_hint_says_what_a_drag_does_in_the_active_view() {
    let (mut bench, _folder) = bench();
    assert!(bench.says("drag: onto an object") && !bench.says("of view A"));
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.settle();
    assert!(bench.says("click, or drag into view B: for all its objects"));
    bench.apply(Action::Compare(CompareCommand::Activate(0)));
    bench.settle();
    assert!(bench.says("drag: onto an object of view A"));
}

#[test]
fn names_have_two_lines_and_longer_ones_are_whole_in_the_tooltip() {
    let long = "A very long name of a material that nobody can read on so small a tile";
    let two = "Gold of old clocks";
    for scale in [100, 150] {
        let (mut bench, folder) = bench();
        bench.apply(Action::View(ViewChange::Scale(scale)));
        own(&mut bench, &folder, &[two, long]);
        for (name, is_whole) in [(two, true), (long, false)] {
            let tile = bench.find(&format!("Material: {name}")).expect("listed").rect;
            let galleys: Vec<_> = bench
                .shapes()
                .into_iter()
                .filter_map(|shape| match shape {
                    Shape::Text(text) if text.galley.text() == name && tile.contains(text.pos) => Some(text),
                    _ => None,
                })
                .collect();
            let [text] = &galleys[..] else { panic!("{name} at {scale} %: {}", galleys.len()) };
            assert_eq!((text.galley.rows.len(), text.galley.elided), (2, !is_whole), "{name} at {scale} %");
            assert!(tile.expand(0.5).contains_rect(text.visual_bounding_rect()), "{name} at {scale} %");
        }
        let tile = bench.find(&format!("Material: {long}")).expect("listed").rect;
        bench.hover(tile.center());
        let whole = bench.shapes().into_iter().any(
            |shape| matches!(shape, Shape::Text(text) if text.galley.text() == long && !text.galley.elided),
        );
        assert!(whole, "the tooltip at {scale} %");
    }
}

#[test]
fn the_tile_says_that_the_shader_is_compiled_until_the_picture_shows_the_material() {
    let (mut bench, _folder) = bench();
    bench.type_into("Search materials", "gold");
    let says = |bench: &mut Bench| {
        let tile = bench.find("Material: Gold").expect("listed").rect;
        bench.texts_in_sight().iter().any(|(text, at)| text == "compiling…" && tile.contains_rect(*at))
    };
    bench.session.facts.compiling[0] = true;
    bench.settle();
    assert!(!says(&mut bench), "another shader");
    bench.click("Material: Gold");
    assert!(says(&mut bench));
    bench.session.facts.compiling[0] = false;
    bench.settle();
    assert!(!says(&mut bench));
    // A later change is not that of the material.
    bench.apply(Action::ChooseModel("ward".to_owned()));
    bench.session.facts.compiling[0] = true;
    bench.settle();
    assert!(!says(&mut bench));
}

#[test]
fn a_material_that_was_just_saved_is_in_sight_whatever_was_searched() {
    let (mut bench, folder) = bench();
    let many: Vec<_> = (10..90).map(|i| format!("Mine {i}")).collect();
    own(&mut bench, &folder, &many.iter().map(String::as_str).collect::<Vec<_>>());
    bench.type_into("Search materials", "gold");
    let mut material = named("Gold");
    material.name = "Zebra".to_owned();
    let path =
        materials::save(&material, &folder.path().join("materials"), &bench.registry).expect("written");
    bench.session.materials.was_saved(path);
    wait_for(&mut bench, "Material: Zebra");
    // The list is scrolled within a moment.
    (0..20).for_each(|_| bench.settle());
    assert!(bench.find("Material: Silver").is_some(), "the search is empty");
    let seen = bench.texts_in_sight().into_iter().find(|(text, _)| text == "Zebra").expect("painted").1;
    let panel = bench.find("Search materials").expect("the panel").rect;
    assert!(seen.top() > panel.bottom() && seen.bottom() < bench.size.y, "{seen:?} below {panel:?}");
    // A search of the user's stays.
    bench.type_into("Search materials", "silver");
    assert!(bench.find("Material: Zebra").is_none());
}
