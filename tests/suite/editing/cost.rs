//! The cost of changes among thousands of objects, counted rather than timed.

use std::path::Path;

use bevy::{
    ecs::{prelude::*, system::RunSystemOnce as _},
    prelude::Transform,
};
use glam::Vec3;
use lights_camera_models::{
    custom,
    document::{Document, Edit, Selection},
    panel::{follow::follow_registry, state::Session},
    parameter::Value,
    registry::Registry,
    render::{
        camera::picture_camera,
        capture::gpu::{GpuRenderer, Output},
        entities::{CurrentScene, SceneEntities},
        overrides::Overrides,
        parts::{Animated, Surface},
        tables::ParameterTables,
        view::View,
    },
    scene::{Object, Part, Scene},
};

const OBJECTS: usize = 2_000;
const SIZE: u32 = 96;
/// More bytes than any row of a table.
const ROW: u64 = 1024;

fn scene(objects: usize) -> Scene {
    let object = |i: usize| {
        let place = Vec3::new((i % 100) as f32, (i / 100) as f32, 0.0) * 0.09 + Vec3::new(0.5, 0.5, 2.0);
        let mut object =
            Object { object_type: "cube".to_owned(), size: 0.05, position: place, ..Object::default() };
        object.material.set("base_colour", Value::Colour([(i % 251) as u8, (i % 241) as u8, 90]));
        object
    };
    Scene { objects: (0..objects).map(object).collect(), ..Scene::default() }
}

fn renderer(scene: &Scene) -> GpuRenderer {
    let mut renderer =
        GpuRenderer::new(SIZE, SIZE, 1, Output::Display).expect("software Vulkan is installed");
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    renderer
}

/// Objects visited and bytes passed to the renderer in a frame after a change, and in the next.
fn cost(renderer: &mut GpuRenderer, change: impl FnOnce(&mut World)) -> [(u64, u64); 2] {
    let counts = |renderer: &mut GpuRenderer| {
        let world = renderer.app().world();
        (world.resource::<SceneEntities>().visits(), world.resource::<ParameterTables>().uploaded())
    };
    change(renderer.app().world_mut());
    [0, 1].map(|_| {
        let before = counts(renderer);
        renderer.step();
        let after = counts(renderer);
        (after.0 - before.0, after.1 - before.1)
    })
}

/// Displays the document, as the window does.
fn show(world: &mut World, document: &Document) {
    let document = document.clone();
    world
        .run_system_once(move |mut entities: ResMut<SceneEntities>, scene: ResMut<CurrentScene>| {
            entities.show(&document, scene);
        })
        .expect("both are there");
}

#[test]
fn a_change_of_one_object_of_thousands_is_work_for_that_one() {
    let registry = Registry::builtin();
    let mut document = Document::new(scene(OBJECTS));
    let mut renderer = renderer(&document);
    // First only views without overrides, then also one with overrides.
    for views in [1, 2] {
        if views == 2 {
            renderer.draw_on_demand();
            let overrides = Overrides { shading_model: Some("flat".to_owned()), ..Overrides::default() };
            let view = View::for_display(glam::UVec2::splat(SIZE));
            let target = bevy::camera::RenderTarget::None { size: glam::UVec2::ONE };
            let camera = (picture_camera(1), bevy::camera::Hdr, target, view, overrides);
            renderer.app().world_mut().spawn(camera);
            renderer.settle().expect("the GPU draws");
        }
        cost(&mut renderer, |world| show(world, &document));
        assert_eq!(cost(&mut renderer, |_| {}), [(0, 0); 2], "nothing");
        assert_eq!(cost(&mut renderer, |world| show(world, &document)), [(0, 0); 2], "the same scene");
        let one = |what: &str, uploads: bool, costs: [(u64, u64); 2]| {
            let [now, later] = costs;
            // The entity is written, compared, and drawn in each kind of view.
            assert!((1..=2 + views).contains(&now.0), "{what}: {} objects are looked at", now.0);
            assert!(later.0 <= 1 && later.1 == 0, "{what}: {later:?}");
            let bytes = if uploads { 1..=views * ROW } else { 0..=0 };
            assert!(bytes.contains(&now.1), "{what}: {} bytes", now.1);
        };
        let costs = cost(&mut renderer, |world| {
            let object = world.resource::<SceneEntities>().objects[17];
            let mut surface = world.get_mut::<Surface>(object).expect("it is an object");
            surface.material.set("base_colour", Value::Colour([1, 2, views as u8]));
        });
        one("a component", true, costs);
        // The document is informed.
        let shown = renderer.app().world().resource::<CurrentScene>().0.clone();
        document.replace("Change by a system", Selection::Room, shown, &registry);
        let costs = cost(&mut renderer, |world| show(world, &document));
        assert_eq!(costs[1], (0, 0));
        for (edit, uploads) in [
            (
                Edit::material(
                    Part::Object(OBJECTS / 2),
                    "base_colour",
                    Value::Colour([200, 2, views as u8]),
                ),
                true,
            ),
            (
                Edit::set(
                    Part::Object(OBJECTS / 2),
                    Object::position,
                    Vec3::new(0.5, 0.5, 1.0 + views as f32),
                ),
                false,
            ),
            (Edit::set(Part::Object(OBJECTS / 2), Object::size, 0.25 * views as f32), false),
        ] {
            let what = format!("{edit:?}");
            document.end_gesture();
            document.edit(edit, Selection::Room, &registry).expect("legal");
            let costs = cost(&mut renderer, |world| show(world, &document));
            one(&what, uploads, costs);
        }
        document.undo().expect("a step");
        let costs = cost(&mut renderer, |world| show(world, &document));
        one("undoing", false, costs);
        document.undo().expect("a step");
    }
    show(renderer.app().world_mut(), &document);
    renderer.settle().expect("the GPU draws");
    let picture = renderer.read().expect("the picture can be read");
    let mut alone = self::renderer(&document);
    assert!(picture == alone.read().expect("the picture can be read"), "what is drawn is the document");
}

#[test]
fn animating_thousands_is_no_work_for_the_scene() {
    let mut renderer = renderer(&scene(OBJECTS));
    renderer.draw_on_demand();
    renderer.settle().expect("the GPU draws");
    cost(&mut renderer, |_| {});
    let stored = renderer.app().world().resource::<CurrentScene>().0.clone();
    let before = renderer.read().expect("the picture can be read");
    let objects = renderer.app().world().resource::<SceneEntities>().objects.clone();
    let turn = |world: &mut World| {
        for object in &objects {
            world.get_mut::<Transform>(*object).expect("objects have a place").rotate_y(0.5);
        }
    };
    let animate = |world: &mut World| {
        objects.iter().for_each(|object| _ = world.entity_mut(*object).insert(Animated));
        turn(world);
    };
    assert_eq!(cost(&mut renderer, animate), [(0, 0); 2]);
    assert_eq!(cost(&mut renderer, turn), [(0, 0); 2]);
    let picture = renderer.read().expect("the picture can be read");
    assert!(before != picture, "the animation shows, in a view that is drawn on demand");
    assert!(renderer.app().world().resource::<CurrentScene>().0 == stored);
    // The wrong twin: without the marker it is a change of every object.
    let rest = |world: &mut World| {
        objects.iter().for_each(|object| _ = world.entity_mut(*object).remove::<Animated>());
    };
    cost(&mut renderer, rest);
    assert!(before == renderer.read().expect("the picture can be read"), "they are back");
    let [now, later] = cost(&mut renderer, turn);
    assert!(now.0 == OBJECTS as u64 && now.1 == 0 && later == (0, 0), "{now:?} {later:?}");
    let scene = &renderer.app().world().resource::<CurrentScene>().0;
    assert!(scene.objects.iter().all(|object| object.rotation.y != 0.0));
}

#[test]
fn rows_that_change_together_are_handed_over_together() {
    let mut scene = scene(OBJECTS);
    let mut renderer = renderer(&scene);
    for object in &mut scene.objects {
        object.material.set("base_colour", Value::Colour([9, 9, 9]));
    }
    let costs = cost(&mut renderer, |world| world.resource_mut::<CurrentScene>().0.clone_from(&scene));
    assert!(costs[0].1 >= 16 * OBJECTS as u64 && costs[1] == (0, 0), "{costs:?}");
    let picture = renderer.read().expect("the picture can be read");
    let mut alone = self::renderer(&scene);
    assert!(picture == alone.read().expect("the picture can be read"));
}

#[test]
fn a_change_of_the_models_is_work_in_proportion_to_the_objects() {
    let put = |registry: &mut Registry, parameter: &str| {
        let text = format!(
            "/* lcm {{ \"parameters\": [{{ \"name\": \"{parameter}\" }}] }} */\nfn response(l: vec3<f32>, v: vec3<f32>, frame: \
             Frame, m: Parameters) -> Terms {{\n    return Terms(vec3(0.0), vec3(max(dot(frame.n, l), 0.0)), vec3(0.0));\n}}\n"
        );
        let model = custom::read(Path::new("models/mine.wgsl"), &text, registry).expect("it is correct");
        registry.put_custom_model(model);
    };
    for objects in [2_000, 10_000] {
        let mut registry = Registry::builtin();
        put(&mut registry, "gloss");
        let mut scene = scene(objects);
        scene.reflection_model = "mine".to_owned();
        scene.objects.iter_mut().for_each(|object| object.material.set("gloss", Value::Number(0.75)));
        let mut session = Session::new(scene.clone());
        // The parameter is removed, and comes back.
        for (parameter, left) in [("sheen_of_mine", 0), ("gloss", objects)] {
            put(&mut registry, parameter);
            let before = session.document.visits();
            follow_registry(&mut session, &registry);
            let visits = session.document.visits() - before;
            let glossy = session.document.objects.iter().filter(|o| o.material.0.contains_key("gloss"));
            assert_eq!(glossy.count(), left);
            assert!(visits <= 4 * objects as u64, "{objects} objects, {parameter}: {visits} visits");
        }
        assert!(*session.document == scene);
    }
}

#[test]
fn names_of_thousands_are_found_without_counting_each_anew() {
    let registry = Registry::builtin();
    let mut document = Document::new(scene(OBJECTS));
    let visits = |document: &Document| {
        let before = document.visits();
        for i in 0..OBJECTS {
            assert_eq!(document.name_of(Selection::Object(i), &registry), format!("Cube {}", i + 1));
        }
        assert!(document.named(&registry) == *document.scene(), "a file calls them so by itself");
        document.visits() - before
    };
    assert!((1..=3 * OBJECTS as u64).contains(&visits(&document)));
    // Moving one changes no number.
    let edit = Edit::set(Part::Object(3), Object::position, Vec3::new(0.5, 0.5, 1.0));
    document.edit(edit, Selection::Room, &registry).expect("legal");
    assert_eq!(visits(&document), (OBJECTS + document.lights.len()) as u64);
}
