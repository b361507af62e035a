//! The document, the only writer of the scene. Every change of the scene is submitted here, checked, and
//! recorded for undo. Parts have ids that survive changes of their position in the list.

use std::{
    collections::VecDeque,
    ops::Deref,
    sync::{
        OnceLock,
        atomic::{AtomicU64, Ordering},
    },
};

use crate::{
    registry::Registry,
    scene::{Part, Scene},
};

mod each;
mod edit;
mod history;
mod index;
mod matching;
pub mod names;
mod others;
mod rows;
mod rules;
mod submit;

pub use edit::Edit;
pub(crate) use history::difference;
use history::{History, Label, Labels, Patch, rest_of};
use index::{Index, Visits};
pub use others::Others;

/// Maximum number of changes covered by [`Document::changes_since`].
const RECENT: usize = 64;

/// Identifies a light or an object while the document is open: the id stays the same when others are added
/// and removed, when undo restores the part, and when the file is reloaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PartId(u64);

/// The selected part of the scene, by its index.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Selection {
    /// The room and the display: the selection when no part is selected.
    #[default]
    Room,
    /// The observer.
    Observer,
    /// A light, by its index in the scene.
    Light(usize),
    /// An object, by its index in the scene.
    Object(usize),
}

/// The part that has the fields of a selection; for the room, the scene itself.
impl From<Selection> for Part {
    fn from(selection: Selection) -> Self {
        match selection {
            Selection::Room => Self::Scene,
            Selection::Observer => Self::Observer,
            Selection::Light(i) => Self::Light(i),
            Selection::Object(i) => Self::Object(i),
        }
    }
}

/// The part of a scene to which a change is confined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// Everything except lights and objects.
    Rest,
    /// One light.
    Light(usize),
    /// One object.
    Object(usize),
    /// Any part.
    All,
}

impl Extent {
    /// Gives this part of a scene a name.
    fn set_name(self, scene: &mut Scene, name: String) {
        match self {
            Self::Light(i) => scene.lights.get_mut(i).into_iter().for_each(|l| l.name = Some(name.clone())),
            Self::Object(i) => scene.objects.get_mut(i).into_iter().for_each(|o| o.name = Some(name.clone())),
            Self::Rest | Self::All => {}
        }
    }

    /// Makes this part of a scene equal to that of another. Lists of different lengths are left unchanged.
    pub(crate) fn copy(self, from: &Scene, to: &mut Scene) {
        match self {
            Self::Rest => history::copy_rest(from, to),
            Self::Light(i) => copy(to.lights.get_mut(i).zip(from.lights.get(i))),
            Self::Object(i) => copy(to.objects.get_mut(i).zip(from.objects.get(i))),
            Self::All => history::copy_all(from, to),
        }
    }
}

fn copy<T: Clone>(parts: Option<(&mut T, &T)>) {
    parts.into_iter().for_each(|(to, from)| to.clone_from(from));
}

/// A scene and its history.
///
/// Dereferences to its [`Scene`].
#[derive(Clone, Debug)]
pub struct Document {
    scene: Scene,
    labels: Labels,
    /// Set when needed.
    index: OnceLock<Index>,
    visits: Visits,
    /// The next id.
    next: u64,
    /// The scene as it is in the file.
    saved: Scene,
    /// The names that exist only in the file.
    saved_names: Vec<(Extent, String)>,
    /// True if the scene and the file differ; set when needed.
    differs: OnceLock<bool>,
    history: History,
    gesture: u64,
    /// The first revision.
    origin: Revision,
    revision: Revision,
    /// The last changes: the revision before each, and the part that it changed.
    recent: VecDeque<(Revision, Extent)>,
}

/// The revision of a document. It is unique among all values of all documents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Revision(u64);

impl Revision {
    fn next() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
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
    /// A document equal to its file, without a history.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        let first = Revision::next();
        let mut document = Self {
            saved: scene.clone(),
            saved_names: Vec::new(),
            scene,
            labels: Labels::default(),
            index: OnceLock::new(),
            visits: Visits::default(),
            next: 0,
            differs: OnceLock::new(),
            history: History::default(),
            gesture: 0,
            origin: first,
            revision: first,
            recent: VecDeque::new(),
        };
        document.label_parts(None);
        document
    }

    /// The label of a new part.
    fn next_label(&mut self) -> Label {
        Label::new(&mut self.next)
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

    /// True if the scene differs from the file.
    #[must_use]
    pub fn differs(&self) -> bool {
        *self.differs.get_or_init(|| self.scene != self.saved)
    }

    /// The revision of the present value, which differs after any change.
    #[must_use]
    pub fn revision(&self) -> Revision {
        self.revision
    }

    /// The revision with which the document began, which another document never has.
    #[must_use]
    pub fn origin(&self) -> Revision {
        self.origin
    }

    /// The parts that may have changed since a revision; `None` if anything may have.
    #[must_use]
    pub fn changes_since(&self, revision: Revision) -> Option<Vec<Extent>> {
        if revision == self.revision {
            return Some(Vec::new());
        }
        let first = self.recent.iter().position(|(before, _)| *before == revision)?;
        let parts: Vec<_> = self.recent.range(first..).map(|(_, part)| *part).collect();
        (!parts.contains(&Extent::All)).then_some(parts)
    }

    /// Records a change of a part; `moved` is true if positions or types of parts may have changed.
    fn touch(&mut self, part: Extent, moved: bool) {
        if moved {
            self.index.take();
            self.prune_others();
        }
        if self.recent.len() == RECENT {
            self.recent.pop_front();
        }
        self.recent.push_back((self.revision, part));
        self.revision = Revision::next();
        self.differs.take();
    }

    /// Records that the scene, as [`named`](Self::named), was written to the file, or read from it.
    pub fn mark_saved(&mut self, registry: &Registry) {
        // Undoing leads back to what was saved.
        self.end_gesture();
        self.saved = self.scene.clone();
        self.saved_names = self.written_names(registry);
        self.differs.take();
    }

    /// True if this is the scene that was saved.
    #[must_use]
    pub fn was_saved_as(&self, scene: &Scene) -> bool {
        if self.saved_names.is_empty() {
            return self.saved == *scene;
        }
        let mut saved = self.saved.clone();
        self.saved_names.iter().for_each(|(part, name)| part.set_name(&mut saved, name.clone()));
        saved == *scene
    }

    /// Records that the content of the file is a different scene from the one known so far.
    pub fn set_saved(&mut self, scene: Scene) {
        self.saved = scene;
        self.saved_names.clear();
        self.differs.take();
    }

    /// The id of an object, by its index.
    #[must_use]
    pub fn object_id(&self, index: usize) -> Option<PartId> {
        self.labels.objects.get(index).map(|label| label.id)
    }

    /// The index of an object, by its id.
    #[must_use]
    pub fn object(&self, id: PartId) -> Option<usize> {
        self.index().objects.place(id)
    }

    /// The id of a light, by its index.
    #[must_use]
    pub fn light_id(&self, index: usize) -> Option<PartId> {
        self.labels.lights.get(index).map(|label| label.id)
    }

    /// The index of a light, by its id.
    #[must_use]
    pub fn light(&self, id: PartId) -> Option<usize> {
        self.index().lights.place(id)
    }

    fn index(&self) -> &Index {
        self.visits.add(1);
        self.index.get_or_init(|| {
            self.visits.add(self.scene.lights.len() + self.scene.objects.len());
            Index::of(&self.scene, &self.labels)
        })
    }

    /// The number of lights and objects visited since the start to find parts by id, and numbers for their
    /// names.
    #[must_use]
    pub fn visits(&self) -> u64 {
        self.visits.count()
    }

    /// Changes the scene within an extent, as one step with this name. `selection` is the current selection.
    /// Setting an equal value is not a change.
    pub fn change(
        &mut self,
        name: impl Into<String>,
        extent: Extent,
        selection: Selection,
        change: impl FnOnce(&mut Scene),
    ) {
        self.step(name.into(), extent, selection, None, |document| change(&mut document.scene));
    }

    /// Changes a part of the document, as one step.
    fn step(
        &mut self,
        name: String,
        part: Extent,
        selection: Selection,
        registry: Option<&Registry>,
        change: impl FnOnce(&mut Self),
    ) {
        let patch = self.patch(part, registry, change);
        self.history.record(name, self.gesture, patch, selection);
    }

    /// Changes a part of the document. Returns the difference.
    fn patch(&mut self, part: Extent, registry: Option<&Registry>, change: impl FnOnce(&mut Self)) -> Patch {
        macro_rules! one {
            ($i:ident, $list:ident, $type:ident, $of_one:path) => {{
                let (parts, labels) = (&self.scene.$list, &self.labels.$list);
                let Some(old) = labels.get($i).copied().zip(parts.get($i).cloned()) else {
                    return Patch::default();
                };
                let (_, before) = &old;
                change(self);
                let retyped = before.$type != self.scene.$list[$i].$type;
                if retyped {
                    self.labels.$list[$i].number = 0;
                    self.number_parts(registry);
                }
                let new = (self.labels.$list[$i], self.scene.$list[$i].clone());
                ($of_one($i, old, new), retyped)
            }};
        }
        let (patch, moved) = match part {
            Extent::Rest => {
                let old = rest_of(&self.scene);
                change(self);
                (Patch::of_rest(old, rest_of(&self.scene)), false)
            }
            Extent::Light(i) => one!(i, lights, light_type, Patch::of_light),
            Extent::Object(i) => one!(i, objects, object_type, Patch::of_object),
            Extent::All => {
                let (old, labels) = (self.scene.clone(), self.labels.clone());
                change(self);
                self.label_parts(registry);
                (Patch::between((&old, &labels), (&self.scene, &self.labels)), true)
            }
        };
        if !patch.is_empty() {
            self.touch(if moved { Extent::All } else { part }, moved);
        }
        patch
    }

    /// Gives every part a label after any change to the lists.
    fn label_parts(&mut self, registry: Option<&Registry>) {
        let Self { scene, labels, next, .. } = self;
        labels.lights.resize_with(scene.lights.len(), || Label::new(next));
        labels.objects.resize_with(scene.objects.len(), || Label::new(next));
        self.number_parts(registry);
    }

    /// Changes a part as a consequence of the last step; undoing the step undoes this too.
    pub fn go_on(&mut self, part: Extent, change: impl FnOnce(&mut Scene)) {
        let patch = self.patch(part, None, |document| change(&mut document.scene));
        self.history.go_on(patch);
    }

    /// Changes values without a step, as required when models change.
    pub fn amend(&mut self, change: impl FnOnce(&mut Scene)) {
        change(&mut self.scene);
        self.label_parts(None);
        self.touch(Extent::All, true);
    }

    // ── steps ──

    /// Ends a gesture. Only within a gesture are steps with the same name merged.
    pub fn end_gesture(&mut self) {
        self.gesture += 1;
    }

    /// True if a step could be merged with the last one.
    #[must_use]
    pub fn in_gesture(&self) -> bool {
        self.history.gesture() == Some(self.gesture)
    }

    /// Sets the selection after the last step.
    pub fn selected(&mut self, selection: Selection) {
        self.history.selected(selection);
    }

    /// Undoes the last step. Returns its name and the selection before it.
    pub fn undo(&mut self) -> Option<(String, Selection)> {
        self.go(true)
    }

    /// Redoes the step that was undone last. Returns its name and the selection after it.
    pub fn redo(&mut self) -> Option<(String, Selection)> {
        self.go(false)
    }

    fn go(&mut self, back: bool) -> Option<(String, Selection)> {
        self.end_gesture();
        let (name, selection, part) = self.history.go(back, &mut self.scene, &mut self.labels)?;
        self.touch(part, part != Extent::Rest);
        Some((name, selection))
    }

    /// The names of all steps, the oldest first; those from [`done`](Self::done) on are undone.
    pub fn steps(&self) -> impl ExactSizeIterator<Item = &str> {
        self.history.names()
    }

    /// The number of steps that have not been undone.
    #[must_use]
    pub fn done(&self) -> usize {
        self.history.done()
    }
}
