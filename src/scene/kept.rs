//! Values of materials that must change with the model, since models may give a parameter different ranges.

use std::cell::OnceCell;

use super::{Part, Scene, check::Declared};
use crate::registry::Registry;

impl Scene {
    /// Replaces every number of a material that its object's model does not allow by the nearest one that it
    /// allows. Returns one sentence for each.
    pub fn bring_into_range(&mut self, registry: &Registry) -> Vec<String> {
        // Most scenes need none.
        let places = OnceCell::new();
        let entry = |scene: &Self, i: usize| places.get_or_init(|| scene.places_in_file())[i];
        (0..self.objects.len()).flat_map(|i| self.bring_one_into_range(i, &entry, registry)).collect()
    }

    /// [`bring_into_range`](Self::bring_into_range) for one object.
    pub(super) fn bring_object_into_range(&mut self, i: usize, registry: &Registry) -> Vec<String> {
        self.bring_one_into_range(i, &|scene: &Self, i| scene.place_in_file(i).0, registry)
    }

    /// Brings the material of one object into range; `entry` gives the index in a file of an object.
    fn bring_one_into_range(
        &mut self,
        i: usize,
        entry: &dyn Fn(&Self, usize) -> usize,
        registry: &Registry,
    ) -> Vec<String> {
        let (mut said, mut changes) = (Vec::new(), Vec::new());
        let object = &self.objects[i];
        for (name, value) in &object.material.0 {
            let declared = Declared::of(registry, self, object, name);
            let Err(Some(rule)) = declared.refusing(value) else { continue };
            let Some(nearest) = declared.nearest(value) else { continue };
            let place = Part::Object(entry(self, i)).path().key("material").key(name.clone());
            let (model, rule) = (self.model_of(object), rule.rule());
            said.push(format!("{place} is {value}, but for {model} it must be {rule}: {nearest} is used"));
            changes.push((name.clone(), nearest));
        }
        self.objects[i].material.0.extend(changes);
        said
    }
}
