//! The steps by which a document came to be: each can be undone and redone.
//!
//! A step holds what it changed and nothing else, so that moving one of ten thousand objects costs one object.

use std::ops::Range;

use super::{Extent, PartId, Selection};
use crate::scene::{Light, Object, Scene};

/// The most steps that are kept; the oldest are dropped.
const MOST_STEPS: usize = 500;
/// The most lights and objects in all steps together, so that memory is bounded.
const MOST_PARTS: usize = 200_000;

/// The identity of a part for life.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Label {
    pub(super) id: PartId,
    /// Its number among the parts of its type, by which it is called without a name; 0 until it gets one.
    pub(super) number: usize,
}

/// The labels of lights and objects, in the order of the scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Labels {
    pub(super) lights: Vec<Label>,
    pub(super) objects: Vec<Label>,
}

/// The stretches in which two lists of these lengths differ, without their common beginning and end. `same` compares
/// an entry of the first with one of the second.
pub(crate) fn difference(
    [old, new]: [usize; 2],
    mut same: impl FnMut(usize, usize) -> bool,
) -> [Range<usize>; 2] {
    let shorter = old.min(new);
    let start = (0..shorter).take_while(|i| same(*i, *i)).count();
    let end = (0..shorter - start).take_while(|i| same(old - 1 - i, new - 1 - i)).count();
    [start..old - end, start..new - end]
}

/// A stretch of a list, before and after.
#[derive(Clone, Debug, PartialEq)]
struct Splice<T> {
    at: usize,
    old: Vec<(Label, T)>,
    new: Vec<(Label, T)>,
}

impl<T: Clone + PartialEq> Splice<T> {
    /// The difference between two versions of a list, without their common beginning and end.
    fn between(old: (&[T], &[Label]), new: (&[T], &[Label])) -> Option<Self> {
        let same = |i: usize, j: usize| old.1[i] == new.1[j] && old.0[i] == new.0[j];
        let [gone, come] = difference([old.0.len(), new.0.len()], same);
        if gone.is_empty() && come.is_empty() {
            return None;
        }
        let at = gone.start;
        let stretch = |(parts, labels): (&[T], &[Label]), range: Range<usize>| {
            range.map(|i| (labels[i], parts[i].clone())).collect::<Vec<_>>()
        };
        Some(Self { at, old: stretch(old, gone), new: stretch(new, come) })
    }

    /// The difference between two versions of one part.
    fn of_one(at: usize, old: (Label, T), new: (Label, T)) -> Option<Self> {
        (old != new).then(|| Self { at, old: vec![old], new: vec![new] })
    }

    fn put(&self, parts: &mut Vec<T>, labels: &mut Vec<Label>, back: bool) {
        let (gone, come) = if back { (&self.new, &self.old) } else { (&self.old, &self.new) };
        let at = self.at.min(parts.len());
        let to = (at + gone.len()).min(parts.len());
        labels.splice(at..to, come.iter().map(|(label, _)| *label));
        parts.splice(at..to, come.iter().map(|(_, part)| part.clone()));
    }

    fn parts(&self) -> usize {
        self.old.len() + self.new.len()
    }

    /// True if it gives one part another value.
    fn is_of_one(&self) -> bool {
        matches!((&self.old[..], &self.new[..]), ([old], [new]) if old.0.id == new.0.id)
    }
}

/// Everything of a scene but its lights and objects.
pub(super) fn rest_of(scene: &Scene) -> Scene {
    let Scene { name, description, scene_size, reflection_model, shading_model, observer, display, .. } =
        scene;
    Scene {
        name: name.clone(),
        description: description.clone(),
        scene_size: *scene_size,
        reflection_model: reflection_model.clone(),
        shading_model: shading_model.clone(),
        lights: Vec::new(),
        observer: *observer,
        objects: Vec::new(),
        display: *display,
    }
}

/// Makes everything but lights and objects equal to that of another scene.
pub(super) fn copy_rest(from: &Scene, to: &mut Scene) {
    let lists = (std::mem::take(&mut to.lights), std::mem::take(&mut to.objects));
    *to = rest_of(from);
    (to.lights, to.objects) = lists;
}

/// The difference between two versions of a scene: of lights and objects one stretch each, or single ones in the order
/// of the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Patch {
    rest: Option<Box<[Scene; 2]>>,
    lights: Vec<Splice<Light>>,
    objects: Vec<Splice<Object>>,
}

impl Patch {
    /// The difference between two versions that differ in the room, the display, the observer and the like.
    pub(super) fn of_rest(old: Scene, new: Scene) -> Self {
        let rest = (old != new).then(|| Box::new([old, new]));
        Self { rest, ..Self::default() }
    }

    /// The difference between two versions of one light.
    pub(super) fn of_light(at: usize, old: (Label, Light), new: (Label, Light)) -> Self {
        Self { lights: Splice::of_one(at, old, new).into_iter().collect(), ..Self::default() }
    }

    /// The difference between two versions of one object.
    pub(super) fn of_object(at: usize, old: (Label, Object), new: (Label, Object)) -> Self {
        Self { objects: Splice::of_one(at, old, new).into_iter().collect(), ..Self::default() }
    }

    /// A light that came or went: before, after.
    pub(super) fn of_lights(at: usize, old: Vec<(Label, Light)>, new: Vec<(Label, Light)>) -> Self {
        Self { lights: vec![Splice { at, old, new }], ..Self::default() }
    }

    /// An object that came or went: before, after.
    pub(super) fn of_objects(at: usize, old: Vec<(Label, Object)>, new: Vec<(Label, Object)>) -> Self {
        Self { objects: vec![Splice { at, old, new }], ..Self::default() }
    }

    /// The difference between any two versions.
    pub(super) fn between(old: (&Scene, &Labels), new: (&Scene, &Labels)) -> Self {
        let lights = Splice::between((&old.0.lights, &old.1.lights), (&new.0.lights, &new.1.lights));
        let objects = Splice::between((&old.0.objects, &old.1.objects), (&new.0.objects, &new.1.objects));
        let (lights, objects) = (lights.into_iter().collect(), objects.into_iter().collect());
        Self { lights, objects, ..Self::of_rest(rest_of(old.0), rest_of(new.0)) }
    }

    pub(super) fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    fn put(&self, scene: &mut Scene, labels: &mut Labels, back: bool) {
        if let Some(versions) = &self.rest {
            copy_rest(&versions[usize::from(!back)], scene);
        }
        self.lights.iter().for_each(|splice| splice.put(&mut scene.lights, &mut labels.lights, back));
        self.objects.iter().for_each(|splice| splice.put(&mut scene.objects, &mut labels.objects, back));
    }

    /// The part that it changes.
    fn extent(&self) -> Extent {
        match (&self.rest, &self.lights[..], &self.objects[..]) {
            (Some(_), [], []) => Extent::Rest,
            (None, [one], []) if one.is_of_one() => Extent::Light(one.at),
            (None, [], [one]) if one.is_of_one() => Extent::Object(one.at),
            _ => Extent::All,
        }
    }

    fn parts(&self) -> usize {
        self.lights.iter().map(Splice::parts).sum::<usize>()
            + self.objects.iter().map(Splice::parts).sum::<usize>()
    }

    /// Makes this change and a later one a single change, which may be none. Hands the later one back if that is
    /// impossible: both move parts, to different places.
    pub(super) fn join(&mut self, later: Self) -> Result<(), Self> {
        if !(joinable(&self.lights, &later.lights) && joinable(&self.objects, &later.objects)) {
            return Err(later);
        }
        self.rest = match (self.rest.take(), later.rest) {
            (Some(a), Some(b)) => {
                let ([old, _], [_, new]) = (*a, *b);
                (old != new).then(|| Box::new([old, new]))
            }
            (a, b) => a.or(b),
        };
        join(&mut self.lights, later.lights);
        join(&mut self.objects, later.objects);
        Ok(())
    }
}

fn joinable<T: Clone + PartialEq>(a: &[Splice<T>], b: &[Splice<T>]) -> bool {
    match (a, b) {
        ([], _) | (_, []) => true,
        ([a], [b]) if a.at == b.at && a.new.len() == b.old.len() => true,
        _ => a.iter().chain(b).all(Splice::is_of_one),
    }
}

fn join<T: Clone + PartialEq>(a: &mut Vec<Splice<T>>, b: Vec<Splice<T>>) {
    for later in b {
        match a.binary_search_by_key(&later.at, |splice| splice.at) {
            Ok(i) if a[i].old == later.new => drop(a.remove(i)),
            Ok(i) => a[i].new = later.new,
            Err(i) => a.insert(i, later),
        }
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
        let joined = match self.steps.last_mut() {
            Some(last) if last.name == name && last.gesture == gesture => {
                last.patch.join(patch).map(|()| last.after = selection)
            }
            _ => Err(patch),
        };
        match joined {
            Ok(()) if self.steps.last().is_some_and(|step| step.patch.is_empty()) => drop(self.steps.pop()),
            Ok(()) => {}
            Err(patch) => self.steps.push(Step { name, gesture, patch, before: selection, after: selection }),
        }
        let mut parts: usize = self.steps.iter().map(|step| step.patch.parts()).sum();
        while self.steps.len() > 1 && (self.steps.len() > MOST_STEPS || parts > MOST_PARTS) {
            parts -= self.steps.remove(0).patch.parts();
        }
        self.done = self.steps.len();
    }

    /// A change belongs to the last step that is done.
    pub(super) fn go_on(&mut self, patch: Patch) {
        if let Some(Step { name, gesture, after, .. }) =
            self.done.checked_sub(1).and_then(|i| self.steps.get(i))
        {
            self.record(name.clone(), *gesture, patch, *after);
        }
    }

    /// The selection after the last step: some steps select what they made.
    pub(super) fn selected(&mut self, selection: Selection) {
        if let Some(step) = self.done.checked_sub(1).and_then(|i| self.steps.get_mut(i)) {
            step.after = selection;
        }
    }

    /// Undoes the last step. Returns its name, the selection before it, and the part that it changed.
    pub(super) fn undo(
        &mut self,
        scene: &mut Scene,
        labels: &mut Labels,
    ) -> Option<(String, Selection, Extent)> {
        let step = self.steps.get(self.done.checked_sub(1)?)?;
        step.patch.put(scene, labels, true);
        self.done -= 1;
        Some((step.name.clone(), step.before, step.patch.extent()))
    }

    /// Redoes the step that was undone last. Returns its name, the selection after it, and the part that it changed.
    pub(super) fn redo(
        &mut self,
        scene: &mut Scene,
        labels: &mut Labels,
    ) -> Option<(String, Selection, Extent)> {
        let step = self.steps.get(self.done)?;
        step.patch.put(scene, labels, false);
        self.done += 1;
        Some((step.name.clone(), step.after, step.patch.extent()))
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
