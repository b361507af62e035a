//! The selected part.

use std::collections::HashSet;

use super::{Session, Severity};
use crate::{
    document::{Edit, PartId, Selection},
    registry::Registry,
    scene::{Light, Object, Part},
};

impl Session {
    pub(super) fn select_first(&mut self) {
        self.selection =
            if self.document.objects.is_empty() { Selection::Room } else { Selection::Object(0) };
    }

    /// The id of the selected light or object.
    pub(in crate::panel) fn selected_id(&self) -> Option<PartId> {
        self.document.id_of(self.selection)
    }

    pub(super) fn exists(&self, part: Selection) -> bool {
        match part {
            Selection::Room | Selection::Observer => true,
            Selection::Light(i) => i < self.document.lights.len(),
            Selection::Object(i) => i < self.document.objects.len(),
        }
    }

    pub(super) fn select(&mut self, selection: Selection) {
        if self.exists(selection) {
            if self.renaming != Some(selection) {
                self.renaming = None;
            }
            self.selection = selection;
            self.document.select_others(HashSet::new());
        }
    }

    /// Selects the part that the latest step added or kept.
    pub(super) fn select_new(&mut self, selection: Selection) {
        self.select(selection);
        self.document.selected(self.selection);
    }

    pub(super) fn begin_rename(&mut self, part: Selection) {
        self.select(part);
        self.renaming = Some(part);
    }

    /// Hides or shows an object; switches a light on or off.
    pub(super) fn toggle(&mut self, part: Selection, registry: &Registry) {
        match part {
            part if self.is_in_group(part) => self.toggle_group(registry),
            Selection::Light(i) if self.exists(part) => {
                let on = !self.document.lights[i].enabled;
                self.edit(Edit::set(Part::Light(i), Light::enabled, on), registry);
            }
            Selection::Object(i) if self.exists(part) => {
                let on = !self.document.objects[i].visible;
                self.edit(Edit::set(Part::Object(i), Object::visible, on), registry);
            }
            _ => self.say(Severity::Info, "Select an object to hide it, or a light to switch it off."),
        }
    }

    pub(super) fn step_selection(&mut self, by: isize) {
        let count = self.document.objects.len() as isize;
        if count == 0 {
            return;
        }
        let next = match self.selection {
            Selection::Object(i) => (i as isize + by).rem_euclid(count),
            _ if by > 0 => 0,
            _ => count - 1,
        };
        self.select(Selection::Object(next as usize));
    }
}
