//! Several lights and objects at once: selecting, editing, copying, hiding and removing them, each as one step.

use glam::Vec3;
use lights_camera_models::{
    document::{Document, Edit, Selection},
    panel::state::{Action, Alike, Arrangement, CompareCommand, Session, Together},
    parameter::Value,
    registry::Registry,
    scene::{Key, Light, Object, Part, Scene},
};

use Selection::{Light as L, Object as O};

/// Objects in a line, of two types by turns.
fn objects(count: usize) -> Vec<Object> {
    let object = |i: usize| Object {
        object_type: ["sphere", "cube"][i % 2].to_owned(),
        position: Vec3::new(1.0 + 0.5 * i as f32, 4.0, 5.0),
        size: 0.4,
        ..Object::default()
    };
    (0..count).map(object).collect()
}

struct Window {
    session: Session,
    registry: Registry,
}

impl Window {
    fn new(count: usize) -> Self {
        let mut scene = Scene { objects: objects(count), ..Scene::default() };
        let second = Light { position: Some(Vec3::new(2.2, 9.0, 2.0)), ..scene.lights[0].clone() };
        scene.lights.push(second);
        Self { session: Session::new(scene), registry: Registry::builtin() }
    }

    fn act(&mut self, action: Action) {
        self.session.apply(action, &self.registry);
    }

    fn select(&mut self, parts: &[Selection]) {
        self.act(Action::SelectEach(parts.to_vec(), false));
    }

    fn document(&self) -> &Document {
        &self.session.document
    }

    fn said(&self) -> String {
        self.session.messages.iter().last().map(|note| note.text.clone()).unwrap_or_default()
    }

    fn visible(&self) -> Vec<bool> {
        self.document().objects.iter().map(|object| object.visible).collect()
    }

    /// Applies an action, which must be one step, undone by one and redone by one.
    fn one_step(&mut self, action: Action) {
        let (before, steps, group) =
            (self.document().scene().clone(), self.document().done(), self.session.group());
        self.act(action.clone());
        let (after, selected) = (self.document().scene().clone(), self.session.group());
        assert_ne!(before, after, "{action:?} changes nothing: {}", self.said());
        assert_eq!(self.document().done(), steps + 1, "{action:?}");
        self.act(Action::Undo);
        assert_eq!(*self.document(), before, "{action:?}");
        assert_eq!(self.session.group(), group, "{action:?}: what was selected");
        self.act(Action::Redo);
        assert_eq!(*self.document(), after, "{action:?}");
        assert_eq!(self.session.group(), selected, "{action:?}: what is selected");
    }
}

#[test]
fn parts_are_added_taken_out_and_selected_by_ranges() {
    let mut window = Window::new(6);
    assert_eq!(window.session.group(), [O(0)]);
    window.act(Action::SelectAlso(O(3)));
    window.act(Action::SelectAlso(L(1)));
    assert_eq!(window.session.group(), [L(1), O(0), O(3)]);
    assert_eq!((window.session.selection, window.session.name_of_group()), (O(0), "3 parts".to_owned()));
    assert!(window.session.is_selected(O(3)) && !window.session.is_selected(O(1)));
    window.act(Action::SelectAlso(O(0)));
    assert_eq!(window.session.group(), [L(1), O(3)]);
    window.act(Action::SelectAlso(L(1)));
    window.act(Action::SelectAlso(O(3)));
    assert_eq!(window.session.group(), [O(3)], "one stays");
    window.act(Action::SelectRange(O(1)));
    assert_eq!((window.session.group(), window.session.selection), (vec![O(1), O(2), O(3)], O(3)));
    window.act(Action::SelectRange(O(5)));
    assert_eq!(window.session.group(), [O(3), O(4), O(5)], "from the first one again");
    window.act(Action::SelectRange(L(1)));
    assert_eq!(window.session.group(), [L(1), O(0), O(1), O(2), O(3)]);
    window.act(Action::Select(O(2)));
    assert_eq!(window.session.group(), [O(2)]);
    // What does not exist, and what cannot be one of several.
    window.act(Action::SelectAlso(O(99)));
    window.act(Action::SelectEach(vec![O(99), Selection::Room], false));
    assert_eq!(window.session.group(), [O(2)]);
    window.act(Action::SelectAlso(O(1)));
    window.act(Action::SelectAlso(Selection::Observer));
    assert_eq!(window.session.group(), []);
}

#[test]
fn parts_are_selected_by_kind_type_and_model() {
    let mut window = Window::new(5);
    window.act(Action::SelectAlike(Alike::Type));
    assert_eq!(window.session.group(), [O(0), O(2), O(4)]);
    window.act(Action::SelectAlike(Alike::Kind));
    assert_eq!(window.session.group().len(), 5);
    window.act(Action::Select(O(1)));
    window.act(Action::Edit(Edit::set(Part::Object(1), Object::reflection_model, "ward")));
    window.act(Action::SelectAlike(Alike::Model));
    assert_eq!(window.session.group(), [O(1)]);
    window.act(Action::Select(O(3)));
    window.act(Action::SelectAlike(Alike::Model));
    assert_eq!(window.session.group(), [O(0), O(2), O(3), O(4)]);
    window.act(Action::Select(L(1)));
    window.act(Action::SelectAlike(Alike::Kind));
    assert_eq!(window.session.group(), [L(0), L(1)]);
    // Of both kinds, all of both, whichever is the first.
    for parts in [[L(1), O(3)], [O(3), L(1)]] {
        window.act(Action::Select(parts[0]));
        window.act(Action::SelectAlso(parts[1]));
        window.act(Action::SelectAlike(Alike::Kind));
        assert_eq!(window.session.group(), [L(0), L(1), O(0), O(1), O(2), O(3), O(4)]);
        assert_eq!(window.session.selection, parts[0]);
    }
}

#[test]
fn each_action_on_several_is_one_step() {
    let mut window = Window::new(6);
    window.select(&[O(1), O(3), O(4), L(1)]);
    window.one_step(Action::Nudge(Vec3::Y));
    window.one_step(Action::Toggle(O(3)));
    assert_eq!(window.visible(), [true, false, true, false, false, true]);
    assert!(!window.document().lights[1].enabled && window.document().lights[0].enabled);
    window.one_step(Action::Toggle(O(3)));
    assert!(window.visible().iter().all(|on| *on));
    window.one_step(Action::HideOthers);
    assert_eq!(window.visible(), [false, true, false, true, true, false]);
    window.one_step(Action::ShowAll);
    assert!(window.visible().iter().all(|on| *on));
    window.one_step(Action::Arrange(Arrangement::Low, 1));
    window.one_step(Action::Arrange(Arrangement::Apart, 0));
    let formation = |window: &Window| -> Vec<Vec3> {
        let group = window.session.group();
        let place = |part: &Selection| match part {
            L(i) => window.document().lights[*i].position.expect("a place"),
            O(i) => window.document().objects[*i].position,
            _ => panic!("{part:?}"),
        };
        let first = place(&group[0]);
        group.iter().map(|part| place(part) - first).collect()
    };
    let before = formation(&window);
    window.one_step(Action::Duplicate(O(1)));
    assert_eq!((window.document().objects.len(), window.document().lights.len()), (9, 3));
    assert_eq!(window.session.group(), [L(2), O(6), O(7), O(8)], "the copies are selected");
    for (from, to) in before.iter().zip(formation(&window)) {
        assert!(from.distance(to) < 1e-4, "{from} and {to}");
    }
    window.one_step(Action::Remove(O(7)));
    assert_eq!((window.document().objects.len(), window.document().lights.len()), (6, 2));
    assert_eq!(window.session.group().len(), 1);
    // A single part alone, though several are selected.
    window.select(&[O(1), O(3)]);
    window.act(Action::Remove(O(5)));
    assert_eq!(window.document().objects.len(), 5);
}

#[test]
fn the_last_light_and_the_last_object_stay() {
    let mut window = Window::new(3);
    window.act(Action::SelectAlike(Alike::Kind));
    window.act(Action::Remove(O(0)));
    assert_eq!(window.document().objects.len(), 3);
    assert!(window.said().contains("all objects"), "{}", window.said());
    window.select(&[L(0), L(1), O(0)]);
    window.act(Action::Remove(O(0)));
    assert_eq!((window.document().objects.len(), window.document().lights.len()), (3, 2));
}

#[test]
fn an_edit_of_several_is_made_in_all_or_in_none() {
    let mut window = Window::new(4);
    let each = |value: fn(usize) -> f32| Edit::Each {
        edits: (0..4).map(|i| Edit::set(Part::Object(i), Object::size, value(i))).collect(),
        step: "Sizes".to_owned(),
    };
    let before = window.document().scene().clone();
    window.act(Action::Edit(each(|i| if i == 2 { -1.0 } else { 0.8 })));
    assert_eq!(*window.document(), before);
    assert!(window.said().contains("size"), "{}", window.said());
    assert!(!window.document().allows(&each(|i| i as f32 - 2.0), &window.registry));
    assert!(window.document().allows(&each(|_| 0.7), &window.registry));
    window.one_step(Action::Edit(each(|i| 0.5 + 0.1 * i as f32)));
    // They meet each other as they will be: an object takes the place that a light leaves, and not that where it goes.
    let (light, object) = (window.document().lights[0].position.expect("a place"), Vec3::new(3.0, 3.0, 3.0));
    let swapped = |light_to: Vec3, object_to: Vec3| Edit::Each {
        edits: vec![
            Edit::set(Part::Light(0), Light::position, light_to),
            Edit::set(Part::Object(0), Object::position, object_to),
        ],
        step: "Places".to_owned(),
    };
    assert!(!window.document().allows(&swapped(object, object), &window.registry));
    assert!(!window.document().allows(&swapped(light, light), &window.registry));
    window.one_step(Action::Edit(swapped(object, light)));
    // Types, with the numbers of names.
    let cubes = Edit::Each {
        edits: (0..4).map(|i| Edit::set(Part::Object(i), Object::object_type, "cube")).collect(),
        step: "Cubes".to_owned(),
    };
    window.one_step(Action::Edit(cubes));
    let names: std::collections::BTreeSet<_> =
        (0..4).map(|i| window.document().name_of(O(i), &window.registry)).collect();
    assert!(names.len() == 4 && names.iter().all(|name| name.starts_with("Cube")), "{names:?}");
}

#[test]
fn drags_of_several_are_one_step_from_first_to_last() {
    let mut window = Window::new(4);
    window.act(Action::SelectAlike(Alike::Kind));
    let room = window.document().scene_size;
    let all = Together::of(&window.session, &window.registry).expect("several");
    let start: Vec<_> = window.document().objects.iter().map(|object| object.position).collect();
    window.act(Action::BeginDrag);
    for k in 1..=5 {
        window.act(Action::Edit(all.moved(0.1 * k as f32 * Vec3::Z, room)));
    }
    assert_eq!(window.document().done(), 1);
    for (object, from) in window.document().objects.iter().zip(&start) {
        assert!(object.position.distance(*from + 0.5 * Vec3::Z) < 1e-4);
    }
    // Back where they were, as Escape does, there is no step.
    window.act(Action::Edit(all.moved(Vec3::ZERO, room)));
    assert_eq!(window.document().done(), 0);
}

#[test]
fn copies_of_a_row_follow_the_one_that_is_selected_with_others() {
    let mut window = Window::new(3);
    window.act(Action::MakeRow(O(1)));
    let row = window.document().row(1).expect("a row");
    let copies = row.range();
    assert!(copies.len() > 2, "{copies:?}");
    let count = window.document().objects.len();
    window.act(Action::SelectAlike(Alike::Kind));
    assert_eq!((window.session.group().len(), window.session.entries().len()), (count, 3));
    window.one_step(Action::Toggle(O(0)));
    assert!(window.visible().iter().all(|on| !on));
    window.one_step(Action::ShowAll);
    let at: Vec<_> = window.document().objects.iter().map(|object| object.position).collect();
    window.one_step(Action::Nudge(Vec3::Y));
    for (object, from) in window.document().objects.iter().zip(&at) {
        assert!(object.position.distance(*from + 0.1 * Vec3::Y) < 1e-4, "{from}");
    }
    assert!(window.document().row(1).is_some(), "it is a row still");
    window.select(&[O(copies.start), O(0)]);
    window.one_step(Action::Remove(O(0)));
    assert_eq!(window.document().objects.len(), 1);
}

#[test]
fn in_another_view_a_material_is_that_of_the_view() {
    let mut window = Window::new(3);
    window.act(Action::Compare(CompareCommand::Add));
    window.act(Action::Compare(CompareCommand::Activate(1)));
    assert_eq!(window.session.active(), 1);
    window.act(Action::SelectAlike(Alike::Kind));
    let before = window.document().objects.clone();
    let edits = (0..3).map(|i| Edit::material(Part::Object(i), "k_d", Value::Number(0.75))).collect();
    window.one_step(Action::Edit(Edit::Each { edits, step: "k_d".to_owned() }));
    assert_eq!(window.document().objects, before, "the scene itself");
    let variant = &window.document().variants[0];
    assert_eq!(variant.material.0.get("k_d"), Some(&Value::Number(0.75)));
    // What a view cannot change alone is the scene's.
    window.one_step(Action::Nudge(Vec3::Y));
    assert_ne!(window.document().objects, before);
}

#[test]
fn keys_of_edits_are_those_of_each_part() {
    // A value that no model has is refused with the name of the part.
    let mut window = Window::new(2);
    let edits = (0..2).map(|i| Edit::set(Part::Object(i), Key::Own("no_such"), 1.0)).collect();
    window.act(Action::Edit(Edit::Each { edits, step: "Nothing".to_owned() }));
    assert_eq!(window.document().done(), 0);
    let nested =
        Edit::Each { edits: vec![Edit::Each { edits: vec![], step: String::new() }], step: String::new() };
    window.act(Action::Edit(nested));
    assert!(window.said().contains("several"), "{}", window.said());
    let room = Edit::Each { edits: vec![Edit::set(Part::Size, Key::Own("width"), 5.0)], step: String::new() };
    window.act(Action::Edit(room));
    assert_eq!(window.document().done(), 0);
}

#[test]
fn a_model_chosen_at_the_top_is_that_of_all_selected_objects_and_materials_go_along() {
    let mut window = Window::new(3);
    window.act(Action::ChooseModel("disney".to_owned()));
    for i in [0, 1] {
        window.act(Action::Edit(Edit::material(Part::Object(i), "clearcoat", Value::Number(0.5))));
    }
    window.select(&[O(0), O(1)]);
    window.one_step(Action::ChooseModel("openpbr".to_owned()));
    let models: Vec<_> = window.document().objects.iter().map(|o| o.reflection_model.as_deref()).collect();
    assert_eq!(models, [Some("openpbr"), Some("openpbr"), None]);
    assert_eq!(window.document().reflection_model, "disney", "the scene keeps its model");
    assert_eq!(window.session.model_shown(), "openpbr");
    let coat =
        |window: &Window, i: usize| window.document().objects[i].material.0.get("coat_weight").cloned();
    let expected = [Some(Value::Number(0.125)), Some(Value::Number(0.125)), None];
    assert_eq!([0, 1, 2].map(|i| coat(&window, i)), expected);
    assert!(window.said().contains("clear coat becomes coat"), "{}", window.said());
    // A single object without a model of its own follows the scene, which gets the model.
    window.act(Action::Select(O(2)));
    window.act(Action::ChooseModel("phong".to_owned()));
    assert_eq!(window.document().reflection_model, "phong");
}
