//! The scene as entities: every light, every object and the observer is an entity with the
//! [components](super::parts) of its part.
//!
//! [`CurrentScene`] and the entities mirror each other. Replacing or editing the scene changes only
//! the entities that differ (so a reload leaves the rest alone); changing a component of an entity
//! changes the scene. Either way the picture follows in the next frame.

use bevy::ecs::{change_detection::Tick, entity::EntityHashMap, prelude::*};

pub use super::mirror::object_transform;
use crate::{
    document::{Extent, PartId, Revision},
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
    pub(super) lists: u64,
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

    /// The number of changes of the list of objects since the start: after each, other entities represent them.
    #[must_use]
    pub fn lists(&self) -> u64 {
        self.lists
    }

    /// Messages about changes of entities that were refused in this frame. Each is reported once, until a
    /// change of the same part is accepted.
    #[must_use]
    pub fn refused(&self) -> &[String] {
        &self.absorbed.refused
    }

    /// The index of the object represented by an entity.
    #[must_use]
    pub fn place_of(&self, object: Entity) -> Option<usize> {
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
