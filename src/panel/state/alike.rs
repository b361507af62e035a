//! Selections of several lights and objects: one by one, by ranges of the list, and by what they have in common.

use std::{collections::HashSet, mem};

use super::Session;
use crate::{
    declared::texts,
    document::{Document, Selection},
};

texts! {
    /// What parts that are selected together have in common.
    Alike(
        /// The part of a command's id.
        id,
        /// The name of the command.
        name
    ) {
        /// Being lights, or being objects.
        Kind = "all" "All objects, all lights, or both",
        /// The type of light or object.
        Type = "same_type" "All of the same type",
        /// The reflection model of objects.
        Model = "same_model" "All with the same reflection model",
    }
}

impl Alike {
    /// All ways.
    pub const ALL: [Self; 3] = [Self::Kind, Self::Type, Self::Model];
}

/// The place of a light or an object in the list: lights come first.
fn place(part: Selection) -> Option<(bool, usize)> {
    match part {
        Selection::Light(i) => Some((false, i)),
        Selection::Object(i) => Some((true, i)),
        Selection::Room | Selection::Observer => None,
    }
}

/// All lights, then all objects.
fn listed(document: &Document) -> impl DoubleEndedIterator<Item = Selection> {
    let lights = (0..document.lights.len()).map(Selection::Light);
    lights.chain((0..document.objects.len()).map(Selection::Object))
}

impl Session {
    /// True if a part is selected, alone or with others. Costs the same however many there are.
    #[must_use]
    pub fn is_selected(&self, part: Selection) -> bool {
        part == self.selection || self.document.is_other(part)
    }

    /// True if several lights and objects are selected.
    #[must_use]
    pub fn has_group(&self) -> bool {
        !self.document.others().is_empty() && place(self.selection).is_some()
    }

    /// True if a part is one of several that are selected.
    pub(in crate::panel) fn is_in_group(&self, part: Selection) -> bool {
        self.has_group() && self.is_selected(part)
    }

    /// The selected lights and objects, in the order of the list.
    #[must_use]
    pub fn group(&self) -> Vec<Selection> {
        let others = self.document.others().iter().filter_map(|id| self.document.part_of(*id));
        let mut all: Vec<_> = others.chain([self.selection]).filter(|part| place(*part).is_some()).collect();
        all.sort_unstable_by_key(|part| place(*part));
        all.dedup();
        all
    }

    /// The selected lights and objects, with one copy for each row: what is set in one copy is set in all.
    #[must_use]
    pub fn entries(&self) -> Vec<Selection> {
        let mut row = 0..0;
        let mut all = self.group();
        all.retain(|part| match part {
            Selection::Object(i) if row.contains(i) => false,
            Selection::Object(i) => {
                row = self.document.row(*i).map_or(0..0, |row| row.range());
                true
            }
            _ => true,
        });
        all
    }

    /// What is selected together, in words: "3 objects", "2 lights", "5 parts".
    #[must_use]
    pub fn name_of_group(&self) -> String {
        let all = self.document.others().len() + 1;
        let is_light = |part: Selection| place(part).is_some_and(|(object, _)| !object);
        let others = self.document.others().iter();
        let lights = others.filter(|id| self.document.light(**id).is_some()).count()
            + usize::from(is_light(self.selection));
        let what = match lights {
            0 => "object",
            lights if lights == all => "light",
            _ => "part",
        };
        crate::text::plural(all, what)
    }

    /// Selects a part, and others besides it.
    pub(super) fn select_group(&mut self, part: Selection, others: impl IntoIterator<Item = Selection>) {
        self.select(part);
        let own = self.selected_id();
        let mut ids: HashSet<_> = others.into_iter().filter_map(|part| self.document.id_of(part)).collect();
        own.map(|own| ids.remove(&own));
        if own.is_some() {
            self.renaming = None;
            self.document.select_others(ids);
        }
    }

    pub(super) fn select_also(&mut self, part: Selection) {
        let group = self.group();
        match place(part).filter(|_| self.exists(part)) {
            // The room cannot be one of several.
            None => self.select(part),
            Some(_) if group.is_empty() => self.select(part),
            Some(_) if self.is_selected(part) => {
                let left: Vec<_> = group.into_iter().filter(|other| *other != part).collect();
                let first = if part == self.selection { left.first() } else { Some(&self.selection) };
                // One always stays.
                if let Some(first) = first.copied() {
                    self.select_group(first, left);
                }
            }
            Some(_) => self.select_group(self.selection, group.into_iter().chain([part])),
        }
    }

    pub(super) fn select_range(&mut self, to: Selection) {
        let ends = place(self.selection).zip(place(to).filter(|_| self.exists(to)));
        let Some((from, to)) = ends else { return self.select(to) };
        let range = from.min(to)..=from.max(to);
        let parts: Vec<_> = listed(&self.document)
            .filter(|part| place(*part).is_some_and(|at| range.contains(&at)))
            .collect();
        self.select_group(self.selection, parts);
    }

    pub(super) fn select_each(&mut self, mut parts: Vec<Selection>, add: bool) {
        parts.retain(|part| place(*part).is_some() && self.exists(*part));
        if add {
            parts.extend(self.group());
        }
        // What was selected stays the first, if it can.
        let first =
            if parts.contains(&self.selection) { Some(self.selection) } else { parts.first().copied() };
        if let Some(first) = first {
            self.select_group(first, parts);
        }
    }

    pub(super) fn select_alike(&mut self, by: Alike) {
        let document = &self.document;
        let like = match self.selection {
            Selection::Room | Selection::Observer => Selection::Object(0),
            part => part,
        };
        let group = self.group();
        let is_mixed = group.first().map(mem::discriminant) != group.last().map(mem::discriminant);
        let same = |part: &Selection| match (by, like, *part) {
            (Alike::Kind, ..) if is_mixed => true,
            (Alike::Kind, Selection::Light(_), Selection::Light(_))
            | (Alike::Kind, Selection::Object(_), Selection::Object(_)) => true,
            (Alike::Type, Selection::Light(i), Selection::Light(k)) => {
                document.lights[i].light_type == document.lights[k].light_type
            }
            (Alike::Type, Selection::Object(i), Selection::Object(k)) => {
                document.objects[i].object_type == document.objects[k].object_type
            }
            (Alike::Model, Selection::Object(i), Selection::Object(k)) => {
                let scene = self.scene();
                scene.model_of(&scene.objects[i]) == scene.model_of(&scene.objects[k])
            }
            _ => false,
        };
        let parts: Vec<_> = listed(document).filter(same).collect();
        self.select_each(parts, false);
    }
}
