//! The scene as entities: every light, every object and the observer is an entity with the [components](super::parts) of
//! its part.
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

/// The scene as it is stored: without what is [animated](super::parts::Animated).
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
    /// The scene that the entities stood for when the two were last made equal. What differs from it
    /// in the scene was edited there, what differs in the entities was edited there.
    pub(super) mirrored: Option<Scene>,
    /// The tick of the last change of the scene of which all is known: it is in `mirrored`, or in `due`.
    pub(super) seen: Option<Tick>,
    /// Parts of the scene that the entities are to follow.
    pub(super) due: Vec<Extent>,
    /// The ids of the parts that the entities stand for, if a document is shown.
    pub(super) ids: Option<Ids>,
    /// The ids of the parts of the scene, where entities have others, or none yet.
    pub(super) new_ids: Option<Ids>,
    /// Changes of entities in this frame, of which the document has yet to learn.
    pub(super) absorbed: Absorbed,
    /// The document's value that the scene is equal to, but for what was absorbed, and the tick of the last change of
    /// the scene for which that is so.
    pub(super) shown: Option<Revision>,
    pub(super) agreed: Option<Tick>,
    /// The index of each object.
    places: EntityHashMap<usize>,
    /// Counts how often the list of objects was another one.
    lists: u64,
    pub(super) visits: u64,
}

/// Changes of entities that went into the scene.
#[derive(Debug, Default)]
pub(super) struct Absorbed {
    /// Parts with other values.
    pub(super) parts: Vec<Extent>,
    /// Lights and objects that went, by their places before.
    pub(super) removed: Vec<Extent>,
    /// True if parts went, came or have other types. Those that came are at the end of the lists.
    pub(super) relisted: bool,
    /// Changes that were refused, each said once.
    pub(super) refused: Vec<String>,
}

impl SceneEntities {
    /// The number of objects visited since the start; a frame in which nothing changed visits none.
    #[must_use]
    pub fn visits(&self) -> u64 {
        self.visits
    }

    /// Changes of entities that were refused in this frame, as messages. Each is reported once, until a change of the
    /// same part was accepted.
    #[must_use]
    pub fn refused(&self) -> &[String] {
        &self.absorbed.refused
    }

    /// The index of the object for which an entity stands.
    pub(super) fn place_of(&self, object: Entity) -> Option<usize> {
        self.places.get(&object).copied().filter(|i| self.objects.get(*i) == Some(&object))
    }

    /// The part for which an entity stands; the observer is [`Extent::Rest`].
    pub(super) fn part_of(&self, entity: Entity) -> Option<Extent> {
        let light = || self.lights.iter().position(|light| *light == entity).map(Extent::Light);
        let observer = || (self.observer == Some(entity)).then_some(Extent::Rest);
        self.place_of(entity).map(Extent::Object).or_else(observer).or_else(light)
    }

    /// True if every part of a scene has its entity.
    pub(super) fn stands_for(&self, scene: &Scene) -> bool {
        let counts = |scene: &Scene| (scene.lights.len(), scene.objects.len());
        self.mirrored.as_ref().is_some_and(|mirrored| counts(mirrored) == counts(scene))
            && counts(scene) == (self.lights.len(), self.objects.len())
    }

    /// Changes whenever other entities stand for objects.
    pub(super) fn list(&self) -> u64 {
        self.lists
    }

    /// Objects from this place on have other entities than before.
    pub(super) fn place(&mut self, first: usize) {
        self.lists += 1;
        self.places.extend(self.objects.iter().enumerate().skip(first).map(|(i, e)| (*e, i)));
    }

    /// An entity stands for no object any more.
    pub(super) fn forget(&mut self, object: Entity) {
        self.places.remove(&object);
    }
}

/// The way from an old list of parts to a new one: equal parts at the beginning and at the end keep their entities.
#[derive(Debug, PartialEq, Eq)]
struct Alignment {
    /// The old places of the others.
    gone: Range<usize>,
    /// The new places of the others.
    come: Range<usize>,
    /// For each of these the old place whose entity it gets, if any.
    from: Vec<Option<usize>>,
    /// The old places whose entities go.
    surplus: Vec<usize>,
}

/// Matches the entities of `old` parts with `new` parts: by their ids where these are known, else those between equal
/// parts get the entities that are left.
fn align<T: PartialEq>(
    entities: usize,
    old: &[T],
    new: &[T],
    ids: Option<[&[PartId]; 2]>,
    visits: &mut u64,
) -> Alignment {
    // Others changed the list: nothing is known.
    let known = entities == old.len();
    let [gone, come] = difference([entities, new.len()], |i, j| {
        *visits += 1;
        known && ids.is_none_or(|[old, new]| old.get(i) == new.get(j)) && old[i] == new[j]
    });
    let mut left: Vec<Option<usize>> = gone.clone().map(Some).collect();
    let from = match ids.filter(|_| known) {
        Some([old_ids, new_ids]) => {
            let places: HashMap<_, _> = gone.clone().filter_map(|i| Some((*old_ids.get(i)?, i))).collect();
            let place = |j: usize| places.get(new_ids.get(j)?).and_then(|i| left[i - gone.start].take());
            come.clone().map(place).collect()
        }
        None => (0..come.len()).map(|k| left.get_mut(k).and_then(Option::take)).collect(),
    };
    Alignment { gone, come, from, surplus: left.into_iter().flatten().collect() }
}

/// Gives the parts of a new list their entities, and makes `old` equal to `new`. Returns the entities that go.
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
                // If it is gone, `absorb` decides what follows.
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

/// Makes the entities equal to the scene. Runs when [`CurrentScene`] changed; touches only what
/// differs, and compares nothing where that is known.
pub fn reconcile(world: &mut World) {
    // Not by `resource_scope`, after which Bevy takes a resource for changed.
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
            // Those that go are known no more when their components tell of it.
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

    /// Gives entities the ids of the parts that they stand for.
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

    /// The parts as numbers: which differ, which entities go, and the place in `old` that each new one had.
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
        // Equal values alone would make the last one go.
        assert_eq!(from([0, 1, 2], &[1, 2]), (vec![Some(1), Some(2)], vec![0]));
        assert_eq!(from([0, 1, 2], &[0, 2]), (vec![Some(0), Some(2)], vec![1]));
        assert_eq!(from([0, 1, 2], &[2, 0]), (vec![Some(2), Some(0)], vec![1]));
        assert_eq!(from([0, 1, 2], &[0, 1, 2]), (vec![Some(0), Some(1), Some(2)], vec![]));
    }
}
