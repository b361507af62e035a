//! The document: the one writer of the scene. Whatever wants to change the scene submits it here, where it is checked,
//! recorded for undoing, and becomes the new value. Parts have ids that outlive changes of their place in the list.

use std::ops::Deref;

use crate::{
    registry::Registry,
    scene::{Light, Object, Scene, check, error::Problem},
};

mod edit;
mod history;
pub mod limits;
pub mod names;
mod rules;

pub use edit::{Edit, LightField, ObjectField};
use history::{History, Ids, Patch, rest_of};

/// The gesture of all that systems change.
const SYSTEMS: u64 = u64::MAX;

/// A light or an object for as long as the document is open: it keeps its id when others come and go, when it is
/// removed and comes back by undoing, and when the file is read again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PartId(u64);

/// A part of the scene, by its place in it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Selection {
    /// The room and the display: what is there when nothing in particular is selected.
    #[default]
    Room,
    /// The observer.
    Observer,
    /// A light, by its index in the scene.
    Light(usize),
    /// An object, by its index in the scene.
    Object(usize),
}

/// The part of a scene that a change is confined to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Everything but lights and objects.
    Rest,
    /// One light.
    Light(usize),
    /// One object.
    Object(usize),
    /// Any of it; which lights and objects there are stays.
    All,
}

/// A scene and the way to it.
///
/// It reads as the [`Scene`] that it holds.
#[derive(Clone, Debug)]
pub struct Document {
    scene: Scene,
    ids: Ids,
    /// The next id.
    next: u64,
    /// The scene as it is in the file.
    saved: Scene,
    history: History,
    gesture: u64,
}

impl Deref for Document {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        &self.scene
    }
}

impl PartialEq<Scene> for Document {
    fn eq(&self, other: &Scene) -> bool {
        self.scene == *other
    }
}

impl Document {
    /// A document that is as its file has it, without a history.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        let mut document = Self {
            saved: scene.clone(),
            scene,
            ids: Ids::default(),
            next: 0,
            history: History::default(),
            gesture: 0,
        };
        document.ids.lights = (0..document.scene.lights.len()).map(|_| document.next_id()).collect();
        document.ids.objects = (0..document.scene.objects.len()).map(|_| document.next_id()).collect();
        document
    }

    fn next_id(&mut self) -> PartId {
        self.next += 1;
        PartId(self.next)
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene as it is in the file.
    #[must_use]
    pub fn saved(&self) -> &Scene {
        &self.saved
    }

    /// True if the scene is not as it is in the file.
    #[must_use]
    pub fn differs(&self) -> bool {
        self.scene != self.saved
    }

    /// The scene was written to the file.
    pub fn mark_saved(&mut self) {
        self.saved = self.scene.clone();
    }

    /// The file holds another scene than was known.
    pub fn set_saved(&mut self, scene: Scene) {
        self.saved = scene;
    }

    /// The id of an object, by its index.
    #[must_use]
    pub fn object_id(&self, index: usize) -> Option<PartId> {
        self.ids.objects.get(index).copied()
    }

    /// The index of an object, by its id.
    #[must_use]
    pub fn object(&self, id: PartId) -> Option<usize> {
        self.ids.objects.iter().position(|known| *known == id)
    }

    /// The id of a light, by its index.
    #[must_use]
    pub fn light_id(&self, index: usize) -> Option<PartId> {
        self.ids.lights.get(index).copied()
    }

    /// The index of a light, by its id.
    #[must_use]
    pub fn light(&self, id: PartId) -> Option<usize> {
        self.ids.lights.iter().position(|known| *known == id)
    }

    /// Changes the scene within an extent, as one step of that name. `selection` is what is selected now. A change to
    /// the same value is none.
    pub fn change(
        &mut self,
        name: impl Into<String>,
        extent: Extent,
        selection: Selection,
        change: impl FnOnce(&mut Scene),
    ) {
        let patch = match extent {
            Extent::Rest => {
                let old = rest_of(&mut self.scene);
                change(&mut self.scene);
                Patch::of_rest(old, rest_of(&mut self.scene))
            }
            Extent::Light(i) => {
                let Some((old, id)) = self.scene.lights.get(i).cloned().zip(self.light_id(i)) else { return };
                change(&mut self.scene);
                let new = self.scene.lights.get(i).cloned().unwrap_or_else(|| old.clone());
                Patch::of_light(i, id, old, new)
            }
            Extent::Object(i) => {
                let Some((old, id)) = self.scene.objects.get(i).cloned().zip(self.object_id(i)) else {
                    return;
                };
                change(&mut self.scene);
                let new = self.scene.objects.get(i).cloned().unwrap_or_else(|| old.clone());
                Patch::of_object(i, id, old, new)
            }
            Extent::All => return self.change_list(name, selection, |scene, _| change(scene)),
        };
        self.history.record(name.into(), self.gesture, patch, selection);
    }

    /// Changes anything, ids included.
    fn change_list(
        &mut self,
        name: impl Into<String>,
        selection: Selection,
        change: impl FnOnce(&mut Scene, &mut Ids),
    ) {
        let (mut old, ids) = (self.scene.clone(), self.ids.clone());
        change(&mut self.scene, &mut self.ids);
        self.give_ids();
        let patch = Patch::between((&mut old, &ids), (&mut self.scene, &self.ids));
        self.history.record(name.into(), self.gesture, patch, selection);
    }

    /// Every part has an id, whatever a change did to the lists.
    fn give_ids(&mut self) {
        self.ids.lights.truncate(self.scene.lights.len());
        self.ids.objects.truncate(self.scene.objects.len());
        while self.ids.lights.len() < self.scene.lights.len() {
            let id = self.next_id();
            self.ids.lights.push(id);
        }
        while self.ids.objects.len() < self.scene.objects.len() {
            let id = self.next_id();
            self.ids.objects.push(id);
        }
    }

    /// Changes values without a step: what the models that are known make necessary, and what comes back with them.
    pub fn amend(&mut self, change: impl FnOnce(&mut Scene)) {
        change(&mut self.scene);
        self.give_ids();
    }

    /// Another version of the scene takes the place of this one, as one step: parts that are equal, or have the same
    /// name, or else the same place, keep their ids.
    pub fn replace(&mut self, name: impl Into<String>, selection: Selection, scene: Scene) {
        let lights =
            self.matched(&self.scene.lights, &scene.lights, &self.ids.lights, |l: &Light| l.name.as_deref());
        let objects = self
            .matched(&self.scene.objects, &scene.objects, &self.ids.objects, |o: &Object| o.name.as_deref());
        let ids = Ids {
            lights: lights.into_iter().map(|id| id.unwrap_or_else(|| self.next_id())).collect(),
            objects: objects.into_iter().map(|id| id.unwrap_or_else(|| self.next_id())).collect(),
        };
        self.change_list(name, selection, |current, known| {
            *current = scene;
            *known = ids;
        });
    }

    /// Takes over what a system changed, if the rules of scenes allow it. All such changes that follow each other are
    /// one step: a system may change something in every frame.
    ///
    /// # Errors
    /// Why it is refused; the scene stays as it is.
    pub fn submit(&mut self, scene: Scene, selection: Selection, registry: &Registry) -> Result<(), String> {
        if let Some(problem) = self.problem_in(&scene, registry) {
            return Err(format!("A change of a component was refused: {problem}."));
        }
        let gesture = std::mem::replace(&mut self.gesture, SYSTEMS);
        self.replace("Change by a system", selection, scene);
        self.gesture = gesture;
        Ok(())
    }

    /// The first problem of the parts in which a scene differs from this one.
    fn problem_in(&self, scene: &Scene, registry: &Registry) -> Option<Problem> {
        if (scene.lights.len(), scene.objects.len()) != (self.lights.len(), self.objects.len()) {
            return check::scene(scene, registry).into_iter().next();
        }
        let lights = (0..scene.lights.len()).filter(|i| scene.lights[*i] != self.lights[*i]);
        let objects = (0..scene.objects.len()).filter(|i| scene.objects[*i] != self.objects[*i]);
        let observer = (scene.observer != self.observer).then(|| check::observer(scene, registry));
        lights
            .flat_map(|i| check::light(scene, i, registry))
            .chain(objects.flat_map(|i| check::object(scene, i, registry)))
            .chain(observer.into_iter().flatten())
            .next()
    }

    /// The ids of the parts of a new list that are parts of the old one.
    fn matched<T: PartialEq>(
        &self,
        old: &[T],
        new: &[T],
        ids: &[PartId],
        name: impl Fn(&T) -> Option<&str>,
    ) -> Vec<Option<PartId>> {
        let shorter = old.len().min(new.len());
        let start = (0..shorter).take_while(|i| old[*i] == new[*i]).count();
        let end =
            (0..shorter - start).take_while(|i| old[old.len() - 1 - i] == new[new.len() - 1 - i]).count();
        let mut found = vec![None; new.len()];
        let mut free: Vec<bool> = vec![false; old.len()];
        free[start..old.len() - end].fill(true);
        (0..start).for_each(|i| found[i] = Some(ids[i]));
        (1..=end).for_each(|i| found[new.len() - i] = Some(ids[old.len() - i]));
        let middle = start..new.len() - end;
        // In a file of thousands of new parts, place decides.
        const MOST: usize = 2000;
        let few = middle.len() <= MOST && old.len() - end - start <= MOST;
        let same: [&dyn Fn(&T, &T) -> bool; 2] =
            [&|a, b| a == b, &|a, b| name(a).is_some() && name(a) == name(b)];
        for same in same.into_iter().filter(|_| few) {
            for i in middle.clone() {
                if found[i].is_none()
                    && let Some(j) = (start..old.len() - end).find(|j| free[*j] && same(&old[*j], &new[i]))
                {
                    (found[i], free[j]) = (Some(ids[j]), false);
                }
            }
        }
        for i in middle {
            if found[i].is_none() && free.get(i) == Some(&true) {
                (found[i], free[i]) = (Some(ids[i]), false);
            }
        }
        found
    }

    // ── steps ──

    /// Everything up to here was one gesture: steps of one name are joined within a gesture only.
    pub fn end_gesture(&mut self) {
        self.gesture += 1;
    }

    /// True if a step could be joined with the last one.
    #[must_use]
    pub fn in_gesture(&self) -> bool {
        self.history.gesture() == Some(self.gesture)
    }

    /// The selection after the last step is this.
    pub fn selected(&mut self, selection: Selection) {
        self.history.selected(selection);
    }

    /// Takes the last step back. Returns its name, and what was selected before it.
    pub fn undo(&mut self) -> Option<(String, Selection)> {
        self.end_gesture();
        let (name, selection) = self.history.undo(&mut self.scene, &mut self.ids)?;
        Some((name.to_owned(), selection))
    }

    /// Does the step again that was taken back last. Returns its name, and what was selected after it.
    pub fn redo(&mut self) -> Option<(String, Selection)> {
        self.end_gesture();
        let (name, selection) = self.history.redo(&mut self.scene, &mut self.ids)?;
        Some((name.to_owned(), selection))
    }

    /// The names of all steps, the oldest first; those from [`done`](Self::done) on are undone.
    pub fn steps(&self) -> impl ExactSizeIterator<Item = &str> {
        self.history.names()
    }

    /// How many of the steps are done.
    #[must_use]
    pub fn done(&self) -> usize {
        self.history.done()
    }
}
