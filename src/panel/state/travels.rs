//! The ways of objects and views through models, on which their materials go along.

use std::{borrow::Cow, collections::BTreeMap};

use crate::{document::PartId, parameter::Value};

/// What has a material, and gets other models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::panel) enum Traveller {
    /// An object.
    Object(PartId),
    /// A variant, by its index, for all objects of its view.
    Variant(usize),
}

/// A parameter in the material of a traveller.
type Place = (Traveller, Cow<'static, str>);

/// The way of each object through models, and what was carried on it. It is not part of the scene, and undo leaves it:
/// a carried value counts as such only while the material has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Travels {
    /// The models that each was taken from, the latest first.
    ways: BTreeMap<Traveller, Vec<String>>,
    /// The values carried to a parameter, with the model for which they were.
    carried: BTreeMap<Place, Vec<(String, Value)>>,
}

impl Travels {
    /// Maximum number of remembered values of one parameter; the oldest are dropped.
    const MOST_VALUES: usize = 32;

    /// Forgets all for another document.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// A duplicate of an object has the same past.
    pub(super) fn copied(&mut self, from: PartId, to: PartId) {
        let [from, to] = [from, to].map(Traveller::Object);
        if let Some(way) = self.ways.get(&from).cloned() {
            self.ways.insert(to, way);
        }
        let theirs = self.carried.iter().filter(|((who, _), _)| *who == from);
        let copies: Vec<_> = theirs.map(|((_, name), all)| ((to, name.clone()), all.clone())).collect();
        self.carried.extend(copies);
    }

    /// Forgets those of views, whose order has changed.
    pub(super) fn forget_views(&mut self) {
        self.ways.retain(|who, _| matches!(who, Traveller::Object(_)));
        self.carried.retain(|(who, _), _| matches!(who, Traveller::Object(_)));
    }

    /// The models from which something may come that leaves one for another: that first, then those before it.
    pub(super) fn way<'a>(
        &'a self,
        who: Traveller,
        from: &'a str,
        to: &'a str,
    ) -> impl Iterator<Item = &'a str> {
        let before = self.ways.get(&who).into_iter().flatten().map(String::as_str);
        [from].into_iter().chain(before.filter(move |known| *known != from)).filter(move |known| *known != to)
    }

    /// Notes that one leaves a model.
    pub(super) fn leave(&mut self, who: Traveller, model: &str) {
        let way = self.ways.entry(who).or_default();
        way.retain(|known| known != model);
        way.insert(0, model.to_owned());
    }

    /// Notes that a value was carried to a parameter for a model.
    pub(super) fn carry(&mut self, place: Place, model: &str, value: &Value) {
        let known = self.carried.entry(place).or_default();
        if !known.iter().any(|(id, old)| id == model && old == value) {
            if known.len() == Self::MOST_VALUES {
                known.remove(0);
            }
            known.push((model.to_owned(), value.clone()));
        }
    }

    /// True if a value was carried for a model, and not set by the user since.
    pub(super) fn was_carried(&self, place: &Place, model: &str, value: &Value) -> bool {
        self.carried.get(place).is_some_and(|all| all.iter().any(|(id, old)| id == model && old == value))
    }
}
