//! New parts of a scene are placed free and in view, and a new light shows the scene without blowing it out.

use std::sync::atomic::AtomicBool;

use bevy_egui::egui::{Key, Modifiers, Pos2, Rect, vec2};
use glam::{Mat3, Quat, Vec3};
use lights_camera_models::{
    document::Selection,
    optics::{
        colour::srgb_encode,
        tone::{ToneMapping, exposure_factor},
    },
    panel::{
        marks::{Lens, anchor},
        state::{Action, Effect, Session},
    },
    parameter::Value,
    reference,
    registry::Registry,
    scene::{
        Light, Object, Scene, SceneSize,
        comparison::Layout,
        load::{self, Defaults},
    },
};

use crate::{helpers::support::root, window::panels::Bench};

/// One of the shipped scenes.
fn shipped(name: &str) -> Scene {
    let path = root().join(format!("scenes/{name}.json"));
    load::file(&path, &Registry::builtin(), Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene
}

/// The sphere around an object.
fn radius(object: &Object, registry: &Registry) -> f32 {
    let shape = registry.shape(&object.object_type).unwrap();
    let mesh = shape.mesh(&object.shape, *shape.declaration.tessellation.start());
    object.size * mesh.positions.iter().map(|p| p.length()).fold(0.0, f32::max)
}

fn sees(session: &Session, p: Vec3) -> bool {
    let rect = Rect::from_min_size(Pos2::ZERO, vec2(1600.0, 900.0));
    Lens::of(session, rect).project(p).is_some_and(|at| rect.contains(at))
}

fn touches_nothing(what: &str, session: &Session, added: usize, registry: &Registry) {
    let object = &session.document.objects[added];
    let r = radius(object, registry);
    for (i, other) in session.document.objects.iter().enumerate().filter(|(i, _)| *i != added) {
        let apart = object.position.distance(other.position) - r - radius(other, registry);
        assert!(apart > 0.0, "{what}: {added} ({}) is in {i} by {} m", object.object_type, -apart);
    }
    for light in session.document.lights.iter().filter_map(|l| l.position) {
        assert!(object.position.distance(light) > r, "{added} is around a light");
    }
    assert!(object.position.distance(session.facts.eye) > r);
    assert!(session.document.scene_size.contains(object.position));
}

/// Rooms and cameras of several kinds.
fn labs() -> Vec<Session> {
    let mut low = Scene::default();
    low.objects[0].position = Vec3::new(2.0, 1.0, 3.0);
    let mut small =
        Scene { scene_size: SceneSize { height: 1.0, width: 1.5, depth: 1.0 }, ..Scene::default() };
    small.objects[0] = Object { position: Vec3::new(0.7, 0.5, 0.3), size: 0.3, ..Object::default() };
    small.lights[0].position = Some(Vec3::new(0.9, 0.9, 0.9));
    small.observer.position = Vec3::new(0.75, 0.5, 0.95);
    let mut turned = Session::default();
    // From the right, above.
    turned.facts.eye = Vec3::new(9.5, 7.5, 5.0);
    turned.facts.camera = Quat::from_rotation_y(std::f32::consts::FRAC_PI_2) * Quat::from_rotation_x(-0.5);
    vec![Session::default(), Session::new(low), Session::new(small), turned]
}

#[test]
fn new_objects_stand_free_and_in_view() {
    let registry = Registry::builtin();
    for (which, mut session) in labs().into_iter().enumerate() {
        for i in 0..9 {
            let kind = registry.shapes()[i % registry.shapes().len()].declaration.id;
            session.apply(Action::AddObject(kind.to_owned()), &registry);
            let added = session.document.objects.len() - 1;
            touches_nothing(&format!("{which}"), &session, added, &registry);
            assert!(sees(&session, session.document.objects[added].position), "{which}: {kind} {i}");
        }
    }
}

#[test]
fn a_new_object_hides_nothing_where_there_is_room() {
    let registry = Registry::builtin();
    let mut session = Session::default();
    session.apply(Action::AddObject("cube".to_owned()), &registry);
    let [old, new] = [0, 1].map(|i| &session.document.objects[i]);
    let rect = Rect::from_min_size(Pos2::ZERO, vec2(1600.0, 900.0));
    let [a, b] = [old, new].map(|o| Lens::of(&session, rect).project(o.position).unwrap());
    assert!(a.distance(b) > 300.0, "{a:?} and {b:?}");
}

#[test]
fn copies_stand_free_too() {
    let registry = Registry::builtin();
    let mut session = Session::default();
    for i in 0..4 {
        session.apply(Action::Duplicate(Selection::Object(0)), &registry);
        let objects = &session.document.objects;
        // There is space on the right and on the left; then the picture is full.
        if i < 2 {
            touches_nothing("copy", &session, 1, &registry);
        }
        assert!(sees(&session, objects[1].position), "copy {i}");
        assert_eq!((objects[1].size, objects[1].position.z), (objects[0].size, objects[0].position.z));
        let apart = |other: &Object| other.position.distance(objects[1].position) > 0.5;
        assert!(objects.iter().enumerate().all(|(k, other)| k == 1 || apart(other)), "copy {i}");
    }
    session.apply(Action::Duplicate(Selection::Light(0)), &registry);
    let [a, b] = [0, 1].map(|i| session.document.lights[i].position.unwrap());
    assert!(a.distance(b) > 0.2);
}

#[test]
fn the_copy_of_the_default_sphere_stands_beside_it() {
    let registry = Registry::builtin();
    let mut session = Session::default();
    session.apply(Action::Duplicate(Selection::Object(0)), &registry);
    session.apply(Action::Duplicate(Selection::Object(0)), &registry);
    let [a, b, c] = [0, 1, 2].map(|i| session.document.objects[i].position);
    assert!((a.z, a.y) == (b.z, b.y) && (a.z, a.y) == (c.z, c.y), "{a} {b} {c}");
}

#[test]
fn copies_stand_beside_the_original_at_the_same_depth() {
    let registry = Registry::builtin();
    // From the front, and from above and aside.
    let looks = [
        (Vec3::new(5.0, 5.0, 9.9), Vec3::NEG_Z),
        (Vec3::new(9.5, 9.0, 9.0), Vec3::new(-1.0, -0.9, -0.9).normalize()),
    ];
    for (eye, ahead) in looks {
        let mut session = Session::default();
        session.document = lights_camera_models::document::Document::new(Scene {
            objects: vec![Object { size: 1.0, ..Object::default() }],
            ..Scene::default()
        });
        session.facts.eye = eye;
        session.facts.camera = Quat::from_mat3(&Mat3::look_to_rh(ahead, Vec3::Y).transpose());
        let seen = |p: Vec3| session.facts.camera.inverse() * (p - eye);
        let first = seen(session.document.objects[0].position);
        let mut copied = session.clone();
        for i in 1..=2 {
            copied.apply(Action::Duplicate(Selection::Object(0)), &registry);
            let copy = seen(copied.document.objects[1].position);
            assert!((copy.z - first.z).abs() < 0.02, "{i}: at {copy}, not at the depth of {first}");
            assert!((copy.y - first.y).abs() < 0.02, "{i}: {copy} is not beside {first}");
            assert!(((copy.x - first.x).abs() - 1.1).abs() < 0.15, "{i}: {copy} is not next to {first}");
        }
        copied.apply(Action::Duplicate(Selection::Light(0)), &registry);
        let [of, copy] = [0, 1].map(|i| seen(copied.document.lights[i].position.expect("it has one")));
        assert!((copy.z - of.z).abs() < 0.02, "{copy} {of}");
    }
}

#[test]
fn copies_keep_the_depth_and_are_seen_where_there_is_little_room() {
    let registry = Registry::builtin();
    for (name, index) in [
        ("gouraud_misses_highlight", 1),
        ("shapes_and_lights", 1),
        ("shapes_and_lights", 2),
        ("superellipsoids", 0),
        ("superellipsoids", 1),
        ("superellipsoids", 4),
    ] {
        let mut session = Session::new(shipped(name));
        let (eye, to_camera) = (session.facts.eye, session.facts.camera.inverse());
        session.apply(Action::Duplicate(Selection::Object(index)), &registry);
        let [original, copy] = [index, index + 1].map(|i| session.document.objects[i].clone());
        let [was, is] = [&original, &copy].map(|o| to_camera * (o.position - eye));
        let what =
            format!("{name}, {}: from {} to {}", original.object_type, original.position, copy.position);
        assert!((was.z - is.z).abs() < 0.02, "{what}: another depth");
        assert!(sees(&session, copy.position), "{what}: out of the picture");
        assert!((was - is).truncate().length() > 0.2 * original.size, "{what}: over the original");
        // No neighbour is more in the way than the original may be.
        let others =
            session.document.objects.iter().enumerate().filter(|(i, _)| *i != index && *i != index + 1);
        for (_, other) in others.filter(|(_, other)| other.size < 10.0) {
            let there = to_camera * (other.position - eye);
            let apart = (there.truncate() / there.z).distance(is.truncate() / is.z) * -is.z;
            let least = 0.5 * (0.5 * original.size + 0.5 * other.size);
            assert!(apart > least, "{what}: before or behind the {}", other.object_type);
        }
    }
}

#[test]
fn a_copy_for_which_the_picture_has_no_room_stands_beside_the_original_and_a_message_says_so() {
    let registry = Registry::builtin();
    for (name, single) in
        [("compare_phong_blinn_phong", false), ("compare_phong_blinn_phong", true), ("portrait", true)]
    {
        let mut scene = shipped(name);
        if single {
            scene.comparison.layout = Layout::Single;
        }
        let mut session = Session::new(scene);
        for nth in 0..2 {
            session.messages.clear();
            session.apply(Action::Duplicate(Selection::Object(0)), &registry);
            let what = format!("{name}, single {single}, copy {nth}");
            touches_nothing(&what, &session, 1, &registry);
            let objects = &session.document.objects;
            let by = session.facts.camera.inverse() * (objects[1].position - objects[0].position);
            assert!(by.y.abs() < 0.02 && by.z.abs() < 0.02, "{what}: {by}, as the camera sees it");
            assert!(by.x.abs() < 1.15 * objects[0].size, "{what}: {by}");
            let offer = Action::Do(Effect::FocusSelection);
            let said = session.messages.iter().any(|note| {
                note.offer.as_ref().is_some_and(|(label, action)| *label == "Frame it" && **action == offer)
            });
            assert!(said, "{what}: {:?}", session.messages);
        }
    }
    let mut session = Session::default();
    session.apply(Action::Duplicate(Selection::Object(0)), &registry);
    assert!(session.messages.is_empty(), "{:?}", session.messages);
}

#[test]
fn a_copy_that_a_wide_window_shows_whole_needs_no_framing() {
    for (size, whole) in [(vec2(1280.0, 720.0), false), (vec2(2600.0, 700.0), true)] {
        let mut scene = Scene::default();
        scene.objects[0].size = 2.4;
        let mut bench = Bench::new(Session::new(scene));
        bench.size = size;
        bench.apply(Action::Select(Selection::Object(0)));
        let aspect = bench.area.aspect().expect("there is a picture");
        assert_eq!(aspect > 2.5, whole, "{size}: {aspect}");
        bench.key(Key::D, Modifiers::CTRL | Modifiers::COMMAND);
        assert_eq!(bench.session.document.objects.len(), 2, "{size}");
        let offers = |(label, _): &(&str, Box<Action>)| *label == "Frame it";
        let said = bench.session.messages.iter().any(|note| note.offer.as_ref().is_some_and(offers));
        assert_eq!(said, !whole, "{size}: {:?}", bench.session.messages);
    }
}

#[test]
fn copies_of_neighbours_leave_each_other_room() {
    let registry = Registry::builtin();
    let mut session = Session::new(Scene {
        objects: [4.0, 5.2]
            .map(|x| Object { size: 0.8, position: Vec3::new(x, 5.0, 5.0), ..Object::default() })
            .into(),
        ..Scene::default()
    });
    // To the right of the left one is the other.
    session.apply(Action::Duplicate(Selection::Object(0)), &registry);
    let copy = session.document.objects[1].position;
    assert!(copy.distance(Vec3::new(3.12, 5.0, 5.0)) < 0.05, "{copy}");
    touches_nothing("copy", &session, 1, &registry);
}

#[test]
fn on_a_floor_copies_of_lights_stand_beside_them_and_new_parts_in_view() {
    let registry = Registry::builtin();
    for index in 0..2 {
        let mut session = Session::new(shipped("shapes_and_lights"));
        let (eye, to_camera) = (session.facts.eye, session.facts.camera.inverse());
        session.apply(Action::Duplicate(Selection::Light(index)), &registry);
        let [was, is] = [index, index + 1].map(|i| session.document.lights[i].position.expect("it has one"));
        assert!(was.distance(is) < 6.0, "{index}: from {was} to {is}");
        let [from, to] = [was, is].map(|p| to_camera * (p - eye));
        assert!((from.z - to.z).abs() < 0.02, "{index}: from {from} to {to}, seen by the camera");
        assert!(!sees(&session, was) || sees(&session, is), "{index}: {is} is out of the picture");
        assert!(is.y > 40.0, "{index}: {is} is in the floor");
    }
    for kind in ["point", "spot", "rectangle"] {
        let mut session = Session::new(shipped("shapes_and_lights"));
        session.apply(Action::AddLight(kind.to_owned()), &registry);
        let at = session.document.lights.last().and_then(|light| light.position).expect("it has one");
        assert!(sees(&session, at) && at.y > 40.0, "a {kind} at {at}");
    }
    let mut session = Session::new(shipped("shapes_and_lights"));
    session.apply(Action::AddObject("sphere".to_owned()), &registry);
    let added = session.document.objects.last().expect("added");
    assert!(sees(&session, added.position), "{}", added.position);
    assert!(added.position.y - radius(added, &registry) > 40.0, "{} is in the floor", added.position);
}

#[test]
fn in_a_room_that_is_an_object_copies_of_lights_stand_beside_them() {
    let registry = Registry::builtin();
    let mut scene = Scene::default();
    let room =
        Object { object_type: "cube".to_owned(), position: Vec3::splat(5.0), size: 9.9, ..Object::default() };
    scene.objects.push(room);
    scene.lights[0].position = Some(Vec3::new(5.5, 5.5, 6.0));
    let mut session = Session::new(scene);
    session.apply(Action::Duplicate(Selection::Light(0)), &registry);
    let [was, is] = [0, 1].map(|i| session.document.lights[i].position.expect("it has one"));
    assert!(was.distance(is) < 2.0 && sees(&session, is), "from {was} to {is}");
}

/// Twelve objects in columns and rows at these distances, and others, with a camera.
fn twelve(start: Vec3, apart: Vec3, others: Vec<Object>, eye: Vec3, ahead: Vec3) -> Session {
    let object = |i: usize| Object {
        position: start + apart * Vec3::new((i % 6) as f32, (i / 6) as f32, 0.0),
        size: 0.5,
        ..Object::default()
    };
    let objects = (0..12).map(object).chain(others).collect();
    let mut session = Session::new(Scene { objects, ..Scene::default() });
    session.facts.eye = eye;
    session.facts.camera = Quat::from_mat3(&Mat3::look_to_rh(ahead, Vec3::Y).transpose());
    session
}

/// Duplicates the twelve objects, whose copies must keep their formation and stand in nothing. Returns the step to the
/// copies, and the extents of the originals, as the camera sees them.
fn step_of_twelve(what: &str, mut session: Session, registry: &Registry) -> [Vec3; 2] {
    let first = session.document.objects.len();
    let all = (0..12).map(Selection::Object).collect();
    session.apply(Action::SelectEach(all, false), registry);
    session.apply(Action::Duplicate(Selection::Object(0)), registry);
    let objects = &session.document.objects;
    assert_eq!(objects.len(), first + 12, "{what}");
    let by = objects[first].position - objects[0].position;
    for (i, (copy, original)) in objects[first..].iter().zip(objects).enumerate() {
        assert!(copy.position.distance(original.position + by) < 1e-3, "{what}: {i} leaves the formation");
        assert!(session.document.scene_size.contains(copy.position), "{what}: {i} is outside");
        for (k, other) in objects[..first].iter().enumerate() {
            let apart =
                copy.position.distance(other.position) - radius(copy, registry) - radius(other, registry);
            assert!(apart > -1e-3, "{what}: the copy of {i} is in {k} by {} m", -apart);
        }
    }
    let to_camera = session.facts.camera.inverse();
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for object in &objects[..12] {
        let seen = to_camera * object.position;
        (low, high) = (low.min(seen), high.max(seen));
    }
    [to_camera * by, high - low + objects[0].size]
}

#[test]
fn copies_of_several_stand_beside_all_of_them_at_the_same_depth() {
    let registry = Registry::builtin();
    let (start, apart) = (Vec3::new(3.5, 4.7, 5.0), Vec3::splat(0.6));
    let front = (Vec3::new(5.0, 5.0, 9.9), Vec3::NEG_Z);
    let above = (Vec3::new(9.5, 9.0, 9.0), Vec3::new(-1.0, -0.9, -0.9).normalize());
    let block = Object { position: Vec3::new(5.0, 6.7, 5.0), size: 0.8, ..Object::default() };
    for (what, others, (eye, ahead)) in [
        ("from the front", vec![], front),
        ("from above", vec![], above),
        ("with an object in the way", vec![block], front),
    ] {
        let [by, extent] = step_of_twelve(what, twelve(start, apart, others, eye, ahead), &registry);
        assert!(by.z.abs() < 0.02, "{what}: {by} leads to another depth");
        // As a whole: not between them.
        assert!(
            by.x.abs() > extent.x || by.y.abs() > extent.y,
            "{what}: {by}, and they extend over {extent}"
        );
    }
}

#[test]
fn copies_of_several_that_fill_the_room_stand_where_nothing_is() {
    let registry = Registry::builtin();
    let (start, apart) = (Vec3::new(0.9, 1.0, 5.0), Vec3::new(1.6, 8.0, 1.0));
    let session = twelve(start, apart, Vec::new(), Vec3::new(5.0, 5.0, 9.9), Vec3::NEG_Z);
    step_of_twelve("a wall of them", session, &registry);
}

#[test]
fn new_lights_stand_free_and_in_view() {
    let registry = Registry::builtin();
    for (which, mut session) in labs().into_iter().enumerate() {
        for kind in ["point", "spot", "point", "directional", "spot"] {
            session.apply(Action::AddLight(kind.to_owned()), &registry);
            let Some(light) = session.document.lights.last() else { panic!("none") };
            let Some(at) = light.position else { continue };
            assert!(sees(&session, at), "{which}: a {kind} at {at}");
            assert_eq!(anchor(light, &session.document), Some(at));
            for object in &session.document.objects {
                let apart = at.distance(object.position) - radius(object, &registry);
                assert!(apart > 0.0, "{which}: a {kind} stands in an object");
            }
            let others = &session.document.lights[..session.document.lights.len() - 1];
            assert!(others.iter().filter_map(|l| l.position).all(|p| p.distance(at) > 0.02), "{which}");
        }
    }
}

#[test]
fn a_new_lamp_lights_what_is_selected_from_above_and_shows_its_bright_side() {
    let registry = Registry::builtin();
    let small = Object { size: 0.3, position: Vec3::new(6.0, 4.5, 5.0), ..Object::default() };
    let mut two = Scene::default();
    two.objects.push(small);
    for (what, scene, aim) in [("one", Scene::default(), 0), ("two", two, 1)] {
        for kind in ["rectangle", "disc", "sphere", "cylinder"] {
            let mut session = Session::new(scene.clone());
            session.apply(Action::Select(Selection::Object(aim)), &registry);
            let target = session.document.objects[aim].position;
            session.apply(Action::AddLight(kind.to_owned()), &registry);
            let light = session.document.lights.last().expect("added").clone();
            let at = light.position.expect("it has a position");
            assert!(sees(&session, at), "{what}: a {kind} at {at}");
            let (way, eye) = (target - at, session.facts.eye - at);
            let above = (session.facts.camera.inverse() * -way).y;
            assert!(above > 0.1 * way.length(), "{what}: a {kind} {above} m above");
            if let Some(direction) = light.direction {
                let facing = direction.dot(way.normalize());
                if kind == "cylinder" {
                    assert!(facing.abs() < 0.05, "{what}: a tube's end faces the object: {facing}");
                } else {
                    assert!(facing > 0.98, "{what}: {kind}, {facing}");
                    assert!(direction.dot(eye) > 0.0, "{what}: the camera sees the back of the {kind}");
                }
            }
            let entry = registry.light(kind).expect("built in");
            let span = entry.span(&light.parameters) / way.length();
            assert!((0.1..0.6).contains(&span), "{what}: {kind}, {span} of its distance");
            for object in &session.document.objects {
                let apart = at.distance(object.position) - radius(object, &registry);
                assert!(apart > 0.5 * entry.span(&light.parameters), "{what}: a {kind} in an object");
            }
            // Alone, it lights a good part of what is seen.
            let lit = |light: Light| {
                let mut alone = session.document.scene().clone();
                alone.lights = vec![light];
                let all = brightness(&Session::new(alone), &registry);
                all.iter().filter(|b| **b > 0.02).count() as f32 / all.len() as f32
            };
            let part = lit(light.clone());
            assert!(part > 0.2, "{what}: a {kind} lights {part} of what is seen");
            if matches!(kind, "rectangle" | "disc") {
                // The wrong twin: it turns its back.
                let back = lit(Light { direction: light.direction.map(|d| -d), ..light });
                assert!(back < 0.05, "{what}: {kind}, {back}");
            }
        }
    }
}

/// The brightest channel of each pixel that shows an object, relative to the maximum of the display.
fn brightness(session: &Session, registry: &Registry) -> Vec<f32> {
    let settings = reference::Settings { width: 320, height: 180, samples: 1, ..Default::default() };
    // Only the objects, not lamps in front of and behind them.
    let mut scene = session.document.scene().clone();
    for light in &mut scene.lights {
        if registry.light(&light.light_type).is_some_and(|entry| entry.declaration.extent) {
            light.parameters.set("visible", Value::flag(false));
        }
    }
    let picture = reference::render(&scene, registry, &settings);
    let exposure = exposure_factor(session.document.display.exposure);
    let lit = picture.pixels.iter().filter(|p| p.w > 0.0);
    lit.map(|p| exposure * p.truncate().max_element()).collect()
}

#[test]
fn a_new_light_shows_the_scene_and_does_not_blow_it_out() {
    let registry = Registry::builtin();
    let dark = |mut scene: Scene| {
        scene.lights[0].intensity = 0.0;
        scene
    };
    let mut bright = Scene::default();
    bright.display.exposure = 3.0;
    let mut dim = Scene::default();
    dim.display.exposure = -3.0;
    let mut large =
        Scene { scene_size: SceneSize { height: 100.0, width: 100.0, depth: 100.0 }, ..Scene::default() };
    large.objects[0] = Object { position: Vec3::splat(50.0), size: 20.0, ..Object::default() };
    large.observer.position = Vec3::new(50.0, 50.0, 95.0);
    let shiny = Scene { reflection_model: "blinn_phong".to_owned(), ..Scene::default() };
    for (what, scene) in [
        ("default", Scene::default()),
        ("dark", dark(Scene::default())),
        ("bright", dark(bright)),
        ("dim", dark(dim)),
        ("large", dark(large)),
        ("shiny", shiny),
    ] {
        let before = brightness(&Session::new(scene.clone()), &registry);
        for kind in registry.lights() {
            let kind = kind.declaration.id;
            let mut session = Session::new(scene.clone());
            let mut after = Vec::new();
            for nth in 0..3 {
                session.apply(Action::AddLight(kind.to_owned()), &registry);
                after = brightness(&session, &registry);
                let clipped =
                    |all: &[f32]| all.iter().filter(|b| **b > 1.0).count() as f32 / all.len() as f32;
                let more = clipped(&after) - clipped(&before);
                let light = session.document.lights.last();
                // Three studio lights shine from the same positions.
                let most = if kind == "environment" { 0.025 } else { 0.02 };
                assert!(more < most, "{what}, {kind} {nth}: {more} of the objects clip: {light:?}");
            }
            let gain = after.iter().zip(&before).map(|(a, b)| a - b).fold(0.0, f32::max);
            assert!(gain > 0.04, "{what}, {kind}: the brightest gain is {gain}");
        }
    }
}

#[test]
fn a_new_light_is_noticed_at_once() {
    let registry = Registry::builtin();
    let shown = |b: f32| srgb_encode(b.min(1.0));
    let before = brightness(&Session::default(), &registry);
    for kind in registry.lights() {
        let kind = kind.declaration.id;
        let mut session = Session::default();
        session.apply(Action::AddLight(kind.to_owned()), &registry);
        let after = brightness(&session, &registry);
        let gains = after.iter().zip(&before).map(|(a, b)| shown(*a) - shown(*b));
        let noticed = gains.filter(|gain| *gain > 0.1).count() as f32 / before.len() as f32;
        println!("{kind} {noticed} {:?}", session.document.lights[1]);
        // The cone of a spot is narrow.
        let least = if kind == "spot" { 0.05 } else { 0.15 };
        assert!(noticed > least, "{kind}: {noticed} of the objects get brighter, visibly");
    }
}

#[test]
fn a_curve_of_tone_mapping_leaves_a_new_light_more_room() {
    let registry = Registry::builtin();
    let mut session = Session::default();
    session.apply(Action::AddLight("point".to_owned()), &registry);
    let mut mapped = Scene::default();
    mapped.display.tone_mapping = ToneMapping::Reinhard;
    let mut lab2 = Session::new(mapped);
    lab2.apply(Action::AddLight("point".to_owned()), &registry);
    let of = |session: &Session| session.document.lights.last().map_or(0.0, |l: &Light| l.intensity);
    assert!(of(&lab2) > 2.0 * of(&session), "{} and {}", of(&lab2), of(&session));
}

/// A scene with six more objects.
fn crowded(registry: &Registry) -> Session {
    let mut session = Session::default();
    for kind in ["sphere", "cube", "torus", "teapot", "sphere", "cube"] {
        session.apply(Action::AddObject(kind.to_owned()), registry);
    }
    session
}

#[test]
fn each_of_many_new_lights_can_be_seen() {
    let registry = Registry::builtin();
    // Adds a light, and returns the brightness with it.
    let add = |session: &mut Session, before: &[f32], (kind, nth): (&str, usize)| {
        session.apply(Action::AddLight(kind.to_owned()), &registry);
        let after = brightness(session, &registry);
        let shown = |b: f32| srgb_encode(b.min(1.0));
        let mut gains: Vec<_> = after.iter().zip(before).map(|(a, b)| shown(*a) - shown(*b)).collect();
        gains.sort_by(f32::total_cmp);
        // Spots reach little of the scene.
        let gain = gains[gains.len() * if kind == "spot" { 995 } else { 970 } / 1000];
        let cd = session.document.lights.last().map_or(0.0, |l| l.intensity);
        assert!(gain > 0.035, "{kind} {nth} of {cd}: a gain of {gain}");
        after
    };
    let mut session = crowded(&registry);
    let mut before = brightness(&session, &registry);
    for nth in 0..4 {
        before = add(&mut session, &before, ("point", nth));
    }
    // Each kind as the fifth.
    for kind in ["point", "ambient", "directional", "spot"] {
        add(&mut session.clone(), &before, (kind, 4));
    }
}

#[test]
fn a_new_light_says_if_the_picture_clips_with_it() {
    let registry = Registry::builtin();
    let mut session = crowded(&registry);
    session.apply(Action::AddLight("point".to_owned()), &registry);
    assert!(session.messages.is_empty(), "{:?}", session.messages);
    for _ in 0..15 {
        session.apply(Action::AddLight("point".to_owned()), &registry);
    }
    assert!(session.messages.iter().any(|m| m.text.contains("the picture clips")));
}

#[test]
fn new_positions_are_short_numbers() {
    let registry = Registry::builtin();
    let mut session = crowded(&registry);
    for kind in ["point", "spot", "directional", "point"] {
        session.apply(Action::AddLight(kind.to_owned()), &registry);
    }
    let decimals = |v: f32| v.to_string().split_once('.').map_or(0, |(_, d)| d.len());
    let all = |v: Vec3| v.to_array().map(decimals).into_iter().max().unwrap_or(0);
    for object in &session.document.objects {
        assert!(all(object.position) <= 1, "{}", object.position);
    }
    for light in &session.document.lights[1..] {
        assert!(light.position.is_none_or(|p| all(p) <= 1), "{:?}", light.position);
        assert!(light.direction.is_none_or(|d| all(d) <= 2), "{:?}", light.direction);
    }
}

/// A picture of a session in which some lights with a position are visible: the first ones, so many.
fn with_lamps(session: &Session, visible: usize, registry: &Registry) -> reference::Picture {
    let settings = reference::Settings { width: 320, height: 180, samples: 1, ..Default::default() };
    let mut scene = session.document.scene().clone();
    let lights = scene.lights.iter_mut().filter(|light| light.position.is_some());
    for (i, light) in lights.enumerate() {
        if registry.light(&light.light_type).is_some_and(|entry| entry.declaration.extent) {
            light.parameters.set("visible", Value::flag(i < visible));
        }
    }
    let samples = reference::LightSamples { first: 0, count: 4 };
    reference::render_samples(&scene, registry, &settings, samples, &AtomicBool::default())
}

#[test]
fn new_lamps_cover_no_object_and_no_other_lamp() {
    let registry = Registry::builtin();
    let dark = Scene { lights: Vec::new(), ..Scene::default() };
    // The view of the studio is narrow.
    for (what, scene) in [("dark", dark), ("studio", shipped("studio"))] {
        let mut session = Session::new(scene);
        for (nth, kind) in ["rectangle", "disc", "sphere"].into_iter().enumerate() {
            session.apply(Action::AddLight(kind.to_owned()), &registry);
            let all = [0, nth, nth + 1].map(|visible| with_lamps(&session, visible, &registry));
            let [bare, before, after] = all.each_ref().map(|picture| &picture.pixels);
            let things = || (0..bare.len()).filter(move |i| bare[*i].w > 0.0 || bare[*i] != before[*i]);
            let covered = things().filter(|i| before[*i] != after[*i]).count();
            let light = session.document.lights.last();
            assert!(100 * covered < things().count(), "{what}, {kind}: {covered} pixels: {light:?}");
            let seen = (0..bare.len()).filter(|i| before[*i] != after[*i]).count();
            let least = if kind == "sphere" { 20 } else { 8 };
            assert!(seen > least, "{what}: only {seen} pixels show the {kind}: {light:?}");
        }
    }
}

#[test]
fn a_new_lamp_shows_its_bright_side_in_narrow_views_too() {
    let registry = Registry::builtin();
    let mut narrow = Scene::default();
    narrow.observer.field_of_view = 25.0;
    for (what, scene) in [
        ("narrow", narrow),
        ("two views", shipped("compare_gouraud_phong")),
        ("two views with two lights", shipped("compare_phong_blinn_phong")),
    ] {
        for kind in ["rectangle", "disc"] {
            let mut session = Session::new(scene.clone());
            session.apply(Action::AddLight(kind.to_owned()), &registry);
            let light = session.document.lights.last().expect("added").clone();
            let (at, direction) = (light.position.expect("it has one"), light.direction.expect("it has one"));
            let (object, eye) = (&session.document.objects[0], session.facts.eye);
            let what = format!("{what}: a {kind} at {at} towards {direction}");
            assert!(direction.dot((object.position - at).normalize()) > 0.98, "{what} lights something else");
            assert!(direction.dot((eye - at).normalize()) > 0.03, "{what} shows its back or its edge");
            for width in [700.0, 1600.0] {
                let rect = Rect::from_min_size(Pos2::ZERO, vec2(width, 900.0));
                let seen = Lens::of(&session, rect).project(at);
                assert!(seen.is_some_and(|at| rect.contains(at)), "{what} is out of a picture of {width}");
            }
            let way = object.position - eye;
            let edge = (radius(object, &registry) / way.length()).asin();
            assert!(way.angle_between(at - eye) > edge, "{what} is before or behind the object");
        }
    }
}

#[test]
fn a_second_lamp_stands_in_a_picture_that_is_narrower_than_the_usual_distance_of_lights() {
    let registry = Registry::builtin();
    let mut scene = Scene::default();
    scene.observer.field_of_view = 3.0;
    scene.objects[0].size = 0.05;
    let mut session = Session::new(scene);
    for nth in 0..2 {
        session.apply(Action::AddLight("rectangle".to_owned()), &registry);
        let at = session.document.lights.last().and_then(|light| light.position).expect("it has one");
        assert!(sees(&session, at), "{nth} at {at}");
    }
}

#[test]
fn a_second_environment_leaves_the_background_as_the_first_does() {
    let registry = Registry::builtin();
    let visible = |session: &Session| {
        let light = session.document.lights.last().expect("added");
        registry.light(&light.light_type).expect("built in").is_visible(&light.parameters)
    };
    let add = |scene: Scene| {
        let mut session = Session::new(scene);
        session.apply(Action::AddLight("environment".to_owned()), &registry);
        visible(&session)
    };
    // That of the studio is not in sight, and the sky is: both add up.
    assert!(!add(shipped("studio")));
    assert!(add(shipped("under_the_sky")));
    assert!(add(Scene::default()));
    let mut studio = shipped("studio");
    studio.lights[0].enabled = false;
    assert!(add(studio));
}
