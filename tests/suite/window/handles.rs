//! The handles of the selected part: dragging one is a step of the history, and does not turn the camera.

use bevy_egui::egui::{
    Color32, Event, Key, Modifiers, PointerButton, Pos2, Shape, Vec2, epaint::ColorMode, pos2, vec2,
};
use glam::{Quat, Vec3};
use lights_camera_models::{
    document::{Edit, Selection},
    light::{self, LightRecord, LightType, Size, extent},
    panel::{
        marks::Lens,
        state::{
            Action, CompareCommand, EXPLAIN_TAB, HandleChange, HandleMode, LessonCommand, LessonSource,
            Session, ViewChange,
        },
    },
    parameter::{Parameter, Value},
    parameters,
    registry::{Register as _, Registry},
    scene::{Light, Object, Part, Scene, comparison::Layout},
    shader::Source,
};

use crate::{helpers::support::builtin, library::plugins::lamp::RingLamp, window::panels::Bench};

const CTRL: Modifiers = Modifiers { ctrl: true, command: true, ..Modifiers::NONE };

/// A sphere seen from the upper right, with a spotlight next to it.
fn scene() -> Scene {
    let mut scene = Scene::default();
    scene.lights.clear();
    scene.lights.push(Light {
        light_type: "spot".to_owned(),
        position: Some(Vec3::new(4.0, 6.0, 5.0)),
        direction: Some(Vec3::new(0.6, -0.8, 0.0)),
        ..Light::default()
    });
    scene
}

fn bench(scene: Scene) -> Bench {
    bench_with(scene, builtin())
}

fn bench_with(scene: Scene, registry: Registry) -> Bench {
    let mut session = Session::new(scene);
    session.facts.camera = Quat::from_rotation_y(0.6) * Quat::from_rotation_x(-0.5);
    session.facts.eye = Vec3::splat(5.0) + session.facts.camera * Vec3::new(0.0, 0.0, 5.0);
    let mut bench = Bench::with_registry(session, registry);
    bench.size = vec2(1280.0, 720.0);
    bench.settle();
    bench
}

fn handle(bench: &Bench, name: &str) -> Pos2 {
    let name = format!("Handle: {name}");
    let found = bench.tree.iter().find(|s| s.label.starts_with(&name));
    let all = || bench.tree.iter().filter(|s| s.label.starts_with("Handle")).map(|s| s.label.clone());
    found.unwrap_or_else(|| panic!("no “{name}” among {:?}", all().collect::<Vec<_>>())).rect.center()
}

fn press(bench: &mut Bench, at: Pos2, pressed: bool) {
    let modifiers = Modifiers::NONE;
    bench.frame(vec![Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers }]);
}

/// Drags in steps, without releasing.
fn pull(bench: &mut Bench, from: Pos2, by: Vec2, modifiers: Modifiers) {
    bench.frame(vec![Event::PointerMoved(from)]);
    press(bench, from, true);
    for k in 1..=5 {
        bench.frame(vec![
            Event::ModifiersChanged(modifiers),
            Event::PointerMoved(from + by * (k as f32 / 5.0)),
        ]);
    }
}

fn drag(bench: &mut Bench, from: Pos2, by: Vec2, modifiers: Modifiers) {
    pull(bench, from, by, modifiers);
    press(bench, from + by, false);
    bench.frame(vec![Event::ModifiersChanged(Modifiers::NONE)]);
    bench.settle();
}

fn position(bench: &Bench) -> Vec3 {
    bench.session.document.objects[0].position
}

/// The movement in the picture for a step of the selected object along an axis.
fn way(bench: &Bench, step: Vec3) -> Vec2 {
    let lens = Lens::of(&bench.session, bench.area.rect);
    lens.project(position(bench) + step).unwrap() - lens.project(position(bench)).unwrap()
}

fn mode(mode: HandleMode) -> Action {
    Action::View(ViewChange::Handles(HandleChange::Mode(mode)))
}

#[test]
fn a_drag_along_an_axis_is_one_step_of_the_history() {
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        let mut bench = bench(scene());
        let before = position(&bench);
        // A previous step with the same name is separate.
        let moved = Edit::set(Part::Object(0), Object::position, before + Vec3::X * 0.1);
        bench.apply(Action::Edit(moved));
        let start = position(&bench);
        let by = way(&bench, 0.5 * Vec3::AXES[axis]);
        let at = handle(&bench, &format!("move Sphere 1 along {letter}"));
        drag(&mut bench, at, by, Modifiers::NONE);
        let after = position(&bench);
        assert!((0..3).all(|i| i == axis || after[i] == start[i]), "{letter}: {start} became {after}");
        assert!((0.3..0.8).contains(&(after[axis] - start[axis])), "{letter}: {start} became {after}");
        assert_eq!(bench.session.document.done(), 2, "{letter}");
        assert!(!bench.session.document.in_gesture());
        bench.apply(Action::Undo);
        assert_eq!(position(&bench), start);
    }
}

#[test]
fn a_press_that_does_not_move_the_pointer_changes_nothing() {
    let mut bench = bench(scene());
    let at = handle(&bench, "move Sphere 1 along x");
    drag(&mut bench, at, Vec2::ZERO, CTRL);
    assert_eq!((bench.session.document.done(), bench.session.selection), (0, Selection::Object(0)));
}

#[test]
fn with_ctrl_a_drag_goes_in_steps() {
    let mut bench = bench(scene());
    let by = way(&bench, 0.6 * Vec3::X);
    let at = handle(&bench, "move Sphere 1 along x");
    drag(&mut bench, at, by, CTRL);
    let x = position(&bench).x;
    assert!(x > 5.0 && (4.0 * x).fract() == 0.0, "{x}");
}

#[test]
fn the_numbers_are_beside_the_pointer_while_it_drags() {
    let mut bench = bench(scene());
    let at = handle(&bench, "move Sphere 1 along x");
    let by = way(&bench, 0.6 * Vec3::X);
    pull(&mut bench, at, by, CTRL);
    let x = position(&bench).x;
    assert!(bench.texts().contains(&format!("x {x:.2} m")), "{x}");
    press(&mut bench, at + by, false);
    bench.settle();
    assert!(!bench.texts().contains(&format!("x {x:.2} m")));
}

#[test]
fn rings_turn_and_the_handle_outward_resizes() {
    let mut bench = bench(scene());
    bench.apply(mode(HandleMode::Turn));
    let at = handle(&bench, "turn Sphere 1 about y");
    drag(&mut bench, at, vec2(-20.0, 40.0), CTRL);
    let turn = bench.session.document.objects[0].rotation;
    assert!(turn.y != 0.0 && turn.x == 0.0 && turn.z == 0.0, "{turn}");
    assert!(turn.y % 15.0 == 0.0, "{turn}");
    assert_eq!(bench.session.document.done(), 1);
    bench.apply(mode(HandleMode::Size));
    let size = bench.session.document.objects[0].size;
    let at = handle(&bench, "size of Sphere 1");
    drag(&mut bench, at, vec2(40.0, -40.0), Modifiers::NONE);
    assert!(bench.session.document.objects[0].size > 1.1 * size);
    drag(&mut bench, at + vec2(40.0, -40.0), vec2(-2000.0, 2000.0), Modifiers::NONE);
    assert_eq!(bench.session.document.done(), 3, "and every drag is one step");
    assert!(bench.session.messages.is_empty());
}

#[test]
fn a_light_is_turned_and_its_cone_opened() {
    let mut bench = bench(scene());
    bench.apply(Action::Select(Selection::Light(0)));
    for kind in HandleMode::ALL {
        bench.apply(mode(*kind));
        handle(&bench, "direction of Spot 1");
        handle(&bench, "cone of Spot 1");
    }
    let light = bench.session.document.lights[0].clone();
    let at = handle(&bench, "direction of Spot 1");
    drag(&mut bench, at, vec2(-50.0, -10.0), Modifiers::NONE);
    let after = bench.session.document.lights[0].clone();
    assert!(after.direction.unwrap().normalize().distance(light.direction.unwrap().normalize()) > 0.1);
    assert_eq!((after.position, &after.parameters), (light.position, &light.parameters));
    let moved = handle(&bench, "direction of Spot 1");
    assert!(moved.distance(at + vec2(-50.0, -10.0)) < 12.0, "{moved:?} follows the pointer from {at:?}");
    assert_eq!(bench.session.document.done(), 1);
    let at = handle(&bench, "cone of Spot 1");
    let lens = Lens::of(&bench.session, bench.area.rect);
    let out = (at - lens.project(light.position.unwrap()).unwrap()).normalized().rot90() * 30.0;
    let before = cone(&bench);
    for way in [out, -out] {
        let at = handle(&bench, "cone of Spot 1");
        drag(&mut bench, at, way, Modifiers::NONE);
    }
    assert_eq!(bench.session.document.done(), 3);
    bench.apply(Action::Undo);
    assert!((cone(&bench) - before).abs() > 5.0, "{} and {before}", cone(&bench));
    assert_eq!(bench.session.document.lights[0].direction, after.direction);
}

fn cone(bench: &Bench) -> f32 {
    let light = &bench.session.document.lights[0];
    bench.registry.light(&light.light_type).unwrap().cone_angle(&light.parameters).unwrap()
}

#[test]
fn the_mark_of_light_from_a_direction_stays_while_it_is_turned() {
    let mut scene = scene();
    scene.lights[0] = Light {
        light_type: "directional".to_owned(),
        position: None,
        direction: Some(Vec3::new(0.6, -0.8, 0.1)),
        ..Light::default()
    };
    let mut bench = bench(scene);
    bench.apply(Action::Select(Selection::Light(0)));
    let at = handle(&bench, "direction of Directional 1");
    let by = vec2(25.0, -15.0);
    pull(&mut bench, at, by, Modifiers::NONE);
    bench.settle();
    let moved = handle(&bench, "direction of Directional 1");
    assert!(moved.distance(at + by) < 14.0, "{moved:?} follows the pointer from {at:?}");
    press(&mut bench, at + by, false);
    bench.settle();
    assert_eq!(bench.session.document.done(), 1);
}

#[test]
fn a_place_that_is_taken_is_passed_in_silence() {
    let mut scene = scene();
    scene.lights[0].position = Some(Vec3::new(4.0, 5.0, 5.0));
    let mut bench = bench(scene);
    bench.apply(Action::Select(Selection::Light(0)));
    let lens = Lens::of(&bench.session, bench.area.rect);
    let [from, to] = [4.0, 5.0].map(|x| lens.project(Vec3::new(x, 5.0, 5.0)).unwrap());
    let at = handle(&bench, "move Spot 1 along x");
    drag(&mut bench, at, to - from, CTRL);
    let place = bench.session.document.lights[0].position.unwrap();
    assert!(place.x > 4.2 && place != position(&bench), "{place}");
    assert!(bench.session.messages.is_empty(), "{:?}", bench.session.messages);
    assert_eq!(bench.session.document.done(), 1);
}

#[test]
fn escape_takes_a_drag_back() {
    let mut bench = bench(scene());
    let before = position(&bench);
    let at = handle(&bench, "move Sphere 1 along y");
    pull(&mut bench, at, vec2(0.0, -60.0), Modifiers::NONE);
    assert!(position(&bench).y > before.y);
    bench.key(Key::Escape, Modifiers::NONE);
    assert_eq!((position(&bench), bench.session.document.done()), (before, 0));
    bench.frame(vec![Event::PointerMoved(at + vec2(0.0, -90.0))]);
    press(&mut bench, at, false);
    assert_eq!(position(&bench), before);
}

#[test]
fn a_handle_is_not_the_picture_and_the_middle_is() {
    let mut bench = bench(scene());
    let lens = Lens::of(&bench.session, bench.area.rect);
    let middle = lens.project(position(&bench)).unwrap();
    let tip = handle(&bench, "move Sphere 1 along y");
    let points =
        [(tip, false), (tip.lerp(middle, 0.2), false), (middle, true), (middle + vec2(30.0, 60.0), true)];
    for (at, picture) in points {
        bench.frame(vec![Event::PointerMoved(at)]);
        bench.frame(Vec::new());
        assert_eq!(bench.area.has_pointer, picture, "{at:?}");
    }
    bench.apply(Action::View(ViewChange::Handles(HandleChange::Show(false))));
    bench.frame(vec![Event::PointerMoved(tip)]);
    bench.frame(Vec::new());
    assert!(bench.area.has_pointer && !bench.says("Handle:"));
    bench.apply(mode(HandleMode::Move));
    assert!(bench.says("Handle:"), "to choose what they do shows them");
    bench.apply(Action::View(ViewChange::Presenting(true)));
    assert!(!bench.says("Handle:"), "a presentation has none");
}

#[test]
fn an_open_menu_or_question_keeps_the_handles_from_the_pointer() {
    let mut bench = bench(scene());
    let at = handle(&bench, "move Sphere 1 along x");
    bench.click("Edit");
    drag(&mut bench, at, vec2(40.0, 0.0), Modifiers::NONE);
    assert_eq!(bench.session.document.done(), 0, "the press closes the menu");
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::shading_model, "flat")));
    bench.apply(Action::New);
    drag(&mut bench, at, vec2(40.0, 0.0), Modifiers::NONE);
    assert_eq!(bench.session.document.done(), 1);
}

#[test]
fn what_is_explained_is_not_covered_by_handles() {
    let mut bench = bench(scene());
    let count = |bench: &Bench| bench.tree.iter().filter(|s| s.label.starts_with("Handle: ")).count();
    for part in [Selection::Object(0), Selection::Light(0)] {
        bench.apply(Action::Select(part));
        bench.settle();
        assert!(count(&bench) > 0, "{part:?}");
        bench.apply(Action::View(ViewChange::BottomTab(EXPLAIN_TAB.to_owned())));
        bench.settle();
        assert!(bench.session.explains() && count(&bench) == 0, "{part:?}");
        bench.apply(Action::View(ViewChange::Bottom(false)));
        bench.settle();
        assert!(!bench.session.explains() && count(&bench) > 0, "{part:?}");
    }
    bench.apply(Action::Lesson(LessonCommand::Open(LessonSource::Shipped(0))));
    bench.apply(Action::Select(Selection::Object(0)));
    bench.settle();
    assert!(bench.session.lesson.is_some() && count(&bench) == 0, "a lesson is about the picture");
}

/// The lines and discs of handles: those in the colours of the axes.
fn painted(bench: &mut Bench) -> Vec<Pos2> {
    let axes = [[0xff, 0x7a, 0x33], [0x2e, 0xd0, 0x9c], [0x5a, 0xa9, 0xf5]];
    let is_axis = |c: Color32| axes.contains(&[c.r(), c.g(), c.b()]);
    let of = |shape| match shape {
        Shape::LineSegment { points, stroke } if is_axis(stroke.color) => points.to_vec(),
        Shape::Path(path) if is_axis(path.fill) => path.points,
        Shape::Path(path) => match path.stroke.color {
            ColorMode::Solid(colour) if is_axis(colour) => path.points,
            _ => Vec::new(),
        },
        _ => Vec::new(),
    };
    let all: Vec<_> = bench.shapes().into_iter().flat_map(of).collect();
    all.into_iter().filter(|p| bench.area.rect.contains(*p)).collect()
}

/// Asserts that the handles of a part are shown and farther from the centre than the object reaches.
fn around(bench: &mut Bench, part: HandleMode, middle: Pos2, radius: f32) {
    bench.apply(mode(part));
    bench.settle();
    let points = painted(bench);
    assert!(part == HandleMode::Size || points.len() > 4, "{part:?}");
    assert!(points.iter().all(|p| p.distance(middle) > radius), "{part:?}: they cover the highlight");
}

#[test]
fn handles_fade_when_the_pointer_rests_or_leaves_and_never_cover_the_object() {
    let mut bench = bench(scene());
    assert_eq!(painted(&mut bench), [], "a window shows its picture first");
    let lens = Lens::of(&bench.session, bench.area.rect);
    let middle = lens.project(position(&bench)).unwrap();
    let near = middle + vec2(150.0, 20.0);
    let seconds = |bench: &mut Bench, count: usize| (0..30 * count).for_each(|_| bench.frame(Vec::new()));
    bench.frame(vec![Event::PointerMoved(near)]);
    bench.settle();
    bench.frame(vec![Event::PointerMoved(near + vec2(4.0, 0.0))]);
    bench.settle();
    let radius = 0.5 * bench.session.document.objects[0].size;
    let right = bench.session.facts.camera * Vec3::X;
    let radius = lens.project(position(&bench) + radius * right).unwrap().distance(middle);
    for part in [HandleMode::Move, HandleMode::Turn, HandleMode::Size] {
        around(&mut bench, part, middle, radius);
    }
    bench.apply(mode(HandleMode::Move));
    bench.settle();
    assert!(!painted(&mut bench).is_empty());
    seconds(&mut bench, 3);
    assert_eq!(painted(&mut bench), [], "the pointer rests");
    // They stay as long as the pointer is over one of them.
    let tip = handle(&bench, "move Sphere 1 along x");
    bench.frame(vec![Event::PointerMoved(tip)]);
    seconds(&mut bench, 3);
    assert!(!painted(&mut bench).is_empty());
    bench.frame(vec![Event::PointerMoved(near)]);
    bench.frame(vec![Event::PointerMoved(pos2(20.0, 400.0))]);
    seconds(&mut bench, 1);
    assert_eq!(painted(&mut bench), [], "the pointer has left the picture");
    bench.key(Key::F3, Modifiers::NONE);
    assert!(!painted(&mut bench).is_empty(), "what a key chooses is shown");
}

#[test]
fn where_an_object_leaves_no_room_its_handles_are_at_the_edge_of_the_view() {
    let mut bench = bench(scene());
    bench.session.facts.eye = Vec3::splat(5.0) + bench.session.facts.camera * Vec3::new(0.0, 0.0, 2.2);
    bench.settle();
    let lens = Lens::of(&bench.session, bench.area.rect);
    let middle = lens.project(position(&bench)).unwrap();
    let right = bench.session.facts.camera * Vec3::X;
    let radius = lens.project(position(&bench) + right).unwrap().distance(middle);
    assert!(radius > 0.6 * 0.5 * bench.area.rect.height(), "{radius} of {:?}", bench.area.rect);
    // A moving pointer shows them again.
    for x in [0.0, 4.0] {
        bench.frame(vec![Event::PointerMoved(middle + vec2(x, 0.0))]);
        bench.settle();
    }
    for part in [HandleMode::Move, HandleMode::Turn, HandleMode::Size] {
        around(&mut bench, part, middle, radius);
        let named = bench.tree.iter().filter(|s| s.label.starts_with("Handle: ")).map(|s| s.rect.center());
        for at in named {
            assert!(at.distance(middle) > radius, "{part:?}: {at:?} is over the object");
            assert!(bench.area.rect.contains(at), "{part:?}: {at:?} is not in the view");
        }
    }
    // From there they move it as from elsewhere.
    bench.apply(mode(HandleMode::Move));
    bench.settle();
    let (start, by) = (position(&bench), way(&bench, Vec3::X * 0.3));
    let at = handle(&bench, "move Sphere 1 along x");
    drag(&mut bench, at, by, Modifiers::NONE);
    let moved = position(&bench) - start;
    assert!((0.2..0.4).contains(&moved.x) && moved.y == 0.0 && moved.z == 0.0, "{moved}");
}

#[test]
fn handles_of_an_object_at_the_edge_lie_on_no_object() {
    let mut bench = bench_with(Scene::default(), builtin());
    (bench.session.facts.eye, bench.session.facts.camera) =
        (Session::default().facts.eye, Session::default().facts.camera);
    bench.settle();
    for copies in 1..3 {
        bench.apply(Action::Duplicate(Selection::Object(0)));
        bench.settle();
        let lens = Lens::of(&bench.session, bench.area.rect);
        let right = bench.session.facts.camera * Vec3::X;
        let Selection::Object(selected) = bench.session.selection else { panic!("the copy is selected") };
        let objects = bench.session.document.objects.clone();
        let disc = |object: &Object| {
            let middle = lens.project(object.position).expect("in view");
            (middle, lens.project(object.position + 0.5 * object.size * right).unwrap().distance(middle))
        };
        let (middle, _) = disc(&objects[selected]);
        for x in [0.0, 4.0] {
            bench.frame(vec![Event::PointerMoved(middle + vec2(x, 0.0))]);
            bench.settle();
        }
        let letters: Vec<_> = bench.tree.iter().filter(|seen| seen.label.contains(" along ")).collect();
        assert!(letters.iter().any(|seen| seen.label.starts_with("Handle: ")), "{copies}: no handles");
        for letter in letters.iter().filter(|seen| seen.label.starts_with("Handle: ")) {
            let at = letter.rect.center();
            assert!(bench.area.rect.contains(at), "{copies}: {} at {at:?}", letter.label);
            for (middle, radius) in objects.iter().map(disc) {
                assert!(at.distance(middle) > radius, "{copies}: {} on a sphere at {middle:?}", letter.label);
            }
        }
    }
}

#[test]
fn every_view_has_its_handles() {
    let mut bench = bench(scene());
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)));
    bench.apply(Action::Select(Selection::Object(0)));
    let name = "Handle: move Sphere 1 along x";
    // From left to right, like the views.
    let handles = |bench: &Bench| {
        let named = bench.tree.iter().filter(|s| s.label == name);
        let mut all: Vec<_> = named.map(|s| s.rect.center()).collect();
        all.sort_by(|a, b| a.x.total_cmp(&b.x));
        all
    };
    let all = handles(&bench);
    let cells: Vec<_> = bench.area.cells.iter().map(|cell| cell.rect).collect();
    assert_eq!((all.len(), cells.len()), (2, 2));
    for (i, at) in all.into_iter().enumerate() {
        assert!(cells[i].contains(at));
        let before = (position(&bench).x, bench.session.document.done());
        // Within the slack of the first drag, the handles have moved with the object.
        let now = handles(&bench)[i];
        drag(&mut bench, now, vec2(30.0, 0.0), Modifiers::NONE);
        assert!(position(&bench).x > before.0 + 0.1, "view {i}");
        assert_eq!(bench.session.document.done(), before.1 + 1);
    }
}

#[test]
fn keys_choose_the_handles_and_nudge_the_selection() {
    let mut bench = bench(scene());
    let start = position(&bench);
    let cases = [
        (Key::ArrowRight, Vec3::X),
        (Key::ArrowLeft, Vec3::NEG_X),
        (Key::ArrowUp, Vec3::NEG_Z),
        (Key::ArrowDown, Vec3::Z),
        (Key::PageUp, Vec3::Y),
        (Key::PageDown, Vec3::NEG_Y),
    ];
    for (k, (key, way)) in cases.into_iter().enumerate() {
        let before = position(&bench);
        bench.key(key, CTRL);
        assert!((position(&bench) - before - 0.1 * way).length() < 1e-4, "{key:?}");
        assert_eq!(bench.session.document.done(), k + 1);
    }
    assert!((position(&bench) - start).length() < 1e-4);
    for expected in [HandleMode::Turn, HandleMode::Size, HandleMode::Move] {
        bench.key(Key::F3, Modifiers::NONE);
        assert_eq!(bench.session.view.handles, expected);
    }
    bench.key(Key::F3, Modifiers::NONE);
    bench.key(Key::PageUp, CTRL);
    assert_eq!(bench.session.document.objects[0].rotation, Vec3::new(0.0, 5.0, 0.0));
    // In a field the keys belong to the text.
    let done = bench.session.document.done();
    let field = bench.field("Name").rect.center();
    bench.click_at(field, PointerButton::Primary);
    bench.key(Key::ArrowRight, CTRL);
    assert_eq!(bench.session.document.done(), done);
}

// ── lights with extent ──

const PLACE: Vec3 = Vec3::new(4.6, 5.6, 5.3);
const WAY: Vec3 = Vec3::new(0.3, -0.4, 0.85);
const SPAN: Parameter = Parameter::number("span", 0.2..=3.0, 1.2).unit("m").help("From side to side.");
const RISE: Parameter = Parameter::number("rise", 0.2..=3.0, 0.8).unit("m").help("From bottom to top.");
const TILT: Parameter = Parameter::number("tilt", 0.0..=360.0, 0.0).unit("°").help("About its direction.");

parameters! {
    /// A rectangle of another crate, whose sizes have names of their own.
    struct Banner {
        span: number = SPAN,
        rise: number = RISE,
        tilt: number = TILT,
    }
}

impl LightType for Banner {
    const DECLARATION: light::Declaration =
        light::Declaration::new("banner", "Banner", Source::new("banner.wgsl", ""))
            .at_position()
            .with_direction()
            .luminance(1.0, 10.0)
            .sizes(&[Size::Width("span"), Size::Height("rise")])
            .roll("tilt");

    fn seen(&self, _: &LightRecord, _: Vec3, _: Vec3) -> extent::Seen {
        extent::Seen::NOTHING
    }
}

/// A selected lamp, with handles for its sizes.
fn lamp(light_type: &str) -> Bench {
    let mut registry = Registry::builtin();
    registry.add_light_type::<Banner>().add_light_type::<RingLamp>();
    let mut scene = scene();
    scene.lights[0] = Light {
        light_type: light_type.to_owned(),
        position: Some(PLACE),
        direction: (light_type != "sphere").then_some(WAY),
        ..Light::default()
    };
    for (name, metres) in [("width", 1.2), ("height", 0.8), ("length", 1.4), ("radius", 0.5)] {
        scene.lights[0].parameters.set(name, Value::Number(metres));
    }
    let mut bench = bench_with(scene, registry);
    bench.apply(Action::Select(Selection::Light(0)));
    bench.apply(mode(HandleMode::Size));
    bench
}

/// Parameters of the lamp.
fn numbers<const N: usize>(bench: &Bench, names: [&str; N]) -> [f32; N] {
    let light = &bench.session.document.lights[0];
    let entry = bench.registry.light(&light.light_type).unwrap();
    names.map(|name| light.parameters.number(entry.parameter(name).unwrap()))
}

/// The positions of the handles of the lamp's parameter, at its first end and at the other.
fn ends(bench: &Bench, parameter: &str) -> Vec<Pos2> {
    let lamp = bench.session.name_of(Selection::Light(0), &bench.registry);
    ["", ", at the other end"]
        .into_iter()
        .filter_map(|end| {
            let name = format!("Handle: {parameter} of {lamp}{end}");
            Some(bench.tree.iter().find(|s| s.label == name)?.rect.center())
        })
        .collect()
}

#[test]
fn a_size_grows_on_both_sides_by_what_the_pointer_pulls_at_either_end() {
    let direction = WAY.normalize();
    let [x, y] = extent::sides(direction, glam::Vec2::Y);
    let cases = [
        ("rectangle", ["width", "height"], x),
        ("rectangle", ["height", "width"], y),
        ("cylinder", ["length", "radius"], direction),
        ("banner", ["span", "rise"], x),
        ("banner", ["rise", "span"], y),
    ];
    for (light_type, [name, other], axis) in cases {
        for end in [0, 1] {
            let mut bench = lamp(light_type);
            let lens = Lens::of(&bench.session, bench.area.rect);
            let before = numbers(&bench, [name, other]);
            let way = if end == 0 { axis } else { -axis };
            let edge = |metres: f32| lens.project(PLACE + 0.5 * metres * way).unwrap();
            let at = ends(&bench, name)[end];
            assert!(at.distance(edge(before[0])) < 1.0, "{light_type}, {name}: {at:?} is not at its edge");
            let by = edge(before[0] + 0.3) - edge(before[0]);
            drag(&mut bench, at, by, Modifiers::NONE);
            let after = numbers(&bench, [name, other]);
            assert!((after[0] - before[0] - 0.3).abs() < 0.0151, "{light_type}, {name}: {after:?}");
            assert_eq!(after[1], before[1], "{light_type}, {name}");
            assert!(ends(&bench, name)[end].distance(at + by) < 2.5, "{light_type}, {name}");
            assert_eq!(bench.session.document.lights[0].position, Some(PLACE));
            assert_eq!(bench.session.document.done(), 1);
            bench.apply(Action::Undo);
            assert_eq!(numbers(&bench, [name, other]), before);
            assert!(bench.session.messages.is_empty());
        }
    }
}

#[test]
fn the_label_of_a_size_says_in_each_frame_what_outline_and_knob_show() {
    let mut bench = lamp("rectangle");
    let at = ends(&bench, "width")[0];
    let middle = Lens::of(&bench.session, bench.area.rect).project(PLACE).unwrap();
    let out = (at - middle).normalized();
    let said = |texts: Vec<String>| {
        let said = texts.iter().find_map(|text| text.strip_prefix("width ")?.strip_suffix(" m"));
        said.unwrap_or_else(|| panic!("{texts:?}")).parse::<f32>().expect("a number")
    };
    bench.frame(vec![Event::PointerMoved(at)]);
    press(&mut bench, at, true);
    for k in 1..=5 {
        // A frame paints the lamp before the edit that it asks for.
        let [painted] = numbers(&bench, ["width"]);
        bench.frame(vec![Event::PointerMoved(at + 15.0 * k as f32 * out)]);
        let said = said(bench.texts_just_painted());
        assert!((said - painted).abs() < 0.006, "frame {k} says {said} and shows {painted}");
        assert!(numbers(&bench, ["width"])[0] > painted + 0.01, "it follows the pointer");
    }
    let [width] = numbers(&bench, ["width"]);
    let said = said(bench.texts());
    assert!((said - width).abs() < 0.006, "at rest it says {said} of {width}");
}

#[test]
fn a_radius_grows_as_far_as_the_pointer_pulls() {
    for light_type in ["disc", "sphere", "cylinder", "ring_lamp"] {
        let mut bench = lamp(light_type);
        let middle = Lens::of(&bench.session, bench.area.rect).project(PLACE).unwrap();
        let all = ends(&bench, "radius");
        assert_eq!(all.len(), 1, "{light_type}");
        drag(&mut bench, all[0], 0.4 * (all[0] - middle), Modifiers::NONE);
        let [radius] = numbers(&bench, ["radius"]);
        assert!((radius - 0.7).abs() < 0.025, "{light_type}: {radius}");
        bench.apply(Action::Undo);
        assert_eq!(numbers(&bench, ["radius"]), [0.5], "{light_type}");
    }
}

#[test]
fn a_size_stays_within_its_range_and_goes_in_steps_with_ctrl() {
    let mut bench = lamp("banner");
    let at = ends(&bench, "span")[0];
    let middle = Lens::of(&bench.session, bench.area.rect).project(PLACE).unwrap();
    let out = (at - middle).normalized();
    drag(&mut bench, at, -500.0 * out, Modifiers::NONE);
    assert_eq!(numbers(&bench, ["span"]), [0.2]);
    // There its handle is separate from the centre nevertheless.
    let at = ends(&bench, "span")[0];
    assert!(at.distance(middle) > 20.0, "{at:?}");
    pull(&mut bench, at, 700.0 * out, Modifiers::NONE);
    assert_eq!(numbers(&bench, ["span"]), [3.0]);
    assert!(bench.texts().iter().any(|text| text == "span 3.000 m"), "{:?}", bench.texts());
    press(&mut bench, at + 700.0 * out, false);
    bench.settle();
    bench.apply(Action::Undo);
    drag(&mut bench, at, 60.0 * out, CTRL);
    let [span] = numbers(&bench, ["span"]);
    assert!(span > 0.5 && (4.0 * span).fract() == 0.0, "{span}");
    assert!(bench.session.messages.is_empty(), "{:?}", bench.session.messages);
}

#[test]
fn a_size_that_reaches_out_of_the_view_has_its_handle_at_the_edge() {
    let mut bench = lamp("rectangle");
    bench.session.document.amend(|scene| scene.lights[0].parameters.set("width", Value::Number(60.0)));
    bench.settle();
    let all = ends(&bench, "width");
    assert!(all.len() == 2 && all.iter().all(|at| bench.area.rect.contains(*at)), "{all:?}");
    let middle = Lens::of(&bench.session, bench.area.rect).project(PLACE).unwrap();
    drag(&mut bench, all[0], 30.0 * (middle - all[0]).normalized(), Modifiers::NONE);
    let [width] = numbers(&bench, ["width"]);
    assert!(width < 59.9 && width > 50.0, "{width}");
}

#[test]
fn a_lamp_is_rolled_about_its_direction() {
    for (light_type, name) in [("rectangle", "roll"), ("banner", "tilt")] {
        let mut bench = lamp(light_type);
        bench.apply(mode(HandleMode::Turn));
        let lens = Lens::of(&bench.session, bench.area.rect);
        let [x, y] = extent::sides(WAY.normalize(), glam::Vec2::Y);
        let middle = lens.project(PLACE).unwrap();
        let top = ends(&bench, name)[0];
        // The knob is at the top of the lamp.
        let up = lens.project(PLACE + 0.1 * y).unwrap() - middle;
        assert!((top - middle).normalized().dot(up.normalized()) > 0.999, "{light_type}");
        let arm = {
            let metres =
                |points: f32| points / lens.project(PLACE + 0.01 * y).unwrap().distance(middle) * 0.01;
            metres(top.distance(middle))
        };
        for (wanted, modifiers, slack) in [(40.0f32, Modifiers::NONE, 2.5), (-32.0, CTRL, 0.0)] {
            let angle = wanted.to_radians();
            let to = lens.project(PLACE + arm * (angle.cos() * y - angle.sin() * x)).unwrap();
            drag(&mut bench, top, to - top, modifiers);
            let [roll] = numbers(&bench, [name]);
            // The range of the tilt begins at 0.
            let expected = if slack == 0.0 { -30.0 } else { wanted };
            let expected = if name == "tilt" { expected.rem_euclid(360.0f32) } else { expected };
            assert!((roll - expected).abs() <= slack, "{light_type}: {roll} for {expected}");
            bench.apply(Action::Undo);
            assert_eq!(numbers(&bench, [name]), [0.0]);
        }
        // The direction has its own handle, which leaves space for the sizes.
        handle(&bench, "direction of");
        bench.apply(mode(HandleMode::Size));
        assert!(!bench.says("Handle: direction of"));
    }
    let mut bench = lamp("disc");
    bench.apply(mode(HandleMode::Turn));
    assert!(!bench.says("Handle: roll"), "a disc is round");
}

#[test]
fn each_view_has_the_handles_of_a_lamp_and_a_presentation_has_none() {
    let mut bench = lamp("rectangle");
    bench.apply(Action::Compare(CompareCommand::Add));
    bench.apply(Action::Compare(CompareCommand::Layout(Layout::SideBySide)));
    bench.apply(Action::Select(Selection::Light(0)));
    let widths = |bench: &Bench| {
        let named = bench.tree.iter().filter(|s| s.label == "Handle: width of Rectangle light 1");
        let mut all: Vec<_> = named.map(|s| s.rect.center()).collect();
        all.sort_by(|a, b| a.x.total_cmp(&b.x));
        all
    };
    assert_eq!(widths(&bench).len(), 2);
    for view in [0, 1] {
        let before = numbers(&bench, ["width"]);
        let at = widths(&bench)[view];
        let middle = Lens::of(&bench.session, bench.area.cells[view].rect).project(PLACE).unwrap();
        drag(&mut bench, at, 20.0 * (at - middle).normalized(), Modifiers::NONE);
        assert!(numbers(&bench, ["width"])[0] > before[0] + 0.05, "view {view}");
    }
    bench.apply(Action::View(ViewChange::Presenting(true)));
    assert!(!bench.says("Handle:"));
}

/// The closed lines in the selection colour.
fn outlines(bench: &mut Bench) -> Vec<Vec<Pos2>> {
    let selected = Color32::from_rgb(0x7c, 0xc8, 0xff);
    let of = |shape| match shape {
        Shape::Path(path) if path.closed && path.stroke.color == ColorMode::Solid(selected) => {
            Some(path.points)
        }
        _ => None,
    };
    bench.shapes().into_iter().filter_map(of).collect()
}

#[test]
fn a_lamp_that_is_selected_has_its_outline_also_where_it_is_not_to_be_seen() {
    let corners = |bench: &Bench| {
        let lens = Lens::of(&bench.session, bench.area.rect);
        let [x, y] = extent::sides(WAY.normalize(), glam::Vec2::Y);
        [(0.6, 0.4), (-0.6, 0.4), (-0.6, -0.4), (0.6, -0.4)]
            .map(|(a, b)| lens.project(PLACE + a * x + b * y).unwrap())
    };
    let mut bench = lamp("rectangle");
    for visible in [true, false] {
        let value = Value::flag(visible);
        bench.session.document.amend(|scene| scene.lights[0].parameters.set("visible", value.clone()));
        bench.settle();
        let all = outlines(&mut bench);
        let frame = corners(&bench);
        assert_eq!(all.len(), 1);
        assert!(all[0].len() == 4, "{all:?}");
        assert!(frame.iter().all(|c| all[0].iter().any(|p| p.distance(*c) < 0.1)), "{all:?} and {frame:?}");
    }
    bench.apply(Action::Select(Selection::Object(0)));
    bench.settle();
    assert!(outlines(&mut bench).is_empty());
    for light_type in ["disc", "sphere", "cylinder", "banner", "ring_lamp"] {
        assert_eq!(outlines(&mut lamp(light_type)).len(), 1, "{light_type}");
    }
}
