//! Changes of several lights and objects at once: edits, copies and removals, each of them one step.
//!
//! A step costs what it changes. Beside that, a scene is copied only when the length of a list changes.

use std::{
    collections::{BTreeMap, HashSet},
    mem,
};

use super::{Document, Edit, Extent, PartId, Selection, history::Patch};
use crate::{
    registry::Registry,
    scene::{
        Key, Light, Object, Part,
        check::{self, Change},
    },
};

/// Maximum number of parts that followers of a document are told one by one.
const TOLD: usize = 16;

/// Lights and objects as they would be, by their indices.
#[derive(Default)]
pub(super) struct Changed {
    lights: BTreeMap<usize, Light>,
    objects: BTreeMap<usize, Object>,
}

impl Document {
    /// The parts after these edits, or the reason why the rules of scenes refuse one of them.
    pub(super) fn check_each(&self, edits: &[Edit], registry: &Registry) -> Result<Changed, String> {
        let mut changed = Changed::default();
        for edit in edits {
            match self.changed(edit, registry)? {
                Change::Light(i, light) => _ = changed.lights.insert(i, light),
                Change::Object(i, object) => _ = changed.objects.insert(i, object),
                Change::Row(range, objects) if range.len() == objects.len() => {
                    changed.objects.extend(range.zip(objects));
                }
                Change::Row(..) | Change::Rest(_) => {
                    return Err("Only values of lights and objects can be changed together.".to_owned());
                }
            }
        }
        // Other values of a part follow when a type or a model is chosen.
        let keys: HashSet<Key> = edits.iter().flat_map(|edit| edit.values().1).map(|(key, _)| *key).collect();
        let materials = keys.iter().any(|key| matches!(key, Key::Material(_)));
        let problems = check::each(&self.scene, &changed.lights, &changed.objects, materials, registry);
        for problem in &problems {
            let object = problem.path.index_in("objects").map(Part::Object);
            let Some(part) = object.or(problem.path.index_in("lights").map(Part::Light)) else { continue };
            if let Some(key) = keys.iter().find(|key| key.within(part) == problem.path) {
                let change = match part {
                    Part::Light(i) => changed.lights.get(&i).map(|light| Change::Light(i, light.clone())),
                    Part::Object(i) => changed.objects.get(&i).map(|o| Change::Object(i, o.clone())),
                    _ => None,
                };
                let said =
                    change.and_then(|change| self.refusal(part, Some(*key), &change, problem, registry));
                return Err(said.unwrap_or_else(|| format!("{problem}.")));
            }
        }
        Ok(changed)
    }

    /// Makes edits of several parts, as one step.
    pub(super) fn edit_each(
        &mut self,
        edits: &[Edit],
        step: String,
        selection: Selection,
        registry: &Registry,
    ) -> Result<(), String> {
        let Changed { lights, objects } = self.check_each(edits, registry)?;
        let (mut renamed, mut retyped) = (Vec::new(), false);
        macro_rules! replaced {
            ($list:ident, $type:ident, $Part:path) => {{
                let each = $list.into_iter().map(|(i, new)| {
                    let label = self.labels.$list[i];
                    let old = mem::replace(&mut self.scene.$list[i], new);
                    let new = &self.scene.$list[i];
                    if old.$type != new.$type {
                        (self.labels.$list[i].number, retyped) = (0, true);
                    }
                    if old.name != new.name {
                        renamed.push($Part(i));
                    }
                    (i, (label, old))
                });
                each.collect::<Vec<_>>()
            }};
        }
        let old_lights = replaced!(lights, light_type, Selection::Light);
        let old_objects = replaced!(objects, object_type, Selection::Object);
        if retyped {
            self.number_parts(Some(registry));
        }
        renamed.into_iter().for_each(|part| self.number_again(part, registry));
        let lights = old_lights
            .into_iter()
            .map(|(i, old)| Patch::of_light(i, old, (self.labels.lights[i], self.scene.lights[i].clone())));
        let objects = old_objects.into_iter().map(|(i, old)| {
            Patch::of_object(i, old, (self.labels.objects[i], self.scene.objects[i].clone()))
        });
        let patch = Patch::of_each(lights.chain(objects));
        match patch.ones().filter(|ones| ones.len() <= TOLD) {
            Some(ones) => ones.into_iter().for_each(|one| self.touch(one, false)),
            None => self.touch(Extent::All, retyped),
        }
        self.history.record(step, self.gesture, patch, selection);
        Ok(())
    }

    /// Adds lights and objects at the ends of the lists, as one step with this name.
    pub fn append(
        &mut self,
        lights: Vec<Light>,
        objects: Vec<Object>,
        step: String,
        selection: Selection,
        registry: &Registry,
    ) {
        self.end_gesture();
        self.step(step, Extent::All, selection, Some(registry), |document| {
            document.scene.lights.extend(lights);
            document.scene.objects.extend(objects);
        });
        self.end_gesture();
    }

    /// Removes lights and objects, as one step with this name.
    pub fn remove_each(
        &mut self,
        parts: impl IntoIterator<Item = Selection>,
        step: String,
        selection: Selection,
        registry: &Registry,
    ) {
        self.end_gesture();
        let gone: HashSet<PartId> = parts.into_iter().filter_map(|part| self.id_of(part)).collect();
        let others = self.others().clone();
        let patch = self.patch(Extent::All, Some(registry), |document| {
            macro_rules! remove {
                ($list:ident) => {
                    let labels = mem::take(&mut document.labels.$list);
                    let parts = mem::take(&mut document.scene.$list);
                    let left = labels.into_iter().zip(parts).filter(|(label, _)| !gone.contains(&label.id));
                    (document.labels.$list, document.scene.$list) = left.unzip();
                };
            }
            remove!(lights);
            remove!(objects);
        });
        // Undoing selects again what was selected before.
        self.history.set_others(others);
        self.history.record(step, self.gesture, patch, selection);
        self.prune_others();
        self.end_gesture();
    }
}
