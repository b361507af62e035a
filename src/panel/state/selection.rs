//! The selected part.

use super::Session;
use crate::document::Selection;

impl Session {
    pub(super) fn select_first(&mut self) {
        self.selection =
            if self.document.objects.is_empty() { Selection::Room } else { Selection::Object(0) };
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
        }
    }

    /// Selects the part that the latest step added or kept.
    pub(super) fn select_new(&mut self, selection: Selection) {
        self.select(selection);
        self.document.selected(self.selection);
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
