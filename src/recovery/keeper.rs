//! The thread that keeps the copy of a window up to date.
//!
//! Callers never wait for a disk, and the copy never waits for the window: it is written even while the window hangs
//! in a driver.

use std::{
    io,
    path::PathBuf,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread,
    time::{Duration, Instant},
};

use super::{About, Document, Journal, Store};
use crate::scene::save;

/// A copy is written this long after the first change that is not in it.
const DELAY: Duration = Duration::from_secs(1);

/// Keeps the copy of a window up to date. Clones share it.
#[derive(Clone)]
pub struct Keeper(Arc<Shared>);

struct Shared {
    state: Mutex<State>,
    /// Signalled when there is something to do.
    work: Condvar,
    /// Signalled when something was done.
    done: Condvar,
}

#[derive(Default)]
struct State {
    /// The document that should be on disk; none without unsaved changes.
    wanted: Option<Arc<Document>>,
    /// A copy that another window left, to be continued.
    adopted: Option<Journal>,
    /// Counts the changes of what is wanted, and up to which it is on disk.
    change: u64,
    settled: u64,
    /// The time of the first change that is not on disk.
    since: Option<Instant>,
    /// A caller waits.
    urgent: bool,
    /// The copy that is on disk.
    copy: Option<PathBuf>,
    /// The reason why there is none.
    problem: Option<String>,
    /// True if the problem was reported to the window.
    told: bool,
}

/// The fate of the unsaved changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Settled {
    /// There are none.
    Nothing,
    /// They are in a copy.
    Kept {
        /// The name of the document.
        title: String,
        /// The file of the copy.
        file: PathBuf,
    },
    /// They could not be kept.
    Lost {
        /// The name of the document.
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
                file.display()
            )),
            Self::Lost { title, why } => Some(format!(
                "the unsaved changes of “{title}” are lost, no recovery copy could be written: {why}"
            )),
        }
    }
}

impl Keeper {
    /// Begins to keep copies in a store. `trouble` is called when one could not be written: see [`Self::problem`].
    #[must_use]
    pub fn start(store: Option<Store>, trouble: impl Fn() + Send + 'static) -> Self {
        let shared = Arc::new(Shared { state: Mutex::default(), work: Condvar::new(), done: Condvar::new() });
        let keeper = Self(shared.clone());
        let writer = Writer { store, journal: None };
        if let Err(error) =
            thread::Builder::new().name("recovery".to_owned()).spawn(move || shared.run(writer, &trouble))
        {
            keeper.0.lock().problem = Some(error.to_string());
        }
        keeper
    }

    /// The document has unsaved changes: this is what must not be lost.
    pub fn keep(&self, document: Document) {
        self.0.want(Some(document), None);
    }

    /// There are no unsaved changes: no copy is needed, and there is none soon.
    pub fn forget(&self) {
        self.0.want(None, None);
    }

    /// The copy that another window left is the document now.
    pub fn adopt(&self, journal: Journal, document: Document) {
        self.0.want(Some(document), Some(journal));
    }

    /// True if this is what is kept already, or will be soon.
    #[must_use]
    pub fn keeps(&self, is: impl FnOnce(&Document) -> bool) -> bool {
        // Comparing takes a while: not under the lock.
        let wanted = self.0.lock().wanted.clone();
        wanted.is_some_and(|document| is(&document))
    }

    /// True if there are unsaved changes to keep.
    #[must_use]
    pub fn is_needed(&self) -> bool {
        self.0.lock().wanted.is_some()
    }

    /// The reason why there is no copy, if one is needed and could not be written. Reported once.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        let mut state = self.0.lock();
        let news = state.problem.clone().filter(|_| !state.told);
        state.told |= news.is_some();
        news
    }

    /// Brings the disk up to date now, waits for it at most `within`, and returns the fate of the unsaved changes.
    #[must_use]
    pub fn settle(&self, within: Duration) -> Settled {
        let shared = &self.0;
        let mut state = shared.lock();
        state.urgent = true;
        if state.problem.is_some() {
            // The disk may have room again.
            state.change += 1;
            state.since.get_or_insert_with(Instant::now);
        }
        shared.work.notify_all();
        let pending = |state: &mut State| state.settled != state.change;
        let (state, waited) =
            shared.done.wait_timeout_while(state, within, pending).unwrap_or_else(PoisonError::into_inner);
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

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn want(&self, document: Option<Document>, adopted: Option<Journal>) {
        let mut state = self.lock();
        if document.is_none() && state.wanted.is_none() {
            return;
        }
        if document.is_none() {
            // What is no longer needed goes at once.
            state.urgent = true;
        }
        state.wanted = document.map(Arc::new);
        state.adopted = adopted.or_else(|| state.adopted.take());
        state.change += 1;
        state.since.get_or_insert_with(Instant::now);
        self.work.notify_all();
    }

    /// The loop of the thread, for as long as the process runs.
    fn run(&self, mut writer: Writer, trouble: &dyn Fn()) {
        loop {
            let (change, wanted, adopted) = self.next();
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
                    state.problem = Some(error.to_string());
                    true
                }
            };
            drop(state);
            self.done.notify_all();
            if failed {
                trouble();
            }
        }
    }

    /// Waits until there is something to do, and a caller waits or enough time has passed.
    fn next(&self) -> (u64, Option<Arc<Document>>, Option<Journal>) {
        let mut state = self.lock();
        loop {
            let waits = state.since.map(|since| DELAY.saturating_sub(since.elapsed()));
            state = match waits {
                // Nothing is to be done for anybody who waits.
                None => {
                    state.urgent = false;
                    self.work.wait(state).unwrap_or_else(PoisonError::into_inner)
                }
                Some(wait) if !state.urgent && !wait.is_zero() => {
                    self.work.wait_timeout(state, wait).unwrap_or_else(PoisonError::into_inner).0
                }
                Some(_) => {
                    state.urgent = false;
                    state.since = None;
                    return (state.change, state.wanted.clone(), state.adopted.take());
                }
            };
        }
    }
}

/// The state that only the thread uses.
struct Writer {
    store: Option<Store>,
    journal: Option<Journal>,
}

impl Writer {
    /// Writes or removes the copy. Returns its file, if there is one.
    fn bring_up_to_date(
        &mut self,
        wanted: Option<&Document>,
        adopted: Option<Journal>,
    ) -> io::Result<Option<PathBuf>> {
        // One window has one copy. That of its own is of what the user gave up for the other.
        let own = adopted.and_then(|adopted| self.journal.replace(adopted));
        let Some(Document { about, scene, registry }) = wanted else {
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
        let about = About { process: std::process::id(), ..about.clone() };
        journal.write(&about, &save::to_json(scene, None, registry))?;
        own.into_iter().for_each(Journal::remove);
        Ok(Some(journal.file()))
    }
}

fn no_folder() -> io::Error {
    io::Error::other(format!(
        "there is no folder for the user's data; {} names one",
        crate::library::assets::DATA_VARIABLE
    ))
}

#[cfg(test)]
mod tests {
    use std::{fs, sync::mpsc};

    use super::*;
    use crate::{registry::Registry, scene::Scene};

    /// Generous, since machines are busy.
    const LONG: Duration = Duration::from_secs(60);

    fn document(title: &str) -> Document {
        Document {
            about: About { title: title.to_owned(), path: Some("/room.json".into()), ..About::default() },
            scene: Scene { name: Some(title.to_owned()), ..Scene::default() },
            registry: Arc::new(Registry::builtin()),
        }
    }

    fn store() -> (Store, tempfile::TempDir) {
        let folder = tempfile::tempdir().expect("a folder");
        (Store::new(folder.path().join("copies")), folder)
    }

    /// The path of the copy that must have been kept.
    fn kept(keeper: &Keeper) -> PathBuf {
        match keeper.settle(LONG) {
            Settled::Kept { file, .. } => file,
            other => panic!("{other:?}"),
        }
    }

    /// Waits until something is so.
    fn until(what: &str, so: impl Fn() -> bool) {
        let begin = Instant::now();
        while !so() {
            assert!(begin.elapsed() < LONG, "never {what}");
            thread::sleep(Duration::from_millis(10));
        }
    }

    /// The number of copies on disk, of windows that run or not.
    fn copies(folder: &tempfile::TempDir) -> usize {
        let sessions = fs::read_dir(folder.path().join("copies")).into_iter().flatten().flatten();
        sessions.filter(|journal| journal.path().join("scene.json").exists()).count()
    }

    #[test]
    fn unsaved_changes_are_written_by_themselves_and_go_when_they_are_saved() {
        let (store, folder) = store();
        let keeper = Keeper::start(Some(store), || {});
        assert!(!keeper.is_needed());
        keeper.keep(document("first"));
        assert!(keeper.is_needed() && keeper.keeps(|d| d.about.title == "first"));
        until("written", || copies(&folder) == 1);
        keeper.forget();
        assert!(!keeper.is_needed());
        until("removed", || copies(&folder) == 0);
        assert_eq!(keeper.settle(LONG), Settled::Nothing);
    }

    #[test]
    fn who_waits_gets_the_latest_at_once() {
        let (store, _folder) = store();
        let keeper = Keeper::start(Some(store), || {});
        for i in 0..5 {
            let title = i.to_string();
            keeper.keep(document(&title));
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
            keeper.keep(document(&i.to_string()));
            kept(&keeper);
        }
        assert!(begin.elapsed() < DELAY * 45, "{:?}", begin.elapsed());
    }

    #[test]
    fn what_cannot_be_kept_is_told_with_the_reason() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        fs::write(&file, "").expect("writable");
        for (store, reason) in
            [(None, "LCM_DATA_DIR"), (Some(Store::new(file.join("copies"))), "ot a directory")]
        {
            let (send, told) = mpsc::channel();
            let keeper = Keeper::start(store, move || {
                let _ = send.send(());
            });
            keeper.keep(document("room"));
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
        journal.write(&document("left").about, "{}").expect("written");
        let file = journal.file();
        drop(journal);

        let left = store.left().pop().expect("offered");
        let keeper = Keeper::start(Some(store.clone()), || {});
        // A copy of its own gives way.
        keeper.keep(document("own"));
        assert_ne!(kept(&keeper), file);
        keeper.adopt(left.journal, document("left"));
        assert_eq!(kept(&keeper), file);
        assert_eq!(copies(&folder), 1);
        assert!(fs::read_to_string(&file).expect("there").contains("\"name\": \"left\""));
        keeper.forget();
        assert_eq!(keeper.settle(LONG), Settled::Nothing);
        assert_eq!(copies(&folder), 0);
    }
}
