//! Changes of the scene by systems: checked part by part, and recorded as one step as long as they follow each other.

use super::{Document, Extent, Patch, Selection, history::rest_of};
use crate::{
    registry::Registry,
    scene::{Observer, Scene, check, error::Problem},
    text::sentence,
};

/// The gesture of all that systems change.
const SYSTEMS: u64 = u64::MAX;
/// The name of the step.
const BY_SYSTEM: &str = "Change by a system";
impl Document {
    /// Adopts what a system changed in these parts, if the rules of scenes allow it. All such changes that follow each
    /// other are one step: a system may change something in every frame.
    ///
    /// # Errors
    /// Why it is refused; the scene stays as it is.
    pub fn submit(
        &mut self,
        scene: &Scene,
        parts: &[Extent],
        selection: Selection,
        registry: &Registry,
    ) -> Result<(), String> {
        self.adopt(scene, parts, registry, |document| {
            if parts.contains(&Extent::All) {
                document.replace(BY_SYSTEM, selection, scene.clone());
                return;
            }
            let mut all = Patch::default();
            for part in parts {
                // A part that is changed twice is one of one place.
                let _ = all.join(document.patch(*part, |document| part.copy(scene, &mut document.scene)));
            }
            document.history.record(BY_SYSTEM.to_owned(), document.gesture, all, selection);
        })
    }

    /// Adopts a scene in which systems removed these lights and objects, by their places before, added others at the
    /// ends of the lists, or gave some another type; as [`submit`](Self::submit) does. The others keep their names.
    ///
    /// # Errors
    /// Why it is refused; the scene stays as it is.
    pub fn submit_lists(
        &mut self,
        scene: &Scene,
        removed: &[Extent],
        selection: Selection,
        registry: &Registry,
    ) -> Result<(), String> {
        self.adopt(scene, &[Extent::All], registry, |document| {
            document.change_parts(BY_SYSTEM.to_owned(), selection, registry, |document, names| {
                let place = |part: &Extent| match *part {
                    Extent::Light(i) => [Some(i), None],
                    Extent::Object(i) => [None, Some(i)],
                    Extent::Rest | Extent::All => [None, None],
                };
                let stay = |list: usize, count: usize| {
                    let mut stays = vec![true; count];
                    for i in removed.iter().filter_map(|part| place(part)[list]).filter(|i| *i < count) {
                        stays[i] = false;
                    }
                    (0..count).filter(move |i| stays[*i])
                };
                let Self { scene: old, ids, .. } = document;
                let (lights, objects): (Vec<_>, Vec<_>) =
                    (stay(0, old.lights.len()).collect(), stay(1, old.objects.len()).collect());
                ids.lights = lights.iter().map(|i| ids.lights[*i]).collect();
                ids.objects = objects.iter().map(|i| ids.objects[*i]).collect();
                // One of another type has another number.
                names.lights = (lights.iter().zip(&scene.lights))
                    .map(|(i, new)| {
                        names.lights[*i].take().filter(|_| old.lights[*i].light_type == new.light_type)
                    })
                    .collect();
                names.objects = (objects.iter().zip(&scene.objects))
                    .map(|(i, new)| {
                        names.objects[*i].take().filter(|_| old.objects[*i].object_type == new.object_type)
                    })
                    .collect();
                names.lights.resize(scene.lights.len(), None);
                names.objects.resize(scene.objects.len(), None);
                document.scene = scene.clone();
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
            return Err(sentence(&format!("A change of a component was refused: {problem}")));
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
            // Room and models have a say in everything.
            return check::scene(scene, registry).into_iter().next();
        }
        let mut check = check::Parts::of(scene, registry);
        let mut problems = |part: &Extent| match *part {
            Extent::Rest if scene.observer == self.observer => Vec::new(),
            Extent::Rest => check.observer(),
            Extent::Light(i) if scene.lights.get(i) == self.lights.get(i) => Vec::new(),
            Extent::Light(i) => check.light(i),
            Extent::Object(i) if scene.objects.get(i) == self.objects.get(i) => Vec::new(),
            Extent::Object(i) => check.object(i),
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
