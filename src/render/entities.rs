//! The scene as entities: every light, every object and the observer is an entity with components
//! of its own.
//!
//! [`CurrentScene`] and the entities mirror each other. Replacing or editing the scene changes only
//! the entities that differ (so a reload leaves the rest alone); changing a component of an entity
//! changes the scene. Either way the picture follows in the next frame.

use crate::{
    registry::Registry,
    scene::{
        Light, Object, Observer, Scene, observer,
        rotation::{euler_degrees, rotation},
    },
};
use bevy::{camera::visibility::Visibility, ecs::prelude::*, log::warn, transform::components::Transform};
use glam::Vec3;

/// The scene that is shown.
#[derive(Clone, Debug, Default, PartialEq, Resource)]
pub struct CurrentScene(pub Scene);

/// A light of the scene. Its type's marker component stands beside it.
#[derive(Clone, Component, Debug, PartialEq)]
#[require(Transform, Visibility)]
pub struct LightSource(pub Light);

/// An object of the scene.
#[derive(Clone, Component, Debug, PartialEq)]
#[require(Transform, Visibility)]
pub struct LitObject(pub Object);

/// The observer of the scene.
#[derive(Clone, Component, Debug, PartialEq)]
#[require(Transform)]
pub struct Eye(pub Observer);

/// Which entity stands for which part of the scene, in the scene's order.
#[derive(Debug, Default, Resource)]
pub struct SceneEntities {
    /// The lights.
    pub lights: Vec<Entity>,
    /// The objects.
    pub objects: Vec<Entity>,
    /// The observer.
    pub observer: Option<Entity>,
    /// The scene that the entities stood for when the two were last made equal. What differs from it
    /// in the scene was edited there, what differs in the entities was edited there.
    mirrored: Option<Scene>,
}

/// The transform of an object: unit mesh → size → rotation → position.
#[must_use]
pub fn object_transform(object: &Object) -> Transform {
    Transform {
        translation: object.position,
        rotation: rotation(object.rotation),
        scale: Vec3::splat(object.size),
    }
}

fn observer_transform(observer: &Observer) -> Transform {
    Transform::from_translation(observer.position).with_rotation(observer::rotation(observer.direction))
}

fn light_transform(light: &Light) -> Transform {
    Transform::from_translation(light.position.unwrap_or(Vec3::ZERO))
}

fn label(name: Option<&String>, kind: &str, index: usize) -> Name {
    Name::new(name.cloned().unwrap_or_else(|| format!("{kind} {}", index + 1)))
}

/// Makes the entities equal to the scene. Runs when [`CurrentScene`] changed; touches only what
/// differs.
pub fn reconcile(
    mut commands: Commands,
    scene: Res<CurrentScene>,
    registry: Res<Registry>,
    mut entities: ResMut<SceneEntities>,
    lights: Query<&LightSource>,
    objects: Query<&LitObject>,
    eyes: Query<&Eye>,
) {
    let mirrored = entities.mirrored.replace(scene.0.clone());
    let mirrored_light = |i: usize| mirrored.as_ref().and_then(|s| s.lights.get(i));
    let mirrored_object = |i: usize| mirrored.as_ref().and_then(|s| s.objects.get(i));
    let Scene { lights: wanted_lights, objects: wanted_objects, observer, .. } = &scene.0;

    let keep = wanted_lights.len().min(entities.lights.len());
    for extra in entities.lights.split_off(keep) {
        commands.entity(extra).try_despawn();
    }
    for (i, light) in wanted_lights.iter().enumerate() {
        let current = entities.lights.get(i).and_then(|e| lights.get(*e).ok());
        if current.is_some() && mirrored_light(i) == Some(light) {
            continue;
        }
        let old_kind = current.map(|c| c.0.kind.as_str());
        let mut entity = match entities.lights.get(i) {
            Some(e) if current.is_some() => commands.entity(*e),
            _ => {
                let e = commands.spawn_empty();
                match entities.lights.get_mut(i) {
                    Some(slot) => *slot = e.id(),
                    None => entities.lights.push(e.id()),
                }
                e
            }
        };
        entity.insert((
            LightSource(light.clone()),
            light_transform(light),
            label(light.name.as_ref(), &light.kind, i),
        ));
        if old_kind != Some(light.kind.as_str()) {
            if let Some(old) = old_kind.and_then(|k| registry.light(k)) {
                (old.unmark)(&mut entity);
            }
            match registry.light(&light.kind) {
                Some(entry) => (entry.mark)(&mut entity),
                None => warn!("light {i} has the unknown type `{}` and gives no light", light.kind),
            }
        }
    }

    let keep = wanted_objects.len().min(entities.objects.len());
    for extra in entities.objects.split_off(keep) {
        commands.entity(extra).try_despawn();
    }
    for (i, object) in wanted_objects.iter().enumerate() {
        let current = entities.objects.get(i).and_then(|e| objects.get(*e).ok());
        if current.is_some() && mirrored_object(i) == Some(object) {
            continue;
        }
        let parts = (
            LitObject(object.clone()),
            object_transform(object),
            if object.visible { Visibility::Inherited } else { Visibility::Hidden },
            label(object.name.as_ref(), &object.kind, i),
        );
        match entities.objects.get_mut(i) {
            Some(e) if current.is_some() => {
                commands.entity(*e).insert(parts);
            }
            slot => {
                let e = commands.spawn(parts).id();
                match slot {
                    Some(slot) => *slot = e,
                    None => entities.objects.push(e),
                }
            }
        }
    }

    match entities.observer.filter(|e| eyes.contains(*e)) {
        Some(e) => {
            if mirrored.is_none_or(|s| s.observer != *observer) {
                commands.entity(e).insert((Eye(*observer), observer_transform(observer)));
            }
        }
        None => {
            let e =
                commands.spawn((Eye(*observer), observer_transform(observer), Name::new("Observer"))).id();
            entities.observer = Some(e);
        }
    }
}

/// Takes over what others changed in the entities: components and transforms become the scene's
/// values, and each other's. Where both were changed, the component counts. What [`reconcile`] wrote
/// itself compares equal and changes nothing.
pub fn absorb(
    mut commands: Commands,
    mut scene: ResMut<CurrentScene>,
    mut entities: ResMut<SceneEntities>,
    registry: Res<Registry>,
    mut lights: Query<(&mut LightSource, &mut Transform), (Without<LitObject>, Without<Eye>)>,
    mut objects: Query<(&mut LitObject, &mut Transform), (Without<LightSource>, Without<Eye>)>,
    mut eyes: Query<(&mut Eye, &mut Transform), (Without<LightSource>, Without<LitObject>)>,
) {
    let mut next = None;
    for (i, entity) in entities.lights.iter().enumerate() {
        let (Ok((mut source, mut transform)), Some(known)) = (lights.get_mut(*entity), scene.0.lights.get(i))
        else {
            continue;
        };
        if !source.is_changed() && !transform.is_changed() {
            continue;
        }
        if source.0 != *known {
            *transform = light_transform(&source.0);
            if source.0.kind != known.kind {
                let mut entity = commands.entity(*entity);
                if let Some(old) = registry.light(&known.kind) {
                    (old.unmark)(&mut entity);
                }
                if let Some(new) = registry.light(&source.0.kind) {
                    (new.mark)(&mut entity);
                }
            }
        } else if source.0.position.is_some_and(|p| p != transform.translation) {
            source.0.position = Some(transform.translation);
        }
        if source.0 != *known {
            let light = source.0.clone();
            commands.entity(*entity).insert(label(light.name.as_ref(), &light.kind, i));
            put(&mut next, &scene.0, |s| s.lights.get_mut(i).map(|l| *l = light));
        }
    }
    for (i, entity) in entities.objects.iter().enumerate() {
        let (Ok((mut lit, mut transform)), Some(known)) = (objects.get_mut(*entity), scene.0.objects.get(i))
        else {
            continue;
        };
        if !lit.is_changed() && !transform.is_changed() {
            continue;
        }
        if lit.0 != *known {
            *transform = object_transform(&lit.0);
        } else if *transform != object_transform(&lit.0) {
            lit.0.position = transform.translation;
            lit.0.rotation = euler_degrees(transform.rotation);
            lit.0.size = transform.scale.max_element();
        }
        if lit.0 != *known {
            let object = lit.0.clone();
            commands.entity(*entity).insert(label(object.name.as_ref(), &object.kind, i));
            put(&mut next, &scene.0, |s| s.objects.get_mut(i).map(|o| *o = object));
        }
    }
    if let Some((mut eye, mut transform)) = entities.observer.and_then(|e| eyes.get_mut(e).ok())
        && (eye.is_changed() || transform.is_changed())
    {
        let known = scene.0.observer;
        if eye.0 != known {
            *transform = observer_transform(&eye.0);
        } else if *transform != observer_transform(&known) {
            eye.0.position = transform.translation;
            eye.0.direction = transform.rotation * Vec3::NEG_Z;
        }
        if eye.0 != known {
            let observer = eye.0;
            put(&mut next, &scene.0, |s| {
                s.observer = observer;
                Some(())
            });
        }
    }
    if let Some(next) = next {
        entities.mirrored = Some(next.clone());
        scene.0 = next;
    }
}

/// Edits a copy of the scene that is made at the first edit.
fn put(next: &mut Option<Scene>, scene: &Scene, edit: impl FnOnce(&mut Scene) -> Option<()>) {
    let _ = edit(next.get_or_insert_with(|| scene.clone()));
}
