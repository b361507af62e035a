//! Document, scene and entities stay equal, whoever changes what.

use std::collections::HashMap;

use bevy::{
    ecs::prelude::*,
    prelude::{Transform, Visibility},
};
use glam::{Quat, Vec3};

use super::*;
use crate::{
    document::{Edit, PartId, Selection},
    light::{Ambient, Point, Spot},
    parameter::Value,
    reflection::laws::Random,
    registry::Registry,
    render::{
        absorb::absorb,
        entities::object_transform,
        mirror::{read_light, read_object},
        parts::{
            Animated, LightColour, LightPower, SceneLight, SceneObject, SceneObserver, Surface, Tessellation,
        },
        reconcile::reconcile,
        shown::{Shown, ShownObject, show_lights},
        typed::{PartTypes, know_types},
    },
    scene::{Comparison, Display, Light, Object, Part, Scene, Variant, check, comparison::Layout},
    shape::{Cube, Sphere, Torus},
};

#[derive(Resource)]
struct Desk(Document);

/// Refusals since the test last looked.
#[derive(Default, Resource)]
struct Said(Vec<String>);

fn show(document: Res<Desk>, mut entities: ResMut<SceneEntities>, scene: ResMut<CurrentScene>) {
    entities.show(&document.0, scene);
}

fn submit(
    mut document: ResMut<Desk>,
    mut entities: ResMut<SceneEntities>,
    mut scene: ResMut<CurrentScene>,
    mut said: ResMut<Said>,
    registry: Res<Registry>,
) {
    let document = &mut document.0;
    said.0.extend_from_slice(entities.refused());
    let Some(changes) = entities.changed_by_others(document, &mut scene) else { return };
    let answer = match &changes {
        Changes::Values(parts) => document.submit(&scene.0, parts, Selection::Room, &registry),
        Changes::Lists(removed) => document.submit_lists(&scene.0, removed, Selection::Room, &registry),
    };
    entities.settle(&changes, answer.is_ok(), document, &mut scene);
    said.0.extend(answer.err());
}

/// The action of a system between [`reconcile`] and [`absorb`].
#[derive(Default, Resource)]
struct Between(Option<fn(&mut World)>);

fn between(world: &mut World) {
    if let Some(act) = world.resource_mut::<Between>().0.take() {
        act(world);
    }
}

/// A world with a document, and the systems of the window between the two.
struct Lab(World, Schedule);

impl Lab {
    fn new() -> Self {
        let mut world = World::new();
        let at = |i: usize| Object { position: Vec3::splat(1.0 + i as f32), size: 0.5, ..Object::default() };
        let scene = Scene { objects: (0..6).map(at).collect(), ..Scene::default() };
        world.insert_resource(Desk(Document::new(scene)));
        world.insert_resource(Registry::builtin());
        world.init_resource::<CurrentScene>();
        world.init_resource::<SceneEntities>();
        world.init_resource::<Shown>();
        world.init_resource::<Said>();
        world.init_resource::<Between>();
        know_types(&mut world);
        let mut schedule = Schedule::default();
        let follow = reconcile.run_if(resource_changed::<CurrentScene>);
        schedule.add_systems((show, follow, between, absorb, submit, show_lights).chain());
        let mut lab = Self(world, schedule);
        lab.frame();
        lab
    }

    fn frame(&mut self) {
        self.1.run(&mut self.0);
        self.0.clear_trackers();
    }

    fn document(&mut self) -> &mut Document {
        &mut self.0.resource_mut::<Desk>().into_inner().0
    }

    fn object(&self, i: usize) -> Entity {
        self.0.resource::<SceneEntities>().objects[i]
    }

    fn light(&self, i: usize) -> Entity {
        self.0.resource::<SceneEntities>().lights[i]
    }

    fn get<C: Component<Mutability = bevy::ecs::component::Mutable>>(
        &mut self,
        entity: Entity,
    ) -> Mut<'_, C> {
        self.0.get_mut::<C>(entity).expect("it has the component")
    }

    /// Messages since the last call.
    fn said(&mut self) -> Vec<String> {
        std::mem::take(&mut self.0.resource_mut::<Said>().0)
    }

    /// Runs frames after a change: refused changes are undone, and new names appear, in the next one.
    fn settle(&mut self) {
        self.frame();
        self.frame();
        self.check("");
    }

    fn check(&mut self, what: &str) {
        let world = &mut self.0;
        let document = &world.resource::<Desk>().0;
        let scene = &world.resource::<CurrentScene>().0;
        let registry = world.resource::<Registry>();
        assert!(*document == *scene, "{what}: the scene is the document");
        assert_eq!(check::scene(document, registry), [], "{what}");
        let entities = world.resource::<SceneEntities>();
        let types = world.resource::<PartTypes>();
        assert!(entities.shows(document), "{what}");
        assert_eq!(entities.objects.len(), scene.objects.len(), "{what}");
        assert_eq!(entities.lights.len(), scene.lights.len(), "{what}");
        for (i, (entity, object)) in entities.objects.iter().zip(&scene.objects).enumerate() {
            let components = world.entity(*entity);
            assert_eq!(entities.place_of(*entity), Some(i), "{what}");
            assert_eq!(components.get::<PartId>().copied(), document.object_id(i), "{what}");
            if components.contains::<Animated>() {
                continue;
            }
            assert_eq!(read_object(components, Some(object), types, registry).as_ref(), Ok(object), "{what}");
            // A rotation may be written in several ways.
            let (now, wanted) =
                (components.get::<Transform>().expect("it has a place"), object_transform(object));
            assert_eq!((now.translation, now.scale), (wanted.translation, wanted.scale), "{what}");
            assert_eq!(components.get::<Surface>(), Some(&Surface::from(object)), "{what}");
            let shown = components.get::<ShownObject>().expect("it is shown");
            assert_eq!(
                (&shown.0.object_type, &shown.0.shape),
                (&object.object_type, &object.shape),
                "{what}"
            );
            assert_eq!((&shown.0.material, shown.0.visible), (&object.material, object.visible), "{what}");
        }
        for (i, (entity, light)) in entities.lights.iter().zip(&scene.lights).enumerate() {
            let components = world.entity(*entity);
            assert_eq!(components.get::<PartId>().copied(), document.light_id(i), "{what}");
            if !components.contains::<Animated>() {
                let now = read_light(components, Some(light), types, registry, scene.scene_size);
                assert_eq!(now.as_ref(), Ok(light), "{what}");
                assert_eq!(components.get::<SceneLight>(), Some(&SceneLight::from(light)), "{what}");
                assert_eq!(world.resource::<Shown>().lights[i], *light, "{what}");
            }
        }
        let counts = [scene.objects.len(), scene.lights.len(), 1];
        let all = [
            world.query::<&SceneObject>().iter(world).count(),
            world.query::<&SceneLight>().iter(world).count(),
            world.query::<&SceneObserver>().iter(world).count(),
        ];
        assert_eq!(all, counts, "{what}: every entity is a part");
    }

    /// The entity of each part.
    fn entities(&self) -> HashMap<PartId, Entity> {
        let entities = self.0.resource::<SceneEntities>();
        let all = entities.lights.iter().chain(&entities.objects);
        all.filter_map(|entity| Some((*self.0.get::<PartId>(*entity)?, *entity))).collect()
    }
}

/// Changes something in the document as a user would, and describes it.
fn edit(
    document: &mut Document,
    registry: &Registry,
    below: &mut impl FnMut(usize) -> usize,
) -> &'static str {
    let amount = 0.5 + below(64) as f32 / 16.0;
    let (i, j) = (below(document.objects.len()), below(document.lights.len()));
    document.end_gesture();
    let mut edit = |edit| drop(document.edit(edit, Selection::Room, registry));
    match below(10) {
        0 => {
            edit(Edit::set(Part::Object(i), Object::size, amount));
            "size"
        }
        1 => {
            edit(Edit::set(Part::Object(i), Object::position, Vec3::splat(amount)));
            "place"
        }
        2 => {
            edit(Edit::set(Part::Light(j), Light::intensity, amount));
            "intensity"
        }
        3 => {
            edit(Edit::set(Part::Light(j), Light::light_type, "spot"));
            "light type"
        }
        4 => {
            edit(Edit::set(Part::Scene, Scene::reflection_model, "phong"));
            "model"
        }
        5 => {
            document.insert_object(i, Object::default(), "Add", Selection::Room, registry);
            "object comes"
        }
        6 => {
            let light = Light { position: Some(Vec3::splat(9.0)), ..Light::default() };
            document.insert_light(j, light, "Add", Selection::Room, registry);
            "light comes"
        }
        7 if document.objects.len() > 1 => {
            document.remove(Selection::Object(i), registry);
            "object goes"
        }
        8 => {
            document.undo();
            "undo"
        }
        _ => {
            document.redo();
            "redo"
        }
    }
}

/// Changes something as a system would, and describes it.
fn act(world: &mut World, below: &mut impl FnMut(usize) -> usize) -> &'static str {
    let amount = 0.5 + below(64) as f32 / 16.0;
    // Sometimes more than a rule allows.
    let far = amount * 4.0 - 3.0;
    let entities = world.resource::<SceneEntities>();
    let one = |list: &[Entity], below: &mut dyn FnMut(usize) -> usize| list[below(list.len())];
    let (object, light) = (one(&entities.objects, below), one(&entities.lights, below));
    let eye = entities.observer.expect("there is an observer");
    let alive = |world: &World, entity| world.get_entity(entity).is_ok();
    if !alive(world, object) || !alive(world, light) || !alive(world, eye) {
        return "nothing: what was chosen is gone";
    }
    match below(24) {
        0 => {
            world.get_mut::<Surface>(object).expect("there").material.set("k_d", Value::Number(far / 8.0));
            "surface"
        }
        1 => {
            world.get_mut::<Transform>(object).expect("there").translation.x = far;
            "object moves"
        }
        2 => {
            world.get_mut::<Transform>(object).expect("there").scale = Vec3::splat(far);
            "object grows"
        }
        3 => {
            world.get_mut::<Transform>(object).expect("there").scale.y *= amount;
            "object is stretched"
        }
        4 => {
            world.get_mut::<Transform>(object).expect("there").rotate_y(amount);
            "object turns"
        }
        5 => {
            *world.get_mut::<Tessellation>(object).expect("there") =
                Tessellation(Some((amount * 4.0) as u32));
            "tessellation"
        }
        6 => {
            *world.get_mut::<Visibility>(object).expect("there") = Visibility::Hidden;
            "object is hidden"
        }
        7 => {
            *world.get_mut::<Name>(object).expect("there") = Name::new(format!("thing {amount}"));
            "name"
        }
        8 => {
            world.entity_mut(object).insert(Torus { tube_radius: far / 8.0 });
            "object becomes a torus"
        }
        9 => {
            world.entity_mut(object).remove::<(Sphere, Cube, Torus)>();
            "object loses its type"
        }
        10 => {
            world.entity_mut(object).remove::<SceneObject>();
            "object loses its marker"
        }
        11 => {
            world.spawn((Cube {}, Transform::from_xyz(amount, amount, 1.0).with_scale(Vec3::splat(0.3))));
            "object is spawned"
        }
        12 => {
            world.despawn(object);
            "object is despawned"
        }
        13 => {
            world.get_mut::<Transform>(light).expect("there").translation = Vec3::new(amount, far, 9.0);
            "light moves"
        }
        14 => {
            world.get_mut::<Transform>(light).expect("there").rotate_x(amount);
            "light turns"
        }
        15 => {
            world.get_mut::<SceneLight>(light).expect("there").power = LightPower::Flux(far);
            "flux"
        }
        16 => {
            world.get_mut::<SceneLight>(light).expect("there").colour =
                LightColour::Temperature(far * 1000.0);
            "temperature"
        }
        17 => {
            world
                .entity_mut(light)
                .remove::<(Point, Spot)>()
                .insert(Spot { cone_angle: far * 9.0, penumbra: 0.5 });
            "light becomes a spot"
        }
        18 => {
            world.entity_mut(light).remove::<(Point, Spot)>().insert(Ambient {});
            "light becomes ambient"
        }
        19 => {
            let spot = Spot { cone_angle: 20.0, ..Spot::default() };
            world.spawn((spot, Transform::from_xyz(5.0, 9.0, amount)));
            "light is spawned"
        }
        20 => {
            world.despawn(light);
            "light is despawned"
        }
        21 => {
            world.get_mut::<SceneObserver>(eye).expect("there").field_of_view = far * 20.0;
            "field of view"
        }
        22 => {
            if world.entity(object).contains::<Animated>() {
                world.entity_mut(object).remove::<Animated>();
            } else {
                world.entity_mut(object).insert(Animated);
            }
            "object is animated, or rests"
        }
        _ => {
            world.despawn(eye);
            "observer is despawned"
        }
    }
}

#[test]
fn document_scene_and_entities_stay_equal_whoever_changes_what() {
    for seed in 1..=60 {
        let mut random = Random(seed);
        let mut below = |n: usize| (random.unit() * n as f32) as usize;
        let mut lab = Lab::new();
        lab.frame();
        lab.check("the start");
        let mut said = Vec::new();
        for round in 0..60 {
            let (before, first) = (lab.entities(), said.len());
            for _ in 0..1 + round % 3 {
                said.push(match below(5) {
                    0 | 1 => {
                        let registry = lab.0.resource::<Registry>().clone();
                        edit(lab.document(), &registry, &mut below)
                    }
                    2 if below(4) == 0 => {
                        lab.0.resource_mut::<CurrentScene>().0.observer.position =
                            Vec3::splat(0.75 + 0.5 * below(8) as f32);
                        "the scene that is shown"
                    }
                    _ => act(&mut lab.0, &mut below),
                });
            }
            lab.frame();
            // Entities that cannot become parts, as the messages say.
            let strangers = lab.0.query_filtered::<Entity, (With<SceneObject>, Without<PartId>)>();
            let known = lab.0.resource::<SceneEntities>().objects.clone();
            let strangers: Vec<_> = { strangers }.iter(&lab.0).filter(|e| !known.contains(e)).collect();
            if !strangers.is_empty() {
                assert!(!lab.said().is_empty(), "seed {seed}: {said:?}");
                strangers.into_iter().for_each(|entity| _ = lab.0.despawn(entity));
            }
            lab.frame();
            lab.frame();
            lab.check(&format!("seed {seed}: {said:?}"));
            // A part keeps its entity for the lifetime of the entity, where the document knows the changes.
            if said[first..].contains(&"the scene that is shown") {
                continue;
            }
            for (id, entity) in lab.entities() {
                let Some(old) = before.get(&id) else { continue };
                assert!(*old == entity || lab.0.get_entity(*old).is_err(), "seed {seed}: {said:?}");
            }
        }
    }
}

#[test]
fn what_was_written_is_not_read_in_the_same_frame_or_the_next() {
    let mut lab = Lab::new();
    lab.settle();
    let registry = lab.0.resource::<Registry>().clone();
    let start = lab.0.resource::<SceneEntities>().visits();
    let visits = |lab: &mut Lab| {
        lab.frame();
        lab.0.resource::<SceneEntities>().visits() - start
    };
    let edit = Edit::set(Part::Object(2), Object::size, 0.25);
    lab.document().edit(edit, Selection::Room, &registry).expect("legal");
    assert_eq!([visits(&mut lab), visits(&mut lab)], [1, 1], "the edit is written");
    let object = lab.object(2);
    lab.get::<Transform>(object).translation.x = 400.0;
    assert_eq!([visits(&mut lab), visits(&mut lab)], [2, 2], "the change is read, and goes back");
    // What a system and the document change in one frame both stay.
    lab.get::<Transform>(object).translation.x = 4.0;
    let edit = Edit::set(Part::Object(2), Object::size, 0.5);
    lab.document().edit(edit, Selection::Room, &registry).expect("legal");
    assert_eq!([visits(&mut lab), visits(&mut lab)], [4, 4]);
    lab.check("both");
    assert_eq!((lab.document().objects[2].position.x, lab.document().objects[2].size), (4.0, 0.5));
}

#[test]
fn edits_and_changes_by_systems_in_one_frame_both_stay_in_either_order() {
    fn get<C: Component<Mutability = bevy::ecs::component::Mutable>>(
        world: &mut World,
        i: usize,
    ) -> Mut<'_, C> {
        let object = world.resource::<SceneEntities>().objects[i];
        world.get_mut::<C>(object).expect("it has the component")
    }
    // The component that is written, another of its entity, and another entity.
    let acts: [(fn(&mut World), fn(&mut Scene)); 3] = [
        (|world| get::<Transform>(world, 2).translation.x = 4.5, |scene| scene.objects[2].position.x = 4.5),
        (
            |world| get::<Surface>(world, 2).material.set("k_d", Value::Number(0.75)),
            |scene| scene.objects[2].material.set("k_d", Value::Number(0.75)),
        ),
        (|world| get::<Transform>(world, 3).translation.x = 4.5, |scene| scene.objects[3].position.x = 4.5),
    ];
    for (i, (act, changed)) in acts.into_iter().enumerate() {
        for later in [false, true] {
            let mut lab = Lab::new();
            lab.settle();
            let registry = lab.0.resource::<Registry>().clone();
            let mut wanted = lab.document().scene().clone();
            wanted.objects[2].size = 0.25;
            changed(&mut wanted);
            let start = lab.0.resource::<SceneEntities>().visits();
            let edit = Edit::set(Part::Object(2), Object::size, 0.25);
            lab.document().edit(edit, Selection::Room, &registry).expect("legal");
            if later {
                lab.0.insert_resource(Between(Some(act)));
            } else {
                act(&mut lab.0);
            }
            lab.frame();
            let visits = lab.0.resource::<SceneEntities>().visits() - start;
            assert_eq!(visits, 2, "{i} {later}: one is written, one is read");
            lab.settle();
            assert!(*lab.document() == wanted, "{i} {later}");
        }
    }
}

#[test]
fn a_part_with_two_edits_in_one_frame_is_written_once_and_not_read() {
    let mut lab = Lab::new();
    lab.settle();
    let registry = lab.0.resource::<Registry>().clone();
    let start = lab.0.resource::<SceneEntities>().visits();
    for edit in [
        Edit::set(Part::Object(2), Object::size, 0.25),
        Edit::set(Part::Object(2), Object::position, Vec3::splat(7.0)),
    ] {
        lab.document().edit(edit, Selection::Room, &registry).expect("legal");
    }
    lab.settle();
    assert_eq!(lab.0.resource::<SceneEntities>().visits() - start, 1);
}

#[test]
fn a_spot_that_is_spawned_is_a_light_of_the_document_and_goes_when_it_is_despawned() {
    let mut lab = Lab::new();
    let spot = Spot { cone_angle: 20.0, ..Spot::default() };
    let entity = lab.0.spawn((spot, Transform::from_xyz(5.0, 9.0, 5.0), Name::new("Lamp"))).id();
    lab.settle();
    let light = lab.document().lights[1].clone();
    assert_eq!((light.light_type.as_str(), light.name.as_deref()), ("spot", Some("Lamp")));
    assert_eq!((light.position, light.direction), (Some(Vec3::new(5.0, 9.0, 5.0)), Some(Vec3::NEG_Z)));
    assert_eq!(light.parameters.0.get("cone_angle"), Some(&Value::Number(20.0)));
    let registry = lab.0.resource::<Registry>().clone();
    let entry = registry.light("spot").expect("built in");
    assert_eq!(light.intensity, entry.declaration.default_intensity);
    // Rotating its transform rotates its light.
    lab.get::<Transform>(entity).rotation = Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
    lab.settle();
    let direction = lab.document().lights[1].direction.expect("a spot has one");
    assert!((direction - Vec3::NEG_Y).length() < 1e-6, "{direction}");
    // Another type.
    lab.0.entity_mut(entity).remove::<Spot>().insert(Point {});
    lab.settle();
    assert_eq!(lab.document().lights[1].light_type, "point");
    assert_eq!(lab.document().lights[1].direction, None);
    assert_eq!(lab.document().steps().collect::<Vec<_>>(), ["Change by a system"]);
    lab.0.despawn(entity);
    lab.settle();
    assert_eq!(lab.document().lights.len(), 1);
    // A part that was added and removed again is not a step.
    let document = lab.document();
    assert_eq!((document.steps().len(), document.differs()), (0, false));
    assert_eq!(lab.said(), [""; 0]);
}

#[test]
fn the_component_of_a_type_has_the_parameters_of_its_part() {
    let mut lab = Lab::new();
    let (light, object) = (lab.light(0), lab.object(0));
    lab.0.entity_mut(light).remove::<Point>().insert(Spot::default());
    lab.0.entity_mut(object).remove::<Sphere>().insert(Torus::default());
    lab.settle();
    lab.get::<Spot>(light).cone_angle = 12.0;
    lab.get::<Torus>(object).tube_radius = 0.2;
    lab.settle();
    let parameters = |lab: &mut Lab| {
        let document = lab.document();
        (document.lights[0].parameters.0.clone(), document.objects[0].shape.0.clone())
    };
    let (spot, torus) = parameters(&mut lab);
    assert_eq!(spot.get("cone_angle"), Some(&Value::Number(12.0)));
    assert_eq!(torus.get("tube_radius"), Some(&Value::Number(0.2)));
    // And in the other direction.
    let registry = lab.0.resource::<Registry>().clone();
    let edit = Edit::parameter(Part::Object(0), "tube_radius", Value::Number(0.1));
    lab.document().edit(edit, Selection::Room, &registry).expect("legal");
    lab.settle();
    assert_eq!(lab.get::<Torus>(object).tube_radius, 0.1);
    // Changes that break a rule are undone.
    lab.get::<Spot>(light).cone_angle = 500.0;
    lab.get::<Torus>(object).tube_radius = f32::NAN;
    lab.settle();
    assert_eq!((lab.get::<Spot>(light).cone_angle, lab.get::<Torus>(object).tube_radius), (12.0, 0.1));
    let said = lab.said();
    assert!(
        said.len() == 2 && said.iter().any(|text| text.contains("lights[0].cone_angle is 500")),
        "{said:?}"
    );
    assert!(said.iter().any(|text| text.contains("objects[0].tube_radius is NaN")), "{said:?}");
}

#[test]
fn components_that_a_part_needs_come_back() {
    let mut lab = Lab::new();
    let object = lab.object(0);
    lab.0.entity_mut(object).remove::<Transform>();
    lab.settle();
    assert_eq!(lab.get::<Transform>(object).translation, Vec3::ONE);
    let said = lab.said();
    let expected =
        "A change to the components of objects[0] was refused: it needs the component `Transform`.";
    assert_eq!(said, [expected]);
    lab.0.entity_mut(object).remove::<(Visibility, Surface)>();
    lab.settle();
    assert!(lab.0.get::<Visibility>(object).is_some() && lab.0.get::<Surface>(object).is_some());
    assert_eq!(lab.said().len(), 1);
}

#[test]
fn objects_that_come_get_names_as_those_of_panels_do() {
    let mut lab = Lab::new();
    let sphere = Transform::from_xyz(2.0, 8.0, 2.0);
    lab.0.spawn((Sphere {}, sphere));
    lab.0.spawn((Torus { tube_radius: 0.1 }, sphere));
    let first = lab.object(0);
    lab.0.despawn(first);
    lab.settle();
    let registry = lab.0.resource::<Registry>().clone();
    let document = lab.document();
    let names: Vec<_> =
        (0..document.objects.len()).map(|i| document.name_of(Selection::Object(i), &registry)).collect();
    let expected = ["Sphere 2", "Sphere 3", "Sphere 4", "Sphere 5", "Sphere 6", "Sphere 7", "Torus 1"];
    assert_eq!(names, expected);
    assert_eq!(document.objects[6].shape.0.get("tube_radius"), Some(&Value::Number(0.1)));
}

#[test]
fn what_is_refused_goes_back_and_is_said_once_until_something_legal_came() {
    let mut lab = Lab::new();
    let (first, second) = (lab.object(0), lab.object(1));
    for round in 0..3 {
        lab.get::<Transform>(first).translation.x = 400.0 + round as f32;
        // A legal change is not refused with it.
        lab.get::<Transform>(second).translation.x = 3.0 + 0.5 * round as f32;
        lab.frame();
        assert_eq!(lab.get::<Transform>(first).translation, Vec3::ONE);
        assert_eq!(lab.document().objects[1].position.x, 3.0 + 0.5 * round as f32);
    }
    let said = lab.said();
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(
        said[0].starts_with("A change to a component was refused: objects[0].position is [400, 1, 1], but"),
        "{said:?}"
    );
    // Another error in the same part is another message.
    lab.get::<Transform>(first).scale = Vec3::new(1.0, 3.0, 1.0);
    lab.settle();
    let said = lab.said();
    assert_eq!(
        said,
        [
            "A change to the components of objects[0] was refused: its scale is (1, 3, 1), but an object has one size: the scale must be \
          the same in x, y and z."
        ]
    );
    assert_eq!(lab.get::<Transform>(first).scale, Vec3::splat(0.5));
    // After a legal change the message is reported again.
    lab.get::<Transform>(first).translation.x = 2.0;
    lab.settle();
    lab.get::<Transform>(first).translation.x = -1.0;
    lab.settle();
    assert_eq!(lab.said().len(), 1);
    let light = lab.light(0);
    lab.0.entity_mut(light).remove::<Point>().insert(Spot { cone_angle: 500.0, penumbra: 0.0 });
    lab.settle();
    let said = lab.said();
    assert!(said.len() == 1 && said[0].contains("lights[0].cone_angle is 500, but"), "{said:?}");
    assert!(lab.0.get::<Point>(light).is_some() && lab.0.get::<Spot>(light).is_none());
}

#[test]
fn what_cannot_become_a_part_is_said_with_the_reason() {
    let mut lab = Lab::new();
    let spawned = [
        lab.0.spawn(Sphere {}).id(),
        lab.0.spawn((Sphere {}, Cube {}, Transform::from_xyz(1.0, 2.0, 3.0), Name::new("both"))).id(),
        lab.0.spawn((SceneObject, Transform::from_xyz(1.0, 2.0, 3.0), Name::new("bare"))).id(),
        lab.0.spawn((Sphere {}, Spot::default(), Transform::from_xyz(1.0, 2.0, 3.0), Name::new("lamp"))).id(),
        lab.0.spawn((SceneLight::default(), Name::new("dark"))).id(),
        lab.0.spawn((SceneObserver::default(), Name::new("eye"))).id(),
        lab.0
            .spawn((
                Spot { cone_angle: 0.0, penumbra: 0.0 },
                Transform::from_xyz(1.0, 2.0, 3.0),
                Name::new("x"),
            ))
            .id(),
    ];
    lab.frame();
    lab.frame();
    let said = lab.said();
    let expected = [
        "was not added to the scene: its position is [0, 0, 0], but",
        "The entity “both” was not added to the scene: it has `Sphere` and `Cube`, but must have one object type.",
        "The entity “bare” was not added to the scene: it needs the component of one object type, such as `Sphere`.",
        "The entity “lamp” was not added to the scene: it is both a light and an object, but must be only one of them.",
        "The entity “dark” was not added to the scene: it needs the component of one light type, such as `Point`.",
        "The entity “eye” was not added to the scene: a scene has only one observer.",
        "The entity “x” was not added to the scene: its cone_angle is 0, but",
    ];
    for (expected, entity) in expected.iter().zip(spawned) {
        assert!(said.iter().any(|text| text.contains(expected)), "{expected}: {said:?}");
        lab.0.despawn(entity);
    }
    assert_eq!(said.len(), expected.len(), "{said:?}");
    lab.settle();
    // A corrected entity is added.
    let entity = lab.0.spawn(Sphere {}).id();
    lab.frame();
    lab.get::<Transform>(entity).translation = Vec3::new(1.0, 2.0, 3.0);
    lab.settle();
    assert_eq!(lab.document().objects.len(), 7);
}

#[test]
fn the_last_object_the_last_light_and_the_observer_come_back() {
    let mut lab = Lab::new();
    let all = lab.0.resource::<SceneEntities>().objects.clone();
    all.into_iter().for_each(|entity| _ = lab.0.despawn(entity));
    let (light, eye) = (lab.light(0), lab.0.resource::<SceneEntities>().observer.expect("there"));
    lab.0.despawn(light);
    lab.0.despawn(eye);
    lab.frame();
    let mut said = lab.said();
    said.sort();
    assert_eq!(
        said,
        [
            "Can’t delete the last light: a scene needs at least one.",
            "Can’t delete the last object: a scene needs at least one.",
            "Can’t delete the observer: a scene needs one.",
        ]
    );
    lab.settle();
    assert_eq!((lab.document().objects.len(), lab.document().lights.len()), (1, 1));
    assert_eq!(lab.document().objects[0].position, Vec3::ONE);
    // Another one may replace the last.
    let light = lab.light(0);
    lab.0.despawn(light);
    lab.0.spawn((Spot::default(), Transform::from_xyz(5.0, 9.0, 5.0)));
    lab.settle();
    assert_eq!(lab.said(), [""; 0]);
    assert_eq!(lab.document().lights[0].light_type, "spot");
}

#[test]
fn what_is_animated_is_shown_and_not_stored() {
    let mut lab = Lab::new();
    let registry = lab.0.resource::<Registry>().clone();
    let (object, light) = (lab.object(0), lab.light(0));
    let eye = lab.0.resource::<SceneEntities>().observer.expect("there");
    for entity in [object, light, eye] {
        lab.0.entity_mut(entity).insert(Animated);
    }
    let stored = lab.document().scene().clone();
    for round in 0..3 {
        // Far outside all rules.
        let place = Vec3::new(50.0 + round as f32, 1.0, 1.0);
        for entity in [object, light, eye] {
            lab.get::<Transform>(entity).translation = place;
        }
        lab.get::<Transform>(object).scale = Vec3::new(1.0, 2.0, 3.0);
        lab.get::<Surface>(object).material.set("k_d", Value::Number(0.75));
        lab.0.entity_mut(object).insert(Torus { tube_radius: 0.1 });
        lab.get::<SceneLight>(light).enabled = round == 1;
        lab.frame();
        assert!(*lab.document() == stored && !lab.document().differs());
        assert_eq!(lab.document().steps().len(), 0);
        let shown = lab.0.resource::<Shown>();
        assert_eq!((shown.lights[0].position, shown.lights[0].enabled), (Some(place), round == 1));
        assert_eq!(shown.observer.position, place);
        let look = &lab.0.get::<ShownObject>(object).expect("it is shown").0;
        assert_eq!(
            (look.object_type.as_str(), look.material.0.get("k_d")),
            ("torus", Some(&Value::Number(0.75)))
        );
        assert_eq!(look.shape.0.get("tube_radius"), Some(&Value::Number(0.1)));
    }
    // An edit writes only its changes, and leaves the rest to the animation.
    let edit = Edit::material(Part::Object(0), "k_d", Value::Number(0.6));
    lab.document().edit(edit, Selection::Room, &registry).expect("legal");
    lab.frame();
    assert_eq!(lab.get::<Surface>(object).material.0.get("k_d"), Some(&Value::Number(0.6)));
    assert_eq!(lab.get::<Transform>(object).translation.x, 52.0);
    let edit = Edit::set(Part::Object(0), Object::position, Vec3::splat(2.0));
    lab.document().edit(edit, Selection::Room, &registry).expect("legal");
    lab.frame();
    assert_eq!(lab.get::<Transform>(object).translation, Vec3::splat(2.0));
    assert_eq!(lab.get::<Transform>(object).scale, Vec3::new(1.0, 2.0, 3.0));
    // Without the marker everything is as in the document.
    for entity in [object, light, eye] {
        lab.0.entity_mut(entity).remove::<Animated>();
    }
    lab.settle();
    assert_eq!(lab.said(), [""; 0]);
    assert!(lab.0.get::<Sphere>(object).is_some() && lab.0.get::<Torus>(object).is_none());
    assert_eq!(lab.get::<Transform>(object).scale, Vec3::splat(0.5));
    assert_eq!(lab.0.resource::<Shown>().lights, stored.lights);
    assert_eq!(lab.0.resource::<Shown>().observer, stored.observer);
    // Despawning removes a part, animated or not.
    lab.0.entity_mut(object).insert(Animated);
    lab.0.despawn(object);
    lab.settle();
    assert_eq!(lab.document().objects.len(), 5);
}

#[test]
fn a_change_of_layout_or_of_another_view_changes_not_what_view_a_shows() {
    let registry = Registry::builtin();
    let mut world = World::new();
    world.insert_resource(CurrentScene(Scene::default()));
    world.insert_resource(Desk(Document::new(Scene::default())));
    world.init_resource::<SceneEntities>();
    let mut schedule = Schedule::default();
    schedule.add_systems(show);
    schedule.run(&mut world);
    let mut changes = |edit: Edit| {
        world.clear_trackers();
        world.resource_mut::<Desk>().0.edit(edit, Selection::Room, &registry).expect("legal");
        schedule.run(&mut world);
        assert_eq!(world.resource::<CurrentScene>().0, *world.resource::<Desk>().0);
        world.is_resource_changed::<CurrentScene>()
    };
    let variants = vec![Variant::default()];
    let comparison = Comparison { layout: Layout::Wipe, ..Comparison::default() };
    assert!(!changes(Edit::Views { variants, comparison, step: "Add a view" }));
    assert!(!changes(Edit::from(Comparison { split: 0.3, ..comparison })));
    assert!(!changes(Edit::set(Part::Variant(0), Variant::exposure, 1.0)));
    // The wrong twin: view A changes.
    assert!(changes(Edit::from(Display { exposure: 1.0, ..Display::default() })));
    assert!(!changes(Edit::from(Comparison { split: 0.6, ..comparison })));
}
