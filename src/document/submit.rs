//! Changes of the scene by systems: checked part by part, and recorded as one step while they follow each
//! other.

use std::collections::HashSet;

use super::{
    Document, Extent, Patch, Selection,
    history::{Label, Labels, rest_of},
};
use crate::{
    registry::Registry,
    scene::{Observer, Part, Scene, check, error::Problem},
    text::sentence,
};

/// The gesture shared by all changes of systems.
const SYSTEMS: u64 = u64::MAX;
/// The name of the step.
const BY_SYSTEM: &str = "Change by a system";

impl Document {
    /// Adopts the changes of a system to these parts, if the rules of scenes allow it. Consecutive changes of
    /// this kind are one step: a system may change something in every frame.
    ///
    /// # Errors
    /// Returns the reason for a refusal; the scene then stays unchanged.
    pub fn submit(
        &mut self,
        scene: &Scene,
        parts: &[Extent],
        selection: Selection,
        registry: &Registry,
    ) -> Result<(), String> {
        self.adopt(scene, parts, registry, |document| {
            if parts.contains(&Extent::All) {
                document.replace(BY_SYSTEM, selection, scene.clone(), registry);
                return;
            }
            let mut all = Patch::default();
            for part in parts {
                all.join(
                    document.patch(*part, Some(registry), |document| part.copy(scene, &mut document.scene)),
                );
            }
            document.history.record(BY_SYSTEM.to_owned(), document.gesture, all, selection);
        })
    }

    /// Adopts a scene in which systems removed these lights and objects, given by their former positions,
    /// added others at the ends of the lists, or changed the types of some, as [`submit`](Self::submit) does.
    /// The others keep their names.
    ///
    /// # Errors
    /// Returns the reason for a refusal; the scene then stays unchanged.
    pub fn submit_lists(
        &mut self,
        scene: &Scene,
        removed: &[Extent],
        selection: Selection,
        registry: &Registry,
    ) -> Result<(), String> {
        self.adopt(scene, &[Extent::All], registry, |document| {
            document.step(BY_SYSTEM.to_owned(), Extent::All, selection, Some(registry), |document| {
                let removed: HashSet<_> = removed.iter().copied().collect();
                let stays = |part: Extent| !removed.contains(&part);
                let lights = kept(
                    &document.labels.lights,
                    |i| stays(Extent::Light(i)),
                    |i, j| Some(document.scene.lights[i].light_type == scene.lights.get(j)?.light_type),
                );
                let objects = kept(
                    &document.labels.objects,
                    |i| stays(Extent::Object(i)),
                    |i, j| Some(document.scene.objects[i].object_type == scene.objects.get(j)?.object_type),
                );
                (document.scene, document.labels) = (scene.clone(), Labels { lights, objects });
            });
        })
    }

    /// Makes a change of systems, if the rules of scenes allow it.
    fn adopt(
        &mut self,
        scene: &Scene,
        parts: &[Extent],
        registry: &Registry,
        change: impl FnOnce(&mut Self),
    ) -> Result<(), String> {
        if let Some(problem) = self.problem_in(scene, parts, registry) {
            return Err(sentence(&format!("A change to a component was refused: {problem}")));
        }
        let gesture = std::mem::replace(&mut self.gesture, SYSTEMS);
        change(self);
        self.gesture = gesture;
        Ok(())
    }

    /// The first problem of the parts in which a scene may differ from this one.
    fn problem_in(&self, scene: &Scene, parts: &[Extent], registry: &Registry) -> Option<Problem> {
        if (scene.lights.len(), scene.objects.len()) != (self.lights.len(), self.objects.len()) {
            return check::scene(scene, registry).into_iter().next();
        }
        let rest = |scene: &Scene| Scene { observer: Observer::default(), ..rest_of(scene) };
        if parts.iter().any(|part| matches!(part, Extent::All | Extent::Rest)) && rest(scene) != rest(self) {
            // Room and models affect everything.
            return check::scene(scene, registry).into_iter().next();
        }
        let mut check = check::Parts::of(scene, registry);
        let mut problems = |part: &Extent| match *part {
            Extent::Rest if scene.observer == self.observer => Vec::new(),
            Extent::Rest => check.problems(Part::Observer),
            Extent::Light(i) if scene.lights.get(i) == self.lights.get(i) => Vec::new(),
            Extent::Light(i) => check.problems(Part::Light(i)),
            Extent::Object(i) if scene.objects.get(i) == self.objects.get(i) => Vec::new(),
            Extent::Object(i) => check.problems(Part::Object(i)),
            Extent::All => Vec::new(),
        };
        if !parts.contains(&Extent::All) {
            return parts.iter().flat_map(problems).next();
        }
        let lights = (0..scene.lights.len()).map(Extent::Light);
        let objects = (0..scene.objects.len()).map(Extent::Object);
        lights.chain(objects).chain([Extent::Rest]).flat_map(|part| problems(&part)).next()
    }
}

/// The labels of the parts that stay. `same_type` compares the type of a part at its old index with that at
/// its new one, if there is one: a part of another type gets another number.
fn kept(
    labels: &[Label],
    stays: impl Fn(usize) -> bool,
    same_type: impl Fn(usize, usize) -> Option<bool>,
) -> Vec<Label> {
    (0..labels.len())
        .filter(|i| stays(*i))
        .enumerate()
        .map_while(|(j, i)| {
            let number = if same_type(i, j)? { labels[i].number } else { 0 };
            Some(Label { number, ..labels[i] })
        })
        .collect()
}
