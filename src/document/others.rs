//! Lights and objects that are selected besides the selection, to be changed with it. Steps of the history remember them,
//! so undoing a deletion selects again what was selected.

use std::{collections::HashSet, sync::Arc};

use super::{Document, PartId, Selection};

/// Parts by their ids, which survive edits. Copies share them.
pub type Others = Arc<HashSet<PartId>>;

impl Document {
    /// The parts that are selected besides the selection.
    #[must_use]
    pub fn others(&self) -> &Others {
        self.history.others()
    }

    /// Selects these parts besides the selection, which is not one of them.
    pub fn select_others(&mut self, others: HashSet<PartId>) {
        if **self.history.others() != others {
            self.history.set_others(Arc::new(others));
        }
    }

    /// True if a part is selected besides the selection. Costs the same however many there are.
    #[must_use]
    pub fn is_other(&self, part: Selection) -> bool {
        !self.others().is_empty() && self.id_of(part).is_some_and(|id| self.others().contains(&id))
    }

    /// The id of a light or an object.
    #[must_use]
    pub fn id_of(&self, part: Selection) -> Option<PartId> {
        match part {
            Selection::Light(i) => self.light_id(i),
            Selection::Object(i) => self.object_id(i),
            Selection::Room | Selection::Observer => None,
        }
    }

    /// The light or object with an id.
    #[must_use]
    pub fn part_of(&self, id: PartId) -> Option<Selection> {
        self.object(id).map(Selection::Object).or_else(|| self.light(id).map(Selection::Light))
    }

    /// Forgets those that are gone.
    pub(super) fn prune_others(&mut self) {
        if self.others().is_empty() {
            return;
        }
        let labels = self.labels.lights.iter().chain(&self.labels.objects);
        let here = labels.map(|label| label.id).filter(|id| self.others().contains(id)).collect();
        self.select_others(here);
    }
}
