//! Matches the parts of a scene with those of another version.

use super::{
    Document, Extent, Selection, difference,
    history::{Label, Labels},
};
use crate::{
    registry::Registry,
    scene::{Light, Object, Scene},
};

impl Document {
    /// Replaces the scene by another version of it, as one step. Parts that are equal, or have the same name,
    /// or else the same position, keep their ids; names that a file had to give them do not count as names.
    pub fn replace(
        &mut self,
        name: impl Into<String>,
        selection: Selection,
        mut scene: Scene,
        registry: &Registry,
    ) {
        let old = self.named(registry);
        let lights = relabelled(
            [&self.lights, &old.lights],
            &self.labels.lights,
            &mut scene.lights,
            |l: &Light| &l.light_type,
            |l: &mut Light| &mut l.name,
            |l: &Light| l.name.as_deref(),
        );
        let objects = relabelled(
            [&self.objects, &old.objects],
            &self.labels.objects,
            &mut scene.objects,
            |o: &Object| &o.object_type,
            |o: &mut Object| &mut o.name,
            |o: &Object| o.name.as_deref(),
        );
        let labels = Labels {
            lights: lights.into_iter().map(|l| l.unwrap_or_else(|| self.next_label())).collect(),
            objects: objects.into_iter().map(|l| l.unwrap_or_else(|| self.next_label())).collect(),
        };
        self.step(name.into(), Extent::All, selection, None, |document| {
            (document.scene, document.labels) = (scene, labels);
        });
    }
}

/// The labels of the parts of a new list that are parts of the old one, given as it is and as in a file. A
/// part of another type needs another number; a name that only the file gave is removed from the new part.
fn relabelled<T: PartialEq>(
    old: [&[T]; 2],
    labels: &[Label],
    new: &mut [T],
    type_of: impl Fn(&T) -> &str,
    name_of: impl Fn(&mut T) -> &mut Option<String>,
    name: impl Fn(&T) -> Option<&str>,
) -> Vec<Option<Label>> {
    let places = matched(old, new, &name);
    let [plain, named] = old;
    let relabel = |(place, new): (Option<usize>, &mut T)| {
        let i = place?;
        let retyped = type_of(&plain[i]) != type_of(new);
        let given = name(&named[i]).filter(|_| name(&plain[i]).is_none() && !retyped);
        name_of(new).take_if(|name| Some(name.as_str()) == given);
        Some(Label { number: if retyped { 0 } else { labels[i].number }, ..labels[i] })
    };
    places.into_iter().zip(new).map(relabel).collect()
}

/// The positions in the old list of the parts of a new one: equal parts, else those with the same name, else
/// those in the same position. The old list is given twice: as it is, and as in a file.
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
    // In a file of thousands of new parts, the position decides.
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
