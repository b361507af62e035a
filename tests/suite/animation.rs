//! Systems that animate parts of a scene: the example, and entities in an app without a window.

use bevy::{ecs::reflect::AppTypeRegistry, prelude::*};
use lights_camera_models::{
    light::{Point, Spot},
    render::{
        capture::gpu::{GpuRenderer, Output},
        entities::{CurrentScene, SceneEntities},
        parts::{Animated, SceneLight, SceneObserver, Surface, Tessellation},
    },
    scene::Scene,
    shape::{Sphere, Torus},
};

use crate::pictures::close_up;

#[path = "../../examples/animate.rs"]
mod animate;

fn renderer(scene: Scene) -> GpuRenderer {
    let mut renderer = GpuRenderer::new(48, 48, 1, Output::Display).expect("software Vulkan is installed");
    renderer.set_scene(scene);
    renderer.settle().expect("the GPU draws");
    renderer
}

fn frame(renderer: &mut GpuRenderer) -> Vec<u8> {
    renderer.step();
    renderer.read_rgb8().expect("the picture can be read")
}

#[test]
fn the_example_swings_a_light_and_leaves_the_scene_alone() {
    let (pictures, scene) = animate::pictures(4).expect("it draws");
    assert!(pictures.windows(2).all(|pair| pair[0] != pair[1]), "the light stands still");
    assert_eq!(scene.lights.len(), 2);
    assert_eq!(scene.lights[1].light_type, "spot");
}

#[test]
fn animated_objects_lights_and_observers_are_drawn_where_they_are() {
    let scene = close_up("sphere", "point");
    let mut renderer = renderer(scene.clone());
    let still = frame(&mut renderer);
    let world = renderer.app().world_mut();
    let entities = world.resource::<SceneEntities>();
    let (object, light) = (entities.objects[0], entities.lights[0]);
    let eye = entities.observer.expect("there is one");
    let mut seen = vec![still.clone()];
    let mut look = |renderer: &mut GpuRenderer, what: &str| {
        let picture = frame(renderer);
        assert!(!seen.contains(&picture), "{what} does not show");
        assert!(renderer.app().world().resource::<CurrentScene>().0 == scene, "{what} is stored");
        seen.push(picture);
    };
    for entity in [object, light, eye] {
        renderer.app().world_mut().entity_mut(entity).insert(Animated);
    }
    let world = renderer.app().world_mut();
    world.get_mut::<Transform>(object).expect("it has a place").translation.x += 0.5;
    look(&mut renderer, "the object");
    let world = renderer.app().world_mut();
    world.get_mut::<Transform>(light).expect("it has a place").translation.x -= 3.0;
    look(&mut renderer, "the light");
    let world = renderer.app().world_mut();
    world.get_mut::<SceneLight>(light).expect("it is a light").enabled = false;
    look(&mut renderer, "the switch");
    let world = renderer.app().world_mut();
    world.get_mut::<SceneLight>(light).expect("it is a light").enabled = true;
    world.entity_mut(light).remove::<Point>().insert(Spot { cone_angle: 5.0, penumbra: 0.5 });
    look(&mut renderer, "the type of the light");
    let world = renderer.app().world_mut();
    world.entity_mut(object).remove::<Sphere>().insert(Torus::default());
    look(&mut renderer, "the type of the object");
    let world = renderer.app().world_mut();
    world.get_mut::<Surface>(object).expect("it has one").shading_model = Some("flat".to_owned());
    world.get_mut::<Tessellation>(object).expect("it has one").0 = Some(4);
    look(&mut renderer, "the surface");
    let world = renderer.app().world_mut();
    world.get_mut::<Transform>(eye).expect("it has a place").translation.z += 0.5;
    look(&mut renderer, "the observer");
    let world = renderer.app().world_mut();
    *world.get_mut::<Visibility>(object).expect("it has one") = Visibility::Hidden;
    look(&mut renderer, "hiding it");
    for entity in [object, light, eye] {
        renderer.app().world_mut().entity_mut(entity).remove::<Animated>();
    }
    assert!(frame(&mut renderer) == still, "at rest everything is as the scene has it");
}

#[test]
fn without_a_window_changes_are_checked_too() {
    let scene = close_up("sphere", "point");
    let mut renderer = renderer(scene.clone());
    let before = frame(&mut renderer);
    let world = renderer.app().world_mut();
    let entities = world.resource::<SceneEntities>();
    let (object, light) = (entities.objects[0], entities.lights[0]);
    world.get_mut::<Transform>(object).expect("it has a place").translation.x = 400.0;
    world.despawn(light);
    assert!(frame(&mut renderer) == before, "the picture of that frame is the old one");
    let world = renderer.app().world();
    assert_eq!(world.resource::<SceneEntities>().refused().len(), 2);
    assert!(world.resource::<CurrentScene>().0 == scene);
    assert!(frame(&mut renderer) == before);
    // What is spawned is drawn in the same frame, what is despawned is gone.
    let world = renderer.app().world_mut();
    let place = Transform::from_translation(scene.objects[0].position + Vec3::X).with_scale(Vec3::splat(0.5));
    let torus = world.spawn((Torus { tube_radius: 0.2 }, place)).id();
    let spot = world.spawn((Spot::default(), Transform::from_xyz(5.0, 9.0, 5.0))).id();
    let more = frame(&mut renderer);
    assert!(more != before);
    assert_eq!(renderer.app().world().resource::<CurrentScene>().0.objects.len(), 2);
    let world = renderer.app().world_mut();
    world.despawn(torus);
    world.despawn(spot);
    assert!(frame(&mut renderer) == before);
    assert!(renderer.app().world().resource::<CurrentScene>().0 == scene);
}

#[test]
fn components_are_known_to_tools() {
    let renderer = &mut renderer(Scene::default());
    let types = renderer.app().world().resource::<AppTypeRegistry>().read();
    for (name, id) in [
        ("SceneLight", std::any::TypeId::of::<SceneLight>()),
        ("SceneObserver", std::any::TypeId::of::<SceneObserver>()),
        ("Surface", std::any::TypeId::of::<Surface>()),
        ("Tessellation", std::any::TypeId::of::<Tessellation>()),
        ("Animated", std::any::TypeId::of::<Animated>()),
    ] {
        let known = types.get(id).expect("it is registered");
        assert_eq!(known.type_info().type_path_table().short_path(), name);
        assert!(known.data::<ReflectComponent>().is_some(), "{name}");
    }
}
