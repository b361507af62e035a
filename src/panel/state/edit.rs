//! Edits of the scene, undo and redo.

use super::{Session, Severity, messages::Step};
use crate::{
    document::{Document, Edit, Extent, LightField, ObjectField, Selection, VariantField},
    panel::follow::{follow_model, follow_registry},
    registry::Registry,
    scene::{Object, Scene},
};

/// A scene default that objects may override.
const MODEL: &str = "reflection model";

impl Session {
    /// Applies an edit in the active view.
    pub(super) fn edit(&mut self, edit: Edit, registry: &Registry) {
        for edit in self.redirected(edit, registry) {
            self.edit_here(edit, registry);
        }
    }

    /// Applies an edit to the scene.
    pub(super) fn edit_here(&mut self, edit: Edit, registry: &Registry) {
        let model = match &edit {
            Edit::Model(id)
            | Edit::Object(_, ObjectField::Model(Some(id)))
            | Edit::Variant(_, VariantField::Model(Some(id))) => Some(id.clone()),
            _ => None,
        };
        let scene_choice = match &edit {
            Edit::Model(_) => Some(MODEL),
            Edit::ShadingModel(_) => Some("shading model"),
            _ => None,
        };
        let other_model = matches!(
            edit,
            Edit::Model(_)
                | Edit::ShadingModel(_)
                | Edit::Object(_, ObjectField::Model(_) | ObjectField::ShadingModel(_))
        );
        let before = self.document.revision();
        let named =
            matches!(edit, Edit::Light(_, LightField::Name(_)) | Edit::Object(_, ObjectField::Name(_)));
        let done = match edit {
            Edit::Light(i, LightField::Type(id)) => self.change_light_type(i, &id, registry),
            edit => self.document.edit(edit, self.selection, registry),
        };
        if let Err(why) = done {
            return self.say(Severity::Warning, why);
        }
        if let Some(id) = model {
            self.model_slots.take(&id);
        }
        if other_model && self.document.revision() != before {
            // Models may allow different values of a parameter that they share.
            follow_model(self, registry);
        }
        if let Some(what) = scene_choice {
            let own = |o: &Object| match what {
                MODEL => o.reflection_model.is_some(),
                _ => o.shading_model.is_some(),
            };
            if self.document.shown().next().is_some() && self.document.shown().all(own) {
                let text = format!(
                    "Every visible object overrides the {what}, so the scene’s does not show. Select an object to change its own."
                );
                self.say(Severity::Info, text);
            }
        }
        if named {
            self.renaming = None;
        }
    }

    /// Adopts a change of these parts made outside the panels, by a system that changed a component.
    ///
    /// # Errors
    /// Returns an error with the reason if the change is refused; the document then stays as it is.
    pub fn submit(&mut self, scene: &Scene, parts: &[Extent], registry: &Registry) -> Result<(), String> {
        self.by_system(|document, selection| document.submit(scene, parts, selection, registry))
    }

    /// Adopts a scene in which systems added, removed or retyped parts: see [`Document::submit_lists`].
    ///
    /// # Errors
    /// Returns an error with the reason if the change is refused; the document then stays as it is.
    pub fn submit_lists(
        &mut self,
        scene: &Scene,
        removed: &[Extent],
        registry: &Registry,
    ) -> Result<(), String> {
        self.by_system(|document, selection| document.submit_lists(scene, removed, selection, registry))
    }

    /// Applies a change made by a system, keeping the selection.
    fn by_system(
        &mut self,
        change: impl FnOnce(&mut Document, Selection) -> Result<(), String>,
    ) -> Result<(), String> {
        let selected = match self.selection {
            Selection::Light(i) => self.document.light_id(i),
            Selection::Object(i) => self.document.object_id(i),
            Selection::Room | Selection::Observer => None,
        };
        let before = (self.document.revision(), self.selection);
        change(&mut self.document, self.selection)?;
        if let Some(id) = selected {
            let light = self.document.light(id).map(Selection::Light);
            self.selection =
                light.or(self.document.object(id).map(Selection::Object)).unwrap_or(Selection::Room);
        }
        if self.selection != before.1 && self.document.revision() != before.0 {
            self.document.selected(self.selection);
        }
        Ok(())
    }

    /// The number of applied steps, and the name of the latest one.
    pub(super) fn last_step(&self) -> Step {
        let done = self.document.done();
        let last = done.checked_sub(1).and_then(|last| self.document.steps().nth(last));
        (done, last.map(str::to_owned))
    }

    /// Changes the type of a light, and places it in view if it gains a position.
    fn change_light_type(&mut self, i: usize, id: &str, registry: &Registry) -> Result<(), String> {
        let position = self.document.lights.get(i).and_then(|light| light.position);
        let stand = self.stand(registry);
        let position = position.unwrap_or_else(|| stand.light(None));
        let place = Some((position, stand.towards_middle(position)));
        self.document.change_light_type(i, id, place, self.selection, registry)
    }

    /// Undoes or redoes until this number of steps is applied.
    pub(super) fn go_to_step(&mut self, done: usize, registry: &Registry) {
        let model = self.document.reflection_model.clone();
        while self.document.done() != done.min(self.document.steps().len()) {
            let step = if self.document.done() > done { self.document.undo() } else { self.document.redo() };
            let Some((_, selection)) = step else { break };
            self.selection = selection;
        }
        if !self.exists(self.selection) {
            self.selection = Selection::Room;
        }
        self.renaming = None;
        if self.document.reflection_model != model {
            self.model_slots.take(&self.document.reflection_model);
        }
        // The models may have changed since the step was made.
        follow_registry(self, registry);
    }
}
