//! The parts of a scene that another version of it still has.

use super::{
    Document, Extent, Selection, difference,
    history::{Label, Labels},
};
use crate::{
    registry::Registry,
    scene::{Light, Object, Scene},
};

impl Document {
    /// Replaces the scene by another version of it, as one step: parts that are equal, or have the same name, or else the
    /// same place, keep their ids, and names that a file had to give them are no names of their own.
    pub fn replace(
        &mut self,
        name: impl Into<String>,
        selection: Selection,
        mut scene: Scene,
        registry: &Registry,
    ) {
        let old = self.named(registry);
        let lights = matched([&self.lights, &old.lights], &scene.lights, |l: &Light| l.name.as_deref());
        let objects = matched([&self.objects, &old.objects], &scene.objects, |o: &Object| o.name.as_deref());
        let lights: Vec<_> = (lights.into_iter().zip(&mut scene.lights))
            .map(|(place, new)| {
                let i = place?;
                let (known, label) = (&self.lights[i], self.labels.lights[i]);
                let retyped = known.light_type != new.light_type;
                let given = old.lights[i].name.as_ref().filter(|_| known.name.is_none() && !retyped);
                new.name.take_if(|name| Some(&*name) == given);
                Some(Label { number: if retyped { 0 } else { label.number }, ..label })
            })
            .collect();
        let objects: Vec<_> = (objects.into_iter().zip(&mut scene.objects))
            .map(|(place, new)| {
                let i = place?;
                let (known, label) = (&self.objects[i], self.labels.objects[i]);
                let retyped = known.object_type != new.object_type;
                let given = old.objects[i].name.as_ref().filter(|_| known.name.is_none() && !retyped);
                new.name.take_if(|name| Some(&*name) == given);
                Some(Label { number: if retyped { 0 } else { label.number }, ..label })
            })
            .collect();
        let labels = Labels {
            lights: lights.into_iter().map(|l| l.unwrap_or_else(|| self.next_label())).collect(),
            objects: objects.into_iter().map(|l| l.unwrap_or_else(|| self.next_label())).collect(),
        };
        self.step(name.into(), Extent::All, selection, None, |document| {
            (document.scene, document.labels) = (scene, labels);
        });
    }
}

/// The places in the old list of the parts of a new one: of equal parts, else of those with the same name, else of
/// those in the same place. The old list stands there twice: as it is, and as a file has it.
fn matched<T: PartialEq>(
    [old, named]: [&[T]; 2],
    new: &[T],
    name: impl Fn(&T) -> Option<&str>,
) -> Vec<Option<usize>> {
    let equal = |i: usize, j: usize| old[i] == new[j] || named[i] == new[j];
    let [gone, middle] = difference([old.len(), new.len()], equal);
    let mut found = vec![None; new.len()];
    let mut free: Vec<bool> = vec![false; old.len()];
    free[gone.clone()].fill(true);
    (0..gone.start).for_each(|i| found[i] = Some(i));
    (middle.end..new.len()).zip(gone.end..old.len()).for_each(|(i, j)| found[i] = Some(j));
    // In a file of thousands of new parts, place decides.
    const MOST: usize = 2000;
    let few = middle.len() <= MOST && gone.len() <= MOST;
    let called_alike = |i: usize, j: usize| name(&new[j]).is_some() && name(&named[i]) == name(&new[j]);
    let same: [&dyn Fn(usize, usize) -> bool; 2] = [&equal, &called_alike];
    for same in same.into_iter().filter(|_| few) {
        for j in middle.clone() {
            if found[j].is_none()
                && let Some(i) = gone.clone().find(|i| free[*i] && same(*i, j))
            {
                (found[j], free[i]) = (Some(i), false);
            }
        }
    }
    for i in middle {
        if found[i].is_none() && free.get(i) == Some(&true) {
            (found[i], free[i]) = (Some(i), false);
        }
    }
    found
}
