//! The scene as entities: every light, every object and the observer is an entity with components
//! of its own.
//!
//! [`CurrentScene`] and the entities mirror each other. Replacing or editing the scene changes only
//! the entities that differ (so a reload leaves the rest alone); changing a component of an entity
//! changes the scene. Either way the picture follows in the next frame.

use crate::{
    document::{Extent, Revision, difference},
    registry::Registry,
    scene::{
        Light, Object, Observer, Scene, observer,
        rotation::{euler_degrees, rotation},
    },
};
use bevy::{
    camera::visibility::Visibility,
    ecs::{
        change_detection::Tick, entity::EntityHashMap, lifecycle::HookContext, prelude::*,
        world::DeferredWorld,
    },
    log::warn,
    transform::components::Transform,
};
use glam::Vec3;
use std::{iter, ops::Range};

/// The scene that is shown.
#[derive(Clone, Debug, Default, PartialEq, Resource)]
pub struct CurrentScene(pub Scene);

/// A light of the scene. The component of its type stands beside it, with its parameters.
#[derive(Clone, Component, Debug, PartialEq)]
#[require(Transform, Visibility)]
pub struct LightSource(pub Light);

/// An object of the scene.
#[derive(Clone, Component, Debug, PartialEq)]
#[require(Transform, Visibility)]
#[component(on_remove = lose)]
pub struct LitObject(pub Object);

fn lose(mut world: DeferredWorld, context: HookContext) {
    if let Some(mut entities) = world.get_resource_mut::<SceneEntities>()
        && entities.places.contains_key(&context.entity)
    {
        entities.lost.push(context.entity);
    }
}

/// The observer of the scene.
#[derive(Clone, Component, Debug, PartialEq)]
#[require(Transform)]
pub struct Eye(pub Observer);

/// The entities of the parts of the scene, in the scene's order.
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
    /// The tick of the last change of the scene of which all is known: it is in `mirrored`, or in `due`.
    pub(super) seen: Option<Tick>,
    /// Parts of the scene that the entities are to follow.
    pub(super) due: Vec<Extent>,
    /// Parts that changed in entities in this frame, and that the document has yet to learn of.
    pub(super) absorbed: Vec<Extent>,
    /// The document's value that the scene is equal to, but for what was absorbed, and the tick of the last change of
    /// the scene for which that is so.
    pub(super) shown: Option<Revision>,
    pub(super) agreed: Option<Tick>,
    /// The index of each object.
    places: EntityHashMap<usize>,
    /// Entities of objects that others despawned.
    lost: Vec<Entity>,
    /// Counts how often the list of objects was another one.
    lists: u64,
    pub(super) visits: u64,
}

impl SceneEntities {
    /// The number of objects visited since the start; a frame in which nothing changed visits none.
    #[must_use]
    pub fn visits(&self) -> u64 {
        self.visits
    }

    /// The index of the object for which an entity stands.
    pub(super) fn place_of(&self, object: Entity) -> Option<usize> {
        self.places.get(&object).copied().filter(|i| self.objects.get(*i) == Some(&object))
    }

    /// Changes whenever other entities stand for objects.
    pub(super) fn list(&self) -> u64 {
        self.lists
    }
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

/// The name of an entity for tools: that of its part, else its type. A number would change with every part before it.
fn label(name: Option<&String>, type_name: &str) -> Name {
    Name::new(name.cloned().unwrap_or_else(|| type_name.to_owned()))
}

/// Matches the entities of `old` parts with `new` parts: equal parts at the beginning and at the end keep their
/// entities, those between get the entities that are left. Makes `old` equal to `new`. Returns which of the new parts
/// differ from what their entities stand for, and the entities that stand for nothing any more.
fn align<T: Clone + PartialEq>(
    entities: &mut Vec<Entity>,
    old: &mut Vec<T>,
    new: &[T],
    visits: &mut u64,
) -> (Range<usize>, Vec<Entity>) {
    // Others changed the list: nothing is known.
    let known = entities.len() == old.len();
    let [gone, come] = difference([entities.len(), new.len()], |i, j| {
        *visits += 1;
        known && old[i] == new[j]
    });
    let unchanged = entities.len() - gone.end;
    old.splice(gone.start..old.len() - unchanged, new[come.clone()].iter().cloned());
    if gone.end > come.end {
        let surplus = entities.drain(come.end..gone.end).collect();
        return (come, surplus);
    }
    entities.splice(gone.end..gone.end, iter::repeat_n(Entity::PLACEHOLDER, come.end - gone.end));
    (come, Vec::new())
}

/// Makes the entities equal to the scene. Runs when [`CurrentScene`] changed; touches only what
/// differs, and compares nothing where that is known.
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
    let due = std::mem::take(&mut entities.due);
    // The lists are public: others may have changed them.
    let known = entities.seen == Some(scene.last_changed())
        && (entities.lights.len(), entities.objects.len()) == (wanted_lights.len(), wanted_objects.len());
    entities.seen = Some(scene.last_changed());
    let mut mirrored = entities.mirrored.take();
    let observer_changed = mirrored.as_ref().is_none_or(|s| s.observer != *observer);
    let mut changed_lights = Vec::new();
    let mut changed_objects = Vec::new();
    // Objects from here on have other indices than before.
    let mut moved = None;
    if let Some(mirrored) = mirrored.as_mut().filter(|_| known) {
        for part in due {
            part.copy(&scene.0, mirrored);
            match part {
                Extent::Light(i) => changed_lights.push(i),
                Extent::Object(i) => changed_objects.push(i),
                Extent::Rest | Extent::All => {}
            }
        }
    } else {
        let old =
            mirrored.get_or_insert_with(|| Scene { lights: vec![], objects: vec![], ..Scene::default() });
        let mut visits = 0;
        let (lights, no_lights) = align(&mut entities.lights, &mut old.lights, wanted_lights, &mut visits);
        let (objects, no_objects) =
            align(&mut entities.objects, &mut old.objects, wanted_objects, &mut visits);
        entities.visits += visits;
        Extent::Rest.copy(&scene.0, old);
        changed_lights.extend(lights);
        if !no_objects.is_empty() {
            moved = Some(objects.end);
        }
        changed_objects.extend(objects);
        for surplus in no_lights.into_iter().chain(no_objects) {
            entities.places.remove(&surplus);
            commands.entity(surplus).try_despawn();
        }
    }
    entities.mirrored = mirrored;

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
        if old_type != Some(light.light_type.as_str())
            && let Some(old) = old_type.and_then(|k| registry.light(k))
        {
            (old.unmark)(&mut entity);
        }
        match registry.light(&light.light_type) {
            Some(entry) => (entry.mark)(&mut entity, &light.parameters),
            None => warn!("light {i} has the unknown type `{}` and gives no light", light.light_type),
        }
    }

    let lost = std::mem::take(&mut entities.lost);
    if !lost.is_empty() {
        let lost = |(i, entity): (usize, &Entity)| lost.contains(entity).then_some(i);
        changed_objects.extend(entities.objects.iter().enumerate().filter_map(lost));
    }
    changed_objects.sort_unstable();
    changed_objects.dedup();
    for i in changed_objects {
        let (Some(object), Some(slot)) = (wanted_objects.get(i), entities.objects.get_mut(i)) else {
            continue;
        };
        entities.visits += 1;
        let known = objects.contains(*slot);
        let mut entity = if known { commands.entity(*slot) } else { commands.spawn_empty() };
        if !known {
            entities.places.remove(slot);
            *slot = entity.id();
            moved = Some(moved.map_or(i, |first: usize| first.min(i)));
        }
        entity.insert((
            LitObject(object.clone()),
            object_transform(object),
            if object.visible { Visibility::Inherited } else { Visibility::Hidden },
            label(object.name.as_ref(), &object.object_type),
        ));
    }
    if let Some(first) = moved {
        entities.lists += 1;
        entities.places.extend(entities.objects.iter().enumerate().skip(first).map(|(i, e)| (*e, i)));
    }

    match entities.observer.filter(|e| eyes.contains(*e)) {
        Some(e) => {
            if observer_changed {
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

type Touched<C> = Or<(Changed<C>, Changed<Transform>)>;

/// Adopts what others changed in the entities: components and transforms become the scene's
/// values, and each other's. Where both were changed, the component counts. What [`reconcile`] wrote
/// itself compares equal and changes nothing.
pub fn absorb(
    mut commands: Commands,
    mut scene: ResMut<CurrentScene>,
    mut entities: ResMut<SceneEntities>,
    registry: Res<Registry>,
    mut lights: Query<
        (&mut LightSource, &mut Transform),
        (Touched<LightSource>, Without<LitObject>, Without<Eye>),
    >,
    mut objects: Query<
        (Entity, &mut LitObject, &mut Transform),
        (Touched<LitObject>, Without<LightSource>, Without<Eye>),
    >,
    mut eyes: Query<(&mut Eye, &mut Transform), (Touched<Eye>, Without<LightSource>, Without<LitObject>)>,
) {
    let entities = &mut *entities;
    let before = Some(scene.last_changed());
    // Without a window, nothing reads it.
    entities.absorbed.clear();
    for (i, entity) in entities.lights.iter().enumerate() {
        let (Ok((mut source, mut transform)), Some(known)) = (lights.get_mut(*entity), scene.0.lights.get(i))
        else {
            continue;
        };
        if source.0 != *known {
            *transform = light_transform(&source.0);
            let mut entity = commands.entity(*entity);
            if source.0.light_type != known.light_type
                && let Some(old) = registry.light(&known.light_type)
            {
                (old.unmark)(&mut entity);
            }
            if let Some(new) = registry.light(&source.0.light_type) {
                (new.mark)(&mut entity, &source.0.parameters);
            }
        } else if source.0.position.is_some_and(|p| p != transform.translation) {
            source.0.position = Some(transform.translation);
        }
        if source.0 != *known {
            let light = &source.0;
            commands.entity(*entity).insert(label(light.name.as_ref(), &light.light_type));
            scene.0.lights[i] = light.clone();
            entities.absorbed.push(Extent::Light(i));
        }
    }
    for (entity, mut lit, mut transform) in &mut objects {
        entities.visits += 1;
        let Some((i, known)) = entities.place_of(entity).and_then(|i| Some((i, scene.0.objects.get(i)?)))
        else {
            continue;
        };
        if lit.0 != *known {
            *transform = object_transform(&lit.0);
        } else if *transform != object_transform(&lit.0) {
            lit.0.position = transform.translation;
            lit.0.rotation = euler_degrees(transform.rotation);
            lit.0.size = transform.scale.max_element();
        }
        if lit.0 != *known {
            let object = &lit.0;
            commands.entity(entity).insert(label(object.name.as_ref(), &object.object_type));
            scene.0.objects[i] = object.clone();
            entities.absorbed.push(Extent::Object(i));
        }
    }
    if let Some((mut eye, mut transform)) = entities.observer.and_then(|e| eyes.get_mut(e).ok()) {
        let known = scene.0.observer;
        if eye.0 != known {
            *transform = observer_transform(&eye.0);
        } else if *transform != observer_transform(&known) {
            eye.0.position = transform.translation;
            eye.0.direction = transform.rotation * Vec3::NEG_Z;
        }
        if eye.0 != known {
            scene.0.observer = eye.0;
            entities.absorbed.push(Extent::Rest);
        }
    }
    if entities.absorbed.is_empty() {
        return;
    }
    if let Some(mirrored) = &mut entities.mirrored {
        entities.absorbed.iter().for_each(|part| part.copy(&scene.0, mirrored));
    }
    for known in [&mut entities.seen, &mut entities.agreed] {
        if *known == before {
            *known = Some(scene.last_changed());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The parts as numbers: which differ, which entities go, and the place in `old` that each new one had.
    fn aligned(old: &[u32], new: &[u32]) -> (Range<usize>, Vec<u32>, Vec<Option<u32>>) {
        let entity = |i: usize| Entity::from_raw_u32(i as u32).expect("a number of an entity");
        let mut entities: Vec<_> = (0..old.len()).map(entity).collect();
        let mut mirrored = old.to_vec();
        let (changed, surplus) = align(&mut entities, &mut mirrored, new, &mut 0);
        assert_eq!(mirrored, new);
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
