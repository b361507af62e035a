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
use std::{iter, ops::Range};

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

/// What tools call an entity: the name of its part, or else its type. A number would change with every part before it.
fn label(name: Option<&String>, type_name: &str) -> Name {
    Name::new(name.cloned().unwrap_or_else(|| type_name.to_owned()))
}

/// Matches the entities of `old` parts with `new` parts: equal parts at the beginning and at the end keep their
/// entities, those between get the entities that are left. Returns which of the new parts differ from what their
/// entities stand for, and the entities that stand for nothing any more.
fn align<T: PartialEq>(entities: &mut Vec<Entity>, old: &[T], new: &[T]) -> (Range<usize>, Vec<Entity>) {
    // Someone else's hands were here: nothing is known.
    let old = if entities.len() == old.len() { old } else { &[] };
    let equal = |(a, b): &(&T, &T)| a == b;
    let before = old.iter().zip(new).take_while(equal).count();
    let rest = (&old[before..], &new[before..]);
    let after = rest.0.iter().rev().zip(rest.1.iter().rev()).take_while(equal).count();
    let end = new.len() - after;
    let old_end = entities.len().saturating_sub(after);
    if old_end > end {
        return (before..end, entities.drain(end..old_end).collect());
    }
    entities.splice(old_end..old_end, iter::repeat_n(Entity::PLACEHOLDER, end - old_end));
    (before..end, Vec::new())
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
    let entities = &mut *entities;
    let Scene { lights: wanted_lights, objects: wanted_objects, observer, .. } = &scene.0;
    let mirrored = entities.mirrored.replace(scene.0.clone());
    let (old_lights, old_objects) =
        mirrored.as_ref().map_or((&[][..], &[][..]), |s| (&s.lights[..], &s.objects[..]));
    let (changed_lights, surplus_lights) = align(&mut entities.lights, old_lights, wanted_lights);
    let (changed_objects, surplus_objects) = align(&mut entities.objects, old_objects, wanted_objects);
    for surplus in surplus_lights.into_iter().chain(surplus_objects) {
        commands.entity(surplus).try_despawn();
    }

    for (i, (light, slot)) in wanted_lights.iter().zip(&mut entities.lights).enumerate() {
        let current = lights.get(*slot).ok();
        if current.is_some() && !changed_lights.contains(&i) {
            continue;
        }
        let old_type = current.map(|c| c.0.light_type.as_str());
        let mut entity = if current.is_some() { commands.entity(*slot) } else { commands.spawn_empty() };
        *slot = entity.id();
        entity.insert((
            LightSource(light.clone()),
            light_transform(light),
            label(light.name.as_ref(), &light.light_type),
        ));
        if old_type != Some(light.light_type.as_str()) {
            if let Some(old) = old_type.and_then(|k| registry.light(k)) {
                (old.unmark)(&mut entity);
            }
            match registry.light(&light.light_type) {
                Some(entry) => (entry.mark)(&mut entity),
                None => warn!("light {i} has the unknown type `{}` and gives no light", light.light_type),
            }
        }
    }

    for (i, (object, slot)) in wanted_objects.iter().zip(&mut entities.objects).enumerate() {
        let known = objects.contains(*slot);
        if known && !changed_objects.contains(&i) {
            continue;
        }
        let mut entity = if known { commands.entity(*slot) } else { commands.spawn_empty() };
        *slot = entity.id();
        entity.insert((
            LitObject(object.clone()),
            object_transform(object),
            if object.visible { Visibility::Inherited } else { Visibility::Hidden },
            label(object.name.as_ref(), &object.object_type),
        ));
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
            if source.0.light_type != known.light_type {
                let mut entity = commands.entity(*entity);
                if let Some(old) = registry.light(&known.light_type) {
                    (old.unmark)(&mut entity);
                }
                if let Some(new) = registry.light(&source.0.light_type) {
                    (new.mark)(&mut entity);
                }
            }
        } else if source.0.position.is_some_and(|p| p != transform.translation) {
            source.0.position = Some(transform.translation);
        }
        if source.0 != *known {
            let light = source.0.clone();
            commands.entity(*entity).insert(label(light.name.as_ref(), &light.light_type));
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
            commands.entity(*entity).insert(label(object.name.as_ref(), &object.object_type));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The parts as numbers: which differ, which entities go, and the place in `old` that each new one had.
    fn aligned(old: &[u32], new: &[u32]) -> (Range<usize>, Vec<u32>, Vec<Option<u32>>) {
        let entity = |i: usize| Entity::from_raw_u32(i as u32).expect("a number of an entity");
        let mut entities: Vec<_> = (0..old.len()).map(entity).collect();
        let (changed, surplus) = align(&mut entities, old, new);
        let place = |e: &Entity| (*e != Entity::PLACEHOLDER).then(|| e.index_u32());
        (changed, surplus.iter().filter_map(place).collect(), entities.iter().map(place).collect())
    }

    #[test]
    fn equal_parts_at_both_ends_keep_their_entities() {
        assert_eq!(aligned(&[1, 2, 3], &[1, 2, 3]), (3..3, vec![], vec![Some(0), Some(1), Some(2)]));
        assert_eq!(aligned(&[1, 2, 3], &[2, 3]), (0..0, vec![0], vec![Some(1), Some(2)]));
        assert_eq!(aligned(&[1, 2, 3], &[1, 3]), (1..1, vec![1], vec![Some(0), Some(2)]));
        assert_eq!(aligned(&[1, 2], &[9, 1, 2]), (0..1, vec![], vec![None, Some(0), Some(1)]));
        assert_eq!(aligned(&[1, 2, 3], &[1, 9, 3]), (1..2, vec![], vec![Some(0), Some(1), Some(2)]));
        assert_eq!(aligned(&[1, 1, 1], &[1, 1]), (2..2, vec![2], vec![Some(0), Some(1)]));
        assert_eq!(aligned(&[1, 2, 3, 4], &[8, 9, 4]), (0..2, vec![2], vec![Some(0), Some(1), Some(3)]));
        assert_eq!(aligned(&[], &[1, 2]), (0..2, vec![], vec![None, None]));
        assert_eq!(aligned(&[1, 2], &[]), (0..0, vec![0, 1], vec![]));
    }
}
