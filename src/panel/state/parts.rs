//! Adding, copying and removing lights and objects.

use std::ops::Range;

use super::{Action, Effect, Note, Session, Severity, placing::Stand};
use crate::{
    document::{Selection, names::free_name},
    light::MAX_LIGHTS,
    parameter::Value,
    registry::Registry,
    scene::{Light, MAX_OBJECTS, Object, Repetition},
};

/// Parts of which a scene has at most so many.
pub(super) const LIGHTS: (&str, usize) = ("lights", MAX_LIGHTS);
pub(super) const OBJECTS: (&str, usize) = ("objects", MAX_OBJECTS);

impl Session {
    /// True if another part has room; says so otherwise.
    fn has_room(&mut self, parts: (&str, usize)) -> bool {
        self.has_room_for(1, parts)
    }

    /// True if so many other parts have room; says so otherwise.
    pub(super) fn has_room_for(&mut self, others: usize, (parts, most): (&str, usize)) -> bool {
        let count = if parts == LIGHTS.0 { self.document.lights.len() } else { self.document.objects.len() };
        let has_room = count + others <= most;
        if !has_room {
            self.say(Severity::Info, format!("A scene has at most {most} {parts}."));
        }
        has_room
    }

    /// Adds a light of a type; `with` sets further properties.
    pub(super) fn add_light(&mut self, id: &str, with: impl FnOnce(&mut Light), registry: &Registry) {
        let Some(entry) = registry.light(id).filter(|_| self.has_room(LIGHTS)) else { return };
        let d = entry.declaration;
        let stand = self.stand(registry);
        let position = stand.new_light(entry);
        let mut light = Light {
            light_type: id.to_owned(),
            position: d.has_position.then_some(position),
            direction: d.has_direction.then(|| stand.direction(entry, position)),
            intensity: d.default_intensity,
            ..Light::default()
        };
        if d.has_position {
            stand.fit_size(entry, position, &mut light.parameters);
        }
        if !stand.may_fill_background(entry) {
            light.parameters.set("visible", Value::flag(false));
        }
        with(&mut light);
        let (intensity, clips) = stand.intensity(&light, entry);
        light.intensity = intensity;
        let at = self.document.lights.len();
        self.document.insert_light(at, light, "Add", self.selection, registry);
        self.select_new(Selection::Light(at));
        if clips {
            let name = self.name_of(self.selection, registry);
            let text = format!("With {name} the picture clips: lower the exposure, or dim another light.");
            self.say(Severity::Info, text);
        }
    }

    /// Adds an object of a type; `with` sets further properties. The name is made unique if it is taken.
    pub(super) fn add_object(
        &mut self,
        id: &str,
        name: Option<String>,
        with: impl FnOnce(&mut Object),
        registry: &Registry,
    ) {
        if registry.shape(id).is_none() || !self.has_room(OBJECTS) {
            return;
        }
        let (position, size) = self.stand(registry).object(id);
        let taken = |name: &String| self.document.objects.iter().any(|o| o.name.as_ref() == Some(name));
        let name = name.map(|name| if taken(&name) { free_name(&self.document, &name) } else { name });
        let mut object = Object { object_type: id.to_owned(), name, position, size, ..Object::default() };
        with(&mut object);
        let at = self.document.objects.len();
        self.document.insert_object(at, object, "Add", self.selection, registry);
        self.select_new(Selection::Object(at));
    }

    pub(super) fn duplicate(&mut self, part: Selection, registry: &Registry) {
        match part {
            part if self.is_in_group(part) => self.duplicate_group(registry),
            Selection::Light(i) if i < self.document.lights.len() => {
                if !self.has_room(LIGHTS) {
                    return;
                }
                let mut copy = self.document.lights[i].clone();
                copy.position = copy.position.map(|p| self.stand(registry).copy_of_light(p));
                copy.name = copy.name.map(|n| free_name(&self.document, &n));
                self.document.insert_light(i + 1, copy, "Duplicate", self.selection, registry);
                self.select_new(Selection::Light(i + 1));
            }
            Selection::Object(i) if i < self.document.objects.len() => {
                if !self.has_room(OBJECTS) {
                    return;
                }
                let mut copy = self.document.objects[i].clone();
                copy.position = self.stand(registry).copy(i);
                copy.name = copy.name.map(|n| free_name(&self.document, &n));
                copy.repeat = Repetition::None;
                let from = self.document.object_id(i);
                let at = self.document.row(i).map_or(i, |row| row.first + row.count - 1) + 1;
                self.document.insert_object(at, copy, "Duplicate", self.selection, registry);
                if let Some((from, to)) = from.zip(self.document.object_id(at)) {
                    self.stashed.copied(from, to);
                    self.travels.copied(from, to);
                }
                self.select_new(Selection::Object(at));
                if self.stand(registry).cuts_off(at, self.facts.aspect) {
                    let note = Note::new(Severity::Info, "The picture does not show all of the copy.");
                    self.note(note.offering("Frame it", Action::Do(Effect::FocusSelection)));
                }
            }
            _ => self.say(Severity::Info, "Select a light or an object to duplicate it."),
        }
    }

    pub(super) fn remove(&mut self, part: Selection, registry: &Registry) {
        // Of a row, all copies go.
        let objects = match part {
            Selection::Object(i) => self.document.row(i).map_or(i..i + 1, |row| row.range()),
            _ => 0..0,
        };
        match part {
            part if self.is_in_group(part) => self.remove_group(registry),
            Selection::Light(_) if self.document.lights.len() <= 1 => {
                self.say(Severity::Info, "Can’t delete the last light: a scene needs at least one.");
            }
            Selection::Object(_) if self.document.objects.len() <= objects.len() => {
                self.say(Severity::Info, "Can’t delete the last object: a scene needs at least one.");
            }
            Selection::Light(_) | Selection::Object(_) if self.exists(part) => {
                let name = match part {
                    Selection::Object(i) => self.document.name_to_edit(i, registry),
                    part => self.name_of(part, registry),
                };
                let text = format!("Deleted “{name}”.");
                self.document.remove(part, registry);
                self.select_new(self.selection_without(part, &objects));
                self.renaming = None;
                self.messages.offer_undo(text, self.last_step());
            }
            Selection::Observer => {
                self.say(Severity::Info, "Can’t delete the observer: a scene needs exactly one.");
            }
            _ => self.say(Severity::Info, "Select a light or an object to remove it."),
        }
    }

    /// The selection after a part was deleted, with all `objects` of its row: the same, or a neighbour of what was deleted.
    fn selection_without(&self, part: Selection, objects: &Range<usize>) -> Selection {
        let (lights, left) = (self.document.lights.len(), self.document.objects.len());
        match (self.selection, part) {
            (Selection::Light(at), Selection::Light(gone)) => {
                Selection::Light((at - usize::from(at > gone)).min(lights - 1))
            }
            (Selection::Object(at), Selection::Object(_)) => {
                let gone = if at >= objects.end { objects.len() } else { at.saturating_sub(objects.start) };
                Selection::Object((at - gone).min(left - 1))
            }
            (other, _) => other,
        }
    }

    /// The scene in front of the camera, for placing new parts.
    pub(super) fn stand<'a>(&'a self, registry: &'a Registry) -> Stand<'a> {
        let selected = match self.selection {
            Selection::Object(i) => self.document.objects.get(i).map(|object| object.position),
            _ => None,
        };
        Stand::new(&self.document, registry, self.facts.eye, self.facts.camera).aiming(selected)
    }
}
