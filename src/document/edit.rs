//! The changes that can be made to a scene, and their names in the history.

use std::{f64::consts::GOLDEN_RATIO, iter, mem};

use glam::Vec3;

use super::{
    Document, Extent, Selection,
    history::{Patch, rest_of},
    names::{light_type, object_type},
};
use crate::{
    declared::from,
    parameter::Value,
    registry::Registry,
    scene::{
        Comparison, Display, Field, Key, Light, Object, Observer, Part, Scene, SceneSize, Variant,
        check::{self, Change},
        field::{Ids, Kind},
        part::Fields,
    },
    text::capitalised,
};

/// A change of the scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// New values within one part.
    Set {
        /// The part.
        part: Part,
        /// The values; `None` removes one that need not be there.
        values: Vec<(Key, Option<Value>)>,
        /// The subject of the change, for the name of the step, if not one field: "Measured material".
        what: Option<&'static str>,
    },
    /// An object, or the row to which it belongs, becomes a row, or single objects.
    Row {
        /// The index of the object, or of any copy.
        object: usize,
        /// The object with its row as in a file; `None` for single objects like the present copies.
        entry: Option<Box<Object>>,
        /// The subject of the change, for the name of the step: "Number".
        what: &'static str,
    },
    /// All variants, if some are added, removed or reordered, together with the resulting comparison of the
    /// views.
    Views {
        /// The variants.
        variants: Vec<Variant>,
        /// The comparison.
        comparison: Comparison,
        /// The name of the step.
        step: &'static str,
    },
    /// Changes of several lights and objects, as one step: all are made, or none.
    Each {
        /// The changes, each of another part.
        edits: Vec<Edit>,
        /// The name of the step.
        step: String,
    },
}

impl Edit {
    /// Sets a field of a part.
    ///
    /// ```
    /// use lights_camera_models::{document::Edit, scene::{Object, Part}};
    /// let edit = Edit::set(Part::Object(0), Object::size, 1.5);
    /// assert_eq!(edit, Edit::put(Part::Object(0), Object::size, Some(1.5)));
    /// ```
    #[must_use]
    pub fn set(part: Part, key: impl Into<Key>, value: impl Into<Value>) -> Self {
        Self::put(part, key, Some(value))
    }

    /// Sets or removes one value of a part.
    #[must_use]
    pub fn put(part: Part, key: impl Into<Key>, value: Option<impl Into<Value>>) -> Self {
        Self::Set { part, values: vec![(key.into(), value.map(Into::into))], what: None }
    }

    /// Sets a parameter that the type of a light or an object declares.
    #[must_use]
    pub fn parameter(part: Part, name: &'static str, value: impl Into<Value>) -> Self {
        Self::set(part, Key::Own(name), value)
    }

    /// Sets a parameter of a material: of an object, or of a variant.
    #[must_use]
    pub fn material(part: Part, name: &'static str, value: Value) -> Self {
        Self::set(part, Key::Material(name), value)
    }

    /// Sets several parameters of a material. `what` is what they are together.
    #[must_use]
    pub fn materials(part: Part, values: Vec<(&'static str, Value)>, what: &'static str) -> Self {
        let values = values.into_iter().map(|(name, value)| (Key::Material(name), Some(value))).collect();
        Self::Set { part, values, what: Some(what) }
    }

    /// The part that is changed, and its new values, if they are given one by one.
    #[must_use]
    pub fn values(&self) -> (Part, &[(Key, Option<Value>)]) {
        match self {
            Self::Set { part, values, .. } => (*part, values),
            Self::Row { object, .. } => (Part::Object(*object), &[]),
            Self::Views { .. } => (Part::Comparison, &[]),
            Self::Each { .. } => (Part::Scene, &[]),
        }
    }

    /// The part and the value, if one value is set.
    #[must_use]
    pub fn one(&self) -> Option<(Part, Key, Option<&Value>)> {
        match self.values() {
            (part, [(key, value)]) => Some((part, *key, value.as_ref())),
            _ => None,
        }
    }
}

/// Replaces a light or an object. True if its name changes.
pub(super) fn replace<T: Fields>(part: &mut T, new: T) -> bool {
    let (name, old) = (Key::from(Light::name), mem::replace(part, new));
    old.value(name) != part.value(name)
}

impl Edit {
    /// The edit of a whole part.
    fn whole(part: Part, of: &impl Fields) -> Self {
        let mut values = Vec::new();
        of.each(&mut |field, held, _| values.push((Key::Own(field.key), held.value())));
        Self::Set { part, values, what: None }
    }
}

from! {
    Edit;
    SceneSize: |size| Self::whole(Part::Size, &size);
    Observer: |observer| Self::whole(Part::Observer, &observer);
    Display: |display| Self::whole(Part::Display, &display);
    Comparison: |comparison| Self::whole(Part::Comparison, &comparison);
}

/// The insertion of parts into a list.
macro_rules! insert {
    ($($(#[$about:meta])+ $insert:ident: $list:ident, $Part:ident, $of_list:ident;)+) => {
        impl Document {
            $($(#[$about])+
            pub fn $insert(
                &mut self, i: usize, part: $Part, verb: &str, selection: Selection, registry: &Registry,
            ) {
                let label = self.next_label();
                self.labels.$list.insert(i, label);
                self.scene.$list.insert(i, part.clone());
                self.number_parts(Some(registry));
                let patch = Patch::$of_list(i, Vec::new(), vec![(self.labels.$list[i], part)]);
                let name = format!("{verb} {}", self.name_of(Selection::$Part(i), registry));
                self.came_or_went(patch, name, selection);
            })+
        }
    };
}

insert! {
    /// Inserts a light into the list. `verb` begins the name of the step: "Add", "Duplicate".
    insert_light: lights, Light, of_lights;
    /// Inserts an object into the list.
    insert_object: objects, Object, of_objects;
}

impl Document {
    /// Makes a change, if the rules of scenes allow it. `selection` is the current selection.
    ///
    /// # Errors
    /// Returns the reason for a refusal; the scene then stays unchanged.
    pub fn edit(&mut self, edit: Edit, selection: Selection, registry: &Registry) -> Result<(), String> {
        if let Edit::Each { edits, step } = edit {
            return self.edit_each(&edits, step, selection, registry);
        }
        if let Some((Part::Light(i), key, Some(Value::Choice(id)))) = edit.one()
            && key == Light::light_type.into()
        {
            return self.change_light_type(i, id, None, selection, registry);
        }
        let change = self.check(&edit, registry)?;
        let name = self.step_name(&edit, registry);
        self.make(change, name, selection, registry);
        Ok(())
    }

    /// Makes a change that was checked.
    fn make(&mut self, change: Change, name: String, selection: Selection, registry: &Registry) {
        let (part, extent) = match &change {
            Change::Light(i, _) => (Selection::Light(*i), Extent::Light(*i)),
            Change::Object(i, _) => (Selection::Object(*i), Extent::Object(*i)),
            Change::Row(..) => return self.make_row(change, name, selection, registry),
            Change::Rest(rest) => {
                return self.change(name, Extent::Rest, selection, |scene| Extent::Rest.copy(rest, scene));
            }
        };
        self.step(name, extent, selection, Some(registry), |document| {
            let renamed = match change {
                Change::Light(i, light) => replace(&mut document.scene.lights[i], light),
                Change::Object(i, object) => replace(&mut document.scene.objects[i], object),
                Change::Rest(_) | Change::Row(..) => false,
            };
            if renamed {
                document.number_again(part, registry);
            }
        });
    }

    /// The change that an edit makes.
    pub(super) fn changed(&self, edit: &Edit, registry: &Registry) -> Result<Change, String> {
        match edit {
            Edit::Row { object, entry, .. } => return self.row_from(*object, entry.as_deref(), registry),
            Edit::Each { .. } => return Err("Changes of several parts cannot be one of several.".to_owned()),
            Edit::Set { .. } | Edit::Views { .. } => {}
        }
        let (part, values) = edit.values();
        if let Part::Object(i) = part
            && let Some(row) = self.scene.row(i)
        {
            return self.row_with(row, i, values, registry);
        }
        let values = values.iter().cloned();
        let none = |what: &str| format!("There is no such {what}.");
        let mut good = true;
        let change = match part {
            Part::Light(i) => {
                let mut light = self.scene.lights.get(i).cloned().ok_or("there is no such light")?;
                let room = self.scene.scene_size;
                values.for_each(|(key, value)| good &= light.set(key, value, registry, room));
                Change::Light(i, light)
            }
            Part::Object(i) => {
                let mut object = self.scene.objects.get(i).cloned().ok_or("there is no such object")?;
                values.for_each(|(key, value)| good &= object.set(key, value, registry));
                Change::Object(i, object)
            }
            _ => {
                let mut rest = rest_of(&self.scene);
                if let Edit::Views { variants, comparison, .. } = edit {
                    (rest.variants, rest.comparison) = (variants.clone(), *comparison);
                }
                let fields = rest.part_mut(part).ok_or_else(|| none("variant"))?;
                values.for_each(|(key, value)| good &= fields.put(key, value));
                if let Part::Variant(i) = part {
                    self.rename_base(i, &mut rest)?;
                }
                Change::Rest(Box::new(rest))
            }
        };
        if good { Ok(change) } else { Err(none("field")) }
    }

    /// Lets the variants that are based on one follow a change of its name.
    fn rename_base(&self, i: usize, rest: &mut Scene) -> Result<(), String> {
        let (before, after) = (&self.scene.variants[i].name, rest.variants[i].name.clone());
        if before.is_none() || *before == after {
            return Ok(());
        }
        for other in rest.variants.iter_mut().filter(|other| other.based_on == *before) {
            if after.is_none() {
                return Err(
                    "Other views are based on this one by name, so its name must not be empty.".to_owned()
                );
            }
            other.based_on.clone_from(&after);
        }
        Ok(())
    }

    /// The name of the step of an edit: "Hide Sphere 1", "Size of Sphere 1".
    fn step_name(&self, edit: &Edit, registry: &Registry) -> String {
        let (what, (part, values)) = match edit {
            Edit::Set { what, .. } => (*what, edit.values()),
            Edit::Views { step, .. } => return (*step).to_owned(),
            Edit::Each { step, .. } => return step.clone(),
            Edit::Row { object, what, .. } => {
                return format!("{what} of {}", self.name_to_edit(*object, registry));
            }
        };
        let Some(fields) = self.scene.part(part) else { return String::new() };
        let differs = |(key, value): &&(Key, Option<Value>)| fields.value(*key) != *value;
        let Some((key, value)) = values.iter().find(differs).or(values.first()) else { return String::new() };
        let field = fields.field(key.name()).filter(|_| matches!(key, Key::Own(_)));
        let parameter = || match key {
            Key::Own(name) => fields.parameters(registry).iter().find(|p| p.name == *name),
            Key::Material(name) => registry.material_parameter(name),
        };
        let label = what.or(field.map(Field::label)).or_else(|| parameter().map(|p| p.label));
        let label = capitalised(label.unwrap_or(key.name()));
        let name = match part {
            Part::Object(i) => self.name_to_edit(i, registry),
            part => self.name_of_part(part, registry),
        };
        match (part, field.map(|field| field.kind), value) {
            (_, Some(Kind::Flag(words)), Some(on)) => {
                format!("{} {name}", words[usize::from(*on == Value::flag(true))])
            }
            (Part::Scene, Some(Kind::Id(ids)), Some(Value::Choice(id))) => {
                let listed = ids.find(registry, id);
                format!("{label}: {}", listed.map_or(id.as_ref(), |listed| listed.name))
            }
            (Part::Object(_), Some(Kind::Id(Ids::ObjectType)), Some(Value::Choice(id))) => {
                format!("{}: {}", part.step(&label, &name), object_type(id, registry))
            }
            _ => part.step(&label, &name),
        }
    }

    /// Changes the type of a light and adds everything that the new type requires. `place` is the position
    /// and direction for a light without them; by default, the light is in the middle of the room and shines
    /// down.
    ///
    /// # Errors
    /// Returns the reason for a refusal; the scene then stays unchanged.
    pub fn change_light_type(
        &mut self,
        i: usize,
        id: &str,
        place: Option<(Vec3, Vec3)>,
        selection: Selection,
        registry: &Registry,
    ) -> Result<(), String> {
        self.check(&Edit::set(Part::Light(i), Light::light_type, id), registry)?;
        let part = self.name_of(Selection::Light(i), registry);
        let name = format!("{}: {}", Part::Light(i).step("Type", &part), light_type(id, registry));
        self.step(name, Extent::Light(i), selection, Some(registry), |document| {
            let room = document.scene.scene_size;
            let light = &mut document.scene.lights[i];
            let has_place = light.position.is_some();
            if let Some((position, direction)) = place.filter(|(_, d)| check::direction(*d).is_ok()) {
                light.position.get_or_insert(position);
                light.direction.get_or_insert(direction);
            }
            light.set(Light::light_type.into(), Some(id.into()), registry, room);
            if let Some(position) = light.position.filter(|_| !has_place) {
                // Distinct heights, however many other lights are in the way.
                let height = |k: usize| (k as f64 * GOLDEN_RATIO).fract() as f32 * room.height;
                let column =
                    (1..document.scene.objects.len() + 3).map(|k| (0.5 * room.corner()).with_y(height(k)));
                let is_free =
                    |p: &Vec3| document.allows(&Edit::set(Part::Light(i), Light::position, *p), registry);
                let free = iter::once(position).chain(column).find(is_free);
                document.scene.lights[i].position = free;
            }
        });
        Ok(())
    }

    /// Removes a light, an object, or the row to which it belongs.
    pub fn remove(&mut self, part: Selection, registry: &Registry) {
        let name = match part {
            Selection::Object(i) => self.name_to_edit(i, registry),
            part => self.name_of(part, registry),
        };
        let patch = match part {
            Selection::Light(i) if i < self.scene.lights.len() => {
                let gone = (self.labels.lights.remove(i), self.scene.lights.remove(i));
                Patch::of_lights(i, vec![gone], Vec::new())
            }
            Selection::Object(i) if i < self.scene.objects.len() => {
                let range = self.scene.row(i).map_or(i..i + 1, |row| row.range());
                let labels = self.labels.objects.drain(range.clone());
                let gone = labels.zip(self.scene.objects.drain(range.clone())).collect();
                Patch::of_objects(range.start, gone, Vec::new())
            }
            _ => return,
        };
        self.came_or_went(patch, format!("Delete {name}"), part);
    }

    /// Records that a part was added or removed, as a separate step.
    fn came_or_went(&mut self, patch: Patch, name: String, selection: Selection) {
        self.end_gesture();
        self.touch(Extent::All, true);
        self.history.record(name, self.gesture, patch, selection);
    }
}
