//! Transfers changes of the scene to the entities of its parts.

use std::{
    collections::{HashMap, HashSet},
    ops::Range,
};

use bevy::ecs::{change_detection::Tick, prelude::*};

use super::{
    entities::{CurrentScene, Ids, SceneEntities},
    mirror::Part,
    noticed,
    parts::Touched,
    shown::show_objects,
    typed::PartTypes,
};
use crate::{
    document::{Extent, PartId, difference},
    scene::Scene,
};

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

/// Writes parts into the world.
struct Writer<'w> {
    world: &'w mut World,
    types: PartTypes,
    /// The changes made by others.
    touched: Touched,
    /// The entities of the parts.
    written: Vec<Entity>,
}

impl Writer<'_> {
    /// Keeps the changes by others to entities that are written next.
    fn keep(&mut self, entities: &[Entity]) {
        noticed::keep(self.world, entities, &mut self.touched);
    }

    /// Writes the differences of a part from `old` into its entity, or everything.
    fn write<T: Part>(&mut self, entity: Entity, part: &T, old: Option<&T>) {
        self.keep(&[entity]);
        self.put(entity, part, old);
    }

    /// Writes into an entity that is kept.
    fn put<T: Part>(&mut self, entity: Entity, part: &T, old: Option<&T>) {
        // If it is gone, `absorb` decides what happens.
        if let Ok(mut entity) = self.world.get_entity_mut(entity) {
            part.write(&mut entity, old, &self.types);
        }
        self.written.push(entity);
    }

    /// Spawns an entity for a part.
    fn spawn<T: Part>(&mut self, part: &T) -> Entity {
        let entity = part.spawn(self.world, &self.types);
        self.written.push(entity);
        entity
    }
}

/// Assigns entities to the parts of a new list, and makes `old` equal to `new`. Returns the entities to
/// remove.
fn follow<T: Part>(
    to: &mut Writer,
    entities: &mut Vec<Entity>,
    old: &mut Vec<T>,
    new: &[T],
    way: &Alignment,
) -> Vec<Entity> {
    // Together: each search has a cost of its own.
    let known: Vec<_> = way.from.iter().flatten().map(|i| entities[*i]).collect();
    to.keep(&known);
    let mut changed = Vec::with_capacity(way.come.len());
    for (part, from) in new[way.come.clone()].iter().zip(&way.from) {
        changed.push(match from {
            Some(i) => {
                to.put(entities[*i], part, old.get(*i));
                entities[*i]
            }
            None => to.spawn(part),
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
    let touched = noticed::begin(world);
    // Not with `resource_scope`, after which Bevy marks the resource as changed.
    let types = world.get_resource::<PartTypes>().cloned().unwrap_or_default();
    let mut entities = std::mem::take(world.resource_mut::<SceneEntities>().bypass_change_detection());
    let mut current = world.resource_mut::<CurrentScene>();
    let changed = current.last_changed();
    let scene = std::mem::take(&mut current.bypass_change_detection().0);
    let mut to = Writer { world, types, touched, written: Vec::new() };
    entities.reconcile(&mut to, &scene, changed);
    let Writer { world, touched, written, .. } = to;
    world.resource_mut::<CurrentScene>().bypass_change_detection().0 = scene;
    *world.resource_mut::<SceneEntities>().bypass_change_detection() = entities;
    show_objects(world, &written);
    noticed::wrote(world, touched, written);
}

impl SceneEntities {
    fn reconcile(&mut self, to: &mut Writer, scene: &Scene, changed: Tick) {
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
            // A part with several changes is written once.
            let mut seen = HashSet::new();
            for part in due.into_iter().filter(|part| seen.insert(*part)) {
                self.write(part, to, scene, &old);
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
            let surplus = follow(to, &mut self.lights, &mut old.lights, &scene.lights, &light_way);
            let no_objects = follow(to, &mut self.objects, &mut old.objects, &scene.objects, &way);
            // Removed entities are forgotten before their components report it.
            no_objects.iter().for_each(|entity| self.forget(*entity));
            let elsewhere = |(k, from): (usize, &Option<usize>)| *from != Some(way.gone.start + k);
            if foreign || !way.surplus.is_empty() || way.from.iter().enumerate().any(elsewhere) {
                self.place(way.come.start);
            }
            self.ids = None;
            Extent::Rest.copy(scene, &mut old);
            for entity in surplus.into_iter().chain(no_objects) {
                let _ = to.world.try_despawn(entity);
            }
        }
        self.mirrored = Some(old);
        if let Some(ids) = self.new_ids.take() {
            self.identify(to.world, ids);
        }
        match self.observer {
            Some(entity) if scene.observer != eye => to.write(entity, &scene.observer, Some(&eye)),
            Some(_) => {}
            None => self.observer = Some(to.spawn(&scene.observer)),
        }
    }

    /// Writes a light or an object into its entity.
    fn write(&mut self, part: Extent, to: &mut Writer, scene: &Scene, old: &Scene) {
        match part {
            Extent::Light(i) => {
                if let (Some(entity), Some(light)) = (self.lights.get(i), scene.lights.get(i)) {
                    to.write(*entity, light, old.lights.get(i));
                }
            }
            Extent::Object(i) => {
                self.visits += 1;
                if let (Some(entity), Some(object)) = (self.objects.get(i), scene.objects.get(i)) {
                    to.write(*entity, object, old.objects.get(i));
                }
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
