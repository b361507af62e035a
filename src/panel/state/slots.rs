//! The models on the keys 1–9.

use bevy::prelude::Deref;

use crate::registry::Registry;

/// Maximum number of models on keys.
pub const MODEL_SLOTS: usize = 9;

/// The models on the keys 1–9. A model keeps its number while it has a key, so that users can memorise it.
#[derive(Clone, Debug, Default, PartialEq, Deref)]
pub struct ModelSlots {
    #[deref]
    slots: Vec<String>,
    /// The models in order of use, latest last; never used ones come first.
    used: Vec<String>,
}

impl ModelSlots {
    /// Assigns free keys to the registered models in registration order, so that the keys work from the start.
    pub fn fill(&mut self, registry: &Registry) {
        for model in registry.models() {
            let id = model.declaration.id;
            if self.len() < MODEL_SLOTS && !self.iter().any(|m| m == id) {
                self.slots.push(id.to_owned());
                // Never used, so the first to be replaced.
                self.used.insert(0, id.to_owned());
            }
        }
    }

    /// Assigns a key to a model: its own, a free one, or that of the least recently used model.
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
