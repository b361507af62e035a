//! Several parts at once, as a user selects and changes them: in the list, in the picture and in the properties.

use bevy_egui::egui::{
    Color32, Event, Key, Modifiers, PointerButton, Pos2, Rect, Shape, Vec2, epaint::ColorMode, pos2, vec2,
};
use glam::{Quat, Vec3};
use lights_camera_models::{
    document::{Edit, Selection},
    panel::{
        marks::Lens,
        state::{Action, Alike, CompareCommand, HandleChange, HandleMode, Session, ViewChange},
    },
    parameter::{METALLIC, Value},
    scene::{Light, Object, Part, Scene, comparison::Layout},
};

use crate::window::panels::Bench;

use Selection::{Light as L, Object as O};

const CTRL: Modifiers = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };
const CTRL_SHIFT: Modifiers = Modifiers { shift: true, ..CTRL };

/// Four spheres of different sizes, and a light above them, seen from the upper right.
fn bench() -> Bench {
    let object = |i: usize| Object {
        position: Vec3::new(3.8 + 0.8 * i as f32, 5.0, 5.0),
        size: 0.3 + 0.1 * i as f32,
        ..Object::default()
    };
    let light = Light { position: Some(Vec3::new(5.0, 6.2, 5.0)), ..Scene::default().lights[0].clone() };
    let scene = Scene { objects: (0..4).map(object).collect(), lights: vec![light], ..Scene::default() };
    let mut session = Session::new(scene);
    session.facts.camera = Quat::from_rotation_y(0.3) * Quat::from_rotation_x(-0.3);
    session.facts.eye = Vec3::splat(5.0) + session.facts.camera * Vec3::new(0.0, 0.0, 6.0);
    let mut bench = Bench::new(session);
    bench.size = vec2(1280.0, 900.0);
    bench.settle();
    bench
}

fn place(bench: &Bench, label: &str) -> Pos2 {
    bench.find(label).unwrap_or_else(|| panic!("no {label}")).rect.center()
}

fn click(bench: &mut Bench, at: Pos2, modifiers: Modifiers) {
    let press =
        |pressed| Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers };
    bench.frame(vec![Event::ModifiersChanged(modifiers), Event::PointerMoved(at)]);
    bench.frame(vec![press(true)]);
    bench.frame(vec![press(false)]);
    bench.frame(vec![Event::ModifiersChanged(Modifiers::NONE)]);
    bench.settle();
}

/// Drags in steps. The button is released at the end if `release`.
fn drag(bench: &mut Bench, from: Pos2, by: Vec2, modifiers: Modifiers, release: bool) {
    let press =
        |pos, pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
    bench.frame(vec![Event::ModifiersChanged(modifiers), Event::PointerMoved(from)]);
    bench.frame(vec![press(from, true)]);
    for k in 1..=5 {
        bench.frame(vec![Event::PointerMoved(from + by * (k as f32 / 5.0))]);
    }
    if release {
        bench.frame(vec![press(from + by, false)]);
        bench.frame(vec![Event::ModifiersChanged(Modifiers::NONE)]);
        bench.settle();
    }
}

fn positions(bench: &Bench) -> Vec<Vec3> {
    bench.session.document.objects.iter().map(|object| object.position).collect()
}

/// The place of a point in the picture.
fn seen(bench: &Bench, point: Vec3) -> Pos2 {
    Lens::of(&bench.session, bench.area.frame).project(point).expect("it is seen")
}

#[test]
fn clicks_in_the_list_add_take_out_and_select_ranges() {
    let mut bench = bench();
    let rows = ["Sphere 1", "Sphere 2", "Sphere 3", "Sphere 4", "Point 1"].map(|name| place(&bench, name));
    click(&mut bench, rows[2], CTRL);
    click(&mut bench, rows[4], CTRL);
    assert_eq!(bench.session.group(), [L(0), O(0), O(2)]);
    click(&mut bench, rows[4], CTRL);
    assert_eq!(bench.session.group(), [O(0), O(2)]);
    click(&mut bench, rows[3], Modifiers::SHIFT);
    assert_eq!(bench.session.group(), [O(0), O(1), O(2), O(3)]);
    // The menu of a row that is selected is about all of them.
    bench.click_at(rows[1], PointerButton::Secondary);
    assert_eq!(bench.session.group().len(), 4);
    bench.click("Hide the others");
    bench.key(Key::Escape, Modifiers::NONE);
    click(&mut bench, rows[1], Modifiers::NONE);
    assert_eq!(bench.session.group(), [O(1)]);
}

#[test]
fn the_keyboard_alone_selects_changes_and_removes_several() {
    let mut bench = bench();
    bench.key(Key::A, CTRL);
    assert_eq!(bench.session.group().len(), 4, "Ctrl+A");
    bench.key(Key::PageUp, CTRL);
    assert!(positions(&bench).iter().all(|p| (p.y - 5.1).abs() < 1e-4), "{:?}", positions(&bench));
    assert_eq!(bench.session.document.done(), 1);
    bench.key(Key::V, Modifiers::NONE);
    assert!(bench.session.document.objects.iter().all(|object| !object.visible));
    bench.key(Key::V, CTRL_SHIFT);
    assert!(bench.session.document.objects.iter().all(|object| object.visible));
    bench.apply(Action::Select(O(0)));
    // The second panel is the list, where the row of what is selected gets the focus.
    (0..2).for_each(|_| bench.key(Key::F6, Modifiers::NONE));
    let names = |bench: &Bench| bench.session.group();
    bench.key(Key::ArrowDown, Modifiers::SHIFT);
    assert_eq!(names(&bench), [O(0), O(1)], "Shift and an arrow");
    bench.key(Key::ArrowDown, Modifiers::SHIFT);
    assert_eq!(names(&bench), [O(0), O(1), O(2)]);
    bench.key(Key::ArrowUp, Modifiers::SHIFT);
    assert_eq!(names(&bench), [O(0), O(1)]);
    bench.key(Key::Space, CTRL);
    assert_eq!(names(&bench), [O(0)], "Ctrl and Space take out the row with the focus");
    bench.key(Key::Space, CTRL);
    bench.key(Key::Delete, Modifiers::NONE);
    assert_eq!(bench.session.document.objects.len(), 2);
    bench.key(Key::Z, CTRL);
    assert_eq!((bench.session.document.objects.len(), names(&bench)), (4, vec![O(0), O(1)]));
}

#[test]
fn the_properties_of_several_show_a_dash_and_set_all() {
    for zoom in [100, 150] {
        let mut bench = bench();
        bench.session.settings.scale = zoom;
        // Tall enough for all knobs.
        bench.size = vec2(1800.0, 3000.0);
        bench.settle();
        bench.apply(Action::SelectAlike(Alike::Kind));
        assert!(bench.says("4 objects"), "at {zoom} %");
        assert_eq!(bench.field("size").label, "size");
        assert!(bench.texts().iter().any(|text| text == "–"), "sizes differ");
        let steps = bench.session.document.done();
        bench.type_into("size", "0.6");
        bench.key(Key::Enter, Modifiers::NONE);
        let sizes: Vec<_> = bench.session.document.objects.iter().map(|object| object.size).collect();
        assert_eq!(sizes, [0.6; 4], "at {zoom} %");
        assert_eq!(bench.session.document.done(), steps + 1);
        // One coordinate of all; the others stay.
        let before = positions(&bench);
        bench.type_into("position y", "4");
        bench.key(Key::Enter, Modifiers::NONE);
        for (from, to) in before.iter().zip(positions(&bench)) {
            assert_eq!(to, from.with_y(4.0), "at {zoom} %");
        }
        // One that differs: the value of the first is a value as any other.
        bench.type_into("position x", "3.8");
        bench.key(Key::Enter, Modifiers::NONE);
        assert!(positions(&bench).iter().all(|p| *p == Vec3::new(3.8, 4.0, 5.0)), "{:?}", positions(&bench));
        bench.apply(Action::Undo);
        bench.apply(Action::Undo);
        assert_eq!(positions(&bench), before);
    }
}

#[test]
fn the_material_of_several_has_the_groups_of_its_model() {
    let mut bench = bench();
    bench.size = vec2(1800.0, 3000.0);
    bench.apply(Action::ChooseModel("openpbr".to_owned()));
    bench.apply(Action::SelectAlike(Alike::Kind));
    let groups = bench.registry.model("openpbr").expect("built in").groups;
    assert!(groups.len() > 3, "{groups:?}");
    let texts = bench.texts_in_sight();
    let right = bench.area.rect.right();
    let is_heading = |(text, at): &&(String, Rect), name: &str| text == name && at.left() > right;
    let height = |name: &str| texts.iter().find(|one| is_heading(one, name)).map(|(_, at)| at.top());
    let heights: Vec<_> = groups.iter().map(|group| height(group.name)).collect();
    assert!(heights.iter().all(Option::is_some) && heights.is_sorted(), "{heights:?}");
    // A heading folds its knobs, and counts those that differ from their defaults.
    let metal = groups.iter().find(|group| group.parameters.contains(&METALLIC.name)).expect("a group");
    bench.field(METALLIC.label);
    let set = Edit::material(Part::Object(1), METALLIC.name, Value::Number(0.5));
    bench.apply(Action::Edit(set));
    let heading = format!("{}1 changed", metal.name);
    assert!(bench.says(&heading), "{:?}", bench.texts());
    bench.click(&heading);
    assert!(bench.find(METALLIC.label).is_none());
}

#[test]
fn knobs_that_none_of_several_uses_are_disabled() {
    let mut bench = bench();
    bench.size = vec2(1800.0, 3000.0);
    bench.apply(Action::ChooseModel("microfacet".to_owned()));
    bench.apply(Action::SelectAlike(Alike::Kind));
    let microfacet = bench.registry.model("microfacet").expect("built in");
    let label = microfacet.parameter("gamma").expect("it has one").label;
    assert!(bench.field(label).disabled, "no distribution is GTR");
    let set = Edit::material(Part::Object(1), "distribution", Value::Choice("gtr".into()));
    bench.apply(Action::Edit(set));
    assert!(!bench.field(label).disabled, "one of them uses it");
}

/// The points of the marks of selection in the picture.
fn brackets(bench: &mut Bench) -> Vec<Pos2> {
    let blue = ColorMode::Solid(Color32::from_rgb(0x7c, 0xc8, 0xff));
    let is_bracket = |shape: Shape| match shape {
        Shape::Path(path) if path.points.len() == 3 && path.stroke.color == blue => Some(path.points),
        _ => None,
    };
    bench.shapes().into_iter().filter_map(is_bracket).flatten().collect()
}

#[test]
fn the_frame_of_one_of_several_is_as_tight_as_that_of_one_alone() {
    let mut bench = bench();
    let turned = Edit::Set {
        part: Part::Object(3),
        values: vec![
            (Object::object_type.into(), Some(Value::from("torus".to_owned()))),
            (Object::rotation.into(), Some(Vec3::new(30.0, 50.0, 10.0).into())),
        ],
        what: None,
    };
    bench.apply(Action::Edit(turned));
    for i in [1, 3] {
        bench.apply(Action::Select(O(i)));
        let alone = brackets(&mut bench);
        assert_eq!(alone.len(), 12, "four corners of three points: {alone:?}");
        bench.apply(Action::SelectEach(vec![O(0), O(i)], false));
        let both = brackets(&mut bench);
        assert_eq!(both.len(), 24, "{both:?}");
        for at in alone {
            let nearest = both.iter().map(|p| p.distance(at)).fold(f32::INFINITY, f32::min);
            assert!(nearest < 1.5, "object {i}: {at:?} is {nearest} points from the frames of both");
        }
    }
}

#[test]
fn handles_move_and_turn_several_as_one_step() {
    let mut bench = bench();
    bench.apply(Action::SelectEach(vec![O(0), O(3)], false));
    let start = positions(&bench);
    let middle = 0.5 * (start[0] + start[3]);
    let by = seen(&bench, middle + 0.6 * Vec3::X) - seen(&bench, middle);
    let handle = |bench: &Bench, name: &str| place(bench, &format!("Handle: {name}"));
    let at = handle(&bench, "move 2 objects along x");
    drag(&mut bench, at, by, Modifiers::NONE, true);
    let after = positions(&bench);
    let moved = after[0] - start[0];
    assert!((0.4..0.8).contains(&moved.x) && moved.y == 0.0 && moved.z == 0.0, "{moved}");
    assert!((after[3] - start[3]).distance(moved) < 3e-4 && after[1] == start[1], "{after:?}");
    assert_eq!(bench.session.document.done(), 1);
    bench.apply(Action::Undo);
    assert_eq!(positions(&bench), start);
    // Escape takes a drag back.
    let at = handle(&bench, "move 2 objects along x");
    drag(&mut bench, at, by, Modifiers::NONE, false);
    assert_ne!(positions(&bench), start);
    bench.key(Key::Escape, Modifiers::NONE);
    assert_eq!(positions(&bench), start);
    let release = Event::PointerButton {
        pos: at + by,
        button: PointerButton::Primary,
        pressed: false,
        modifiers: Modifiers::NONE,
    };
    bench.frame(vec![release]);
    bench.settle();
    bench.apply(Action::View(ViewChange::Handles(HandleChange::Mode(HandleMode::Turn))));
    let at = handle(&bench, "turn 2 objects about y");
    drag(&mut bench, at, vec2(-60.0, 10.0), Modifiers::NONE, true);
    let after = positions(&bench);
    assert!(after[0].distance(start[0]) > 0.02, "{after:?}");
    assert!((0.5 * (after[0] + after[3])).distance(middle) < 1e-3, "about their middle: {after:?}");
    assert!((after[0].distance(after[3]) - start[0].distance(start[3])).abs() < 1e-3, "{after:?}");
    let turns: Vec<_> = bench.session.document.objects.iter().map(|object| object.rotation).collect();
    assert!(turns[0] != Vec3::ZERO && turns[0] == turns[3] && turns[1] == Vec3::ZERO, "{turns:?}");
    assert_eq!(bench.session.document.done(), 1);
}

#[test]
fn a_frame_in_the_picture_selects_what_is_in_it_in_every_view() {
    for layout in [Layout::Single, Layout::SideBySide, Layout::Wipe] {
        let mut bench = bench();
        if layout != Layout::Single {
            bench.apply(Action::Compare(CompareCommand::Add));
            bench.apply(Action::Compare(CompareCommand::Layout(layout)));
        }
        bench.apply(Action::Select(Selection::Observer));
        let cell = bench.area.cells.first().map_or(bench.area.frame, |cell| cell.rect);
        let lens = Lens::of(&bench.session, cell);
        let at = |i: usize| lens.project(positions(&bench)[i]).expect("it is seen");
        let around = |from: Pos2, to: Pos2| (from - vec2(14.0, 14.0), to - from + vec2(28.0, 28.0));
        let (from, by) = around(at(1).min(at(2)), at(1).max(at(2)));
        let (first, only) = around(at(0), at(0));
        // Without Ctrl it turns the camera.
        drag(&mut bench, from, by, Modifiers::NONE, true);
        assert_eq!(bench.session.selection, Selection::Observer, "{layout:?}");
        drag(&mut bench, from, by, CTRL, true);
        assert_eq!(bench.session.group(), [O(1), O(2)], "{layout:?}");
        drag(&mut bench, first, only, CTRL_SHIFT, true);
        assert_eq!(bench.session.group(), [O(0), O(1), O(2)], "{layout:?}");
        drag(&mut bench, first, only, CTRL, true);
        assert_eq!(bench.session.group(), [O(0)], "{layout:?}");
        // Nothing in it changes nothing, and Escape ends it.
        drag(&mut bench, pos2(cell.left() + 20.0, cell.bottom() - 60.0), vec2(20.0, 20.0), CTRL, true);
        assert_eq!(bench.session.group(), [O(0)], "{layout:?}");
    }
}

#[test]
fn no_section_is_without_a_value() {
    let mut scene = Scene::default();
    let sky = Light { light_type: "environment".to_owned(), position: None, ..scene.lights[0].clone() };
    scene.lights.push(sky);
    let mut bench = Bench::new(Session::new(scene));
    bench.apply(Action::SelectEach(vec![L(0), O(0)], false));
    assert!(bench.texts().iter().any(|text| text == "Position"), "both have one");
    for parts in [vec![L(0), L(1), O(0)], vec![L(0), L(1)]] {
        bench.apply(Action::SelectEach(parts, false));
        assert!(bench.texts().iter().all(|text| text != "Position"), "a sky has none");
    }
    assert!(bench.texts().iter().any(|text| text == "Light"));
}
