//! The names of the parts of a scene. A part without a name is called by its type and number, and keeps that name for
//! life: it is written down when others come and go.

use std::collections::HashSet;

use super::{Document, Selection, index::numbers};
use crate::{registry::Registry, scene::Scene};

impl Document {
    /// The name of a part, else its type and its number among parts of that type.
    #[must_use]
    pub fn name_of(&self, part: Selection, registry: &Registry) -> String {
        match part {
            Selection::Room => "Room".to_owned(),
            Selection::Observer => "Observer".to_owned(),
            Selection::Light(i) => {
                let Some(light) = self.lights.get(i) else { return "light".to_owned() };
                let number = || self.index().lights.number(i);
                name(&light.name, light_type(&light.light_type, registry), number)
            }
            Selection::Object(i) => {
                let Some(object) = self.objects.get(i) else { return "object".to_owned() };
                let number = || self.index().objects.number(i);
                name(&object.name, object_type(&object.object_type, registry), number)
            }
        }
    }
}

fn name(own: &Option<String>, type_name: &str, number: impl FnOnce() -> usize) -> String {
    own.clone().unwrap_or_else(|| format!("{type_name} {}", number()))
}

fn light_type<'a>(id: &'a str, registry: &Registry) -> &'a str {
    registry.light(id).map_or(id, |entry| entry.declaration.name)
}

fn object_type<'a>(id: &'a str, registry: &Registry) -> &'a str {
    registry.shape(id).map_or(id, |entry| entry.declaration.name)
}

/// "lamp" → "lamp 2", "lamp 2" → "lamp 3": the next number that is free.
pub fn free_name(scene: &Scene, name: &str) -> String {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end();
    let stem = if stem.is_empty() { name } else { stem };
    let names: HashSet<_> = (scene.lights.iter().filter_map(|l| l.name.as_deref()))
        .chain(scene.objects.iter().filter_map(|o| o.name.as_deref()))
        .collect();
    next(stem, 2, |name| names.contains(name))
}

fn next(stem: &str, first: usize, taken: impl Fn(&str) -> bool) -> String {
    (first..).map(|n| format!("{stem} {n}")).find(|name| !taken(name)).unwrap_or_default()
}

/// The names of all lights and objects; none for one that is to get a new name.
pub(super) struct Names {
    pub(super) lights: Vec<Option<String>>,
    pub(super) objects: Vec<Option<String>>,
}

impl Names {
    pub(super) fn of(scene: &Scene, registry: &Registry) -> Self {
        let lights = scene.lights.iter().map(|l| (&l.name, light_type(&l.light_type, registry)));
        let objects = scene.objects.iter().map(|o| (&o.name, object_type(&o.object_type, registry)));
        Self { lights: numbered(lights), objects: numbered(objects) }
    }

    /// Writes down what would change otherwise, and gives a new part a number that no other has.
    pub(super) fn keep(self, scene: &mut Scene, registry: &Registry) {
        let now = Self::of(scene, registry);
        let known = self.lights.iter().chain(&self.objects).flatten();
        let mut taken: HashSet<String> = known.cloned().collect();
        let lights = scene.lights.iter_mut().map(|l| &mut l.name).zip(self.lights).zip(now.lights);
        let objects = scene.objects.iter_mut().map(|o| &mut o.name).zip(self.objects).zip(now.objects);
        for ((name, before), now) in lights.chain(objects) {
            let now = now.unwrap_or_default();
            match before {
                _ if name.is_some() => {}
                Some(before) if before == now => {}
                Some(before) => *name = Some(before),
                None if taken.insert(now.clone()) => {}
                None => {
                    let (stem, number) = now.rsplit_once(' ').unwrap_or((&now, ""));
                    let free = next(stem, number.parse().unwrap_or(2), |name| taken.contains(name));
                    taken.insert(free.clone());
                    *name = Some(free);
                }
            }
        }
    }
}

fn numbered<'a>(parts: impl Iterator<Item = (&'a Option<String>, &'a str)> + Clone) -> Vec<Option<String>> {
    let numbers = numbers(parts.clone().map(|(_, type_name)| type_name));
    parts.zip(numbers).map(|((own, type_name), number)| Some(name(own, type_name, || number))).collect()
}
