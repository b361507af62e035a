//! The models that keys 1–9 choose.

use std::ops::Deref;

use crate::registry::Registry;

/// The most models that keys 1–9 reach.
pub const MODEL_SLOTS: usize = 9;

/// The models that keys 1–9 choose. A model keeps its number while it is among them, so that fingers can learn it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelSlots {
    slots: Vec<String>,
    /// The same in the order of use, latest last; those that were never used come first.
    used: Vec<String>,
}

impl Deref for ModelSlots {
    type Target = [String];

    fn deref(&self) -> &[String] {
        &self.slots
    }
}

impl ModelSlots {
    /// Gives the free keys to the registered models in their order, so that there is a choice from the start.
    pub fn fill(&mut self, registry: &Registry) {
        for model in registry.models() {
            let id = model.declaration.id;
            if self.len() < MODEL_SLOTS && !self.iter().any(|m| m == id) {
                self.slots.push(id.to_owned());
                // Never used, so the first to give way.
                self.used.insert(0, id.to_owned());
            }
        }
    }

    /// Gives a model one of the keys: the one that it has, a free one, or that of the model that was not used for
    /// longest.
    pub(in crate::panel) fn take(&mut self, id: &str) {
        self.used.retain(|m| m != id);
        self.used.push(id.to_owned());
        if self.iter().any(|m| m == id) {
            return;
        }
        if self.len() < MODEL_SLOTS {
            self.slots.push(id.to_owned());
            return;
        }
        let oldest = self.used.remove(0);
        if let Some(slot) = self.slots.iter_mut().find(|m| **m == oldest) {
            id.clone_into(slot);
        }
    }
}
