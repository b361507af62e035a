//! The history of a document: each of its steps can be undone and redone.
//!
//! A step stores only what it changed, so that moving one of ten thousand objects costs one object.

use std::ops::Range;

use super::{Extent, Others, PartId, Selection};
use crate::scene::{Light, Object, Scene};

/// Maximum number of steps; the oldest are dropped.
const MOST_STEPS: usize = 500;
/// Maximum number of lights and objects in all steps together, so that memory is bounded.
const MOST_PARTS: usize = 200_000;

/// The permanent identity of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Label {
    pub(super) id: PartId,
    /// Number among the parts of its type, by which it is called if it has no name; 0 until it gets one.
    pub(super) number: usize,
}

impl Label {
    /// The label of a new part, after as many others.
    pub(super) fn new(others: &mut u64) -> Self {
        *others += 1;
        Self { id: PartId(*others), number: 0 }
    }
}

/// The labels of lights and objects, in the order of the scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Labels {
    pub(super) lights: Vec<Label>,
    pub(super) objects: Vec<Label>,
}

/// The ranges in which two lists of these lengths differ, without their common beginning and end. `same`
/// compares an entry of the first with one of the second.
pub(crate) fn difference(
    [old, new]: [usize; 2],
    mut same: impl FnMut(usize, usize) -> bool,
) -> [Range<usize>; 2] {
    let shorter = old.min(new);
    let start = (0..shorter).take_while(|i| same(*i, *i)).count();
    let end = (0..shorter - start).take_while(|i| same(old - 1 - i, new - 1 - i)).count();
    [start..old - end, start..new - end]
}

/// A range of a list, before and after.
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

    /// True if the list has a different length afterwards.
    fn resizes(&self) -> bool {
        self.old.len() != self.new.len()
    }

    /// True if only the value of one part changes, but not its type.
    fn is_of_one_by(&self, type_of: impl Fn(&T) -> &str) -> bool {
        matches!((&self.old[..], &self.new[..]), ([old], [new]) if type_of(&old.1) == type_of(&new.1))
            && self.is_of_one()
    }

    /// True if only the value of one part changes.
    fn is_of_one(&self) -> bool {
        matches!((&self.old[..], &self.new[..]), ([old], [new]) if old.0.id == new.0.id)
    }
}

/// Everything in a scene except its lights and objects.
pub(super) fn rest_of(scene: &Scene) -> Scene {
    Scene {
        name: scene.name.clone(),
        description: scene.description.clone(),
        reflection_model: scene.reflection_model.clone(),
        shading_model: scene.shading_model.clone(),
        variants: scene.variants.clone(),
        lights: Vec::new(),
        objects: Vec::new(),
        ..*scene
    }
}

/// Copies everything except lights and objects from another scene.
pub(super) fn copy_rest(from: &Scene, to: &mut Scene) {
    let lists = (std::mem::take(&mut to.lights), std::mem::take(&mut to.objects));
    *to = rest_of(from);
    (to.lights, to.objects) = lists;
}

/// Copies everything from another scene; of the lists, only the range in which they differ.
pub(super) fn copy_all(from: &Scene, to: &mut Scene) {
    fn copy<T: Clone + PartialEq>(from: &[T], to: &mut Vec<T>) {
        let [gone, come] = difference([to.len(), from.len()], |i, j| to[i] == from[j]);
        to.splice(gone, from[come].iter().cloned());
    }
    copy_rest(from, to);
    copy(&from.lights, &mut to.lights);
    copy(&from.objects, &mut to.objects);
}

/// The difference between two versions of a scene: ranges of lights and of objects that do not overlap, in
/// the order of the scene. Positions refer to the old version.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Patch {
    rest: Option<Box<[Scene; 2]>>,
    lights: Vec<Splice<Light>>,
    objects: Vec<Splice<Object>>,
}

impl Patch {
    /// The difference between two versions that differ in everything except lights and objects.
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

    /// The difference made by adding or removing lights: before, after.
    pub(super) fn of_lights(at: usize, old: Vec<(Label, Light)>, new: Vec<(Label, Light)>) -> Self {
        Self { lights: vec![Splice { at, old, new }], ..Self::default() }
    }

    /// The difference made by adding or removing objects: before, after.
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
        put(&self.lights, &mut scene.lights, &mut labels.lights, back);
        put(&self.objects, &mut scene.objects, &mut labels.objects, back);
    }

    /// The part that the step changes. A change of a part's type concerns all parts, because it changes the
    /// numbers that a file gives to others.
    fn extent(&self) -> Extent {
        match (&self.rest, &self.lights[..], &self.objects[..]) {
            (Some(_), [], []) => Extent::Rest,
            (None, [one], []) if one.is_of_one_by(|light| &light.light_type) => Extent::Light(one.at),
            (None, [], [one]) if one.is_of_one_by(|object| &object.object_type) => Extent::Object(one.at),
            _ => Extent::All,
        }
    }

    fn parts(&self) -> usize {
        self.lights.iter().map(Splice::parts).sum::<usize>()
            + self.objects.iter().map(Splice::parts).sum::<usize>()
    }

    /// Changes of single lights and objects, each of another one, in the order of the scene.
    pub(super) fn of_each(patches: impl Iterator<Item = Self>) -> Self {
        let mut all = Self::default();
        for patch in patches {
            all.lights.extend(patch.lights);
            all.objects.extend(patch.objects);
        }
        all
    }

    /// The lights and objects that change, each alone and not its type; `None` if anything else does.
    pub(super) fn ones(&self) -> Option<Vec<Extent>> {
        let lights =
            self.lights.iter().map(|one| (one.is_of_one_by(|l| &l.light_type), Extent::Light(one.at)));
        let objects =
            self.objects.iter().map(|one| (one.is_of_one_by(|o| &o.object_type), Extent::Object(one.at)));
        let ones = lights.chain(objects).map(|(alone, extent)| alone.then_some(extent));
        ones.collect::<Option<_>>().filter(|_| self.rest.is_none())
    }

    /// Merges this change and a later one into a single change, which may be empty.
    pub(super) fn join(&mut self, later: Self) {
        self.rest = match (self.rest.take(), later.rest) {
            (Some(a), Some(b)) => {
                let ([old, _], [_, new]) = (*a, *b);
                (old != new).then(|| Box::new([old, new]))
            }
            (a, b) => a.or(b),
        };
        join(&mut self.lights, later.lights);
        join(&mut self.objects, later.objects);
    }
}

/// Inserts ranges into a list. Positions refer to the old list; everything before a range must still be old.
fn put<T: Clone + PartialEq>(splices: &[Splice<T>], parts: &mut Vec<T>, labels: &mut Vec<Label>, back: bool) {
    let put = |splice: &Splice<T>| splice.put(parts, labels, back);
    if back { splices.iter().for_each(put) } else { splices.iter().rev().for_each(put) }
}

/// Merges two changes of a list into one.
fn join<T: Clone + PartialEq>(a: &mut Vec<Splice<T>>, b: Vec<Splice<T>>) {
    if !a.iter().chain(&b).all(Splice::is_of_one) {
        *a = composed(std::mem::take(a), b);
        return;
    }
    for later in b {
        match a.binary_search_by_key(&later.at, |splice| splice.at) {
            Ok(i) if a[i].old == later.new => drop(a.remove(i)),
            Ok(i) => a[i].new = later.new,
            Err(i) => a.insert(i, later),
        }
    }
}

/// Combines a change from an old list to an intermediate one with a change from there to a new list. Ranges
/// that share parts of the intermediate list, or between which a part was added or removed, become one.
fn composed<T: Clone + PartialEq>(a: Vec<Splice<T>>, b: Vec<Splice<T>>) -> Vec<Splice<T>> {
    let (mut a, mut b) = (a.into_iter().peekable(), b.into_iter().peekable());
    let mut all = Vec::with_capacity(a.len().max(b.len()));
    // The total lengths of the old and new ranges of the first change so far: the intermediate list is longer
    // by their difference.
    let (mut gone, mut come) = (0, 0);
    loop {
        let before = (gone, come);
        // Ranges with their positions in the intermediate list.
        let (mut first, mut later): (Vec<(usize, Splice<T>)>, Vec<Splice<T>>) = (Vec::new(), Vec::new());
        let mut range = None;
        let mut resized = false;
        loop {
            let place_a = a.peek().map(|splice| splice.at + come - gone);
            let place_b = b.peek().map(|splice| splice.at);
            let is_a = place_a.is_some_and(|place| place_b.is_none_or(|other| place <= other));
            let Some((place, resizes)) = (if is_a {
                place_a.zip(a.peek().map(Splice::resizes))
            } else {
                place_b.zip(b.peek().map(Splice::resizes))
            }) else {
                break;
            };
            let Range { start, end } = *range.get_or_insert(place..place);
            let is_empty = first.is_empty() && later.is_empty();
            if !is_empty && (place > end || place == end && !(resized || resizes)) {
                break;
            }
            resized |= resizes;
            let length = if is_a {
                a.next().map_or(0, |splice| {
                    (gone, come) = (gone + splice.old.len(), come + splice.new.len());
                    let length = splice.new.len();
                    first.push((place, splice));
                    length
                })
            } else {
                b.next().map_or(0, |splice| {
                    let length = splice.old.len();
                    later.push(splice);
                    length
                })
            };
            range = Some(start..end.max(place + length));
        }
        let Some(range) = range else { return all };
        let splice = merged(range.start + before.0 - before.1, &range, first, later);
        if splice.old != splice.new {
            all.push(splice);
        }
    }
}

/// The ranges of two changes that cover a range of the intermediate list, as one range at this position of
/// the old list.
fn merged<T: Clone>(
    at: usize,
    range: &Range<usize>,
    first: Vec<(usize, Splice<T>)>,
    later: Vec<Splice<T>>,
) -> Splice<T> {
    let mut between = vec![None; range.len()];
    let (mut befores, mut afters) = (Vec::new(), Vec::new());
    for (place, Splice { old, new, .. }) in first {
        befores.push((place - range.start, new.len(), old));
        between.splice(place - range.start..place - range.start + new.len(), new.into_iter().map(Some));
    }
    for Splice { at: place, old, new } in later {
        let place = place - range.start;
        afters.push((place, old.len(), new));
        for (slot, part) in between[place..].iter_mut().zip(old) {
            slot.get_or_insert(part);
        }
    }
    // Parts in only one of the changes are equal before or after it; no part is both.
    let mut side = |stretches: Vec<(usize, usize, Vec<(Label, T)>)>| {
        let (mut all, mut next) = (Vec::new(), 0);
        for (place, length, parts) in stretches {
            all.extend(between[next..place].iter_mut().filter_map(Option::take));
            all.extend(parts);
            next = place + length;
        }
        all.extend(between[next..].iter_mut().filter_map(Option::take));
        all
    };
    Splice { at, old: side(befores), new: side(afters) }
}

/// One step.
#[derive(Clone, Debug)]
struct Step {
    name: String,
    /// Steps with the same name within one gesture are merged.
    gesture: u64,
    patch: Patch,
    before: Selected,
    after: Selected,
}

/// The selection, and what is selected besides it.
type Selected = (Selection, Others);

/// The steps, and the number of those that have not been undone.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    steps: Vec<Step>,
    done: usize,
    /// What is selected besides the selection now.
    others: Others,
}

impl History {
    /// Records a change.
    pub(super) fn record(&mut self, name: String, gesture: u64, patch: Patch, selection: Selection) {
        if patch.is_empty() {
            return;
        }
        self.steps.truncate(self.done);
        match self.steps.last_mut() {
            Some(last) if last.name == name && last.gesture == gesture => {
                last.patch.join(patch);
                last.after = (selection, self.others.clone());
                if last.patch.is_empty() {
                    self.steps.pop();
                }
            }
            _ => {
                let selected = (selection, self.others.clone());
                self.steps.push(Step { name, gesture, patch, before: selected.clone(), after: selected });
            }
        }
        let mut parts: usize = self.steps.iter().map(|step| step.patch.parts()).sum();
        while self.steps.len() > 1 && (self.steps.len() > MOST_STEPS || parts > MOST_PARTS) {
            parts -= self.steps.remove(0).patch.parts();
        }
        self.done = self.steps.len();
    }

    /// Adds a change to the last step that has not been undone.
    pub(super) fn go_on(&mut self, patch: Patch) {
        if let Some(Step { name, gesture, after: (selection, _), .. }) = self.steps[..self.done].last() {
            self.record(name.clone(), *gesture, patch, *selection);
        }
    }

    /// Sets the selection after the last step: some steps select what they added.
    pub(super) fn selected(&mut self, selection: Selection) {
        let selected = (selection, self.others.clone());
        self.steps[..self.done].last_mut().into_iter().for_each(|step| step.after = selected.clone());
    }

    /// What is selected besides the selection.
    pub(super) fn others(&self) -> &Others {
        &self.others
    }

    pub(super) fn set_others(&mut self, others: Others) {
        self.others = others;
    }

    /// Undoes the last step, or redoes the one that was undone last. Returns its name, the selection then, and the part
    /// that it changed.
    pub(super) fn go(
        &mut self,
        back: bool,
        scene: &mut Scene,
        labels: &mut Labels,
    ) -> Option<(String, Selection, Extent)> {
        let step = self.steps.get(if back { self.done.checked_sub(1)? } else { self.done })?;
        step.patch.put(scene, labels, back);
        self.done = if back { self.done - 1 } else { self.done + 1 };
        let (selection, others) = if back { &step.before } else { &step.after };
        self.others = others.clone();
        Some((step.name.clone(), *selection, step.patch.extent()))
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

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{document::Document, registry::Registry};

    /// A random number generator with the same sequence in each run.
    struct Dice(u64);

    impl Dice {
        fn below(&mut self, end: usize) -> usize {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) as usize % end
        }
    }

    #[test]
    fn parts_that_systems_add_in_each_frame_are_one_step() {
        let registry = Registry::builtin();
        let start = Scene::default();
        let mut document = Document::new(start.clone());
        for i in 0..20 {
            let mut scene = document.scene().clone();
            // The first object moves, too.
            scene.objects[0].position.x += 0.01;
            document.submit(&scene, &[Extent::Object(0)], Selection::Room, &registry).expect("it may move");
            let mut object = scene.objects[0].clone();
            object.position = Vec3::new(1.0 + 0.1 * i as f32, 2.0, 2.0);
            scene.objects.push(object);
            document.submit_lists(&scene, &[], Selection::Room, &registry).expect("it may come");
        }
        let end = document.scene().clone();
        let id = document.object_id(20);
        assert_eq!(document.steps().len(), 1, "{:?}", document.steps().collect::<Vec<_>>());
        document.undo();
        assert!(*document.scene() == start);
        document.redo();
        assert!(*document.scene() == end);
        assert_eq!(document.object_id(20), id);
        // Everything that was added is removed.
        let removed: Vec<_> = (1..=20).map(Extent::Object).collect();
        document.submit_lists(&start, &removed, Selection::Room, &registry).expect("they may go");
        assert_eq!(document.steps().len(), 0, "together that changes nothing");
    }

    #[test]
    fn of_a_list_only_the_range_that_differs_is_copied() {
        let object = |size: usize| Object { size: size as f32, ..Object::default() };
        let scene = |sizes: &[usize]| Scene {
            objects: sizes.iter().copied().map(object).collect(),
            ..Scene::default()
        };
        // How many of the first and of the last stay.
        let cases: [(&[usize], &[usize], [usize; 2]); 6] = [
            (&[1, 2, 3, 4], &[1, 2, 4], [2, 1]),
            (&[1, 2, 4], &[1, 2, 3, 4], [2, 1]),
            (&[1, 2, 3], &[1, 9, 3], [1, 1]),
            (&[1, 1, 1], &[1, 1], [2, 0]),
            (&[1, 2], &[1, 2], [2, 0]),
            (&[1, 2], &[3], [0, 0]),
        ];
        for (old, new, [first, last]) in cases {
            let (from, mut to) = (Scene { name: Some("other".to_owned()), ..scene(new) }, scene(old));
            // Strings keep their memory unless they are cloned.
            let memory = |scene: &Scene| -> Vec<_> {
                scene.objects.iter().map(|object| object.object_type.as_ptr()).collect()
            };
            let before = memory(&to);
            Extent::All.copy(&from, &mut to);
            let after = memory(&to);
            assert!(to == from, "{old:?} → {new:?}");
            assert_eq!(after[..first], before[..first], "{old:?} → {new:?}");
            assert_eq!(after[after.len() - last..], before[before.len() - last..], "{old:?} → {new:?}");
        }
    }

    #[test]
    fn joined_changes_are_undone_and_redone_exactly() {
        let mut dice = Dice(1);
        let mut id = PartId(1000);
        let mut label = || {
            id = PartId(id.0 + 1);
            Label { id, number: 0 }
        };
        for _ in 0..2000 {
            let start: Vec<(Label, usize)> = (0..dice.below(8)).map(|i| (label(), i)).collect();
            let mut now = start.clone();
            let mut joined = Vec::new();
            for _ in 0..1 + dice.below(8) {
                let mut next = now.clone();
                for _ in 0..1 + dice.below(3) {
                    let i = dice.below(next.len() + 1);
                    match dice.below(3) {
                        0 => next.insert(i, (label(), dice.below(4))),
                        1 if i < next.len() => drop(next.remove(i)),
                        _ => next.iter_mut().skip(i).take(2).for_each(|part| part.1 = dice.below(4)),
                    }
                }
                let split = |list: &[(Label, usize)]| -> (Vec<usize>, Vec<Label>) {
                    list.iter().map(|(label, part)| (*part, *label)).unzip()
                };
                let (old, new) = (split(&now), split(&next));
                let change = Splice::between((&old.0, &old.1), (&new.0, &new.1));
                let ones = now.iter().zip(&next).enumerate();
                let ones = ones.filter_map(|(at, (old, new))| Splice::of_one(at, *old, *new));
                let same_parts = old.1 == new.1;
                join(&mut joined, if same_parts { ones.collect() } else { change.into_iter().collect() });
                let check = |from: &[(Label, usize)], to: &[(Label, usize)], back| {
                    let (mut parts, mut labels) = split(from);
                    put(&joined, &mut parts, &mut labels, back);
                    assert_eq!((parts, labels), split(to), "{start:?} → {next:?}: {joined:?}");
                };
                check(&start, &next, false);
                check(&next, &start, true);
                assert!(joined.iter().all(|splice| splice.old != splice.new));
                now = next;
            }
        }
    }
}
