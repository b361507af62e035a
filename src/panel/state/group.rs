//! Actions on several lights and objects at once, each of them one step of the history.

use std::collections::HashSet;

use glam::Vec3;

use super::{
    Session, Severity, Together,
    arrange::tidy,
    follow::follow_model,
    parts::{LIGHTS, OBJECTS},
};
use crate::{
    document::{Edit, Selection, names},
    parameter::Value,
    registry::Registry,
    scene::{Key, Light, Object, Part, Repetition, Scene},
};

impl Session {
    /// Applies edits of several parts in the active view.
    pub(super) fn edit_each(&mut self, edits: Vec<Edit>, step: String, registry: &Registry) {
        // What another view than the first changes alone, it changes for all objects.
        let (mut here, mut of_view) = (Vec::with_capacity(edits.len()), None);
        for edit in edits {
            match self.redirected(edit, registry) {
                edit if matches!(edit.values().0, Part::Variant(_)) => of_view = Some(edit),
                edit => here.push(edit),
            }
        }
        of_view.into_iter().for_each(|edit| self.edit_here(edit, registry));
        if here.is_empty() {
            return;
        }
        let models: [Key; 2] = [Scene::reflection_model.into(), Scene::shading_model.into()];
        let chooses = here.iter().any(|edit| edit.values().1.iter().any(|(key, _)| models.contains(key)));
        let before = self.document.revision();
        let departures = self.departures(&here);
        let model = here.iter().find_map(|edit| match edit.one() {
            Some((_, key, Some(Value::Choice(id)))) if key == models[0] => Some(id.clone().into_owned()),
            _ => None,
        });
        let edit = Edit::Each { edits: here, step };
        if let Err(why) = self.document.edit(edit, self.selection, registry) {
            return self.say(Severity::Warning, why);
        }
        if self.document.revision() == before {
            return;
        }
        model.iter().for_each(|id| self.model_slots.take(id));
        self.carry(departures, registry);
        if chooses {
            follow_model(self, registry);
        }
    }

    /// Applies an edit as a step of its own, or says why there is none.
    pub(super) fn alone(&mut self, edit: Result<Edit, String>, registry: &Registry) {
        self.document.end_gesture();
        match edit {
            Ok(edit) => self.edit(edit, registry),
            Err(why) => self.say(Severity::Info, why),
        }
        self.document.end_gesture();
    }

    /// True if a light is on, or an object is shown.
    fn is_there(&self, part: Selection) -> bool {
        match part {
            Selection::Light(i) => self.document.lights.get(i).is_some_and(|light| light.enabled),
            Selection::Object(i) => self.document.objects.get(i).is_some_and(|object| object.visible),
            Selection::Room | Selection::Observer => false,
        }
    }

    /// The edit that shows or hides a light or an object.
    fn shown(part: Selection, on: bool) -> Edit {
        match part {
            Selection::Light(_) => Edit::set(part.into(), Light::enabled, on),
            part => Edit::set(part.into(), Object::visible, on),
        }
    }

    /// Hides what is selected, or shows it if all of it is hidden.
    pub(super) fn toggle_group(&mut self, registry: &Registry) {
        let all = self.entries();
        let on = !all.iter().any(|part| self.is_there(*part));
        let edits = all.into_iter().map(|part| Self::shown(part, on)).collect();
        let step = format!("{} {}", if on { "Show" } else { "Hide" }, self.name_of_group());
        self.alone(Ok(Edit::Each { edits, step }), registry);
    }

    /// One object of each row, and the single objects.
    fn rows_and_objects(&self) -> Vec<Selection> {
        let mut copies = HashSet::new();
        self.document.rows().for_each(|row| copies.extend(row.range().skip(1)));
        (0..self.document.objects.len()).filter(|i| !copies.contains(i)).map(Selection::Object).collect()
    }

    pub(super) fn hide_others(&mut self, registry: &Registry) {
        let mut kept = HashSet::new();
        for part in self.entries() {
            if let Selection::Object(i) = part {
                kept.insert(self.document.row(i).map_or(i, |row| row.first));
            }
        }
        if kept.is_empty() {
            return self.say(Severity::Info, "Select objects to hide the others.");
        }
        let is_kept = |part: &Selection| matches!(part, Selection::Object(i) if kept.contains(i));
        let changed =
            self.rows_and_objects().into_iter().filter(|part| self.is_there(*part) != is_kept(part));
        let edits = changed.map(|part| Self::shown(part, is_kept(&part))).collect();
        self.alone(Ok(Edit::Each { edits, step: "Hide the other objects".to_owned() }), registry);
    }

    pub(super) fn show_all(&mut self, registry: &Registry) {
        let hidden = self.rows_and_objects().into_iter().filter(|part| !self.is_there(*part));
        let edits = hidden.map(|part| Self::shown(part, true)).collect();
        self.alone(Ok(Edit::Each { edits, step: "Show all objects".to_owned() }), registry);
    }

    pub(super) fn remove_group(&mut self, registry: &Registry) {
        let mut parts = HashSet::new();
        for part in self.entries() {
            match part {
                Selection::Object(i) => {
                    let row = self.document.row(i).map_or(i..i + 1, |row| row.range());
                    parts.extend(row.map(Selection::Object));
                }
                part => _ = parts.insert(part),
            }
        }
        let lights = parts.iter().filter(|part| matches!(part, Selection::Light(_))).count();
        for (gone, all, what) in [
            (lights, self.document.lights.len(), "lights"),
            (parts.len() - lights, self.document.objects.len(), "objects"),
        ] {
            if gone == all {
                let text = format!("Can’t delete all {what}: a scene needs at least one.");
                return self.say(Severity::Info, text);
            }
        }
        // The first that stays below the selection, or else the last.
        let left = |i: &usize| match self.selection {
            Selection::Light(_) => !parts.contains(&Selection::Light(*i)),
            _ => !parts.contains(&Selection::Object(*i)),
        };
        let next = match self.selection {
            Selection::Light(at) => Selection::Light((0..at).filter(left).count()),
            Selection::Object(at) => Selection::Object((0..at).filter(left).count()),
            part => part,
        };
        let name = self.name_of_group();
        self.document.remove_each(parts, format!("Delete {name}"), self.selection, registry);
        let last = match next {
            Selection::Light(i) => Selection::Light(i.min(self.document.lights.len() - 1)),
            Selection::Object(i) => Selection::Object(i.min(self.document.objects.len() - 1)),
            part => part,
        };
        self.select_new(last);
        self.renaming = None;
        self.messages.offer_undo(format!("Deleted {name}."), self.last_step());
    }

    pub(super) fn duplicate_group(&mut self, registry: &Registry) {
        let all = self.entries();
        let count = all.iter().filter(|part| matches!(part, Selection::Light(_))).count();
        if !self.has_room_for(count, LIGHTS) || !self.has_room_for(all.len() - count, OBJECTS) {
            return;
        }
        let by = self.beside(&all, registry);
        let mut names = names::FreeNames::of(&self.document);
        let (mut lights, mut objects, mut originals) = (Vec::new(), Vec::new(), Vec::new());
        for part in &all {
            match *part {
                Selection::Light(i) => {
                    let mut copy = self.document.lights[i].clone();
                    copy.position = copy.position.map(|p| tidy(p + by));
                    copy.name = copy.name.map(|name| names.next(&name));
                    lights.push(copy);
                }
                Selection::Object(i) => {
                    let mut copy = self.document.objects[i].clone();
                    copy.position = tidy(copy.position + by);
                    copy.name = copy.name.map(|name| names.next(&name));
                    copy.repeat = Repetition::None;
                    originals.extend(self.document.object_id(i));
                    objects.push(copy);
                }
                Selection::Room | Selection::Observer => {}
            }
        }
        let [first_light, first_object] = [self.document.lights.len(), self.document.objects.len()];
        let name = format!("Duplicate {}", self.name_of_group());
        self.document.append(lights, objects, name, self.selection, registry);
        for (from, at) in originals.into_iter().zip(first_object..) {
            if let Some(to) = self.document.object_id(at) {
                self.stashed.copied(from, to);
            }
        }
        let copies = (first_light..self.document.lights.len()).map(Selection::Light);
        let copies = copies.chain((first_object..self.document.objects.len()).map(Selection::Object));
        let copies: Vec<_> = copies.collect();
        // The copy of what was selected first.
        let place = all.iter().position(|part| *part == self.selection).unwrap_or_default();
        if let Some(first) = copies.get(place).or(copies.first()) {
            self.select_group(*first, copies.iter().copied());
            self.document.selected(self.selection);
        }
    }

    /// The step from what is selected to its copies; if there is no place for all, that of the first alone, as far as
    /// all stay in the room.
    fn beside(&self, all: &[Selection], registry: &Registry) -> Vec3 {
        let stand = self.stand(registry);
        if let Some(by) = stand.step_of(all) {
            return by;
        }
        let (from, to) = match self.selection {
            Selection::Light(i) => {
                let position = self.document.lights.get(i).and_then(|light| light.position);
                (position, position.map(|p| stand.copy_of_light(p)))
            }
            Selection::Object(i) => {
                (self.document.objects.get(i).map(|object| object.position), Some(stand.copy(i)))
            }
            Selection::Room | Selection::Observer => (None, None),
        };
        let by = to.unwrap_or_default() - from.unwrap_or_default();
        let room = self.document.scene_size;
        Together::of(self, registry).map_or(by, |all| all.within(by, room))
    }
}
