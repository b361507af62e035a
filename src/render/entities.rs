//! The scene as entities: every light, every object and the observer is an entity with the
//! [components](super::parts) of its part.
//!
//! [`CurrentScene`] and the entities mirror each other. Replacing or editing the scene changes only
//! the entities that differ (so a reload leaves the rest alone); changing a component of an entity
//! changes the scene. Either way the picture follows in the next frame.

use std::{collections::HashMap, ops::Range};

use bevy::ecs::{change_detection::Tick, entity::EntityHashMap, prelude::*};

pub use super::mirror::object_transform;
use super::{mirror::Part, typed::PartTypes};
use crate::{
    document::{Extent, PartId, Revision, difference},
    scene::Scene,
};

/// The scene as stored: without [animated](super::parts::Animated) changes.
#[derive(Clone, Debug, Default, PartialEq, Resource)]
pub struct CurrentScene(pub Scene);

/// The ids of lights and objects, in the scene's order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Ids {
    pub(super) lights: Vec<PartId>,
    pub(super) objects: Vec<PartId>,
}

/// The entities of the parts of the scene, in the scene's order.
#[derive(Debug, Default, Resource)]
pub struct SceneEntities {
    /// The lights.
    pub lights: Vec<Entity>,
    /// The objects.
    pub objects: Vec<Entity>,
    /// The observer.
    pub observer: Option<Entity>,
    /// The scene that the entities represented when both were last synchronised. Differences of the scene
    /// from it are edits of the scene, differences of the entities are edits of the entities.
    pub(super) mirrored: Option<Scene>,
    /// The tick of the last known change of the scene: it is in `mirrored`, or in `due`.
    pub(super) seen: Option<Tick>,
    /// Parts of the scene that the entities have yet to follow.
    pub(super) due: Vec<Extent>,
    /// The ids of the parts represented by the entities, if a document is shown.
    pub(super) ids: Option<Ids>,
    /// The ids of the parts of the scene, where those of the entities differ or are missing.
    pub(super) new_ids: Option<Ids>,
    /// Changes of entities in this frame that the document has not received yet.
    pub(super) absorbed: Absorbed,
    /// The document's revision that equals the scene, except for absorbed changes, and the tick of the last
    /// change of the scene for which this is true.
    pub(super) shown: Option<Revision>,
    pub(super) agreed: Option<Tick>,
    /// The index of each object.
    places: EntityHashMap<usize>,
    /// Number of changes of the list of objects.
    lists: u64,
    pub(super) visits: u64,
}

/// Changes of entities that were transferred to the scene.
#[derive(Debug, Default)]
pub(super) struct Absorbed {
    /// Parts with other values.
    pub(super) parts: Vec<Extent>,
    /// Lights and objects that were removed, by their former positions.
    pub(super) removed: Vec<Extent>,
    /// True if parts were removed or added, or changed their types. Added ones are at the end of the lists.
    pub(super) relisted: bool,
    /// Refused changes, each reported once.
    pub(super) refused: Vec<String>,
}

impl SceneEntities {
    /// The number of objects visited since the start; none in a frame without changes.
    #[must_use]
    pub fn visits(&self) -> u64 {
        self.visits
    }

    /// Messages about changes of entities that were refused in this frame. Each is reported once, until a
    /// change of the same part is accepted.
    #[must_use]
    pub fn refused(&self) -> &[String] {
        &self.absorbed.refused
    }

    /// The index of the object represented by an entity.
    pub(super) fn place_of(&self, object: Entity) -> Option<usize> {
        self.places.get(&object).copied().filter(|i| self.objects.get(*i) == Some(&object))
    }

    /// The part represented by an entity; the observer is [`Extent::Rest`].
    pub(super) fn part_of(&self, entity: Entity) -> Option<Extent> {
        let light = || self.lights.iter().position(|light| *light == entity).map(Extent::Light);
        let observer = || (self.observer == Some(entity)).then_some(Extent::Rest);
        self.place_of(entity).map(Extent::Object).or_else(observer).or_else(light)
    }

    /// True if every part of a scene has an entity.
    pub(super) fn stands_for(&self, scene: &Scene) -> bool {
        let counts = |scene: &Scene| (scene.lights.len(), scene.objects.len());
        self.mirrored.as_ref().is_some_and(|mirrored| counts(mirrored) == counts(scene))
            && counts(scene) == (self.lights.len(), self.objects.len())
    }

    /// A number that changes whenever other entities represent the objects.
    pub(super) fn list(&self) -> u64 {
        self.lists
    }

    /// Records that the objects from this index on have other entities.
    pub(super) fn place(&mut self, first: usize) {
        self.lists += 1;
        self.places.extend(self.objects.iter().enumerate().skip(first).map(|(i, e)| (*e, i)));
    }

    /// Records that an entity no longer represents an object.
    pub(super) fn forget(&mut self, object: Entity) {
        self.places.remove(&object);
    }
}

/// The mapping from an old list of parts to a new one: equal parts at the beginning and at the end keep their
/// entities.
#[derive(Debug, PartialEq, Eq)]
struct Alignment {
    /// Old positions of the others.
    gone: Range<usize>,
    /// New positions of the others.
    come: Range<usize>,
    /// For each of these, the old position of the entity that it gets, if any.
    from: Vec<Option<usize>>,
    /// Old positions of the entities to remove.
    surplus: Vec<usize>,
}

/// Matches the entities of `old` parts with `new` parts: by id where known; otherwise, parts between equal
/// ones get the remaining entities.
fn align<T: PartialEq>(
    entities: usize,
    old: &[T],
    new: &[T],
    ids: Option<[&[PartId]; 2]>,
    visits: &mut u64,
) -> Alignment {
    // Somebody else changed the list: nothing is known.
    let known = entities == old.len();
    let [gone, come] = difference([entities, new.len()], |i, j| {
        *visits += 1;
        known && ids.is_none_or(|[old, new]| old.get(i) == new.get(j)) && old[i] == new[j]
    });
    let mut surplus: Vec<Option<usize>> = gone.clone().map(Some).collect();
    let from = match ids.filter(|_| known) {
        Some([old_ids, new_ids]) => {
            let places: HashMap<_, _> = gone.clone().filter_map(|i| Some((*old_ids.get(i)?, i))).collect();
            let place = |j: usize| places.get(new_ids.get(j)?).and_then(|i| surplus[i - gone.start].take());
            come.clone().map(place).collect()
        }
        None => (0..come.len()).map(|k| surplus.get_mut(k).and_then(Option::take)).collect(),
    };
    Alignment { gone, come, from, surplus: surplus.into_iter().flatten().collect() }
}

/// Assigns entities to the parts of a new list, and makes `old` equal to `new`. Returns the entities to
/// remove.
fn follow<T: Part>(
    world: &mut World,
    types: &PartTypes,
    entities: &mut Vec<Entity>,
    old: &mut Vec<T>,
    new: &[T],
    way: &Alignment,
) -> Vec<Entity> {
    let mut changed = Vec::with_capacity(way.come.len());
    for (part, from) in new[way.come.clone()].iter().zip(&way.from) {
        let known = from.map(|i| (entities[i], old.get(i)));
        changed.push(match known {
            Some((entity, before)) => {
                // If it is gone, `absorb` decides what happens.
                if let Ok(mut entity) = world.get_entity_mut(entity) {
                    part.write(&mut entity, before, types);
                }
                entity
            }
            None => part.spawn(world, types),
        });
    }
    let surplus = way.surplus.iter().map(|i| entities[*i]).collect();
    let unchanged = entities.len() - way.gone.end;
    old.splice(way.gone.start..old.len() - unchanged, new[way.come.clone()].iter().cloned());
    entities.splice(way.gone.clone(), changed);
    surplus
}

/// Makes the entities equal to the scene. Runs if [`CurrentScene`] changed; writes only differences, and
/// compares nothing where these are known.
pub fn reconcile(world: &mut World) {
    // Not with `resource_scope`, after which Bevy marks the resource as changed.
    let types = world.get_resource::<PartTypes>().cloned().unwrap_or_default();
    let mut entities = std::mem::take(world.resource_mut::<SceneEntities>().bypass_change_detection());
    let mut current = world.resource_mut::<CurrentScene>();
    let changed = current.last_changed();
    let scene = std::mem::take(&mut current.bypass_change_detection().0);
    entities.reconcile(world, &scene, changed, &types);
    world.resource_mut::<CurrentScene>().bypass_change_detection().0 = scene;
    *world.resource_mut::<SceneEntities>().bypass_change_detection() = entities;
}

impl SceneEntities {
    fn reconcile(&mut self, world: &mut World, scene: &Scene, changed: Tick, types: &PartTypes) {
        let due = std::mem::take(&mut self.due);
        // The lists are public: others may have changed them.
        let known = self.seen == Some(changed)
            && (self.lights.len(), self.objects.len()) == (scene.lights.len(), scene.objects.len());
        self.seen = Some(changed);
        let is_first = self.mirrored.is_none();
        let nothing = || Scene { lights: vec![], objects: vec![], ..Scene::default() };
        let mut old = self.mirrored.take().unwrap_or_else(nothing);
        let eye = old.observer;
        if known && !is_first {
            for part in due {
                self.write(part, world, scene, &old, types);
                part.copy(scene, &mut old);
            }
        } else {
            let ids = self.ids.as_ref().zip(self.new_ids.as_ref());
            let lights = ids.map(|(old, new)| [&*old.lights, &*new.lights]);
            let objects = ids.map(|(old, new)| [&*old.objects, &*new.objects]);
            let foreign = self.objects.len() != old.objects.len();
            let mut visits = 0;
            let light_way = align(self.lights.len(), &old.lights, &scene.lights, lights, &mut visits);
            let way = align(self.objects.len(), &old.objects, &scene.objects, objects, &mut visits);
            self.visits += visits + way.come.len() as u64;
            let surplus = follow(world, types, &mut self.lights, &mut old.lights, &scene.lights, &light_way);
            let no_objects = follow(world, types, &mut self.objects, &mut old.objects, &scene.objects, &way);
            // Removed entities are forgotten before their components report it.
            no_objects.iter().for_each(|entity| self.forget(*entity));
            let elsewhere = |(k, from): (usize, &Option<usize>)| *from != Some(way.gone.start + k);
            if foreign || !way.surplus.is_empty() || way.from.iter().enumerate().any(elsewhere) {
                self.place(way.come.start);
            }
            self.ids = None;
            Extent::Rest.copy(scene, &mut old);
            for entity in surplus.into_iter().chain(no_objects) {
                let _ = world.try_despawn(entity);
            }
        }
        self.mirrored = Some(old);
        if let Some(ids) = self.new_ids.take() {
            self.identify(world, ids);
        }
        match self.observer {
            Some(entity) if scene.observer != eye => {
                if let Ok(mut entity) = world.get_entity_mut(entity) {
                    scene.observer.write(&mut entity, Some(&eye), types);
                }
            }
            Some(_) => {}
            None => self.observer = Some(scene.observer.spawn(world, types)),
        }
    }

    /// Writes a light or an object into its entity.
    fn write(&mut self, part: Extent, world: &mut World, scene: &Scene, old: &Scene, types: &PartTypes) {
        fn write<T: Part>(
            world: &mut World,
            types: &PartTypes,
            at: Option<&Entity>,
            new: Option<&T>,
            old: Option<&T>,
        ) {
            if let (Some(entity), Some(new)) = (at, new)
                && let Ok(mut entity) = world.get_entity_mut(*entity)
            {
                new.write(&mut entity, old, types);
            }
        }
        match part {
            Extent::Light(i) => {
                write(world, types, self.lights.get(i), scene.lights.get(i), old.lights.get(i));
            }
            Extent::Object(i) => {
                self.visits += 1;
                write(world, types, self.objects.get(i), scene.objects.get(i), old.objects.get(i));
            }
            Extent::Rest | Extent::All => {}
        }
    }

    /// Gives entities the ids of the parts that they represent.
    fn identify(&mut self, world: &mut World, ids: Ids) {
        for (entities, ids) in [(&self.lights, &ids.lights), (&self.objects, &ids.objects)] {
            for (entity, id) in entities.iter().zip(ids) {
                if let Ok(mut entity) = world.get_entity_mut(*entity)
                    && entity.get() != Some(id)
                {
                    entity.insert(*id);
                }
            }
        }
        self.ids = Some(ids);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The parts as numbers: which differ, which entities are removed, and the former position of each new
    /// part in `old`.
    fn aligned(old: &[u32], new: &[u32]) -> (Range<usize>, Vec<usize>, Vec<Option<usize>>) {
        let way = align(old.len(), old, new, None, &mut 0);
        let before = (0..way.gone.start).map(Some);
        let after = (way.gone.end..old.len()).map(Some);
        (way.come.clone(), way.surplus.clone(), before.chain(way.from).chain(after).collect())
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

    #[test]
    fn parts_keep_their_entities_by_their_ids() {
        let document = crate::document::Document::new(Scene {
            objects: vec![crate::scene::Object::default(); 3],
            ..Scene::default()
        });
        let id = |i: usize| document.object_id(i).expect("three");
        let from = |old: [usize; 3], new: &[usize]| {
            let [old, new]: [Vec<_>; 2] = [&old[..], new].map(|ids| ids.iter().map(|i| id(*i)).collect());
            let way = align(3, &[7; 3], &vec![7; new.len()], Some([&old, &new]), &mut 0);
            let kept = (0..way.gone.start).map(Some).chain(way.from).chain((way.gone.end..3).map(Some));
            (kept.collect::<Vec<_>>(), way.surplus)
        };
        // Equal values alone would remove the last one.
        assert_eq!(from([0, 1, 2], &[1, 2]), (vec![Some(1), Some(2)], vec![0]));
        assert_eq!(from([0, 1, 2], &[0, 2]), (vec![Some(0), Some(2)], vec![1]));
        assert_eq!(from([0, 1, 2], &[2, 0]), (vec![Some(2), Some(0)], vec![1]));
        assert_eq!(from([0, 1, 2], &[0, 1, 2]), (vec![Some(0), Some(1), Some(2)], vec![]));
    }
}
