//! The names of the parts of a scene. A part without a name is called by its type and number, and keeps that
//! name permanently: if others were added or removed, it is written into the file.

use std::{
    cell::OnceCell,
    collections::{HashMap, HashSet},
};

use super::{Document, Extent, Selection, history::Label};
use crate::{registry::Registry, scene::Scene};

/// The name that a part of a scene has in a new document, as [`Document::name_of`] gives it, without one.
#[must_use]
pub fn name_in(scene: &Scene, part: Selection, registry: &Registry) -> String {
    name(scene, part, registry, || match part {
        Selection::Light(i) => nth(&scene.lights, i, |light| &light.light_type),
        Selection::Object(i) => nth(&scene.objects, i, |object| &object.object_type),
        Selection::Room | Selection::Observer => 0,
    })
}

/// The number of a part among those of its type, from 1.
fn nth<T>(parts: &[T], i: usize, type_of: impl Fn(&T) -> &String) -> usize {
    parts[..=i].iter().filter(|part| type_of(part) == type_of(&parts[i])).count()
}

impl Document {
    /// The name of a part, or else its type and its number among parts of that type.
    #[must_use]
    pub fn name_of(&self, part: Selection, registry: &Registry) -> String {
        name(self, part, registry, || match part {
            Selection::Light(i) => self.labels.lights[i].number,
            Selection::Object(i) => self.labels.objects[i].number,
            Selection::Room | Selection::Observer => 0,
        })
    }
}

/// The name of a part, or else its type and its number, which is asked for only if the part is there and has no name.
fn name(scene: &Scene, part: Selection, registry: &Registry, number: impl FnOnce() -> usize) -> String {
    let (own, type_name) = match part {
        Selection::Room => return "Room".to_owned(),
        Selection::Observer => return "Observer".to_owned(),
        Selection::Light(i) => match scene.lights.get(i) {
            Some(light) => (&light.name, light_type(&light.light_type, registry)),
            None => return "light".to_owned(),
        },
        Selection::Object(i) => match scene.objects.get(i) {
            Some(object) => (&object.name, object_type(&object.object_type, registry)),
            None => return "object".to_owned(),
        },
    };
    own.clone().unwrap_or_else(|| format!("{type_name} {}", number()))
}

/// The name of a light type, else its id.
pub(super) fn light_type<'a>(id: &'a str, registry: &Registry) -> &'a str {
    registry.light(id).map_or(id, |entry| entry.declaration.name)
}

/// The name of an object type, else its id.
pub(super) fn object_type<'a>(id: &'a str, registry: &Registry) -> &'a str {
    registry.shape(id).map_or(id, |entry| entry.declaration.name)
}

/// "lamp" → "lamp 2", "lamp 2" → "lamp 3", "B1" → "B2": the next free number.
pub fn free_name(scene: &Scene, name: &str) -> String {
    FreeNames::of(scene).next(name)
}

/// Free names for several copies.
#[derive(Debug)]
pub struct FreeNames<'a> {
    given: HashSet<&'a str>,
    /// The number after that of the last name from each stem, so that many copies need no long search.
    next: HashMap<String, usize>,
}

impl<'a> FreeNames<'a> {
    /// Those beside the names in a scene.
    #[must_use]
    pub fn of(scene: &'a Scene) -> Self {
        Self { given: given_names(scene), next: HashMap::new() }
    }

    /// The name of a copy: with the next number that is free.
    pub fn next(&mut self, name: &str) -> String {
        let cut = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let stem = match cut.trim_end() {
            "" => format!("{name} "),
            // As in "B1", without a space.
            _ if cut.len() < name.len() && !cut.ends_with(char::is_whitespace) => cut.to_owned(),
            stem => format!("{stem} "),
        };
        let first = self.next.get(&stem).copied().unwrap_or(2);
        let with = |n: usize| format!("{stem}{n}");
        let n = (first..).find(|n| !self.given.contains(with(*n).as_str())).unwrap_or(first);
        let name = with(n);
        self.next.insert(stem, n + 1);
        name
    }
}

/// Gives every part without a number the first that is free above all of its type. `type_of` is the type of the part
/// in a place; `taken` is true if a part has the name of that type and number.
fn number<'a>(labels: &mut [Label], type_of: impl Fn(usize) -> &'a str, taken: impl Fn(&str, usize) -> bool) {
    if labels.iter().all(|label| label.number != 0) {
        return;
    }
    let mut highest: HashMap<&str, usize> = HashMap::new();
    for (i, label) in labels.iter().enumerate() {
        let highest = highest.entry(type_of(i)).or_default();
        *highest = label.number.max(*highest);
    }
    for (i, label) in labels.iter_mut().enumerate().filter(|(_, label)| label.number == 0) {
        let id = type_of(i);
        let highest = highest.entry(id).or_default();
        *highest = (*highest + 1..).find(|n| !taken(id, *n)).unwrap_or_default();
        label.number = *highest;
    }
}

/// The names that parts of the scene were given.
fn given_names(scene: &Scene) -> HashSet<&str> {
    let lights = scene.lights.iter().filter_map(|l| l.name.as_deref());
    lights.chain(scene.objects.iter().filter_map(|o| o.name.as_deref())).collect()
}

/// True if a part of the scene was given this name.
fn is_given(scene: &Scene, name: &str) -> bool {
    scene.lights.iter().any(|l| l.name.as_deref() == Some(name))
        || scene.objects.iter().any(|o| o.name.as_deref() == Some(name))
}

impl Document {
    /// Gives every part a number, whatever a change did to lists and types. With a registry, avoids names
    /// given to other parts.
    pub(super) fn number_parts(&mut self, registry: Option<&Registry>) {
        let Self { scene, labels, .. } = self;
        let scene: &Scene = scene;
        // All at once, since the copies of a row may be thousands.
        let names = OnceCell::new();
        let given = |type_name: &str, n: usize| {
            names.get_or_init(|| given_names(scene)).contains(format!("{type_name} {n}").as_str())
        };
        let light = |id: &str, n| registry.is_some_and(|r| given(light_type(id, r), n));
        let object = |id: &str, n| registry.is_some_and(|r| given(object_type(id, r), n));
        number(&mut labels.lights, |i| &scene.lights[i].light_type, light);
        number(&mut labels.objects, |i| &scene.objects[i].object_type, object);
    }

    /// Gives another number to a part that lost its name, if its automatic name was given to another part.
    pub(super) fn number_again(&mut self, part: Selection, registry: &Registry) {
        let name = match part {
            Selection::Light(i) => &self.scene.lights[i].name,
            Selection::Object(i) => &self.scene.objects[i].name,
            Selection::Room | Selection::Observer => return,
        };
        if name.is_some() || !is_given(&self.scene, &self.name_of(part, registry)) {
            return;
        }
        match part {
            Selection::Light(i) => self.labels.lights[i].number = 0,
            Selection::Object(i) => self.labels.objects[i].number = 0,
            Selection::Room | Selection::Observer => {}
        }
        self.number_parts(Some(registry));
    }

    /// The name that an unnamed part needs in a file, since a reader would otherwise give it another: parts
    /// of the same type were removed or added before it. `in_row` is true for the index of a copy.
    fn written_name(
        &self,
        part: Extent,
        in_row: impl Fn(usize) -> bool,
        registry: &Registry,
    ) -> Option<String> {
        let (own, number, read, part) = match part {
            Extent::Light(i) => {
                let label = self.labels.lights.get(i)?;
                (&self.lights[i].name, label.number, self.index().lights.number(i), Selection::Light(i))
            }
            Extent::Object(i) => {
                let label = self.labels.objects.get(i)?;
                (&self.objects[i].name, label.number, self.index().objects.number(i), Selection::Object(i))
            }
            Extent::Rest | Extent::All => return None,
        };
        // Copies have that of their entry.
        let is_copy = || matches!(part, Selection::Object(i) if in_row(i));
        (own.is_none() && number != read && !is_copy()).then(|| self.name_of(part, registry))
    }

    /// All names that exist only in the file.
    pub(super) fn written_names(&self, registry: &Registry) -> Vec<(Extent, String)> {
        let mut in_row = vec![false; self.objects.len()];
        self.rows().for_each(|row| in_row[row.range()].fill(true));
        let lights = (0..self.lights.len()).map(Extent::Light);
        let parts = lights.chain((0..self.objects.len()).map(Extent::Object));
        parts.filter_map(|part| Some((part, self.written_name(part, |i| in_row[i], registry)?))).collect()
    }

    /// Writes the names that exist only in the file into a copy of the scene.
    pub fn write_names(&self, part: Extent, copy: &mut Scene, registry: &Registry) {
        let names = match part {
            Extent::All => self.written_names(registry),
            one => {
                let name = self.written_name(one, |i| self.row(i).is_some(), registry);
                name.map(|name| (one, name)).into_iter().collect()
            }
        };
        names.into_iter().for_each(|(part, name)| part.set_name(copy, name));
    }

    /// The scene as in a file: unnamed parts get their present names where a reader would give them others.
    #[must_use]
    pub fn named(&self, registry: &Registry) -> Scene {
        let mut named = self.scene.clone();
        self.write_names(Extent::All, &mut named, registry);
        named
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Light, Object};

    #[test]
    fn a_copy_has_the_next_free_number_written_as_in_the_original() {
        let named = |name: &str| Object { name: Some(name.to_owned()), ..Object::default() };
        let scene = Scene { objects: ["B1", "B2", "lamp 2", "7"].map(named).to_vec(), ..Scene::default() };
        for (name, copy) in
            [("B1", "B3"), ("lamp", "lamp 3"), ("lamp 2", "lamp 3"), ("lamp  2", "lamp 3"), ("7", "7 2")]
        {
            assert_eq!(free_name(&scene, name), copy, "{name}");
        }
        let mut names = FreeNames::of(&scene);
        assert_eq!(["B1", "B2", "lamp 2"].map(|name| names.next(name)), ["B3", "B4", "lamp 3"]);
    }

    #[test]
    fn a_scene_names_its_parts_as_a_new_document_of_it_does() {
        let registry = Registry::builtin();
        let object = |object_type: &str, name: Option<&str>| Object {
            object_type: object_type.to_owned(),
            name: name.map(str::to_owned),
            ..Object::default()
        };
        let light = |light_type: &str| Light { light_type: light_type.to_owned(), ..Light::default() };
        let scene = Scene {
            objects: vec![
                object("sphere", None),
                object("cube", None),
                object("sphere", Some("ball")),
                object("sphere", None),
                object("unknown", None),
            ],
            lights: ["point", "sun", "point"].map(light).to_vec(),
            ..Scene::default()
        };
        let document = Document::new(scene.clone());
        let objects = (0..6).map(Selection::Object);
        let parts = objects.chain((0..4).map(Selection::Light)).chain([Selection::Room, Selection::Observer]);
        for part in parts {
            assert_eq!(name_in(&scene, part, &registry), document.name_of(part, &registry), "{part:?}");
        }
        assert_eq!(name_in(&scene, Selection::Object(3), &registry), "Sphere 3");
    }
}
