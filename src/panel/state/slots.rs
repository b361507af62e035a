//! The models that keys 1–9 choose.

use super::Session;
use crate::registry::Registry;

/// The most models that keys 1–9 reach.
pub const MODEL_SLOTS: usize = 9;

impl Session {
    /// Keys 1–9 choose a model from the start: the numbers that are free go to the registered models in
    /// their order.
    pub fn fill_model_slots(&mut self, registry: &Registry) {
        for model in registry.models() {
            let id = model.declaration.id;
            if self.model_slots.len() < MODEL_SLOTS && !self.model_slots.iter().any(|m| m == id) {
                self.model_slots.push(id.to_owned());
                // Never used, so the first to give way.
                self.slot_use.insert(0, id.to_owned());
            }
        }
    }

    /// Gives a model one of the keys 1–9: the one that it has, a free one, or that of the model that
    /// was not used for longest. The others keep theirs, so that fingers can learn them.
    pub(in crate::panel) fn use_slot(&mut self, id: &str) {
        self.slot_use.retain(|m| m != id);
        self.slot_use.push(id.to_owned());
        if self.model_slots.iter().any(|m| m == id) {
            return;
        }
        if self.model_slots.len() < MODEL_SLOTS {
            self.model_slots.push(id.to_owned());
            return;
        }
        let oldest = self.slot_use.remove(0);
        if let Some(slot) = self.model_slots.iter_mut().find(|m| **m == oldest) {
            id.clone_into(slot);
        }
    }
}
