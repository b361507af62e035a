//! Edits of rows: of all copies at once, by their entry.

use std::ops::Range;

use glam::Vec3;

use super::{
    Document, Extent, Selection,
    edit::replace,
    history::{Label, Patch},
};
use crate::{
    parameter::Value,
    registry::Registry,
    scene::{
        Key, MAX_OBJECTS, Object, Repetition,
        check::Change,
        error::{Path, Problem},
        rows::{Row, copies, entry_name},
    },
    text::{capitalised, sentence},
};

impl Document {
    /// The name of an object, or of the row that is edited in its place.
    #[must_use]
    pub fn name_to_edit(&self, object: usize, registry: &Registry) -> String {
        match self.scene.row(object) {
            None => self.name_of(Selection::Object(object), registry),
            Some(Row { entry: Object { name: Some(name), .. }, .. }) => name.clone(),
            Some(row) => format!("the row of {}", self.name_of(Selection::Object(row.first), registry)),
        }
    }

    /// The change that makes a row of an object, other copies of a row, or single objects of its copies.
    pub(super) fn row_from(
        &self,
        object: usize,
        entry: Option<&Object>,
        registry: &Registry,
    ) -> Result<Change, String> {
        if object >= self.scene.objects.len() {
            return Err("There is no such object.".to_owned());
        }
        let row = self.scene.row(object);
        let range = row.map_or(object..object + 1, |row| row.range());
        let objects = match (entry, row) {
            (Some(entry), _) => copies(entry, registry).map_err(|problems| said(&problems))?,
            (None, None) => {
                let name = self.name_of(Selection::Object(object), registry);
                return Err(format!("{name} is a single object already."));
            }
            (None, Some(_)) => {
                let single = |copy: &Object| Object { repeat: Repetition::None, ..copy.clone() };
                self.scene.objects[range.clone()].iter().map(single).collect()
            }
        };
        let count = self.scene.objects.len() - range.len() + objects.len();
        if count > MAX_OBJECTS {
            return Err(format!("The scene would have {count} objects, but has at most {MAX_OBJECTS}."));
        }
        Ok(Change::Row(range, objects))
    }

    /// The change that gives the copies of a row these values, which one of them was given.
    pub(super) fn row_with(
        &self,
        row: Row,
        object: usize,
        values: &[(Key, Option<Value>)],
        registry: &Registry,
    ) -> Result<Change, String> {
        let copy = &self.scene.objects[object];
        let mut entry = row.entry.clone();
        for (key, value) in values {
            if let Some(variable) = row.variables(registry).find(|variable| variable.key == *key) {
                let label = capitalised(variable.declared.label());
                return Err(format!("{label} differs from copy to copy: change it under “Row”."));
            }
            let value = match value {
                // All move as one of them does.
                Some(Value::Triple(p)) if *key == Object::position.into() => {
                    Some(moved(entry.position, copy.position, (*p).into()).into())
                }
                Some(Value::Choice(name)) if *key == Object::name.into() => {
                    Some(entry_name(name.trim(), (object - row.first) as u32).into())
                }
                value => value.clone(),
            };
            if !entry.set(*key, value, registry) {
                return Err("There is no such field.".to_owned());
            }
        }
        self.row_from(object, Some(&entry), registry)
    }

    /// Replaces objects by the copies of a row, as one step.
    pub(super) fn make_row(
        &mut self,
        change: Change,
        name: String,
        selection: Selection,
        registry: &Registry,
    ) {
        let Change::Row(range, objects) = change else { return };
        let old = &self.scene.objects[range.clone()];
        let alike = |(old, new): (&Object, &Object)| old.object_type == new.object_type;
        let patch = if old.len() == objects.len() && old.iter().zip(&objects).all(alike) {
            Patch::of_each(range.zip(objects).map(|(i, object)| {
                self.patch(Extent::Object(i), Some(registry), |document| {
                    if replace(&mut document.scene.objects[i], object) {
                        document.number_again(Selection::Object(i), registry);
                    }
                })
            }))
        } else {
            self.splice_objects(range, objects, registry)
        };
        self.history.record(name, self.gesture, patch, selection);
    }

    /// Replaces objects by others, of which the first keep the labels.
    fn splice_objects(&mut self, range: Range<usize>, objects: Vec<Object>, registry: &Registry) -> Patch {
        let (start, count) = (range.start, objects.len());
        let known = self.labels.objects[range.clone()].to_vec();
        let mut labels: Vec<Label> = Vec::with_capacity(count);
        for (k, object) in objects.iter().enumerate() {
            let old = self.scene.objects[range.clone()].get(k);
            let alike = old.is_some_and(|old| old.object_type == object.object_type);
            let known = known.get(k).copied();
            labels.push(known.map_or_else(
                || self.next_label(),
                |label| if alike { label } else { Label { number: 0, ..label } },
            ));
        }
        self.labels.objects.splice(range.clone(), labels);
        let gone: Vec<_> = self.scene.objects.splice(range, objects).collect();
        self.number_parts(Some(registry));
        self.touch(Extent::All, true);
        let come = start..start + count;
        let new =
            self.labels.objects[come.clone()].iter().copied().zip(self.scene.objects[come].iter().cloned());
        Patch::of_objects(start, known.into_iter().zip(gone).collect(), new.collect())
    }

    /// The reason why copies are refused.
    pub(super) fn refused_copy(&self, row: &Range<usize>, problem: &Problem, registry: &Registry) -> String {
        let copy = problem.path.index_in("objects").map_or(0, |i| i - row.start) + 1;
        let value = Path::of(problem.path.segments().get(2..).unwrap_or_default().to_vec());
        let name = self.name_to_edit(row.start, registry);
        format!("Copy {copy} of {name}: {value} {}.", problem.message())
    }
}

/// The first of the problems of a row, as a sentence.
fn said(problems: &[Problem]) -> String {
    problems.first().map_or_else(String::new, |problem| sentence(&problem.to_string()))
}

/// The position of the entry if a copy moves from one place to another.
fn moved(entry: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    // Without the noise of differences, so that the file has the numbers that were typed.
    let along = |axis: usize| {
        let [entry, from, to] = [entry, from, to].map(|v| f64::from(v[axis]));
        ((entry + (to - from)) * 1e6).round() / 1e6
    };
    if from == to { entry } else { Vec3::new(along(0) as f32, along(1) as f32, along(2) as f32) }
}
