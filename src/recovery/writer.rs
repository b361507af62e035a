//! The work in the background that keeps a window's copy up to date.
//!
//! Callers never wait for a disk, and the copy never waits for the window: it is written even while the window hangs
//! in a driver.

use std::{
    io,
    path::PathBuf,
    sync::{Arc, Condvar, Mutex, MutexGuard, OnceLock},
    time::Duration,
};

use web_time::Instant;

use super::{About, Journal, Store};
use crate::{
    caught::{lock, unpoisoned},
    document::{Document, Revision},
    files::{Shown as _, words},
    platform::{Next, Worker},
    registry::Registry,
    scene::{Scene, save},
};

/// Delay between the first change that is not in the copy and its writing.
const DELAY: Duration = Duration::from_secs(1);

/// Keeps a window's copy up to date. Clones share it.
#[derive(Clone)]
pub struct Keeper(Arc<Shared>);

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    /// What writes, woken when there is work.
    work: OnceLock<Worker>,
    /// Signalled when work was done.
    done: Condvar,
}

/// A document with unsaved changes.
#[derive(Clone)]
struct Unsaved {
    about: About,
    /// The scene. It may break rules: unfinished work counts.
    scene: Scene,
    /// The document's revision, equal to the scene except for names.
    revision: Revision,
    /// The registry at that time, for the order of parameters.
    registry: Arc<Registry>,
}

#[derive(Default)]
struct State {
    /// The document that should be on disk; `None` without unsaved changes. Shared with the thread while it
    /// writes.
    wanted: Option<Arc<Unsaved>>,
    /// A copy left by another window, to be continued.
    adopted: Option<Journal>,
    /// Number of changes of `wanted`, and the number up to which it is on disk.
    change: u64,
    settled: u64,
    /// Time of the first change that is not on disk.
    since: Option<Instant>,
    /// True if a caller waits.
    urgent: bool,
    /// The copy on disk.
    copy: Option<PathBuf>,
    /// The reason why there is no copy on disk.
    problem: Option<String>,
    /// True if the problem was reported to the window.
    told: bool,
}

/// The outcome for the unsaved changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Settled {
    /// There were no unsaved changes.
    Nothing,
    /// They are in a copy.
    Kept {
        /// Name of the document.
        title: String,
        /// File of the copy.
        file: PathBuf,
    },
    /// They could not be kept.
    Lost {
        /// Name of the document.
        title: String,
        /// The reason.
        why: String,
    },
}

impl Settled {
    /// A message to the user, for standard error.
    #[must_use]
    pub fn sentence(&self) -> Option<String> {
        match self {
            Self::Nothing => None,
            Self::Kept { title, file } => Some(format!(
                "the unsaved changes of “{title}” are kept in {}; the window offers them at its next start",
                file.shown()
            )),
            Self::Lost { title, why } => Some(format!(
                "the unsaved changes of “{title}” are lost, because no recovery copy could be written: {why}"
            )),
        }
    }
}

impl Keeper {
    /// Starts keeping copies in a store. `trouble` is called when one could not be written: see
    /// [`Self::problem`].
    #[must_use]
    pub fn start(store: Option<Store>, trouble: impl Fn() + Send + 'static) -> Self {
        let keeper = Self(Arc::default());
        let shared = keeper.0.clone();
        let mut writer = Writer { store, journal: None };
        match Worker::start("recovery", move || shared.step(&mut writer, &trouble)) {
            Ok(worker) => _ = keeper.0.work.set(worker),
            Err(error) => keeper.0.lock().problem = Some(words(&error)),
        }
        keeper
    }

    /// Records that the document has unsaved changes, which must not be lost. Copies the parts changed since
    /// the last call, and does nothing if there are none.
    pub fn keep(&self, document: &Document, about: About, registry: &Arc<Registry>) {
        let mut state = self.0.lock();
        let parts = state.wanted.as_ref().and_then(|kept| document.changes_since(kept.revision));
        match (&mut state.wanted, parts) {
            (Some(kept), Some(parts)) if parts.is_empty() && kept.about == about => return,
            (Some(kept), Some(parts)) => {
                // While the thread writes the kept scene, this copies all of it, at most once for each write.
                let kept = Arc::make_mut(kept);
                for part in parts {
                    part.copy(document, &mut kept.scene);
                    document.write_names(part, &mut kept.scene, registry);
                }
                (kept.about, kept.revision) = (about, document.revision());
                kept.registry = registry.clone();
            }
            (wanted, _) => *wanted = Some(Arc::new(Unsaved::new(document, about, registry))),
        }
        self.0.changed(state);
    }

    /// Records that there are no unsaved changes: the copy is not needed, and is removed soon.
    pub fn forget(&self) {
        let mut state = self.0.lock();
        if state.wanted.take().is_some() {
            // A copy that is no longer needed is removed at once.
            state.urgent = true;
            self.0.changed(state);
        }
    }

    /// Lets the copy be written without delay, also if it seems up to date. Nobody waits for it.
    pub fn hurry(&self) {
        let mut state = self.0.lock();
        if state.wanted.is_some() {
            state.urgent = true;
            self.0.changed(state);
        }
    }

    /// Continues the copy left by another window, which is the document now.
    pub fn adopt(&self, journal: Journal, document: &Document, about: About, registry: &Arc<Registry>) {
        let mut state = self.0.lock();
        state.wanted = Some(Arc::new(Unsaved::new(document, about, registry)));
        state.adopted = Some(journal);
        self.0.changed(state);
    }

    /// The reason why a needed copy could not be written, if so. Reported once.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        let mut state = self.0.lock();
        let news = state.problem.clone().filter(|_| !state.told);
        state.told |= news.is_some();
        news
    }

    /// Brings the disk up to date now, waits for it at most `within`, and returns the outcome for the unsaved
    /// changes.
    #[must_use]
    pub fn settle(&self, within: Duration) -> Settled {
        let shared = &self.0;
        let mut state = shared.lock();
        state.urgent = true;
        if state.problem.is_some() {
            // There may be space on the disk again.
            state.change += 1;
            state.since.get_or_insert_with(Instant::now);
        }
        shared.wake();
        let pending = |state: &mut State| state.settled != state.change;
        let (state, waited) = unpoisoned(shared.done.wait_timeout_while(state, within, pending));
        let Some(document) = &state.wanted else { return Settled::Nothing };
        let title = document.about.title.clone();
        match &state.copy {
            Some(file) => Settled::Kept { title, file: file.clone() },
            None if waited.timed_out() => {
                Settled::Lost { title, why: "writing it takes too long".to_owned() }
            }
            None => {
                let unknown = || "it could not be written".to_owned();
                Settled::Lost { title, why: state.problem.clone().unwrap_or_else(unknown) }
            }
        }
    }
}

impl Unsaved {
    fn new(document: &Document, about: About, registry: &Arc<Registry>) -> Self {
        let scene = document.named(registry);
        Self { about, scene, revision: document.revision(), registry: registry.clone() }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }

    /// Records a change of the wanted document.
    fn changed(&self, mut state: MutexGuard<'_, State>) {
        state.change += 1;
        state.since.get_or_insert_with(Instant::now);
        self.wake();
    }

    fn wake(&self) {
        self.work.get().into_iter().for_each(Worker::wake);
    }

    /// A step of the work, which lasts for the lifetime of the process.
    fn step(&self, writer: &mut Writer, trouble: &dyn Fn()) -> Next {
        let (change, wanted, adopted) = match self.next() {
            Ok(next) => next,
            Err(wait) => return wait,
        };
        let written = writer.bring_up_to_date(wanted.as_deref(), adopted);
        let mut state = self.lock();
        state.settled = change;
        state.copy = None;
        let failed = match written {
            Ok(copy) => {
                (state.copy, state.problem, state.told) = (copy, None, false);
                false
            }
            Err(error) => {
                state.problem = Some(words(&error));
                true
            }
        };
        drop(state);
        self.done.notify_all();
        if failed {
            trouble();
        }
        Next::Now
    }

    /// The work, if there is some, and a caller waits or enough time has passed; otherwise what to wait for.
    fn next(&self) -> Result<(u64, Option<Arc<Unsaved>>, Option<Journal>), Next> {
        let mut state = self.lock();
        match state.since.map(|since| DELAY.saturating_sub(since.elapsed())) {
            // Callers that wait have nothing to wait for.
            None => {
                state.urgent = false;
                Err(Next::Woken)
            }
            Some(wait) if !state.urgent && !wait.is_zero() => Err(Next::After(wait)),
            Some(_) => {
                state.urgent = false;
                state.since = None;
                Ok((state.change, state.wanted.clone(), state.adopted.take()))
            }
        }
    }
}

/// State used only by the work.
struct Writer {
    store: Option<Store>,
    journal: Option<Journal>,
}

impl Writer {
    /// Writes or removes the copy. Returns the file of an existing copy.
    fn bring_up_to_date(
        &mut self,
        wanted: Option<&Unsaved>,
        adopted: Option<Journal>,
    ) -> io::Result<Option<PathBuf>> {
        // One window has one copy. Its earlier copy is of a document that the user gave up for the other.
        let own = adopted.and_then(|adopted| self.journal.replace(adopted));
        let Some(Unsaved { about, scene, registry, .. }) = wanted else {
            own.into_iter().chain(self.journal.take()).for_each(Journal::remove);
            return Ok(None);
        };
        let journal = match &mut self.journal {
            Some(journal) => journal,
            none => {
                let store = self.store.as_ref().ok_or_else(no_folder)?;
                none.insert(store.begin()?)
            }
        };
        let about = About { process: crate::platform::process(), ..about.clone() };
        journal.write(&about, &save::to_json(scene, None, registry))?;
        own.into_iter().for_each(Journal::remove);
        Ok(Some(journal.file()))
    }
}

fn no_folder() -> io::Error {
    io::Error::other(format!(
        "there is no folder for the user's data; set {} to one",
        crate::library::assets::DATA_VARIABLE
    ))
}

#[cfg(test)]
mod tests {
    use std::{fs, sync::mpsc, thread};

    use super::*;
    use crate::{
        document::{Edit, Extent, Selection},
        scene::{Object, Part},
    };

    /// True if there are unsaved changes to keep.
    fn is_needed(keeper: &Keeper) -> bool {
        keeper.0.lock().wanted.is_some()
    }

    /// Generous, since machines may be busy.
    const LONG: Duration = Duration::from_secs(60);

    fn about(title: &str) -> About {
        About { title: title.to_owned(), path: Some("/room.json".into()), ..About::default() }
    }

    fn document(title: &str) -> Document {
        Document::new(Scene { name: Some(title.to_owned()), ..Scene::default() })
    }

    fn keep(keeper: &Keeper, title: &str) {
        keeper.keep(&document(title), about(title), &Arc::new(Registry::builtin()));
    }

    fn store() -> (Store, tempfile::TempDir) {
        let folder = tempfile::tempdir().expect("a folder");
        (Store::new(folder.path().join("copies")), folder)
    }

    /// The path of the copy, which must exist.
    fn kept(keeper: &Keeper) -> PathBuf {
        match keeper.settle(LONG) {
            Settled::Kept { file, .. } => file,
            other => panic!("{other:?}"),
        }
    }

    /// Waits until a condition holds.
    fn until(what: &str, so: impl Fn() -> bool) {
        let begin = Instant::now();
        while !so() {
            assert!(begin.elapsed() < LONG, "never {what}");
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// The number of copies on disk, of running windows or others.
    fn copies(folder: &tempfile::TempDir) -> usize {
        let sessions = fs::read_dir(folder.path().join("copies")).into_iter().flatten().flatten();
        sessions.filter(|journal| journal.path().join("scene.json").exists()).count()
    }

    #[test]
    fn unsaved_changes_are_written_by_themselves_and_go_when_they_are_saved() {
        let (store, folder) = store();
        let keeper = Keeper::start(Some(store), || {});
        assert!(!is_needed(&keeper));
        keep(&keeper, "first");
        assert!(is_needed(&keeper));
        until("written", || copies(&folder) == 1);
        keeper.forget();
        assert!(!is_needed(&keeper));
        until("removed", || copies(&folder) == 0);
        assert_eq!(keeper.settle(LONG), Settled::Nothing);
    }

    #[test]
    fn who_waits_gets_the_latest_at_once() {
        let (store, _folder) = store();
        let keeper = Keeper::start(Some(store), || {});
        for i in 0..5 {
            let title = i.to_string();
            keep(&keeper, &title);
            let file = kept(&keeper);
            let text = fs::read_to_string(file).expect("there");
            assert!(text.contains(&format!("\"name\": \"{title}\"")), "{text}");
        }
    }

    #[test]
    fn an_urgent_copy_does_not_wait_for_the_delay() {
        let (store, _folder) = store();
        let keeper = Keeper::start(Some(store), || {});
        // Each would wait for a second.
        let begin = Instant::now();
        for i in 0..60 {
            keep(&keeper, &i.to_string());
            kept(&keeper);
        }
        assert!(begin.elapsed() < DELAY * 45, "{:?}", begin.elapsed());
    }

    #[test]
    fn a_copy_in_a_hurry_is_written_at_once_and_nobody_waits() {
        let (store, folder) = store();
        let keeper = Keeper::start(Some(store), || {});
        keeper.hurry();
        assert_eq!(copies(&folder), 0, "there is nothing to copy");
        let begin = Instant::now();
        for i in 0..20 {
            keep(&keeper, &i.to_string());
            keeper.hurry();
            until("written", || {
                let state = keeper.0.lock();
                state.settled == state.change
            });
        }
        assert_eq!(copies(&folder), 1);
        assert!(begin.elapsed() < DELAY * 15, "{:?}", begin.elapsed());
    }

    #[test]
    fn what_cannot_be_kept_is_told_with_the_reason() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        fs::write(&file, "").expect("writable");
        for (store, reason) in
            [(None, "LCM_DATA_DIR"), (Some(Store::new(file.join("copies"))), "is not a folder")]
        {
            let (send, told) = mpsc::channel();
            let keeper = Keeper::start(store, move || {
                let _ = send.send(());
            });
            keep(&keeper, "room");
            match keeper.settle(LONG) {
                Settled::Lost { title, why } => assert!(title == "room" && why.contains(reason), "{why}"),
                other => panic!("{other:?}"),
            }
            told.recv_timeout(LONG).expect("told");
            assert!(keeper.problem().is_some_and(|why| why.contains(reason)));
            assert_eq!(keeper.problem(), None, "once");
        }
    }

    #[test]
    fn a_copy_that_was_left_is_gone_on_with() {
        let (store, folder) = store();
        let mut journal = store.begin().expect("made");
        journal.write(&about("left"), "{}").expect("written");
        let file = journal.file();
        drop(journal);

        let copy = store.abandoned().pop().expect("offered");
        let keeper = Keeper::start(Some(store.clone()), || {});
        // The window's own copy is dropped.
        keep(&keeper, "own");
        assert_ne!(kept(&keeper), file);
        keeper.adopt(copy.journal, &document("left"), about("left"), &Arc::new(Registry::builtin()));
        assert_eq!(kept(&keeper), file);
        assert_eq!(copies(&folder), 1);
        assert!(fs::read_to_string(&file).expect("there").contains("\"name\": \"left\""));
        keeper.forget();
        assert_eq!(keeper.settle(LONG), Settled::Nothing);
        assert_eq!(copies(&folder), 0);
    }

    #[test]
    fn a_change_of_one_part_is_copied_alone_and_nothing_is_lost() {
        // Without the thread, which would share the kept scene while it writes.
        let keeper = Keeper(Arc::default());
        let registry = Arc::new(Registry::builtin());
        // The second has no name.
        let name = |i: usize| (i != 1).then(|| format!("ball {i}"));
        let ball = |i: usize| Object { name: name(i), ..Object::default() };
        let mut document = Document::new(Scene { objects: (0..3).map(ball).collect(), ..Scene::default() });
        let keep = |document: &Document, title: &str| {
            keeper.keep(document, about(title), &registry);
            let state = keeper.0.lock();
            let kept = state.wanted.clone().expect("kept");
            assert!(document.named(&registry) == kept.scene && kept.about.title == title);
            (
                kept.scene.objects.iter().map(|o| o.name.as_deref().map(str::as_ptr)).collect::<Vec<_>>(),
                state.change,
            )
        };
        let (before, change) = keep(&document, "a");
        assert_eq!(keep(&document, "a"), (before.clone(), change), "nothing changed");
        let edit = |document: &mut Document, size: f32| {
            let edit = Edit::set(Part::Object(1), Object::size, size);
            document.edit(edit, Selection::Room, &registry).expect("legal");
        };
        edit(&mut document, 0.5);
        let (after, _) = keep(&document, "a");
        assert_eq!([0, 2].map(|i| after[i]), [0, 2].map(|i| before[i]), "the others are not copied");
        let (renamed, later) = keep(&document, "b");
        assert!(renamed == after && later == change + 2, "the file is another, the scene is not");
        // While the thread writes, the document changes: the scene being written stays unchanged.
        let written = keeper.0.lock().wanted.clone().expect("kept");
        edit(&mut document, 0.75);
        keep(&document, "b");
        assert_eq!(written.scene.objects[1].size, 0.5);
        drop(written);
        document.undo().expect("a step");
        keep(&document, "b");
        document.redo().expect("a step");
        keep(&document, "b");
        document.remove(Selection::Object(0), &registry);
        keep(&document, "b");
        let name = keeper.0.lock().wanted.as_ref().and_then(|kept| kept.scene.objects[0].name.clone());
        assert_eq!(name.as_deref(), Some("Sphere 2"), "a copy keeps the names of parts without one");
        document.change("Display", Extent::Rest, Selection::Room, |s| s.display.exposure = 1.0);
        keep(&document, "b");
        // More changes than a document remembers, and another document.
        for i in 0..100 {
            edit(&mut document, 0.1 + i as f32 / 100.0);
        }
        keep(&document, "b");
        keep(&Document::new(Scene::default()), "c");
        keeper.forget();
        assert!(!is_needed(&keeper));
        keep(&document, "b");
    }
}
