//! Edits of the scene, undo and redo.

use std::collections::HashSet;

use super::{
    Session, Severity,
    follow::{follow_model, follow_registry, tell_views},
    messages::Step,
};
use crate::{
    document::{Document, Edit, Extent, Selection},
    parameter::Value,
    registry::Registry,
    scene::{Display, Field, Light, Object, Part, Scene, part::Fields as _},
};

impl Session {
    /// Applies an edit in the active view.
    pub(super) fn edit(&mut self, edit: Edit, registry: &Registry) {
        if let Edit::Each { edits, step } = edit {
            return self.edit_each(edits, step, registry);
        }
        let edit = self.redirected(edit, registry);
        self.edit_here(edit, registry);
    }

    /// Applies an edit to the scene.
    pub(super) fn edit_here(&mut self, edit: Edit, registry: &Registry) {
        let (part, values) = edit.values();
        let sets = |field: Field| values.iter().any(|(key, _)| *key == field.into());
        let model = values.iter().find_map(|(key, value)| match value {
            Some(Value::Choice(id)) if *key == Scene::reflection_model.into() => {
                Some(id.clone().into_owned())
            }
            _ => None,
        });
        let chosen = [Scene::reflection_model, Scene::shading_model].into_iter().find(|field| sets(*field));
        let scene_choice = chosen.filter(|_| part == Part::Scene);
        let other_model = chosen.is_some() && matches!(part, Part::Scene | Part::Object(_));
        let named = sets(Light::name) && matches!(part, Part::Light(_) | Part::Object(_));
        self.outside.allow(values.iter().filter_map(|(_, value)| match value {
            Some(Value::File(file)) => Some(file),
            _ => None,
        }));
        let before = self.document.revision();
        let departure = self.departure(&edit);
        let of_view = self.view_departure(&edit, registry);
        let reorders = matches!(edit, Edit::Views { .. });
        let row = match edit {
            Edit::Row { object, .. } => Some(self.document.row(object).map_or(object, |row| row.first)),
            _ => None,
        };
        let selected = row.and_then(|_| self.selected_id());
        let done = match edit.one() {
            Some((Part::Light(i), key, Some(Value::Choice(id)))) if key == Light::light_type.into() => {
                self.change_light_type(i, id, registry)
            }
            _ => self.document.edit(edit, self.selection, registry),
        };
        if let Err(why) = done {
            return self.say(Severity::Warning, why);
        }
        row.into_iter().for_each(|first| self.stay_in_row(selected, first));
        if let Some(id) = model {
            self.model_slots.take(&id);
        }
        if let Some(departure) = departure.filter(|_| self.document.revision() != before) {
            self.carry(vec![departure], registry);
        }
        if let Some(departure) = of_view.filter(|_| self.document.revision() != before) {
            self.carry_in_view(departure, registry);
            tell_views(self, registry);
        }
        if reorders {
            self.desk.travels.forget_views();
        }
        if other_model && self.document.revision() != before {
            // Models may allow different values of a parameter that they share.
            follow_model(self, registry);
        }
        scene_choice.into_iter().for_each(|field| self.tell_overrides(field));
        if named {
            self.renaming = None;
        }
    }

    /// Says so if the scene's choice of a model does not show.
    fn tell_overrides(&mut self, field: Field) {
        let own = |o: &Object| o.value(field.into()).is_some();
        if self.document.shown().next().is_some() && self.document.shown().all(own) {
            let what = field.label();
            let text = format!(
                "Every visible object overrides the {what}, so the scene’s does not show. Select an object to change its own."
            );
            self.say(Severity::Info, text);
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
        let selected = self.selected_id();
        let before = (self.document.revision(), self.selection);
        change(&mut self.document, self.selection)?;
        if let Some(id) = selected {
            let light = self.document.light(id).map(Selection::Light);
            self.selection =
                light.or(self.document.object(id).map(Selection::Object)).unwrap_or(Selection::Room);
            if self.selection == Selection::Room {
                self.document.select_others(HashSet::new());
            }
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
        let place = registry.light(id).map(|entry| {
            let position = position.unwrap_or_else(|| stand.new_light(entry));
            (position, stand.direction(entry, position))
        });
        self.document.change_light_type(i, id, place, self.selection, registry)
    }

    pub(super) fn undo(&mut self, registry: &Registry) {
        match self.document.done().checked_sub(1) {
            Some(done) => self.go_to_step(done, registry),
            None => self.say(Severity::Info, "There is nothing to undo."),
        }
    }

    pub(super) fn redo(&mut self, registry: &Registry) {
        match self.document.done() {
            done if done == self.document.steps().len() => {
                self.say(Severity::Info, "There is nothing to redo.");
            }
            done => self.go_to_step(done + 1, registry),
        }
    }

    /// Changes the exposure, within its limits.
    pub(super) fn expose(&mut self, ev: f32, registry: &Registry) {
        let exposure = self.scene().display.exposure + ev;
        if Display::exposure.limits().allows(f64::from(exposure)) {
            self.edit(Edit::set(Part::Display, Display::exposure, exposure), registry);
        }
    }

    /// Selects a recent model.
    pub(super) fn choose_recent(&mut self, slot: usize, registry: &Registry) {
        if let Some(edit) = self.model_slots.get(slot).map(|id| self.edit_model(id)) {
            self.edit(edit, registry);
        }
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
            self.select(Selection::Room);
        }
        self.renaming = None;
        if self.document.reflection_model != model {
            self.desk.model_slots.take(&self.document.reflection_model);
        }
        // The models may have changed since the step was made.
        follow_registry(self, registry);
    }
}
