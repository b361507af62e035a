//! The cost of changes of a scene of ten thousand objects, from the document to the renderer's input: medians in
//! microseconds. Nothing is drawn.

use std::{path::Path, time::Instant};

use bevy::{ecs::prelude::*, prelude::Transform};
use glam::Vec3;
use lights_camera_models::{
    custom,
    document::{Document, Edit, Selection},
    panel::{
        follow::follow_registry,
        state::{Action, CompareCommand, Session, Together},
    },
    parameter::Value,
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        entities::{CurrentScene, SceneEntities},
        parts::{Animated, Surface},
        schedule::LabFrame,
    },
    scene::{
        Comparison, Display, Key, Light, Object, Observer, Part, Scene, SceneSize, Variant,
        comparison::Layout,
    },
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
    world.insert_resource(Shown(Document::new(scene.clone())));
    let mut follow = Schedule::default();
    follow.add_systems(show);
    let mut change = |world: &mut World, change: &dyn Fn(&mut Document)| {
        change(&mut world.resource_mut::<Shown>().0);
        follow.run(world);
        world.run_schedule(LabFrame);
    };
    let edit = |document: &mut Document, edit: Edit| {
        document.edit(edit, Selection::Room, &registry).expect("legal");
    };
    report("a parameter of one object", |i| {
        let field = || {
            Edit::material(
                Part::Object(OBJECTS / 2),
                "k_d",
                Value::Number(0.5 + 0.5 * i as f32 / ROUNDS as f32),
            )
        };
        change(world, &|document| edit(document, field()));
    });
    report("the size of one object", |i| {
        change(world, &|document| {
            edit(document, Edit::set(Part::Object(OBJECTS / 2), Object::size, 0.05 + i as f32 * 1e-4))
        });
    });
    let set = |part: Part, key: Key, value: Value| Edit::set(part, key, value);
    report("the position of a light", |i| {
        let place = Vec3::new(5.0, 8.0, 5.0 + i as f32 * 1e-3);
        change(world, &|document| edit(document, set(Part::Light(0), Light::position.into(), place.into())));
    });
    report("the observer", |i| {
        let angle = Value::from(40.0 + i as f32 * 0.1);
        change(world, &|document| {
            edit(document, set(Part::Observer, Observer::field_of_view.into(), angle.clone()))
        });
    });
    report("the size of the room", |i| {
        let depth = Value::from(11.0 + i as f32 * 1e-2);
        change(world, &|document| edit(document, set(Part::Size, SceneSize::depth.into(), depth.clone())));
    });
    report("the exposure", |i| {
        let ev = Value::from(i as f32 * 1e-2);
        change(world, &|document| edit(document, set(Part::Display, Display::exposure.into(), ev.clone())));
    });
    let views = Edit::Views {
        variants: ["b", "c", "d"]
            .map(|name| Variant { name: Some(name.to_owned()), ..Variant::default() })
            .to_vec(),
        comparison: Comparison { layout: Layout::SideBySide, ..Comparison::default() },
        step: "Add views",
    };
    change(world, &|document| edit(document, views.clone()));
    report("the exposure of view B", |i| {
        let ev = Value::from(i as f32 * 1e-2);
        change(world, &|document| {
            edit(document, set(Part::Variant(0), Variant::exposure.into(), ev.clone()))
        });
    });
    report("a parameter of view C", |i| {
        let k_d = Value::from(0.5 + 0.5 * i as f32 / ROUNDS as f32);
        change(world, &|document| edit(document, set(Part::Variant(1), Key::Material("k_d"), k_d.clone())));
    });
    report("the model of view D", |i| {
        let id = Value::from(["phong", "ward"][i % 2]);
        change(world, &|document| {
            edit(document, set(Part::Variant(2), Variant::reflection_model.into(), id.clone()))
        });
    });
    report("the arrangement of views", |i| {
        let split = Value::from(i as f32 / ROUNDS as f32);
        change(world, &|document| {
            edit(document, set(Part::Comparison, Comparison::split.into(), split.clone()))
        });
    });
    report("one object, with views", |i| {
        let size = Value::from(0.05 + i as f32 * 1e-4);
        change(world, &|document| edit(document, set(Part::Object(17), Object::size.into(), size.clone())));
    });
    report("one object removed", |_| {
        change(world, &|document| document.remove(Selection::Object(OBJECTS / 2), &registry));
    });
    report("one object brought back", |_| change(world, &|document| drop(document.undo().expect("a step"))));
    report("a component of one object", |i| {
        let object = world.resource::<SceneEntities>().objects[17];
        let mut surface = world.get_mut::<Surface>(object).expect("it is an object");
        surface.material.set("k_d", Value::Number(0.5 + 0.5 * i as f32 / ROUNDS as f32));
        world.run_schedule(LabFrame);
    });
    let turn = |world: &mut World| {
        let objects = world.resource::<SceneEntities>().objects.clone();
        objects.iter().for_each(|object| {
            world.get_mut::<Transform>(*object).expect("objects have a place").rotate_y(0.01);
        });
        world.run_schedule(LabFrame);
    };
    report("all objects turned", |_| turn(world));
    let objects = world.resource::<SceneEntities>().objects.clone();
    objects.iter().for_each(|object| _ = world.entity_mut(*object).insert(Animated));
    report("all objects animated", |_| turn(world));
    objects.iter().for_each(|object| _ = world.entity_mut(*object).remove::<Animated>());
    report("anything, by others", |i| {
        world.resource_mut::<CurrentScene>().0.objects[OBJECTS / 2].size = 0.1 + i as f32 * 1e-4;
        world.run_schedule(LabFrame);
    });

    // A custom model loses a parameter that every object has, and gets it back.
    let registries = ["gloss", "sheen_of_mine"].map(|parameter| {
        let text = format!(
            "/* lcm {{ \"parameters\": [{{ \"name\": \"{parameter}\" }}] }} */\nfn response(l: vec3<f32>, v: vec3<f32>, \
             frame: Frame, m: Parameters) -> Terms {{\n    return Terms(vec3(0.0), vec3(0.5), vec3(0.0));\n}}\n"
        );
        let mut registry = Registry::builtin();
        let model = custom::read(Path::new("models/mine.wgsl"), &text, &registry).expect("it is correct");
        registry.put_custom_model(model);
        registry
    });
    let start = scene.clone();
    let mut scene = Scene { reflection_model: "mine".to_owned(), ..scene };
    scene.objects.iter_mut().for_each(|object| object.material.set("gloss", Value::Number(0.75)));
    let mut seen = Session::new(Scene { reflection_model: "phong".to_owned(), ..scene.clone() });
    seen.apply(Action::Compare(CompareCommand::Add), &registry);
    report("view B in the window", |i| {
        let edit = Edit::set(Part::Display, Display::exposure, i as f32 * 1e-2);
        seen.apply(Action::Edit(edit), &registry);
    });
    report("an object in view B", |i| {
        let edit = Edit::set(Part::Object(17), Object::size, 0.05 + i as f32 * 1e-4);
        seen.apply(Action::Edit(edit), &registry);
    });
    let mut all = Session::new(start);
    report("all objects selected", |i| {
        let parts = (0..OBJECTS - i % 2).map(Selection::Object).collect();
        all.apply(Action::SelectEach(parts, false), &registry);
    });
    report("all objects looked up", |_| {
        assert!(
            (0..OBJECTS)
                .all(|i| std::hint::black_box(all.is_selected(Selection::Object(i)) || i + 1 == OBJECTS))
        );
    });
    let room = all.document.scene_size;
    report("all objects grasped", |_| drop(std::hint::black_box(Together::of(&all, &registry))));
    let together = Together::of(&all, &registry).expect("they are many");
    report("all objects moved", |i| {
        let edit = together.moved(Vec3::Z * (i + 1) as f32 * 1e-3, room);
        all.apply(Action::Edit(edit), &registry);
    });
    report("all objects moved, shown", |i| {
        let step = together.moved(Vec3::Y * (i + 1) as f32 * 1e-3, room);
        change(world, &|document| edit(document, step.clone()));
    });
    let mut session = Session::new(scene);
    report("a parameter of a model", |i| follow_registry(&mut session, &registries[(i + 1) % 2]));
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
