//! Copies of unsaved texts of the editor, one journal each, written in the background a second after the first change.
//!
//! They are in a store of their own, so that a copy of a scene is never taken for that of a shader.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex,
        mpsc::{self, Receiver, Sender},
    },
    time::Duration,
};

use web_time::Instant;

use super::{Abandoned, About, Journal, Store, ago};
use crate::{
    caught::lock,
    files,
    library::assets,
    platform::{self, Next, Worker, fs},
    program,
};

/// Maximum time for which the end of a window waits for the disk.
const PATIENCE: Duration = Duration::from_secs(60);
/// Delay between the first change that is not in a copy and its writing.
const DELAY: Duration = Duration::from_secs(1);
/// Name of the folder with the copies, in the user's data.
const FOLDER: &str = "recovery of code";
/// Greatest size of a copy that is read, bytes.
const MOST: u64 = 1 << 20;

/// The place of the scene as JSON among the texts, which is no file of its own.
pub const OF_SCENE: &str = "the scene as JSON";

/// The texts with unsaved changes, by their files, or [`OF_SCENE`].
pub type Texts = BTreeMap<PathBuf, Arc<str>>;

impl Store {
    /// The store of the editor's texts in the user's data; `None` without such a folder.
    #[must_use]
    pub fn of_texts() -> Option<Self> {
        Some(Self::new(program::own(assets::data_folder()?).join(FOLDER)))
    }
}

/// Keeps copies of texts up to date.
#[derive(Debug)]
pub struct TextKeeper {
    work: Option<Work>,
    last: Texts,
}

#[derive(Debug)]
struct Work {
    worker: Worker,
    wanted: Arc<Mutex<Wanted>>,
    /// Closed at the end.
    ended: Mutex<Receiver<()>>,
}

#[derive(Debug, Default)]
struct Wanted {
    /// The texts that are not in copies yet, and since when.
    texts: Option<(Texts, Instant)>,
    closed: bool,
}

/// The copies.
struct Copies {
    store: Store,
    /// Dropped, and with them their locks, before the end is told.
    journals: BTreeMap<PathBuf, (Journal, Arc<str>)>,
    _ended: Sender<()>,
}

impl TextKeeper {
    /// Starts to keep copies in a store; without one, nothing is kept.
    #[must_use]
    pub fn start(store: Option<Store>) -> Self {
        let work = |store| {
            let (tell, ended) = mpsc::channel();
            let wanted = Arc::<Mutex<Wanted>>::default();
            let theirs = wanted.clone();
            let mut copies = Copies { store, journals: BTreeMap::new(), _ended: tell };
            let worker = Worker::start("recovery of code", move || step(&theirs, &mut copies)).ok()?;
            Some(Work { worker, wanted, ended: Mutex::new(ended) })
        };
        Self { work: store.and_then(work), last: Texts::new() }
    }

    /// Records the texts with unsaved changes. Copies of others are no longer needed.
    pub fn keep(&mut self, texts: Texts) {
        if texts == self.last {
            return;
        }
        self.last = texts.clone();
        if let Some(work) = &self.work {
            let mut wanted = lock(&work.wanted);
            let since = wanted.texts.as_ref().map_or_else(Instant::now, |(_, since)| *since);
            wanted.texts = Some((texts, since));
            work.worker.wake();
        }
    }
}

impl Drop for TextKeeper {
    fn drop(&mut self) {
        let Some(work) = &self.work else { return };
        lock(&work.wanted).closed = true;
        work.worker.wake();
        // Closed once the last texts are written.
        let _ = platform::receive(&lock(&work.ended), PATIENCE);
    }
}

/// Follows the texts until the end; the last ones are written at once.
fn step(wanted: &Mutex<Wanted>, Copies { store, journals, .. }: &mut Copies) -> Next {
    let mut wanted = lock(wanted);
    let closed = wanted.closed;
    let Some((texts, since)) = wanted.texts.take() else {
        return if closed { Next::Never } else { Next::Woken };
    };
    let left = DELAY.saturating_sub(since.elapsed());
    if !closed && !left.is_zero() {
        wanted.texts = Some((texts, since));
        return Next::After(left);
    }
    drop(wanted);
    update(store, journals, &texts);
    Next::Now
}

fn update(store: &Store, journals: &mut BTreeMap<PathBuf, (Journal, Arc<str>)>, texts: &Texts) {
    let gone: Vec<_> = journals.keys().filter(|path| !texts.contains_key(*path)).cloned().collect();
    for path in gone {
        journals.remove(&path).into_iter().for_each(|(journal, _)| journal.remove());
    }
    for (path, text) in texts {
        if journals.get(path).is_some_and(|(_, kept)| kept == text) {
            continue;
        }
        let title = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let is_file = path != Path::new(OF_SCENE);
        let absolute = is_file.then(|| fs::absolute(path).ok()).flatten();
        let absolute = absolute.unwrap_or_else(|| path.clone());
        let process = platform::process();
        let about = About { title, path: Some(absolute), process, ..About::default() };
        let known = journals.remove(path).map(|(journal, _)| journal);
        // Without a place for copies, the text is in the editor all the same.
        let Some(mut journal) = known.or_else(|| store.begin().ok()) else { continue };
        let _ = journal.write(&about, text);
        journals.insert(path.clone(), (journal, text.clone()));
    }
}

/// A text that an earlier window left.
#[derive(Debug)]
pub struct KeptText {
    /// The file that it belongs to.
    pub path: PathBuf,
    /// The text.
    pub text: String,
    /// Its age: "5 minutes ago".
    pub when: String,
    copy: Abandoned,
}

impl KeptText {
    /// Removes the copy.
    pub fn remove(self) {
        self.copy.journal.remove();
    }

    /// True for the copy of the text of this file.
    #[must_use]
    pub fn is_of(&self, path: &Path) -> bool {
        self.path == path
    }
}

/// The texts that earlier windows left. What cannot be read stays where it is.
#[must_use]
pub fn left(store: &Store) -> Vec<KeptText> {
    let read = |copy: Abandoned| {
        let path = copy.about.path.clone()?;
        let text = String::from_utf8(files::read(&copy.journal.file(), MOST).ok()?).ok()?;
        let age = platform::now().duration_since(copy.when).unwrap_or_default();
        Some(KeptText { path, text, when: ago(age), copy })
    };
    store.abandoned().into_iter().filter_map(read).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn texts(all: &[(&str, &str)]) -> Texts {
        all.iter().map(|(path, text)| (PathBuf::from(path), Arc::from(*text))).collect()
    }

    #[test]
    fn unsaved_texts_outlive_the_window_and_saved_ones_leave_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::new(folder.path().join("a"));
        let mut keeper = TextKeeper::start(Some(store.clone()));
        keeper.keep(texts(&[("/models/a.wgsl", "a"), ("/models/b.wgsl", "b")]));
        keeper.keep(texts(&[("/models/a.wgsl", "a 2"), ("/models/b.wgsl", "b")]));
        // The end of the window does not wait for the delay.
        drop(keeper);
        let mut found: Vec<_> = left(&store).into_iter().map(|kept| (kept.path, kept.text)).collect();
        found.sort();
        let expected = [("/models/a.wgsl", "a 2"), ("/models/b.wgsl", "b")];
        assert_eq!(found, expected.map(|(path, text)| (PathBuf::from(path), text.to_owned())));
        // The user continues with one of them, and saves it.
        let kept = left(&store);
        for kept in kept {
            if kept.is_of(Path::new("/models/a.wgsl")) {
                kept.remove();
            }
        }
        assert_eq!(left(&store).len(), 1);
        let mut keeper = TextKeeper::start(Some(store.clone()));
        keeper.keep(texts(&[("/models/c.wgsl", "c")]));
        keeper.keep(Texts::new());
        drop(keeper);
        assert_eq!(left(&store).len(), 1, "what was saved needs no copy");
    }

    #[test]
    fn a_copy_that_is_no_text_is_not_offered_and_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::new(folder.path().join("a"));
        let mut keeper = TextKeeper::start(Some(store.clone()));
        keeper.keep(texts(&[(OF_SCENE, "{")]));
        drop(keeper);
        let kept = left(&store).remove(0);
        // It is none of the files in the present folder.
        assert!(kept.is_of(Path::new(OF_SCENE)) && kept.text == "{", "{kept:?}");
        let file = kept.copy.journal.file();
        // As long as it is held, nobody else is offered it.
        drop(kept);
        fs::write(&file, b"\xff").expect("writable");
        assert!(left(&store).is_empty());
        assert!(file.exists());
    }
}
