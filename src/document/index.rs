//! Lookup of parts by id, and of the numbers that a file gives them, without a search.

use std::{
    collections::HashMap,
    sync::atomic::{AtomicU64, Ordering},
};

use super::{
    PartId,
    history::{Label, Labels},
};
use crate::scene::Scene;

/// Lights and objects by id, and their numbers.
#[derive(Clone, Debug)]
pub(super) struct Index {
    pub(super) lights: List,
    pub(super) objects: List,
}

/// One of the two lists.
#[derive(Clone, Debug)]
pub(super) struct List {
    places: HashMap<PartId, usize>,
    numbers: Vec<usize>,
}

impl Index {
    pub(super) fn of(scene: &Scene, labels: &Labels) -> Self {
        Self {
            lights: List::of(&labels.lights, scene.lights.iter().map(|l| &*l.light_type)),
            objects: List::of(&labels.objects, scene.objects.iter().map(|o| &*o.object_type)),
        }
    }
}

impl List {
    fn of<'a>(labels: &[Label], types: impl Iterator<Item = &'a str>) -> Self {
        let places = labels.iter().enumerate().map(|(i, label)| (label.id, i)).collect();
        Self { places, numbers: numbers(types).collect() }
    }

    /// The position of a part in the list.
    pub(super) fn place(&self, id: PartId) -> Option<usize> {
        self.places.get(&id).copied()
    }

    /// The number of a part among those of its type in the order of the list, from 1 on.
    pub(super) fn number(&self, place: usize) -> usize {
        self.numbers.get(place).copied().unwrap_or_default()
    }
}

/// The number of each part among those of its type, from 1 on.
fn numbers<'a>(types: impl Iterator<Item = &'a str>) -> impl Iterator<Item = usize> {
    let mut counts: HashMap<&str, usize> = HashMap::new();
    types.map(move |part| {
        let count = counts.entry(part).or_default();
        *count += 1;
        *count
    })
}

/// Counts the parts that are visited.
#[derive(Debug, Default)]
pub(super) struct Visits(AtomicU64);

impl Visits {
    pub(super) fn add(&self, parts: usize) {
        self.0.fetch_add(parts as u64, Ordering::Relaxed);
    }

    pub(super) fn count(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

impl Clone for Visits {
    fn clone(&self) -> Self {
        Self(self.count().into())
    }
}
