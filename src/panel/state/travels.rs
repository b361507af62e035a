//! The ways of objects and views through models, on which their materials go along.

use std::{borrow::Cow, collections::BTreeMap};

use crate::{
    document::PartId,
    parameter::{Value, Values},
};

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

/// Values of a material that change, and those that go.
pub(super) type Changes = BTreeMap<Cow<'static, str>, Option<Value>>;

/// Changes a material.
pub(super) fn change(Values(material): &mut Values, changes: &Changes) {
    for (name, value) in changes {
        match value {
            Some(value) => drop(material.insert(name.clone(), value.clone())),
            None => drop(material.remove(name)),
        }
    }
}

/// A value that was carried to a parameter.
#[derive(Clone, Debug, PartialEq)]
struct Deposit {
    /// The model for which it was.
    model: String,
    value: Value,
    /// The value that it replaced.
    before: Option<Value>,
}

impl Deposit {
    fn is(&self, model: &str, value: &Value) -> bool {
        self.model == model && self.value == *value
    }
}

/// The way of each object through models, and what was carried on it. It is not part of the scene, and undo leaves it:
/// a carried value counts as such only while the material has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Travels {
    /// The models that each was taken from, the latest first.
    ways: BTreeMap<Traveller, Vec<String>>,
    /// The values carried to a parameter, the latest last.
    carried: BTreeMap<Place, Vec<Deposit>>,
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

    /// Notes that a value was carried to a parameter for a model, and what it replaced.
    pub(super) fn carry(&mut self, place: Place, model: &str, value: &Value, before: Option<&Value>) {
        let known = self.carried.entry(place).or_default();
        known.retain(|one| !one.is(model, value));
        if known.len() == Self::MOST_VALUES {
            known.remove(0);
        }
        let (model, value, before) = (model.to_owned(), value.clone(), before.cloned());
        known.push(Deposit { model, value, before });
    }

    /// What changes in a material when a model is left: what was carried for it, and not set by the user since, goes, and
    /// what that had replaced is back.
    pub(super) fn taken_back(&self, who: Traveller, model: &str, material: &Values) -> Changes {
        let back = |(name, value): (&Cow<'static, str>, &Value)| {
            let all = self.carried.get(&(who, name.clone()))?;
            let one = all.iter().find(|one| one.is(model, value))?;
            Some((name.clone(), one.before.clone()))
        };
        material.0.iter().filter_map(back).collect()
    }

    /// True if something was carried to a parameter for a model, and the parameter has something else now.
    pub(super) fn was_changed(&self, place: &Place, model: &str, now: Option<&Value>) -> bool {
        let all = self.carried.get(place).into_iter().flatten();
        let of_model: Vec<_> = all.filter(|one| one.model == model).collect();
        !of_model.is_empty() && of_model.iter().all(|one| Some(&one.value) != now)
    }
}
