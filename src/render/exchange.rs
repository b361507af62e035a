//! Synchronises the displayed scene with a document, and the document with changes of entities by systems;
//! both at a cost proportional to the changes.

use bevy::ecs::prelude::*;

use super::entities::{CurrentScene, Ids, SceneEntities};
use crate::document::{Document, Extent};

/// Changes of the displayed scene by others.
#[derive(Clone, Debug, PartialEq)]
pub enum Changes {
    /// These parts have other values.
    Values(Vec<Extent>),
    /// Parts were added at the ends of the lists, or changed their types, and these were removed, by their
    /// former positions.
    Lists(Vec<Extent>),
}

impl SceneEntities {
    /// True if the displayed scene is that of the document.
    #[must_use]
    pub fn shows(&self, document: &Document) -> bool {
        self.shown == Some(document.revision())
    }

    /// Displays the document.
    pub fn show(&mut self, document: &Document, mut scene: ResMut<CurrentScene>) {
        if self.shows(document) {
            return;
        }
        let before = Some(scene.last_changed());
        let parts = self.shown.and_then(|shown| document.changes_since(shown));
        // If others changed the scene, the document takes precedence.
        match parts.filter(|_| self.agreed == before) {
            Some(parts)
                if parts.iter().all(|part| *part == Extent::Rest) && document.shows_the_same(&scene.0) =>
            {
                // No picture changes: views follow their overrides, and layouts only arrange them.
                let scene = &mut scene.bypass_change_detection().0;
                scene.variants.clone_from(&document.variants);
                scene.comparison = document.comparison;
            }
            Some(parts) => {
                parts.iter().for_each(|part| part.copy(document, &mut scene.0));
                if self.seen == before {
                    self.seen = Some(scene.last_changed());
                    self.due.extend(parts);
                }
            }
            None => {
                let ids = ids(document);
                if *document != scene.0 {
                    Extent::All.copy(document, &mut scene.0);
                } else if self.ids.as_ref() != Some(&ids) {
                    scene.set_changed();
                }
                self.new_ids = Some(ids);
            }
        }
        self.agree(document, &scene);
    }

    /// The changes of the displayed scene by others in this frame.
    pub fn changed_by_others(
        &mut self,
        document: &Document,
        scene: &mut ResMut<CurrentScene>,
    ) -> Option<Changes> {
        let (parts, removed) = (&mut self.absorbed.parts, &mut self.absorbed.removed);
        let (parts, removed) = (std::mem::take(parts), std::mem::take(removed));
        if !scene.is_changed() {
            return None;
        }
        if self.shows(document) && self.agreed == Some(scene.last_changed()) {
            if self.absorbed.relisted {
                return Some(Changes::Lists(removed));
            }
            return (!parts.is_empty()).then_some(Changes::Values(parts));
        }
        if *document != scene.0 {
            return Some(Changes::Values(vec![Extent::All]));
        }
        if self.ids.is_none() {
            self.identify_later(document, scene);
        }
        self.agree(document, scene);
        None
    }

    /// Records that the displayed scene is that of the document: entities get their ids when they next follow
    /// it.
    fn identify_later(&mut self, document: &Document, scene: &mut ResMut<CurrentScene>) {
        let before = Some(scene.last_changed());
        scene.set_changed();
        if self.seen == before {
            self.seen = Some(scene.last_changed());
        }
        self.new_ids = Some(ids(document));
    }

    /// Records that the displayed scene equals the document.
    fn agree(&mut self, document: &Document, scene: &ResMut<CurrentScene>) {
        self.shown = Some(document.revision());
        self.agreed = Some(scene.last_changed());
    }

    /// Concludes the changes: the document adopted them, or refused them and is displayed again.
    pub fn settle(
        &mut self,
        changes: &Changes,
        adopted: bool,
        document: &Document,
        scene: &mut ResMut<CurrentScene>,
    ) {
        let parts = matches!(changes, Changes::Values(parts) if !parts.contains(&Extent::All));
        if !parts || !adopted {
            if *document != scene.0 {
                Extent::All.copy(document, &mut scene.0);
            }
            self.identify_later(document, scene);
        }
        self.agree(document, scene);
    }
}

fn ids(document: &Document) -> Ids {
    Ids {
        lights: (0..document.lights.len()).filter_map(|i| document.light_id(i)).collect(),
        objects: (0..document.objects.len()).filter_map(|i| document.object_id(i)).collect(),
    }
}

#[cfg(test)]
mod tests;
