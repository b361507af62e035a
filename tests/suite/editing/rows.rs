//! Rows in the window: made, edited as one, undone in one step, and broken up.

use bevy_egui::egui::{Event, Key, Modifiers, PointerButton, Shape, accesskit::Role, vec2};
use glam::Vec3;
use lights_camera_models::{
    document::{Document, Edit, Selection},
    panel::{
        command::all,
        state::{Action, CompareCommand, Session, ViewChange},
        theme,
    },
    parameter::Value,
    registry::Registry,
    scene::{
        Background, Display, Light, Object, Part, Repeat, Repetition, Scene, SceneSize, Varied, check,
        rows::Row,
    },
};

use crate::{
    helpers::support::{read, written},
    window::panels::{Bench, Seen},
};

fn varied() -> Varied {
    Varied { parameter: "material.roughness".to_owned(), from: Some(0.1), to: Some(0.9), ..Varied::default() }
}

fn entry(repeat: Repeat) -> Object {
    Object {
        name: Some("ball".to_owned()),
        position: Vec3::new(2.0, 5.0, 5.0),
        size: 1.0,
        repeat: Repetition::Entry(Box::new(repeat)),
        ..Object::default()
    }
}

/// A cube, a row of five, and another cube.
fn scene() -> Scene {
    let cube = |x: f32| Object {
        object_type: "cube".to_owned(),
        position: Vec3::new(x, 2.0, 5.0),
        size: 1.0,
        ..Object::default()
    };
    let row =
        Repeat { columns: 5, spacing: Vec3::new(1.5, 0.0, 0.0), vary: vec![varied()], ..Repeat::default() };
    let scene = Scene {
        reflection_model: "metallic_roughness".to_owned(),
        objects: vec![cube(3.0), entry(row), cube(7.0)],
        ..Scene::default()
    };
    scene.expanded(&Registry::builtin()).expect("the row is legal")
}

fn document() -> Document {
    Document::new(scene())
}

fn row(document: &Document) -> Row<'_> {
    document.row(1).expect("the row is there")
}

/// The edit of the row through one of its copies.
fn changed(document: &Document, object: usize, change: impl FnOnce(&mut Repeat)) -> Edit {
    let row = document.row(object).expect("a copy");
    let mut repeat = row.repeat.clone();
    change(&mut repeat);
    let repeat = Repetition::Entry(Box::new(repeat));
    Edit::Row { object, entry: Some(Box::new(Object { repeat, ..row.entry.clone() })), what: "Number" }
}

fn roughness(document: &Document) -> Vec<Option<Value>> {
    document.objects.iter().map(|o| o.material.0.get("roughness").cloned()).collect()
}

#[test]
fn a_value_set_for_one_copy_is_set_for_all_in_one_step() {
    let registry = Registry::builtin();
    let mut document = document();
    let before = document.scene().clone();
    let edit = Edit::material(Part::Object(3), "metallic", Value::Number(0.5));
    document.edit(edit, Selection::Object(3), &registry).expect("it may be set");
    assert!((1..6).all(|i| document.objects[i].material.0["metallic"] == Value::Number(0.5)));
    assert!(document.objects[0].material.0.is_empty() && document.objects[6].material.0.is_empty());
    assert_eq!(row(&document).entry.material.0["metallic"], Value::Number(0.5));
    assert_eq!(document.steps().collect::<Vec<_>>(), ["Metallic of ball"]);
    assert_eq!(read(&written(&document)), *document.scene());
    document.undo();
    assert!(*document.scene() == before);
    document.redo();
    assert_eq!(document.objects[5].material.0["metallic"], Value::Number(0.5));
}

#[test]
fn a_row_moves_as_one_of_its_copies_does_and_is_renamed_as_one() {
    let registry = Registry::builtin();
    let mut document = document();
    let part = Part::Object(2);
    let to = document.objects[2].position + Vec3::new(0.0, 1.0, 0.0);
    document.edit(Edit::set(part, Object::position, to), Selection::Room, &registry).expect("there is room");
    assert!((1..6).all(|i| document.objects[i].position.y == 6.0));
    assert_eq!(document.objects[2].position, to);
    document.edit(Edit::set(part, Object::name, "kugel 2"), Selection::Room, &registry).expect("a name");
    let names: Vec<_> = document.objects[1..6].iter().map(|o| o.name.clone().unwrap_or_default()).collect();
    assert_eq!(names, ["kugel 1", "kugel 2", "kugel 3", "kugel 4", "kugel 5"]);
    // Out of the room, for the last copy alone.
    let far = document.objects[2].position + Vec3::new(2.5, 0.0, 0.0);
    let said = document.edit(Edit::set(part, Object::position, far), Selection::Room, &registry);
    let said = said.expect_err("copy 5 would be outside");
    assert!(said.starts_with("Copy 5 of kugel: position is [10.5, 6, 5], but a position must be"), "{said}");
    assert!(!document.allows(&Edit::set(part, Object::position, far), &registry));
}

#[test]
fn a_value_that_varies_is_changed_by_its_range() {
    let registry = Registry::builtin();
    let mut document = document();
    let edit = Edit::material(Part::Object(3), "roughness", Value::Number(0.5));
    let said = document.edit(edit, Selection::Room, &registry).expect_err("it varies");
    assert_eq!(said, "Roughness differs from copy to copy: change it under “Row”.");
    let edit = changed(&document, 3, |row| row.vary[0].to = Some(0.5));
    document.edit(edit, Selection::Room, &registry).expect("a range");
    let expected = [0.1, 0.2, 0.3, 0.4, 0.5].map(|v| Some(Value::Number(v)));
    assert_eq!(roughness(&document)[1..6], expected);
    let edit = changed(&document, 3, |row| row.vary[0].to = Some(1.5));
    let said = document.edit(edit, Selection::Room, &registry).expect_err("beyond its range");
    assert!(said.starts_with("Copy 4 of ball: material.roughness is 1.15, but "), "{said}");
}

#[test]
fn more_and_fewer_copies_are_one_step_and_the_others_keep_their_identity() {
    let registry = Registry::builtin();
    let mut document = document();
    let before = document.scene().clone();
    let ids = |document: &Document| -> Vec<_> {
        (0..document.objects.len()).map(|i| document.object_id(i).expect("there")).collect()
    };
    let known = ids(&document);
    for columns in [6, 3, 4] {
        let edit = changed(&document, 2, |row| row.columns = columns);
        document.edit(edit, Selection::Object(2), &registry).expect("there is room");
        assert_eq!(document.objects.len(), 2 + columns as usize);
        assert_eq!(document.object_id(1 + columns as usize), Some(known[6]), "the last cube");
        assert_eq!(ids(&document)[..4], known[..4]);
        assert_eq!(check::scene(&document, &registry), []);
    }
    assert_eq!(document.steps().len(), 1, "a drag of the knob is one step");
    assert_eq!(roughness(&document)[4], Some(Value::Number(0.9)));
    document.undo();
    assert!(*document.scene() == before);
    assert_eq!(ids(&document), known);
    document.redo();
    assert_eq!(document.objects.len(), 6);
    let edit = changed(&document, 2, |row| row.columns = 20_000);
    let said = document.edit(edit, Selection::Object(2), &registry).expect_err("too many");
    assert!(said.contains("20000 copies") && said.contains("at most 10000"), "{said}");
}

#[test]
fn single_objects_are_what_the_row_showed() {
    let registry = Registry::builtin();
    let mut document = document();
    let before = document.scene().clone();
    let edit = Edit::Row { object: 4, entry: None, what: "Single objects" };
    document.edit(edit.clone(), Selection::Object(4), &registry).expect("a row");
    assert!((0..7).all(|i| document.row(i).is_none()));
    for (old, new) in before.objects.iter().zip(&document.objects) {
        assert_eq!(Object { repeat: Repetition::None, ..old.clone() }, *new);
    }
    assert_eq!(read(&written(&document)).objects.len(), 7);
    assert!(document.edit(edit, Selection::Object(4), &registry).is_err(), "it is none any more");
    document.undo();
    assert!(*document.scene() == before);
    assert!(document.row(4).is_some());
}

#[test]
fn copies_are_deleted_and_hidden_as_one_and_duplicated_alone() {
    let registry = Registry::builtin();
    let mut session = Session::new(scene());
    session.apply(Action::Select(Selection::Object(3)), &registry);
    session.apply(Action::Toggle(Selection::Object(3)), &registry);
    assert_eq!(session.document.shown().count(), 2);
    session.apply(Action::Toggle(Selection::Object(3)), &registry);
    session.apply(Action::Duplicate(Selection::Object(3)), &registry);
    assert_eq!((session.document.objects.len(), session.selection), (8, Selection::Object(6)));
    assert_eq!(session.document.objects[6].repeat, Repetition::None);
    assert_eq!(session.document.row(1).map(|row| row.count), Some(5), "the row stays whole");
    session.apply(Action::Undo, &registry);
    session.apply(Action::Select(Selection::Object(6)), &registry);
    session.apply(Action::Remove(Selection::Object(2)), &registry);
    assert_eq!((session.document.objects.len(), session.selection), (2, Selection::Object(1)));
    session.apply(Action::Undo, &registry);
    assert_eq!(session.document.objects.len(), 7);
    // The last object cannot go, and neither can the last row.
    let mut session = Session::new(Scene { objects: scene().objects[1..6].to_vec(), ..scene() });
    session.apply(Action::Remove(Selection::Object(0)), &registry);
    assert_eq!(session.document.objects.len(), 5);
}

#[test]
fn the_selection_stays_at_its_copy_or_moves_to_the_first() {
    let registry = Registry::builtin();
    let mut session = Session::new(scene());
    session.apply(Action::Select(Selection::Object(5)), &registry);
    let edit = changed(&session.document, 5, |row| row.columns = 6);
    session.apply(Action::Edit(edit), &registry);
    assert_eq!(session.selection, Selection::Object(5));
    let edit = changed(&session.document, 5, |row| row.columns = 2);
    session.apply(Action::Edit(edit), &registry);
    assert_eq!(session.selection, Selection::Object(1), "not at the cube behind the row");
}

#[test]
fn a_new_row_fits_room_and_picture_and_varies_what_says_most() {
    let registry = Registry::builtin();
    let mut session =
        Session::new(Scene { reflection_model: "metallic_roughness".to_owned(), ..Scene::default() });
    let before = session.document.scene().clone();
    session.apply(Action::MakeRow(Selection::Object(0)), &registry);
    assert_eq!(session.document.objects.len(), 5, "{:?}", session.messages);
    let row = session.document.row(0).expect("a row");
    assert_eq!((row.repeat.columns, row.repeat.labels), (5, true));
    assert_eq!(row.repeat.vary, [varied()]);
    assert_eq!(check::scene(&session.document, &registry), []);
    let [first, last] = [0, 4].map(|i| session.document.objects[i].position.x);
    assert!((first + last - 10.0).abs() < 1e-3 && first < last, "around its place: {first}, {last}");
    // Seen from x = 5, 4.5 m away, at 45° and 16:9: all of it, with a margin, but not lost in the picture.
    let half = 4.5 * 22.5f32.to_radians().tan() * 16.0 / 9.0;
    assert!(last + 0.5 * session.document.objects[4].size <= 5.0 + half);
    let (side, reach) = (last - 5.0, 0.5 * session.document.objects[4].size);
    let silhouette = 4.5 * ((side / 4.5).atan() + (reach / side.hypot(4.5)).asin()).tan();
    assert!((0.75..0.9).contains(&(silhouette / half)), "{silhouette} of {half}");
    assert!(session.messages.iter().any(|note| note.text.contains("smaller")));
    session.apply(Action::Undo, &registry);
    assert!(*session.document.scene() == before, "one undo");
    // In a small room.
    let size = SceneSize { width: 1.0, height: 1.0, depth: 1.0 };
    let mut small = Scene { scene_size: size, ..Scene::default() };
    small.observer.position = Vec3::new(0.5, 0.5, 0.95);
    small.lights[0] = Light { position: Some(Vec3::new(0.9, 0.9, 0.9)), ..Light::default() };
    small.objects[0] = Object { position: Vec3::new(0.2, 0.5, 0.3), size: 0.2, ..Object::default() };
    let mut session = Session::new(small);
    session.apply(Action::MakeRow(Selection::Object(0)), &registry);
    assert_eq!(session.document.objects.len(), 5, "{:?}", session.messages);
    session.apply(Action::MakeRow(Selection::Room), &registry);
    session.apply(Action::MakeRow(Selection::Object(2)), &registry);
    assert_eq!(session.document.objects.len(), 5);
}

#[test]
fn more_rows_leave_room_for_the_labels_between_them() {
    let scene = Scene { reflection_model: "metallic_roughness".to_owned(), ..Scene::default() };
    let mut bench = Bench::new(Session::new(scene));
    bench.apply(Action::MakeRow(Selection::Object(0)));
    bench.settle();
    bench.type_into("rows", "2");
    let of = |bench: &Bench| {
        let row = bench.session.document.row(0).expect("a grid");
        (row.repeat.rows, -row.repeat.row_spacing.y, row.entry.size, row.repeat.labels)
    };
    let (rows, step, size, labels) = of(&bench);
    let observer = bench.session.document.observer;
    let height = 2.0 * 4.0 * (0.5 * observer.field_of_view.to_radians()).tan();
    // A line of 18 pixels in 720, and its plate.
    assert!((rows, labels) == (2, true) && step > size + 0.05 * height, "{step} for {size}, {height}");
    bench.type_into("rows", "3");
    assert_eq!(of(&bench).1, step, "there is room for as much");
    // More rows are nearer to each other, and all in the room.
    bench.type_into("rows", "9");
    let (rows, near, ..) = of(&bench);
    assert!(rows == 9 && near < step, "{rows} rows, {near} m");
    let found = check::scene(&bench.session.document, &Registry::builtin());
    assert!(found.is_empty(), "{found:?}");
    // A step of the user's own stays.
    let own = |row: &mut Repeat| row.row_spacing = Vec3::NEG_Y * 0.3;
    bench.apply(Action::Edit(changed(&bench.session.document, 0, own)));
    bench.type_into("rows", "4");
    assert_eq!(of(&bench).1, 0.3);
}

#[test]
fn a_grid_grows_around_its_middle_as_far_as_the_room_has_place() {
    let mut bench = Bench::new(Session::new(Scene::default()));
    bench.apply(Action::MakeRow(Selection::Object(0)));
    bench.settle();
    let row = |bench: &Bench| {
        let row = bench.session.document.row(0).expect("a grid");
        (row.middle(), row.entry.position, -row.repeat.row_spacing.y, row.count)
    };
    let (middle, first, ..) = row(&bench);
    for (rows, count) in [("2", 10), ("4", 20), ("3", 15)] {
        bench.type_into("rows", rows);
        let (now, top, step, total) = row(&bench);
        assert!((now - middle).length() < 2e-4 && total == count, "{rows}: {now} {middle} {total}");
        let half = 0.5 * (count / 5 - 1) as f32 * step;
        assert!((top.y - first.y - half).abs() < 2e-4, "{rows}: {top} above {first}, {step}");
    }
    bench.type_into("columns", "3");
    assert!((row(&bench).0 - middle).length() < 2e-4 && row(&bench).1.x > first.x);
    bench.type_into("rows", "1");
    assert!((row(&bench).1.y - first.y).abs() < 2e-4, "back to where it was");
    // Near a wall the middle moves as far as it must.
    let mut scene = Scene::default();
    scene.objects[0].position.y = 0.6;
    let mut bench = Bench::new(Session::new(scene));
    bench.apply(Action::MakeRow(Selection::Object(0)));
    bench.settle();
    bench.type_into("rows", "4");
    let (middle, _, step, count) = row(&bench);
    assert_eq!(count, 20, "{:?}", bench.session.messages);
    let size = bench.session.document.objects[0].size;
    let lowest = middle.y - 1.5 * step;
    assert!((lowest - 0.6f32.min(0.5 * size)).abs() < 1e-3, "{lowest} {step} {size}");
    assert_eq!(check::scene(&bench.session.document, &Registry::builtin()), []);
}

#[test]
fn a_new_row_of_an_object_beyond_sight_fits_the_room() {
    let registry = Registry::builtin();
    for position in [Vec3::new(5.0, 5.0, 9.9), Vec3::new(9.9, 1.0, 5.0), Vec3::new(0.05, 9.9, 0.05)] {
        let mut scene = Scene::default();
        scene.objects[0].position = position;
        let mut session = Session::new(scene);
        session.apply(Action::MakeRow(Selection::Object(0)), &registry);
        assert_eq!(session.document.objects.len(), 5, "{position}: {:?}", session.messages);
        assert_eq!(check::scene(&session.document, &registry), []);
    }
}

#[test]
fn every_model_and_object_type_makes_a_legal_row() {
    let registry = Registry::builtin();
    for model in registry.models() {
        let scene = Scene { reflection_model: model.declaration.id.to_owned(), ..Scene::default() };
        let mut session = Session::new(scene);
        session.apply(Action::MakeRow(Selection::Object(0)), &registry);
        assert_eq!(session.document.objects.len(), 5, "{}: {:?}", model.declaration.id, session.messages);
        // Highlights stay round.
        let values: Vec<_> = session.document.objects.iter().map(|o| &o.material.0).collect();
        assert!(values.iter().all(|v| v.get("alpha_x") == v.get("alpha_y")), "{}", model.declaration.id);
    }
}

#[test]
fn the_properties_say_which_copy_is_shown_and_edit_the_row() {
    let shows = |bench: &mut Bench, words: &str| bench.texts().iter().any(|text| text.contains(words));
    let mut bench = Bench::new(Session::new(scene()));
    bench.apply(Action::Select(Selection::Object(3)));
    bench.settle();
    assert!(shows(&mut bench, "Copy 3 of 5 of ball"), "{:?}", bench.texts());
    bench.type_into("columns", "4");
    assert_eq!(bench.session.document.objects.len(), 6, "{:?}", bench.session.messages);
    bench.apply(Action::Undo);
    bench.apply(Action::Edit(Edit::Row { object: 3, entry: None, what: "Single objects" }));
    bench.settle();
    assert!(bench.session.document.row(3).is_none());
    assert!(!shows(&mut bench, "Copy 3 of"), "{:?}", bench.texts());
    bench.apply(Action::MakeRow(Selection::Object(3)));
    bench.settle();
    assert_eq!(bench.session.document.objects.len(), 11, "{:?}", bench.session.messages);
}

/// The keys come one by one: a value that is typed is one step, as a drag is.
#[test]
fn a_typed_value_is_one_step() {
    let mut bench = Bench::new(Session::new(scene()));
    bench.apply(Action::Select(Selection::Object(0)));
    bench.settle();
    let before = bench.session.document.done();
    bench.type_into("size", "");
    for text in ["0", ".", "4"] {
        bench.frame(vec![Event::Text(text.to_owned())]);
    }
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(bench.session.document.objects[0].size, 0.4);
    assert_eq!(bench.session.document.done(), before + 1);
}

#[test]
fn a_range_becomes_a_list_whose_values_are_changed_one_by_one() {
    let mut bench = Bench::new(Session::new(scene()));
    bench.apply(Action::Select(Selection::Object(1)));
    bench.settle();
    let before = roughness(&bench.session.document);
    bench.click("List instead");
    assert_eq!(roughness(&bench.session.document), before, "{:?}", bench.session.messages);
    let listed = |bench: &Bench| row(&bench.session.document).repeat.vary[0].values.clone();
    assert_eq!(listed(&bench).len(), 5);
    bench.type_into("value 2", "0.77");
    assert_eq!(listed(&bench)[1], Value::Number(0.77));
    assert_eq!(roughness(&bench.session.document)[2], Some(Value::Number(0.77)));
    bench.key(Key::Enter, Modifiers::NONE);
    bench.type_into("value 2", "7");
    assert_eq!(listed(&bench)[1], Value::Number(0.77), "beyond the range of the roughness");
}

/// Opens a list and chooses one of its entries.
fn choose(bench: &mut Bench, list: &str, entry: &str) {
    bench.click(list);
    let at = bench.tree.iter().rev().find(|seen| seen.label == entry).expect(entry).rect.center();
    bench.click_at(at, PointerButton::Primary);
}

#[test]
fn colours_and_models_are_listed_and_changed_one_by_one() {
    let mut bench = Bench::new(Session::new(scene()));
    bench.apply(Action::Select(Selection::Object(1)));
    bench.settle();
    let listed = |bench: &Bench| row(&bench.session.document).repeat.vary[0].values.clone();
    choose(&mut bench, "varies: roughness", "base colour");
    let colours = listed(&bench);
    assert!(colours.len() == 5 && colours.iter().all(|v| *v == colours[0]), "{colours:?}");
    bench.type_into("value 2 in hexadecimal", "#ff8000");
    assert_eq!(listed(&bench)[1], Value::Colour([255, 128, 0]));
    let material = &bench.session.document.objects[2].material;
    assert_eq!(material.0.get("base_colour"), Some(&Value::Colour([255, 128, 0])));
    choose(&mut bench, "varies: base colour", "reflection model");
    // Models in their order, from that of the row on.
    let models = listed(&bench);
    let word = |i: usize| models[i].to_string();
    assert!(word(0).contains("metallic_roughness") && word(1) != word(0), "{models:?}");
    let registry = Registry::builtin();
    let name = |i: usize| registry.model(&word(i)).map_or("", |model| model.declaration.name);
    let model = |bench: &Bench| bench.session.document.objects[3].reflection_model.clone();
    // Among many, by a search.
    bench.click(&format!("value 3: {}", name(2)));
    bench.frame(vec![Event::Text("lommel".to_owned())]);
    bench.settle();
    bench.key(Key::Enter, Modifiers::NONE);
    assert_eq!(model(&bench).as_deref(), Some("lommel_seeliger"), "{:?}", bench.session.messages);
    bench.click("value 3: Lommel–Seeliger");
    bench.click("Lambert");
    assert_eq!(model(&bench).as_deref(), Some("lambert"));
}

#[test]
fn the_commands_are_there_when_they_can_be_used() {
    let registry = Registry::builtin();
    let why_not = |session: &Session, id: &str| {
        let all = all(session, &registry, false);
        let found = all.commands().into_iter().find(|(_, command)| command.id == id);
        found.expect("it is declared").1.why_not.clone().map(std::borrow::Cow::into_owned)
    };
    let mut session = Session::new(scene());
    session.apply(Action::Select(Selection::Room), &registry);
    assert_eq!(why_not(&session, "row").as_deref(), Some("No object is selected"));
    session.apply(Action::Select(Selection::Object(0)), &registry);
    assert_eq!(why_not(&session, "row"), None);
    assert_eq!(why_not(&session, "single_objects").as_deref(), Some("The object is in no row"));
    session.apply(Action::Select(Selection::Object(2)), &registry);
    assert_eq!(why_not(&session, "row").as_deref(), Some("The object is in a row already"));
    assert_eq!(why_not(&session, "single_objects"), None);
}

/// A window with a row whose first value is listed, and its second copy selected.
fn listed() -> Bench {
    let values = [0.1, 0.2, 0.3, 0.5].map(Value::Number).to_vec();
    let varied = Varied { from: None, to: None, values, ..varied() };
    let repeat =
        Repeat { columns: 4, spacing: Vec3::new(1.5, 0.0, 0.0), vary: vec![varied], ..Repeat::default() };
    let scene = Scene { objects: vec![entry(repeat)], ..scene() };
    let mut bench = Bench::new(Session::new(scene.expanded(&Registry::builtin()).expect("legal")));
    bench.apply(Action::Select(Selection::Object(1)));
    bench.settle();
    bench
}

#[test]
fn copies_that_come_back_have_their_listed_values() {
    let mut bench = listed();
    let values = |bench: &Bench| -> Vec<f32> {
        let all = roughness(&bench.session.document);
        all.into_iter().map(|value| if let Some(Value::Number(v)) = value { v } else { f32::NAN }).collect()
    };
    let before = values(&bench);
    assert_eq!(before, [0.1, 0.2, 0.3, 0.5]);
    // In one drag, or with other edits in between.
    bench.type_into("columns", "2");
    assert_eq!(values(&bench), before[..2]);
    bench.apply(Action::Edit(Edit::material(Part::Object(0), "metallic", Value::Number(1.0))));
    bench.type_into("columns", "5");
    assert_eq!(values(&bench), [0.1, 0.2, 0.3, 0.5, 0.5], "the steps are uneven: the last value is repeated");
    bench.type_into("columns", "3");
    while bench.session.document.done() > 0 {
        bench.apply(Action::Undo);
    }
    assert_eq!(values(&bench), before);
    // Even steps go on, as far as they are legal.
    bench.type_into("columns", "3");
    bench.apply(Action::Edit(changed(&bench.session.document, 0, |row| {
        row.vary[0].values = [0.3, 0.5, 0.7].map(Value::Number).to_vec();
    })));
    bench.type_into("columns", "5");
    assert_eq!(values(&bench), [0.3, 0.5, 0.7, 0.9, 0.9]);
}

#[test]
fn numbers_of_columns_that_do_not_fit_are_refused_beside_the_field() {
    let shows = |bench: &mut Bench, words: &str| bench.texts().iter().any(|text| text.contains(words));
    let mut bench = Bench::new(Session::new(scene()));
    bench.size = vec2(1280.0, 720.0);
    bench.apply(Action::Select(Selection::Object(3)));
    // In steps of 1.5 m, a room of 10 m has seven places.
    for (typed, rule) in [
        ("0", "Must be a whole number between 1 and 7 (there is room for no more); the picture keeps 5"),
        ("8", "Must be a whole number between 1 and 7 (there is room for no more); the picture keeps 5"),
        ("99999", "Must be a whole number between 1 and 7"),
    ] {
        bench.type_into("columns", typed);
        assert!(shows(&mut bench, rule), "{typed}: {:?}", bench.texts());
        assert_eq!(bench.session.document.objects.len(), 7, "{typed}");
        assert!(bench.session.messages.iter().next().is_none(), "{typed}: {:?}", bench.session.messages);
        bench.key(Key::Escape, Modifiers::NONE);
    }
    bench.type_into("columns", "7");
    assert_eq!(bench.session.document.objects.len(), 9);
    // A step that leads a copy out of the room.
    bench.type_into("spacing x", "3");
    // Six steps from x = 0.5.
    let texts = bench.texts();
    let rule = texts.iter().find(|text| text.contains("x must be between")).cloned().unwrap_or_default();
    assert!(rule.contains("between −0.083") && rule.contains(" and 1.58"), "{rule:?} in {texts:?}");
    assert!(rule.contains("(all copies must be in the room)"), "{rule}");
    assert_eq!(bench.session.document.objects.len(), 9);
}

#[test]
fn knobs_of_values_that_vary_are_disabled_and_say_where_the_range_is() {
    let why = "It differs from copy to copy: change its range or its list under “Row”, above.";
    let mut bench = Bench::new(Session::new(scene()));
    bench.apply(Action::Select(Selection::Object(3)));
    bench.settle();
    let slider = |bench: &Bench, label: &str| {
        let is = |s: &&Seen| s.role == Role::Slider && s.label.starts_with(label);
        bench.tree.iter().find(is).unwrap_or_else(|| panic!("no slider “{label}”")).clone()
    };
    assert!(slider(&bench, "roughness").disabled && !slider(&bench, "metallic").disabled);
    let at = slider(&bench, "roughness").rect.center();
    bench.hover(at);
    assert!(bench.says(why), "{:?}", bench.texts());
    // View B has a roughness of its own, for all copies alike.
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Compare(CompareCommand::Activate(1)));
    bench.settle();
    assert!(!slider(&bench, "roughness").disabled);
    // The size, which is no parameter.
    let edit = changed(&bench.session.document, 3, |row| {
        row.vary[0] =
            Varied { parameter: "size".to_owned(), from: Some(0.5), to: Some(1.0), ..Varied::default() };
    });
    bench.apply(Action::Edit(edit));
    bench.settle();
    assert!(slider(&bench, "size").disabled, "{:?}", bench.session.messages);
}

#[test]
fn labels_in_the_window_suit_the_background() {
    let mut scene = scene();
    scene.display.background = Background::Colour;
    let mut entry = scene.row(1).expect("a row").entry.clone();
    let Repetition::Entry(repeat) = &mut entry.repeat else { panic!("it is one") };
    repeat.labels = true;
    scene.objects = vec![entry];
    let mut bench = Bench::new(Session::new(scene.expanded(&Registry::builtin()).expect("legal")));
    let plates = |bench: &mut Bench, palette: theme::Palette| {
        let fill = palette.plate();
        let is = |shape: &Shape| matches!(shape, Shape::Rect(rect) if rect.fill == fill);
        bench.shapes().iter().filter(|shape| is(shape)).count()
    };
    let [light, dark] = [theme::LIGHT, theme::DARK].map(|palette| plates(&mut bench, palette));
    assert!(light >= 3, "{light} light plates, {dark} dark ones");
    bench.apply(Action::Edit(Edit::set(Part::Display, Display::background_colour, Value::Colour([9; 3]))));
    let after = [theme::LIGHT, theme::DARK].map(|palette| plates(&mut bench, palette));
    assert_eq!(after, [0, dark + light]);
}

#[test]
fn the_knobs_of_a_row_are_beside_each_other_in_a_laptops_window() {
    for scale in [100, 150] {
        let mut bench = Bench::new(Session::new(scene()));
        bench.size = vec2(1280.0, 720.0);
        bench.apply(Action::View(ViewChange::Scale(scale)));
        bench.apply(Action::Select(Selection::Object(3)));
        let right = bench.size.x / (f32::from(scale) / 100.0);
        let left = bench.area.rect.right();
        for label in ["columns", "rows", "spacing x", "spacing y", "spacing z", "from", "to"] {
            let rect = bench.field(label).rect;
            assert!(rect.left() > left && rect.right() < right, "{scale} %: {label} at {rect:?}");
        }
        let [x, z] = ["spacing x", "spacing z"].map(|label| bench.field(label).rect);
        assert!((x.top() - z.top()).abs() < 1.0 && z.left() > x.right(), "{scale} %: {x:?}, {z:?}");
        let [varies, scale_of] =
            ["varies: roughness", "scale: linear"].map(|label| bench.find(label).expect(label).rect);
        assert!((varies.right() - scale_of.right()).abs() < 1.0, "{scale} %: {varies:?}, {scale_of:?}");
        let bin = bench.find("The same for all copies").expect("beside it").rect;
        assert!(bin.left() >= varies.right() && bin.right() < right, "{scale} %: {bin:?}");
    }
}
