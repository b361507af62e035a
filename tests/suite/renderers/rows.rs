//! The copies of a row are drawn as single objects are, by both renderers, and belong to a row as long as nothing
//! changes one of them alone.

use bevy::prelude::*;
use lights_camera_models::{
    reference::{self, Settings},
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        entities::{CurrentScene, SceneEntities},
        parts::SceneObject,
    },
    scene::{Object, Repetition, Scene, examples::EXAMPLES},
};

use crate::helpers::support::{read, written};

/// The shipped row.
fn five() -> Scene {
    let example = EXAMPLES.iter().find(|example| example.file == "five_spheres.json").expect("it is shipped");
    read(example.text)
}

/// The scene with single objects in place of rows.
fn singles(scene: &Scene) -> Scene {
    let single = |object: &Object| Object { repeat: Repetition::None, ..object.clone() };
    Scene { objects: scene.objects.iter().map(single).collect(), ..scene.clone() }
}

#[test]
fn both_renderers_draw_a_row_as_the_same_scene_of_single_objects_bit_for_bit() {
    let (row, apart) = (five(), singles(&five()));
    assert_eq!(row.objects.len(), 5);
    // What a file of single objects gives.
    assert_eq!(read(&written(&apart)), apart);
    let registry = Registry::builtin();
    let settings = Settings { width: 96, height: 54, samples: 4, ..Settings::default() };
    let cpu =
        [&row, &apart].map(|scene| reference::render(scene, &registry, &settings).to_rgb8(&scene.display));
    assert!(cpu[0] == cpu[1], "the CPU draws them differently");
    assert!(cpu[0].iter().any(|v| *v > 150), "the row is lit");
    let gpu = [&row, &apart].map(|scene| {
        let mut renderer =
            GpuRenderer::new(96, 54, 1, Output::Display).expect("software Vulkan is installed");
        renderer.set_scene(scene.clone());
        renderer.settle().expect("the GPU draws");
        renderer.read_rgb8().expect("the picture can be read")
    });
    assert!(gpu[0] == gpu[1], "the GPU draws them differently");
}

#[test]
fn a_copy_that_a_system_changes_leaves_its_row() {
    let mut renderer = GpuRenderer::new(48, 27, 1, Output::Display).expect("software Vulkan is installed");
    renderer.set_scene(five());
    renderer.settle().expect("the GPU draws");
    let world = renderer.app().world_mut();
    let third = world.resource::<SceneEntities>().objects[2];
    assert!(world.get::<SceneObject>(third).is_some());
    world.get_mut::<Transform>(third).expect("it has a place").translation.y += 0.5;
    (0..3).for_each(|_| renderer.step());
    let scene = renderer.app().world().resource::<CurrentScene>().0.clone();
    assert_eq!(scene.objects[2].position.y, 5.5);
    assert_eq!(scene.objects[2].repeat, Repetition::None);
    assert!((0..5).all(|i| scene.row(i).is_none()), "a row needs all of its copies");
    assert_eq!(read(&written(&scene)), singles(&scene), "a file has what is seen");
}
