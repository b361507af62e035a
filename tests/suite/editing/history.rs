//! Every change of the document can be undone and redone.

use std::path::PathBuf;

use bevy_egui::egui::{Event, Key, Modifiers, PointerButton, vec2};
use glam::Vec3;
use lights_camera_models::{
    document::{Document, Edit, Extent, Selection},
    panel::state::{Action, Session},
    parameter::{ParameterKind, Value, kind::number::Number},
    registry::Registry,
    scene::{Background, Display, Light, Object, Observer, Part, Scene, SceneSize, check},
};

use crate::window::panels::Bench;

/// Actions that change the scene, at least one of each kind.
fn changes() -> Vec<Action> {
    vec![
        Action::Edit(Edit::set(Part::Scene, Scene::name, "Room")),
        Action::Edit(Edit::set(Part::Scene, Scene::description, "Nothing much")),
        Action::Edit(Edit::from(SceneSize { width: 12.0, height: 11.0, depth: 10.0 })),
        Action::Edit(Edit::from(Display { exposure: 1.5, ..Display::default() })),
        Action::Edit(Edit::set(Part::Display, Display::background, Background::Gradient)),
        Action::Edit(Edit::set(Part::Display, Display::background_colour, [10, 20, 30])),
        Action::Edit(Edit::set(Part::Display, Display::background_bottom, [200, 210, 220])),
        Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "phong")),
        Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")),
        Action::Edit(Edit::from(Observer { position: Vec3::new(1.0, 2.0, 9.0), ..Observer::default() })),
        Action::Edit(Edit::set(Part::Light(0), Light::name, "lamp")),
        Action::Edit(Edit::set(Part::Light(0), Light::enabled, false)),
        Action::Edit(Edit::set(Part::Light(0), Light::light_type, "spot")),
        Action::Edit(Edit::set(Part::Light(0), Light::position, Vec3::new(2.0, 3.0, 4.0))),
        Action::Edit(Edit::set(Part::Light(0), Light::direction, Vec3::new(0.0, -1.0, 0.5))),
        Action::Edit(Edit::set(Part::Light(0), Light::colour, [200, 100, 50])),
        Action::Edit(Edit::set(Part::Light(0), Light::colour_temperature, 3000.0)),
        Action::Edit(Edit::set(Part::Light(0), Light::luminous_flux, 900.0)),
        Action::Edit(Edit::set(Part::Light(0), Light::intensity, 70.0)),
        Action::Edit(Edit::parameter(Part::Light(0), "cone_angle", Value::Number(20.0))),
        Action::Edit(Edit::set(Part::Object(0), Object::name, "ball")),
        Action::Edit(Edit::set(Part::Object(0), Object::visible, false)),
        Action::Edit(Edit::set(Part::Object(0), Object::object_type, "torus")),
        Action::Edit(Edit::parameter(Part::Object(0), "tube_radius", Value::Number(0.1))),
        Action::Edit(Edit::set(Part::Object(0), Object::position, Vec3::new(4.0, 4.0, 4.0))),
        Action::Edit(Edit::set(Part::Object(0), Object::size, 1.25)),
        Action::Edit(Edit::set(Part::Object(0), Object::rotation, Vec3::new(10.0, 20.0, 30.0))),
        Action::Edit(Edit::set(Part::Object(0), Object::tessellation, 48)),
        Action::Edit(Edit::set(Part::Object(0), Object::reflection_model, "ward")),
        Action::Edit(Edit::set(Part::Object(0), Object::shading_model, "gouraud")),
        Action::Edit(Edit::material(Part::Object(0), "alpha", Value::Integer(17))),
        Action::Edit(Edit::materials(
            Part::Object(0),
            vec![("k_s", Value::Number(0.25)), ("k_d", Value::Number(0.625))],
            "Measured material",
        )),
        Action::AddLight("directional".to_owned()),
        Action::AddObject("cube".to_owned()),
        Action::Duplicate(Selection::Object(0)),
        Action::Duplicate(Selection::Light(0)),
        Action::Toggle(Selection::Object(1)),
        Action::Remove(Selection::Object(0)),
        Action::Remove(Selection::Light(0)),
        Action::Expose(0.5),
    ]
}

#[test]
fn every_change_is_a_step_that_is_undone_and_redone_exactly() {
    let registry = Registry::builtin();
    let mut session = Session::default();
    let mut states = vec![(session.document.scene().clone(), session.selection)];
    for action in changes() {
        let before = session.document.steps().len();
        let known = |session: &Session, i: usize| session.document.objects.get(i).is_some();
        assert!(known(&session, 0));
        session.apply(action.clone(), &registry);
        session.document.end_gesture();
        assert!(
            *session.document.scene() != states[states.len() - 1].0,
            "{action:?}: {:?}",
            session.messages
        );
        assert_eq!(session.document.steps().len(), before + 1, "{action:?}");
        assert!(check::scene(&session.document, &registry).is_empty(), "{action:?}");
        states.push((session.document.scene().clone(), session.selection));
    }
    let names: Vec<_> = session.document.steps().map(str::to_owned).collect();
    assert!(names.iter().all(|name| !name.is_empty()), "{names:?}");
    assert!(names.contains(&"Intensity of lamp".to_owned()), "{names:?}");
    assert!(names.contains(&"Add Cube 1".to_owned()), "{names:?}");
    for (scene, _) in states.iter().rev().skip(1) {
        session.apply(Action::Undo, &registry);
        assert!(*scene == *session.document.scene(), "undoing {}", names[session.document.done()]);
        assert!(check::scene(&session.document, &registry).is_empty());
    }
    assert!(!session.is_dirty(), "as it was opened");
    session.apply(Action::Undo, &registry);
    assert!(session.messages.iter().any(|m| m.text == "There is nothing to undo."));
    for (scene, selection) in &states[1..] {
        session.apply(Action::Redo, &registry);
        assert!(*scene == *session.document.scene(), "redoing {}", names[session.document.done() - 1]);
        assert_eq!(*selection, session.selection);
    }
    session.apply(Action::Redo, &registry);
    assert!(session.messages.iter().any(|m| m.text == "There is nothing to redo."));
    // Any number of steps in one jump.
    for at in [0, 7, states.len() - 1, 20] {
        session.apply(Action::GoToStep(at), &registry);
        assert!(states[at].0 == *session.document.scene(), "{at}");
    }
    // Another change replaces what was undone.
    session.apply(Action::Expose(0.25), &registry);
    assert_eq!((session.document.done(), session.document.steps().len()), (21, 21));
}

#[test]
fn what_was_selected_comes_back() {
    let registry = Registry::builtin();
    let mut session = Session::default();
    session.apply(Action::AddObject("cube".to_owned()), &registry);
    session.apply(Action::Select(Selection::Light(0)), &registry);
    session.apply(Action::Edit(Edit::set(Part::Light(0), Light::intensity, 5.0)), &registry);
    session.apply(Action::Select(Selection::Room), &registry);
    session.apply(Action::Undo, &registry);
    assert_eq!(session.selection, Selection::Light(0));
    session.apply(Action::Undo, &registry);
    assert_eq!(session.selection, Selection::Object(0));
    session.apply(Action::Redo, &registry);
    assert_eq!(session.selection, Selection::Object(1), "the cube");
    session.apply(Action::Remove(Selection::Object(1)), &registry);
    session.apply(Action::Undo, &registry);
    assert_eq!(session.selection, Selection::Object(1));
}

#[test]
fn parts_keep_their_ids_when_others_come_and_go_and_when_they_come_back() {
    let registry = Registry::builtin();
    let mut session = Session::new(Scene {
        objects: (0..5).map(|i| Object { size: 0.5 + 0.1 * i as f32, ..Object::default() }).collect(),
        ..Scene::default()
    });
    let ids = |session: &Session| {
        (0..session.document.objects.len()).map(|i| session.document.object_id(i)).collect::<Vec<_>>()
    };
    let first = ids(&session);
    session.apply(Action::Remove(Selection::Object(1)), &registry);
    assert_eq!(ids(&session), [first[0], first[2], first[3], first[4]]);
    session.apply(Action::Duplicate(Selection::Object(0)), &registry);
    let copied = ids(&session);
    assert_eq!(copied.len(), 5);
    assert!(!first.contains(&copied[1]), "a new part has a new id");
    session.apply(Action::GoToStep(0), &registry);
    assert_eq!(ids(&session), first);
    session.apply(Action::GoToStep(2), &registry);
    assert_eq!(ids(&session), copied);
    // Another version of the file: the objects in another order, one removed, one changed, one new.
    session.apply(Action::GoToStep(0), &registry);
    let mut scene = session.document.scene().clone();
    scene.objects.swap(0, 4);
    scene.objects.remove(2);
    scene.objects.push(Object { object_type: "cube".to_owned(), ..Object::default() });
    session.document.replace("Reload from disk", Selection::Room, scene, &registry);
    assert_eq!(ids(&session)[..4], [first[4], first[1], first[3], first[0]]);
    session.apply(Action::Undo, &registry);
    assert_eq!(ids(&session), first);
}

#[test]
fn a_gesture_is_one_step_and_one_that_leads_nowhere_is_none() {
    let registry = Registry::builtin();
    let mut session = Session::default();
    let size = |session: &mut Session, v: f32| {
        session.apply(Action::Edit(Edit::set(Part::Object(0), Object::size, v)), &registry)
    };
    for i in 1..10 {
        size(&mut session, 2.0 - 0.1 * i as f32);
    }
    assert_eq!(session.document.steps().collect::<Vec<_>>(), ["Size of Sphere 1"]);
    session.apply(Action::Undo, &registry);
    assert_eq!(session.document.objects[0].size, 2.0);
    session.apply(Action::Redo, &registry);
    assert!((session.document.objects[0].size - 1.1).abs() < 1e-6);
    // Another gesture is another step; there and back again is none.
    size(&mut session, 1.5);
    session.document.end_gesture();
    assert_eq!(session.document.steps().len(), 2);
    size(&mut session, 1.75);
    size(&mut session, 1.5);
    assert_eq!(session.document.steps().len(), 2);
    // Setting the same value again is not a change.
    session.document.end_gesture();
    size(&mut session, 1.5);
    assert_eq!(session.document.steps().len(), 2);
}

#[test]
fn history_outlives_saving_and_reading_the_file_again_but_not_another_document() {
    let registry = Registry::builtin();
    let mut session = Session::default();
    let path = PathBuf::from("room.json");
    let _ = session.opened(path.clone(), Scene::default());
    session.apply(Action::Expose(1.0), &registry);
    session.document.end_gesture();
    let _ = session.saved(path, &registry);
    assert!(!session.is_dirty());
    session.apply(Action::Undo, &registry);
    assert!(session.is_dirty() && session.document.display.exposure == 0.0);
    session.apply(Action::Redo, &registry);
    assert!(!session.is_dirty(), "as it was saved");
    let mut edited = session.document.scene().clone();
    edited.reflection_model = "phong".to_owned();
    session.document.set_saved(edited.clone());
    session.document.replace("Reload from disk", session.selection, edited, &registry);
    session.apply(Action::Undo, &registry);
    assert_eq!(session.document.reflection_model, "lambert");
    session.apply(Action::Undo, &registry);
    assert_eq!(session.document.display.exposure, 0.0);
    session.apply(Action::New, &registry);
    session.apply(Action::Answer(lights_camera_models::panel::state::Answer::Discard), &registry);
    assert_eq!(session.document.steps().len(), 0);
}

#[test]
fn history_is_bounded() {
    let registry = Registry::builtin();
    let mut document = Document::new(Scene::default());
    for i in 0..2000 {
        document.change(format!("Step {i}"), Extent::Rest, Selection::Room, |s| {
            s.display.exposure = i as f32 * 1e-3
        });
    }
    assert_eq!(document.steps().len(), 500);
    assert_eq!(document.steps().last(), Some("Step 1999"));
    // A step that changes all of ten thousand objects stores twenty thousand.
    let mut document = Document::new(Scene { objects: vec![Object::default(); 10_000], ..Scene::default() });
    for i in 0..40 {
        let size = 0.5 + 0.01 * i as f32;
        document.change(format!("Step {i}"), Extent::All, Selection::Room, |s| {
            s.objects.iter_mut().for_each(|o| o.size = size);
        });
    }
    assert_eq!(document.steps().len(), 10);
    // The first objects all have one position, which is allowed.
    assert!(check::scene(&document, &registry).is_empty());
}

#[test]
fn a_component_that_a_system_changes_is_checked_and_a_step() {
    let registry = Registry::builtin();
    let mut session = Session::default();
    for i in 0..50 {
        let mut scene = session.document.scene().clone();
        scene.lights[0].intensity = 10.0 + i as f32;
        assert_eq!(session.submit(&scene, &[Extent::All], &registry), Ok(()));
    }
    assert_eq!(
        session.document.steps().collect::<Vec<_>>(),
        ["Change by a system"],
        "an animation is one step"
    );
    let good = session.document.scene().clone();
    let mut scene = good.clone();
    scene.objects[0].size = -1.0;
    let why = session.submit(&scene, &[Extent::All], &registry).expect_err("a size is above 0");
    assert!(why.contains("size"), "{why}");
    assert!(*session.document.scene() == good);
    session.apply(Action::Undo, &registry);
    assert!(*session.document.scene() == Scene::default());
}

#[test]
fn keys_menu_and_list_take_steps_back_and_forth() {
    let mut bench = Bench::new(Session::default());
    bench.frame(Vec::new());
    bench.apply(Action::AddObject("cube".to_owned()));
    bench.apply(Action::Expose(1.0));
    let objects =
        |bench: &Bench| (bench.session.document.objects.len(), bench.session.document.display.exposure);
    assert_eq!(objects(&bench), (2, 1.0));
    bench.key(Key::Z, Modifiers::COMMAND);
    assert_eq!(objects(&bench), (2, 0.0));
    bench.key(Key::Z, Modifiers::COMMAND);
    assert_eq!(objects(&bench), (1, 0.0));
    bench.key(Key::Z, Modifiers::COMMAND | Modifiers::SHIFT);
    assert_eq!(objects(&bench), (2, 0.0));
    bench.key(Key::Y, Modifiers::COMMAND);
    assert_eq!(objects(&bench), (2, 1.0));
    bench.click("Edit");
    bench.settle();
    assert!(bench.find("Undo “Exposure” Ctrl+Z").is_some());
    bench.click("Undo “Exposure” Ctrl+Z");
    bench.settle();
    assert_eq!(objects(&bench), (2, 0.0));
    bench.click("Edit");
    bench.settle();
    assert!(
        bench.find("Undo “Add Cube 1” Ctrl+Z").is_some()
            && bench.find("Redo “Exposure” Ctrl+Shift+Z").is_some()
    );
    bench.click("History… ");
    bench.settle();
    bench.click("Scene as it was opened");
    bench.settle();
    assert_eq!(objects(&bench), (1, 0.0));
    bench.click("Exposure");
    bench.settle();
    assert_eq!(objects(&bench), (2, 1.0));
}

#[test]
fn a_drag_of_a_knob_is_one_step() {
    let mut bench = Bench::with_model("phong");
    bench.frame(Vec::new());
    let slider = bench
        .tree
        .iter()
        .find(|s| s.role == bevy_egui::egui::accesskit::Role::Slider && s.label == "shininess");
    let at = slider.expect("there is a slider").rect.left_center() + vec2(20.0, 0.0);
    let exponent = |bench: &Bench| bench.session.document.objects[0].material.0.get("alpha").cloned();
    let before = exponent(&bench);
    let drag = |bench: &mut Bench, from: f32| {
        let press = |pos, pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let at = at + vec2(from, 0.0);
        bench.hover(at);
        bench.frame(vec![press(at, true)]);
        for k in 1..12 {
            bench.hover(at + vec2(2.0 * k as f32, 0.0));
        }
        bench.frame(vec![press(at + vec2(24.0, 0.0), false)]);
        bench.settle();
    };
    let steps = |bench: &Bench| bench.session.document.steps().map(str::to_owned).collect::<Vec<_>>();
    drag(&mut bench, 0.0);
    let between = exponent(&bench);
    assert!(between != before, "the drag changes it");
    assert_eq!(steps(&bench), ["Shininess of Sphere 1"]);
    // The slider still has the focus.
    drag(&mut bench, 24.0);
    assert!(exponent(&bench) != between, "the second drag changes it");
    assert_eq!(steps(&bench), ["Shininess of Sphere 1"; 2]);
    bench.key(Key::Z, Modifiers::COMMAND);
    assert_eq!(exponent(&bench), between);
    bench.key(Key::Z, Modifiers::COMMAND);
    assert_eq!(exponent(&bench), before);
}

#[test]
fn names_that_only_the_file_has_are_none_of_the_document() {
    let registry = Registry::builtin();
    let ball = |i: u8| Object { position: Vec3::splat(f32::from(i)), ..Object::default() };
    let mut document = Document::new(Scene { objects: (1..=4).map(ball).collect(), ..Scene::default() });
    let parts = |document: &Document| -> Vec<_> {
        let name = |i| document.name_of(Selection::Object(i), &registry);
        (0..document.objects.len()).map(|i| (document.object_id(i), name(i))).collect()
    };
    document.remove(Selection::Object(0), &registry);
    let before = parts(&document);
    assert_eq!(before.iter().map(|part| &*part.1).collect::<Vec<_>>(), ["Sphere 2", "Sphere 3", "Sphere 4"]);
    let file = document.named(&registry);
    assert_eq!(file.objects[0].name.as_deref(), Some("Sphere 2"));
    assert!(file != *document.scene() && !document.was_saved_as(&file));
    document.mark_saved(&registry);
    assert!(document.was_saved_as(&file) && !document.was_saved_as(document.scene()));
    // The file is read again, with the parts in another order, one of them changed, and a new one.
    let mut edited = file.clone();
    edited.objects[0].size = 0.5;
    edited.objects.swap(0, 2);
    edited.objects.push(ball(5));
    document.replace("Reload from disk", Selection::Room, edited, &registry);
    let after = parts(&document);
    assert_eq!(after[..3], [before[2].clone(), before[1].clone(), before[0].clone()]);
    assert_eq!(after[3].1, "Sphere 5");
    assert!(document.objects.iter().all(|object| object.name.is_none()));
    document.undo();
    assert_eq!(parts(&document), before);
    assert!(*document.scene() == *document.saved() && !document.differs());
}

#[test]
fn undoing_leads_back_to_what_was_saved() {
    let registry = Registry::builtin();
    let mut document = Document::new(Scene::default());
    let size = |document: &mut Document, v| {
        document
            .edit(Edit::set(Part::Object(0), Object::size, v), Selection::Room, &registry)
            .expect("legal");
    };
    size(&mut document, 3.0);
    document.mark_saved(&registry);
    size(&mut document, 4.0);
    document.undo();
    assert!(!document.differs() && document.objects[0].size == 3.0);
}

#[test]
fn a_system_keeps_the_rules_of_room_models_and_display_and_the_selection() {
    let registry = Registry::builtin();
    let objects = (0..3).map(|i| Object { position: Vec3::splat(2.0 + i as f32), ..Object::default() });
    let mut session = Session::new(Scene { objects: objects.collect(), ..Scene::default() });
    let wrong: [fn(&mut Scene); 3] = [
        |s| s.reflection_model = "nonsense".to_owned(),
        |s| s.scene_size.width = 0.1,
        |s| s.display.exposure = 99.0,
    ];
    for wrong in wrong {
        for part in [Extent::All, Extent::Rest] {
            let mut scene = session.document.scene().clone();
            wrong(&mut scene);
            session.submit(&scene, &[part], &registry).expect_err("a rule is broken");
        }
    }
    assert_eq!(session.document.steps().len(), 0);
    session.apply(Action::Select(Selection::Object(1)), &registry);
    let mut scene = session.document.scene().clone();
    scene.objects.remove(0);
    session.submit(&scene, &[Extent::All], &registry).expect("legal");
    assert_eq!(session.selection, Selection::Object(0), "the same object");
    scene.objects.remove(0);
    session.submit(&scene, &[Extent::All], &registry).expect("legal");
    assert_eq!(session.selection, Selection::Room, "it is gone");
}

#[test]
fn a_light_of_any_type_becomes_any_other_and_is_valid_throughout() {
    let registry = Registry::builtin();
    // Others are where a lamp would hang.
    let default = Scene::default();
    let middle = (0.5 * default.scene_size.corner()).with_y(8.0);
    let objects = vec![Object { position: middle, ..Object::default() }, Object::default()];
    let mut document = Document::new(Scene { objects, ..default });
    let edit = |document: &mut Document, edit: Edit| {
        document.end_gesture();
        let before = document.scene().clone();
        document.edit(edit, Selection::Room, &registry).expect("legal");
        assert_eq!(check::scene(document, &registry), []);
        let after = document.scene().clone();
        document.undo().expect("a step");
        assert!(*document == before, "undoing");
        document.redo().expect("a step");
        assert!(*document == after, "redoing");
    };
    let mut turns = 0.0;
    for from in registry.lights() {
        for to in registry.lights().iter().filter(|to| to.declaration.id != from.declaration.id) {
            for entry in [from, to] {
                if document.lights[0].light_type == entry.declaration.id {
                    continue;
                }
                edit(
                    &mut document,
                    Edit::set(Part::Light(0), Light::light_type, entry.declaration.id.to_owned()),
                );
                for p in entry.parameters {
                    if let ParameterKind::Number(Number { min, .. }) = p.kind {
                        // Another value than the previous type may have left.
                        let known = document.lights[0].parameters.number(p);
                        let value = if known == min + 0.5 { min + 0.25 } else { min + 0.5 };
                        edit(&mut document, Edit::parameter(Part::Light(0), p.name, Value::Number(value)));
                    }
                }
                if entry.declaration.has_direction {
                    turns += 1.0;
                    let direction = Vec3::new(1.0, -2.0, turns);
                    edit(&mut document, Edit::set(Part::Light(0), Light::direction, direction));
                }
            }
        }
    }
    // A position that is taken, outside, or NaN, and a zero direction.
    for position in [middle, Vec3::splat(5.0), document.observer.position, Vec3::splat(99.0), Vec3::NAN] {
        for direction in [Vec3::ZERO, Vec3::NAN, Vec3::X] {
            for id in ["directional", "spot"] {
                let place = Some((position, direction));
                document.change_light_type(0, id, place, Selection::Room, &registry).expect("legal");
                assert_eq!(check::scene(&document, &registry), []);
            }
        }
    }
    // The others keep their names, and an unknown type is refused.
    document.insert_light(1, document.lights[0].clone(), "Add", Selection::Room, &registry);
    let name = document.name_of(Selection::Light(1), &registry);
    edit(&mut document, Edit::set(Part::Light(0), Light::light_type, "point"));
    assert_eq!(document.name_of(Selection::Light(1), &registry), name);
    let before = document.scene().clone();
    let unknown = Edit::set(Part::Light(0), Light::light_type, "laser");
    assert!(document.edit(unknown, Selection::Room, &registry).is_err());
    assert!(*document == before);
}

/// A scene built from the default one does not keep its name and description, and undoing restores both.
#[test]
fn the_words_of_the_default_scene_go_once_they_are_untrue() {
    let registry = Registry::builtin();
    let words = |session: &Session| (session.document.name.clone(), session.document.description.clone());
    let default = Scene::default();
    let both = (default.name.clone(), default.description.clone());
    let after = |actions: Vec<Action>| {
        let mut session = Session::new(Scene::default());
        session.document.end_gesture();
        for action in actions {
            session.apply(action, &registry);
        }
        session
    };
    // It still matches its name.
    let moved = after(vec![
        Action::Edit(Edit::set(Part::Object(0), Object::size, 3.0)),
        Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "phong")),
        Action::Edit(Edit::from(Display { exposure: 1.0, ..Display::default() })),
    ]);
    assert_eq!(words(&moved), both);
    // It is no longer matte.
    let shiny = after(vec![Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, "blinn_phong"))]);
    assert_eq!(words(&shiny), (both.0.clone(), None));
    assert_eq!(
        words(&after(vec![Action::Edit(Edit::set(Part::Light(0), Light::colour, [9, 9, 9]))])).1,
        None
    );
    // Nor does it have one light and one sphere.
    for actions in [
        vec![Action::AddObject("torus".to_owned())],
        vec![Action::AddLight("spot".to_owned())],
        vec![Action::Duplicate(Selection::Object(0))],
        vec![Action::Edit(Edit::set(Part::Object(0), Object::object_type, "teapot"))],
    ] {
        let mut session = after(actions.clone());
        assert_eq!(words(&session), (None, None), "{actions:?}");
        assert_eq!(session.title(), "Untitled scene");
        assert_eq!(session.document.steps().len(), 1, "{actions:?}");
        session.apply(Action::Undo, &registry);
        assert_eq!(words(&session), both, "{actions:?}");
        assert_eq!(*session.document, default);
        session.apply(Action::Redo, &registry);
        assert_eq!(words(&session), (None, None), "{actions:?}");
    }
    // A file keeps the name of its scene, and stays in the title.
    let mut session = Session::new(default.clone());
    session.path = Some("/scenes/default.json".into());
    session.apply(Action::AddObject("torus".to_owned()), &registry);
    assert_eq!(words(&session), (both.0.clone(), None));
    assert_eq!(session.window_title(), "Default scene — default.json");
    // The user's own words are kept.
    let own = Scene { name: Some("Mine".to_owned()), description: Some("Two.".to_owned()), ..default };
    let mut session = Session::new(own);
    session.apply(Action::AddObject("torus".to_owned()), &registry);
    assert_eq!(words(&session), (Some("Mine".to_owned()), Some("Two.".to_owned())));
}
