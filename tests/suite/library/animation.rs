//! Systems that animate parts of a scene: the example, and entities in an app without a window.

use bevy::{ecs::reflect::AppTypeRegistry, prelude::*};
use lights_camera_models::{
    document::PartId,
    light::{self, Incident, LightRecord, LightType, MAX_LIGHTS, Point, Rectangle, Spot},
    panel::state::{Action, Session},
    parameter::Value,
    parameters,
    registry::{Register as _, Registry},
    render::{
        capture::gpu::{GpuRenderer, Output},
        entities::{CurrentScene, SceneEntities},
        parts::{Animated, LightPower, SceneLight, SceneObject, SceneObserver, Surface, Tessellation},
    },
    scene::{Light, Object, Scene},
    shader::Source,
    shape::{Sphere, Torus},
    window::{DocumentPlugin, LabPlugins, ViewOptions},
};

use crate::{
    helpers::pictures::close_up,
    library::plugins::{app, draw},
};

#[path = "../../../examples/animate.rs"]
pub mod animate;

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
    let mut renderer = GpuRenderer::extended(96, 64, 1, Output::Display, animate::swinging)
        .expect("software Vulkan is installed");
    let mut scene = Scene { shading_model: "phong".to_owned(), ..Scene::default() };
    scene.lights[0].intensity = 4.0;
    renderer.set_scene(scene);
    (0..4).for_each(|_| renderer.step());
    let pictures: Vec<_> = (0..4).map(|_| frame(&mut renderer)).collect();
    assert!(pictures.windows(2).all(|pair| pair[0] != pair[1]), "the light stands still");
    let scene = &renderer.app().world().resource::<CurrentScene>().0;
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
    world.entity_mut(light).remove::<Point>().insert(Spot { cone_angle: 15.0, penumbra: 0.5 });
    world.get_mut::<Transform>(light).expect("it has a place").look_at(scene.objects[0].position, Vec3::Y);
    look(&mut renderer, "the type of the light");
    let world = renderer.app().world_mut();
    world.get_mut::<Transform>(light).expect("it has a place").rotate_x(0.1);
    look(&mut renderer, "the direction of the light");
    let world = renderer.app().world_mut();
    world.get_mut::<Spot>(light).expect("it is a spot").cone_angle = 10.0;
    look(&mut renderer, "the cone of the light");
    let world = renderer.app().world_mut();
    world.entity_mut(light).remove::<Spot>().insert(Rectangle::default());
    look(&mut renderer, "an extent of the light");
    let world = renderer.app().world_mut();
    world.get_mut::<Rectangle>(light).expect("it is a rectangle").width = 4.0;
    look(&mut renderer, "the width of the light");
    let world = renderer.app().world_mut();
    world.get_mut::<Transform>(light).expect("it has a place").rotate_y(0.2);
    look(&mut renderer, "the turn of the light");
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
    // A spawned part is drawn in the same frame, a despawned one is gone.
    let world = renderer.app().world_mut();
    let place = scene.objects[0].position + 1.6 * Vec3::Z;
    let torus = Transform::from_translation(place).with_scale(Vec3::splat(0.5));
    let torus = world.spawn((Torus { tube_radius: 0.2 }, torus)).id();
    let more = frame(&mut renderer);
    assert!(more != before, "the object shows");
    let spot = Transform::from_xyz(5.0, 9.0, 8.0).looking_at(scene.objects[0].position, Vec3::Z);
    let spot = renderer.app().world_mut().spawn((Spot::default(), spot)).id();
    assert!(more != frame(&mut renderer), "the light shows");
    assert_eq!(renderer.app().world().resource::<CurrentScene>().0.objects.len(), 2);
    let world = renderer.app().world_mut();
    world.despawn(torus);
    world.despawn(spot);
    assert!(frame(&mut renderer) == before);
    assert!(renderer.app().world().resource::<CurrentScene>().0 == scene);
}

#[test]
fn what_goes_makes_room_for_what_comes() {
    let mut scene = close_up("sphere", "point");
    scene.objects.push(Object { position: Vec3::new(2.0, 2.0, 2.0), ..scene.objects[0].clone() });
    let lamp = Light { enabled: false, ..scene.lights[0].clone() };
    for i in 1..MAX_LIGHTS {
        let place = Vec3::new(0.5 + (i % 16) as f32 * 0.25, 9.5, 0.5 + (i / 16) as f32 * 0.25);
        scene.lights.push(Light { position: Some(place), ..lamp.clone() });
    }
    let mut renderer = renderer(scene);
    let step = |renderer: &mut GpuRenderer| {
        renderer.step();
        renderer.app().world().resource::<SceneEntities>().refused().to_vec()
    };
    let light =
        |renderer: &mut GpuRenderer, i: usize| renderer.app().world().resource::<SceneEntities>().lights[i];
    let spawn = |renderer: &mut GpuRenderer, place: Vec3| {
        let spot = (Spot::default(), Transform::from_translation(place));
        renderer.app().world_mut().spawn(spot).id()
    };
    // In the same frame.
    let gone = light(&mut renderer, 5);
    renderer.app().world_mut().despawn(gone);
    let spot = spawn(&mut renderer, Vec3::new(6.0, 8.0, 6.0));
    assert_eq!(step(&mut renderer), [""; 0]);
    assert_eq!(light(&mut renderer, MAX_LIGHTS - 1), spot);
    // Where an object was.
    let object = renderer.app().world().resource::<SceneEntities>().objects[1];
    let gone = light(&mut renderer, 6);
    renderer.app().world_mut().despawn(object);
    renderer.app().world_mut().despawn(gone);
    let spot = spawn(&mut renderer, Vec3::new(2.0, 2.0, 2.0));
    assert_eq!(step(&mut renderer), [""; 0]);
    assert_eq!(light(&mut renderer, MAX_LIGHTS - 1), spot);
    // Later.
    let spot = spawn(&mut renderer, Vec3::new(7.0, 8.0, 6.0));
    let why = step(&mut renderer);
    assert!(matches!(&why[..], [one] if one.contains("was not added to the scene")), "{why:?}");
    assert_eq!(step(&mut renderer), [""; 0], "it is said once");
    let gone = light(&mut renderer, 7);
    renderer.app().world_mut().despawn(gone);
    (0..2).for_each(|_| assert_eq!(step(&mut renderer), [""; 0]));
    assert_eq!(light(&mut renderer, MAX_LIGHTS - 1), spot);
    assert_eq!(renderer.app().world().resource::<CurrentScene>().0.lights.len(), MAX_LIGHTS);
}

#[test]
fn last_parts_that_a_system_deletes_in_each_frame_give_one_message() {
    let mut renderer = renderer(close_up("sphere", "point"));
    let delete = |renderer: &mut GpuRenderer| {
        let entities = renderer.app().world().resource::<SceneEntities>();
        let gone = [Some(entities.lights[0]), Some(entities.objects[0]), entities.observer];
        gone.into_iter().flatten().for_each(|entity| _ = renderer.app().world_mut().despawn(entity));
    };
    let mut said = Vec::new();
    for _ in 0..5 {
        delete(&mut renderer);
        renderer.step();
        said.extend_from_slice(renderer.app().world().resource::<SceneEntities>().refused());
    }
    assert_eq!(said.len(), 3, "{said:?}");
    // A removed part is not the last one if another is added.
    delete(&mut renderer);
    let spot = (Spot::default(), Transform::from_xyz(6.0, 8.0, 6.0));
    let spot = renderer.app().world_mut().spawn(spot).id();
    renderer.step();
    let entities = renderer.app().world().resource::<SceneEntities>();
    assert_eq!((&entities.lights[..], entities.refused()), (&[spot][..], &[][..]));
    delete(&mut renderer);
    renderer.step();
    let refused = renderer.app().world().resource::<SceneEntities>().refused();
    assert!(matches!(refused, [one] if one.contains("last light")), "{refused:?}");
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
        ("SceneObject", std::any::TypeId::of::<SceneObject>()),
        ("PartId", std::any::TypeId::of::<PartId>()),
        ("Spot", std::any::TypeId::of::<Spot>()),
        ("Torus", std::any::TypeId::of::<Torus>()),
    ] {
        let known = types.get(id).expect("it is registered");
        assert_eq!(known.type_info().type_path_table().short_path(), name);
        assert!(known.data::<ReflectComponent>().is_some(), "{name}");
    }
}

// ── in the window ──

fn spawn_spot(mut commands: Commands) {
    commands.spawn((Spot { cone_angle: 20.0, ..default() }, Transform::from_xyz(5.0, 9.0, 5.0)));
}

fn lab(extend: impl FnOnce(&mut App)) -> App {
    let mut app = app(LabPlugins::default().size(64, 36).headless().build(), extend);
    draw(&mut app);
    app
}

#[test]
fn systems_of_guests_edit_the_document() {
    let widen = |mut spots: Query<&mut Spot>| {
        spots.iter_mut().filter(|spot| spot.cone_angle < 40.0).for_each(|mut spot| spot.cone_angle += 5.0);
    };
    let mut app = lab(|app| {
        app.add_systems(Startup, spawn_spot).add_systems(Update, widen);
    });
    let count =
        |app: &mut App| app.world_mut().query::<(&Spot, &SceneLight, &PartId)>().iter(app.world()).count();
    (0..6).for_each(|_| app.update());
    let registry = app.world().resource::<Registry>().clone();
    let mut session = app.world_mut().resource_mut::<Session>();
    let spot = &session.document.lights[1];
    assert_eq!(spot.light_type, "spot");
    assert_eq!(spot.parameters.0.get("cone_angle"), Some(&Value::Number(40.0)));
    assert_eq!(spot.intensity, Spot::DECLARATION.default_intensity);
    assert!(session.document.differs());
    assert_eq!(session.document.steps().collect::<Vec<_>>(), ["Change by a system"]);
    session.apply(Action::Undo, &registry);
    app.update();
    assert_eq!(count(&mut app), 0, "undone, it is gone");
    app.world_mut().resource_mut::<Session>().apply(Action::Redo, &registry);
    (0..2).for_each(|_| app.update());
    assert_eq!(count(&mut app), 1);
}

#[test]
fn what_guests_may_not_do_goes_back_with_a_message_in_the_window() {
    let wrong = |mut spots: Query<&mut Spot>, mut objects: Query<&mut Transform, With<SceneObject>>| {
        spots.iter_mut().for_each(|mut spot| spot.cone_angle = 500.0);
        objects.iter_mut().for_each(|mut place| place.scale = Vec3::new(1.0, 3.0, 1.0));
    };
    let mut app = lab(|app| {
        app.add_systems(Startup, spawn_spot);
    });
    let before = app.world().resource::<Session>().document.scene().clone();
    app.add_systems(Update, wrong);
    (0..6).for_each(|_| app.update());
    let session = app.world().resource::<Session>();
    assert!(session.document == before, "neither is in the document");
    for text in ["lights[1].cone_angle is 500, but", "its scale is (1, 3, 1), but an object has one size"] {
        let said = session.messages.iter().filter(|message| message.text.contains(text)).count();
        assert_eq!(said, 1, "{text}: {:?}", session.messages);
    }
}

#[test]
fn what_guests_animate_leaves_the_document_saved() {
    let mut app = lab(|app| {
        app.add_systems(Update, |mut lights: Query<&mut Transform, With<SceneLight>>| {
            lights.iter_mut().for_each(|mut place| place.rotate_x(0.1));
            lights.iter_mut().for_each(|mut place| place.translation.x = 400.0);
        });
    });
    // Without the marker it is refused.
    let lights = app.world().resource::<SceneEntities>().lights.clone();
    assert!(!app.world().resource::<Session>().messages.is_empty());
    lights.iter().for_each(|light| _ = app.world_mut().entity_mut(*light).insert(Animated));
    (0..6).for_each(|_| app.update());
    assert_eq!(app.world().get::<Transform>(lights[0]).expect("there").translation.x, 400.0);
    let document = &app.world().resource::<Session>().document;
    assert!(!document.differs() && document.steps().len() == 0);
}

parameters! {
    /// A lamp of a guest, without parameters.
    struct Glow {}
}

const GLOW: Source = Source {
    path: "glow.wgsl",
    text: "fn incident_glow(light: Light, p: vec3<f32>) -> Incident {
               let to_light = light.position - p;
               return Incident(unit_or_zero(to_light), vec3(light.intensity * inverse_square(to_light)), 0u);
           }",
};

impl LightType for Glow {
    const DECLARATION: light::Declaration =
        light::Declaration::new("glow", "Glow", GLOW).at_position().candela(7.0, 200.0);

    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        Point::default().incident(light, p)
    }
}

#[test]
fn types_that_only_the_registry_knows_are_components_too() {
    // As passed on by `cli::main_with`.
    let mut registry = Registry::builtin();
    registry.add_light_type::<Glow>();
    let mut options = ViewOptions::default();
    options.registry = Some(registry);
    let plugins = LabPlugins::default().size(64, 36).headless().build();
    let mut app = app(plugins.set(DocumentPlugin { options, for_user: false }), |app| {
        app.add_systems(Startup, |mut commands: Commands| {
            commands.spawn((Glow {}, Transform::from_xyz(5.0, 9.0, 5.0)));
        });
    });
    (0..3).for_each(|_| app.update());
    let document = &app.world().resource::<Session>().document;
    assert_eq!((document.lights[1].light_type.as_str(), document.lights[1].intensity), ("glow", 7.0));
    let light = app.world().resource::<SceneEntities>().lights[1];
    assert_eq!(
        app.world().get::<SceneLight>(light).expect("it came along").power,
        LightPower::Intensity(7.0)
    );
}
