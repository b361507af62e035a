//! What a change of a scene of ten thousand objects costs, from the document to what the renderer is handed: medians
//! in microseconds. Nothing is drawn.

use std::time::Instant;

use bevy::ecs::prelude::*;
use glam::Vec3;
use lights_camera_models::{
    document::{Document, Edit, ObjectField, Selection},
    parameter::Value,
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        entities::{CurrentScene, LitObject, SceneEntities},
        schedule::LabFrame,
    },
    scene::{Object, Scene},
};

const OBJECTS: usize = 10_000;
const ROUNDS: usize = 101;

#[derive(Resource)]
struct Shown(Document);

fn show(document: Res<Shown>, mut entities: ResMut<SceneEntities>, scene: ResMut<CurrentScene>) {
    entities.show(&document.0, scene);
}

fn main() {
    let object = |i: usize| {
        let place = Vec3::new((i % 100) as f32, (i / 100) as f32, 0.0) * 0.09 + Vec3::new(0.5, 0.5, 2.0);
        let mut object =
            Object { object_type: "cube".to_owned(), size: 0.05, position: place, ..Object::default() };
        object.material.set("base_colour", Value::Colour([(i % 251) as u8, (i % 241) as u8, 90]));
        object.material.set("k_d", Value::Number(0.5));
        object
    };
    let scene = Scene { objects: (0..OBJECTS).map(object).collect(), ..Scene::default() };
    let mut renderer =
        GpuRenderer::new(64, 64, 1, Output::Display).expect("a Vulkan driver, software will do");
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");

    let copy = scene.clone();
    report("scene cloned", |_| drop(std::hint::black_box(scene.clone())));
    report("scenes compared", |_| assert!(std::hint::black_box(&scene) == std::hint::black_box(&copy)));
    let world = renderer.app().world_mut();
    report("nothing changed", |_| world.run_schedule(LabFrame));
    let registry = Registry::builtin();
    world.insert_resource(Shown(Document::new(scene)));
    let mut follow = Schedule::default();
    follow.add_systems(show);
    let mut edit = |world: &mut World, field: ObjectField| {
        let document = &mut world.resource_mut::<Shown>().0;
        document.edit(Edit::Object(OBJECTS / 2, field), Selection::Room, &registry).expect("legal");
        follow.run(world);
        world.run_schedule(LabFrame);
    };
    report("a parameter of one object", |i| {
        edit(world, ObjectField::Material("k_d", Value::Number(i as f32 / ROUNDS as f32)));
    });
    report("the size of one object", |i| edit(world, ObjectField::Size(0.05 + i as f32 * 1e-4)));
    report("a component of one object", |i| {
        let object = world.resource::<SceneEntities>().objects[17];
        let mut object = world.get_mut::<LitObject>(object).expect("it is an object");
        object.0.material.set("k_d", Value::Number(i as f32 / ROUNDS as f32));
        world.run_schedule(LabFrame);
    });
    report("anything, by others", |i| {
        world.resource_mut::<CurrentScene>().0.objects[OBJECTS / 2].size = 0.1 + i as f32 * 1e-4;
        world.run_schedule(LabFrame);
    });
}

fn report(what: &str, mut act: impl FnMut(usize)) {
    let mut times: Vec<_> = (0..ROUNDS)
        .map(|i| {
            let begin = Instant::now();
            act(i);
            begin.elapsed()
        })
        .collect();
    times.sort_unstable();
    println!("{what:<28} {:>9.1} µs", times[ROUNDS / 2].as_secs_f64() * 1e6);
}
