//! The steps by which a document came to be: each can be undone and redone.
//!
//! A step holds what it changed and nothing else, so that moving one of ten thousand objects costs one object.

use super::{PartId, Selection};
use crate::scene::{Light, Object, Scene};

/// As many steps are kept; the oldest give way.
const MOST_STEPS: usize = 500;
/// As many lights and objects are kept in all steps together, so that memory is bounded.
const MOST_PARTS: usize = 200_000;

/// The lights and objects by id, in the order of the scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Ids {
    pub(super) lights: Vec<PartId>,
    pub(super) objects: Vec<PartId>,
}

/// A stretch of a list, before and after.
#[derive(Clone, Debug, PartialEq)]
struct Splice<T> {
    at: usize,
    old: Vec<(PartId, T)>,
    new: Vec<(PartId, T)>,
}

impl<T: Clone + PartialEq> Splice<T> {
    /// The difference between two versions of a list, without their common beginning and end.
    fn between(old: (&[T], &[PartId]), new: (&[T], &[PartId])) -> Option<Self> {
        let same = |i: usize, j: usize| old.1[i] == new.1[j] && old.0[i] == new.0[j];
        let shorter = old.0.len().min(new.0.len());
        let at = (0..shorter).take_while(|i| same(*i, *i)).count();
        let (m, n) = (old.0.len(), new.0.len());
        let end = (0..shorter - at).take_while(|i| same(m - 1 - i, n - 1 - i)).count();
        if at == m && at == n {
            return None;
        }
        let stretch = |(parts, ids): (&[T], &[PartId]), to: usize| {
            (at..to).map(|i| (ids[i], parts[i].clone())).collect::<Vec<_>>()
        };
        Some(Self { at, old: stretch(old, m - end), new: stretch(new, n - end) })
    }

    fn put(&self, parts: &mut Vec<T>, ids: &mut Vec<PartId>, back: bool) {
        let (gone, come) = if back { (&self.new, &self.old) } else { (&self.old, &self.new) };
        let at = self.at.min(parts.len());
        let to = (at + gone.len()).min(parts.len());
        ids.splice(at..to, come.iter().map(|(id, _)| *id));
        parts.splice(at..to, come.iter().map(|(_, part)| part.clone()));
    }

    fn parts(&self) -> usize {
        self.old.len() + self.new.len()
    }
}

/// Everything of a scene but its lights and objects.
pub(super) fn rest_of(scene: &mut Scene) -> Scene {
    let lists = (std::mem::take(&mut scene.lights), std::mem::take(&mut scene.objects));
    let rest = scene.clone();
    (scene.lights, scene.objects) = lists;
    rest
}

/// The difference between two versions of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Patch {
    rest: Option<Box<[Scene; 2]>>,
    lights: Option<Splice<Light>>,
    objects: Option<Splice<Object>>,
}

impl Patch {
    /// The difference between two versions that differ in the room, the display, the observer and the like.
    pub(super) fn of_rest(old: Scene, new: Scene) -> Self {
        let rest = (old != new).then(|| Box::new([old, new]));
        Self { rest, ..Self::default() }
    }

    /// The difference between two versions of one light.
    pub(super) fn of_light(at: usize, id: PartId, old: Light, new: Light) -> Self {
        let lights = (old != new).then(|| Splice { at, old: vec![(id, old)], new: vec![(id, new)] });
        Self { lights, ..Self::default() }
    }

    /// The difference between two versions of one object.
    pub(super) fn of_object(at: usize, id: PartId, old: Object, new: Object) -> Self {
        let objects = (old != new).then(|| Splice { at, old: vec![(id, old)], new: vec![(id, new)] });
        Self { objects, ..Self::default() }
    }

    /// The difference between any two versions.
    pub(super) fn between(old: (&mut Scene, &Ids), new: (&mut Scene, &Ids)) -> Self {
        let lights = Splice::between((&old.0.lights, &old.1.lights), (&new.0.lights, &new.1.lights));
        let objects = Splice::between((&old.0.objects, &old.1.objects), (&new.0.objects, &new.1.objects));
        Self { lights, objects, ..Self::of_rest(rest_of(old.0), rest_of(new.0)) }
    }

    pub(super) fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    fn put(&self, scene: &mut Scene, ids: &mut Ids, back: bool) {
        if let Some(versions) = &self.rest {
            let lists = (std::mem::take(&mut scene.lights), std::mem::take(&mut scene.objects));
            *scene = versions[usize::from(!back)].clone();
            (scene.lights, scene.objects) = lists;
        }
        if let Some(splice) = &self.lights {
            splice.put(&mut scene.lights, &mut ids.lights, back);
        }
        if let Some(splice) = &self.objects {
            splice.put(&mut scene.objects, &mut ids.objects, back);
        }
    }

    fn parts(&self) -> usize {
        self.lights.as_ref().map_or(0, Splice::parts) + self.objects.as_ref().map_or(0, Splice::parts)
    }

    /// This change with another one behind it, if both are of the same place.
    fn with(&self, later: &Self) -> Option<Self> {
        let rest = match (&self.rest, &later.rest) {
            (Some(a), Some(b)) => (a[0] != b[1]).then(|| Box::new([a[0].clone(), b[1].clone()])),
            (None, None) => None,
            _ => return None,
        };
        let (lights, objects) =
            (joined(&self.lights, &later.lights)?, joined(&self.objects, &later.objects)?);
        Some(Self { rest, lights, objects })
    }
}

/// Two changes of one stretch as one, which may be none; outer `None` if they are of different stretches.
fn joined<T: Clone + PartialEq>(a: &Option<Splice<T>>, b: &Option<Splice<T>>) -> Option<Option<Splice<T>>> {
    match (a, b) {
        (Some(a), Some(b)) if a.at == b.at && a.new.len() == b.old.len() => {
            Some((a.old != b.new).then(|| Splice { at: a.at, old: a.old.clone(), new: b.new.clone() }))
        }
        (None, None) => Some(None),
        _ => None,
    }
}

/// One step.
#[derive(Clone, Debug)]
struct Step {
    name: String,
    /// Steps of one name within one gesture are one.
    gesture: u64,
    patch: Patch,
    before: Selection,
    after: Selection,
}

/// The steps, and how many of them are done.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    steps: Vec<Step>,
    done: usize,
}

impl History {
    /// A change was made.
    pub(super) fn record(&mut self, name: String, gesture: u64, patch: Patch, selection: Selection) {
        if patch.is_empty() {
            return;
        }
        self.steps.truncate(self.done);
        let mut step = Step { name, gesture, patch, before: selection, after: selection };
        if let Some(last) = self.steps.last()
            && last.name == step.name
            && last.gesture == gesture
            && let Some(patch) = last.patch.with(&step.patch)
        {
            step = Step { patch, before: last.before, ..step };
            self.steps.pop();
        }
        if !step.patch.is_empty() {
            self.steps.push(step);
        }
        let mut parts: usize = self.steps.iter().map(|step| step.patch.parts()).sum();
        while self.steps.len() > 1 && (self.steps.len() > MOST_STEPS || parts > MOST_PARTS) {
            parts -= self.steps.remove(0).patch.parts();
        }
        self.done = self.steps.len();
    }

    /// Calls the last step by a name that was not known before it.
    pub(super) fn rename_last(&mut self, name: String) {
        if let Some(step) = self.steps.last_mut() {
            step.name = name;
        }
    }

    /// The selection after the last step: some steps select what they made.
    pub(super) fn selected(&mut self, selection: Selection) {
        if let Some(step) = self.done.checked_sub(1).and_then(|i| self.steps.get_mut(i)) {
            step.after = selection;
        }
    }

    /// Takes the last step back. Returns its name and the selection before it.
    pub(super) fn undo(&mut self, scene: &mut Scene, ids: &mut Ids) -> Option<(&str, Selection)> {
        let step = self.steps.get(self.done.checked_sub(1)?)?;
        step.patch.put(scene, ids, true);
        self.done -= 1;
        Some((&step.name, step.before))
    }

    /// Does the step again that was taken back last. Returns its name and the selection after it.
    pub(super) fn redo(&mut self, scene: &mut Scene, ids: &mut Ids) -> Option<(&str, Selection)> {
        let step = self.steps.get(self.done)?;
        step.patch.put(scene, ids, false);
        self.done += 1;
        Some((&step.name, step.after))
    }

    pub(super) fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.steps.iter().map(|step| step.name.as_str())
    }

    /// The gesture of the last step.
    pub(super) fn gesture(&self) -> Option<u64> {
        self.steps.last().map(|step| step.gesture)
    }

    pub(super) fn done(&self) -> usize {
        self.done
    }
}
