//! Models and shading models are swapped between two frames, and no frame lacks the object.

use bevy::ecs::query::With;
use glam::Vec3;
use lights_camera_models::{
    optics::colour::BACKGROUND,
    parameter::{Value, Values},
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        entities::SceneEntities,
        live::{LiveShaders, SPARE},
        parts::{LightColour, SceneLight, SceneObject, Surface},
        swap::AwaitsShader,
    },
    scene::{Light, Object, Scene},
    shape::{Cube, Sphere, Torus},
};

use crate::helpers::pictures::close_up;

const SIZE: u32 = 48;

/// Number of models whose shaders, in all shading models, stay ready beside those of as many others.
const AT_A_TIME: usize = SPARE / 4 / 2 - 1;

/// Samples of lights with extent: pictures with the same ones are equal, however few they are.
const SAMPLES: u32 = 16;

fn renderer() -> GpuRenderer {
    let mut renderer =
        GpuRenderer::new(SIZE, SIZE, 1, Output::Display).expect("software Vulkan is installed");
    renderer.set_light_samples(SAMPLES);
    renderer
}

fn frame(renderer: &mut GpuRenderer) -> Vec<u8> {
    renderer.step();
    renderer.read_rgb8().expect("the picture can be read")
}

fn covered(picture: &[u8]) -> usize {
    picture.chunks_exact(3).filter(|p| *p != BACKGROUND).count()
}

/// The scene with a reflection model and a shading model, scene-wide or as an override of the object.
fn choose(scene: &Scene, (model, shading): (&str, &str), on_object: bool) -> Scene {
    let mut scene = scene.clone();
    if on_object {
        scene.objects[0].reflection_model = Some(model.to_owned());
        scene.objects[0].shading_model = Some(shading.to_owned());
    } else {
        scene.reflection_model = model.to_owned();
        scene.shading_model = shading.to_owned();
    }
    scene
}

#[test]
fn a_scene_that_outgrows_its_tables_is_right_in_the_next_frame() {
    let few = close_up("sphere", "point");
    let mut many = few.clone();
    many.objects[0].size = 0.5;
    for i in 0..150 {
        let mut object = many.objects[0].clone();
        object.position.x += 0.2 * (i % 15) as f32 - 1.5;
        object.position.y += 0.2 * (i / 15) as f32 - 1.0;
        object.material.set("base_colour", Value::Colour([(i * 3) as u8, 40, 200]));
        object.shading_model = Some(if i % 2 == 0 { "phong" } else { "flat" }.to_owned());
        many.objects.push(object);
    }
    let settled = |scene: &Scene| {
        let mut renderer = renderer();
        renderer.set_scene(scene.clone());
        renderer.settle().expect("the GPU draws");
        renderer.read_rgb8().expect("the picture can be read")
    };
    let (expected_few, expected_many) = (settled(&few), settled(&many));
    assert_ne!(expected_few, expected_many);
    let mut renderer = renderer();
    // Every shader is compiled before the frame that counts.
    for shading in ["flat", "phong"] {
        renderer.set_scene(choose(&few, ("lambert", shading), true));
        renderer.settle().expect("the GPU draws");
    }
    renderer.set_scene(few.clone());
    renderer.settle().expect("the GPU draws");
    renderer.set_scene(many);
    assert!(frame(&mut renderer) == expected_many, "the frame after the growth is another");
    renderer.set_scene(few);
    assert!(frame(&mut renderer) == expected_few, "the frame after the return is another");
}

#[test]
fn a_frame_that_says_that_a_shader_is_awaited_comes_before_the_one_that_makes_it() {
    let scene = close_up("sphere", "point");
    let other = choose(&scene, ("ward", "phong"), false);
    let mut renderer = renderer();
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    let before = renderer.read_rgb8().expect("the picture can be read");
    let waiting = |renderer: &mut GpuRenderer| {
        let world = renderer.app().world_mut();
        let mut waiting = world.query_filtered::<(), With<AwaitsShader>>();
        waiting.iter(world).count()
    };
    renderer.app().world_mut().resource_mut::<LiveShaders>().announce();
    renderer.set_scene(other.clone());
    assert!(frame(&mut renderer) == before, "the picture keeps what it showed");
    assert_eq!(waiting(&mut renderer), 1);
    renderer.step();
    assert_eq!(waiting(&mut renderer), 0);
    renderer.settle().expect("the GPU draws");
    let after = renderer.read_rgb8().expect("the picture can be read");
    assert!(after != before);
    // Shaders that are made need no announcement.
    renderer.set_scene(scene);
    assert!(frame(&mut renderer) == before);
    renderer.set_scene(other);
    assert!(frame(&mut renderer) == after);
}

#[test]
fn every_model_and_mode_follows_every_other_model_and_mode_in_one_frame() {
    let registry = Registry::builtin();
    let states: Vec<_> = registry
        .models()
        .iter()
        // A smooth body shows no light without extent, whatever the shading.
        .filter(|m| !m.passage(&Values::default()).solid)
        .flat_map(|m| registry.shading_models().iter().map(|s| (m.declaration.id, s.declaration.id)))
        .collect();
    let mut scene = close_up("torus", "point");
    scene.objects[0].tessellation = Some(16);
    scene.objects[0].material.set("k_d", Value::Number(0.6));
    // Frosted, thin glass shows a point.
    scene.objects[0].material.set("roughness", Value::Number(0.6));
    let mut renderer = renderer();

    let expected: Vec<_> = states
        .iter()
        .map(|state| {
            renderer.set_scene(choose(&scene, *state, false));
            renderer.settle().expect("the GPU draws");
            renderer.read_rgb8().expect("the picture can be read")
        })
        .collect();
    for (i, a) in expected.iter().enumerate() {
        assert!(covered(a) > 300, "{:?} shows nothing", states[i]);
        for (j, b) in expected.iter().enumerate().skip(i + 1) {
            assert_ne!(
                a, b,
                "{:?} and {:?} look the same, so a swap could not be seen",
                states[i], states[j]
            );
        }
    }
    // Every ordered pair of models, and within a model every ordered pair of shading models; the shading models of the first
    // rotate, so that all of them come and go.
    let shadings = registry.shading_models().len();
    let models = states.len() / shadings;
    let mut pairs = Vec::new();
    for from in 0..models {
        for to in 0..models {
            if from != to {
                pairs.push((
                    from * shadings + (from + to) % shadings,
                    to * shadings + (from + 2 * to + 1) % shadings,
                ));
            }
        }
        let of = |shading| from * shadings + shading;
        let both =
            (0..shadings).flat_map(|a| (0..shadings).filter(move |b| *b != a).map(move |b| (of(a), of(b))));
        pairs.extend(both);
    }
    // A shader that is out of the picture for long is made anew when it comes back. Few models at a time, against few
    // others, makes each some ten times and not at each swap: swaps to shaders that are made and to others both occur.
    pairs.sort_by_key(|(from, to)| {
        let [a, b] = [from, to].map(|state| state / shadings / AT_A_TIME);
        (a.max(b), a.min(b))
    });
    for (i, &(from, to)) in pairs.iter().enumerate() {
        // Both ways meet a shader that is not made yet.
        for on_object in [i % 2 == 1, i % 2 == 0] {
            renderer.set_scene(choose(&scene, states[from], on_object));
            renderer.step();
            renderer.set_scene(choose(&scene, states[to], on_object));
            let shown = frame(&mut renderer);
            assert!(
                shown == expected[to],
                "{:?} → {:?}: the next frame shows {}",
                states[from],
                states[to],
                if covered(&shown) == 0 {
                    "nothing".to_owned()
                } else if shown == expected[from] {
                    "the old picture".to_owned()
                } else {
                    "something else".to_owned()
                }
            );
        }
    }
}

#[test]
fn a_scene_that_gets_its_first_light_of_a_type_is_right_in_the_next_frame() {
    let registry = Registry::builtin();
    let mut scene = close_up("torus", "point");
    let lamp = scene.lights[0].clone();
    let mut all = vec![scene.clone()];
    for entry in registry.lights().iter().filter(|l| l.declaration.id != "point") {
        let mut light = lamp.clone();
        light.direction = Some(Vec3::new(-0.5, -0.55, -1.0));
        light.set_type(entry, &registry, scene.scene_size);
        // For a photometric lamp, a hundredth of its own output.
        light.intensity = if entry.declaration.unit == "×" { 0.01 } else { 3.0 };
        scene.lights.push(light);
        all.push(scene.clone());
    }
    // Back again, without any of the first.
    let mut without = scene.clone();
    without.lights.remove(0);
    all.extend([all[0].clone(), without]);
    let mut drawn = Vec::new();
    for scene in &all {
        // Each by a renderer that has not drawn any other.
        let mut renderer = renderer();
        renderer.set_scene(scene.clone());
        renderer.settle().expect("the GPU draws");
        drawn.push(renderer.read_rgb8().expect("the picture can be read"));
    }
    for (i, pair) in drawn.windows(2).enumerate() {
        assert_ne!(pair[0], pair[1], "{i}: a swap could not be seen");
    }
    let mut renderer = renderer();
    renderer.set_scene(all[0].clone());
    renderer.settle().expect("the GPU draws");
    for (i, (scene, expected)) in all.iter().zip(&drawn).enumerate() {
        renderer.set_scene(scene.clone());
        assert!(frame(&mut renderer) == *expected, "{i}: the next frame shows something else");
    }
}

#[test]
fn changing_a_component_changes_the_next_frame_and_the_scene() {
    let mut renderer = renderer();
    renderer.set_scene(close_up("sphere", "point"));
    renderer.settle().expect("the GPU draws");
    let before = renderer.read_rgb8().expect("the picture can be read");

    let world = renderer.app().world_mut();
    let light = world.resource::<SceneEntities>().lights[0];
    world.get_mut::<SceneLight>(light).expect("the light is an entity").colour =
        LightColour::Rgb([0, 0, 255]);
    let blue = frame(&mut renderer);
    assert!(before != blue, "the colour shows");

    let world = renderer.app().world_mut();
    world.get_mut::<bevy::prelude::Transform>(light).expect("lights have a place").translation.x = 3.0;
    let moved = frame(&mut renderer);
    assert!(blue != moved, "the place shows");

    let world = renderer.app().world_mut();
    let object = world.resource::<SceneEntities>().objects[0];
    world.entity_mut(object).remove::<Sphere>().insert(Cube {});
    let cube = frame(&mut renderer);
    assert!(moved != cube, "the shape shows");

    // So does a parameter of its shape, which gets separate meshes.
    let world = renderer.app().world_mut();
    world.entity_mut(object).remove::<Cube>().insert(Torus { tube_radius: 0.05 });
    let thin = frame(&mut renderer);
    let world = renderer.app().world_mut();
    world.get_mut::<Torus>(object).expect("it is a torus").tube_radius = 0.24;
    assert!(thin != frame(&mut renderer), "the parameter shows");
    let world = renderer.app().world_mut();
    world.entity_mut(object).remove::<Torus>().insert(Cube {});
    assert!(cube == frame(&mut renderer));

    // So does its surface.
    let world = renderer.app().world_mut();
    let mut surface = world.get_mut::<Surface>(object).expect("objects have a surface");
    surface.material.set("base_colour", Value::Colour([255, 0, 200]));
    let pink = frame(&mut renderer);
    assert!(cube != pink, "the surface shows");
    let world = renderer.app().world_mut();
    world.get_mut::<bevy::prelude::Transform>(object).expect("objects have a place").translation =
        Vec3::new(5.5, 4.5, 5.0);
    world.get_mut::<bevy::prelude::Transform>(light).expect("lights have a place").translation =
        Vec3::new(4.0, 7.0, 8.0);
    let lower = frame(&mut renderer);
    assert!(pink != lower, "the transform's place shows");
    let scene = &renderer.app().world().resource::<lights_camera_models::render::entities::CurrentScene>().0;
    assert_eq!(scene.objects[0].position, Vec3::new(5.5, 4.5, 5.0));
    assert_eq!(scene.lights[0].position, Some(Vec3::new(4.0, 7.0, 8.0)));
    let world = renderer.app().world_mut();
    world.get_mut::<bevy::prelude::Transform>(light).expect("lights have a place").translation.x = 3.0;
    renderer.step();

    let scene = &renderer.app().world().resource::<lights_camera_models::render::entities::CurrentScene>().0;
    assert_eq!(scene.lights[0].colour, [0, 0, 255]);
    assert_eq!(scene.lights[0].position.map(|p| p.x), Some(3.0));
    assert_eq!(scene.objects[0].object_type, "cube");
}

#[test]
fn loading_another_scene_respawns_what_differs_and_keeps_the_rest() {
    let mut renderer = renderer();
    let mut scene = close_up("sphere", "point");
    scene.objects.push(Object {
        object_type: "cube".to_owned(),
        position: Vec3::new(2.0, 2.0, 2.0),
        ..Object::default()
    });
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    let first = renderer.app().world().resource::<SceneEntities>().objects[0];

    scene.objects.pop();
    scene.lights.push(Light {
        light_type: "ambient".to_owned(),
        position: None,
        intensity: 0.5,
        ..Light::default()
    });
    renderer.set_scene(scene);
    renderer.step();
    let world = renderer.app().world_mut();
    assert_eq!(world.resource::<SceneEntities>().objects, [first], "the sphere stays the same entity");
    assert_eq!(world.query::<&SceneObject>().iter(world).count(), 1);
    assert_eq!(world.query::<&SceneLight>().iter(world).count(), 2);
    let ambient =
        world.query_filtered::<&SceneLight, bevy::prelude::With<lights_camera_models::light::Ambient>>();
    assert_eq!({ ambient }.iter(world).count(), 1, "each type has its component");
}
