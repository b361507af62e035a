//! The folder of recovery copies: one folder per window, locked as long as that window runs.

use std::{
    fs::{self, File, OpenOptions, TryLockError},
    io,
    path::{Path, PathBuf},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use super::About;
use crate::files::Shown as _;
use crate::{
    files,
    library::assets,
    parameter::outside,
    program,
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults, MAX_FILE_BYTES},
    },
};

/// The most copies that are kept; the oldest are dropped.
pub const MAX_COPIES: usize = 20;
/// Name of the folder of the copies within the user's data.
const FOLDER: &str = "recovery";
/// The names of the files of a journal.
const SCENE: &str = "scene.json";
const ABOUT: &str = "about.json";
const LOCK: &str = "lock";
/// The most bytes of the file about a document; the library that reads it goes 128 levels deep. The copy itself is a scene
/// file, with the limits of those.
const MAX_ABOUT_BYTES: u64 = 1 << 16;
/// The most entries of the folder that are looked at.
const MAX_ENTRIES: usize = 1000;
/// A folder without a lock belongs to a window that starts, unless it is older than this.
const STARTING: Duration = Duration::from_secs(24 * 3600);

/// The folder with the copies of all windows.
#[derive(Clone, Debug)]
pub struct Store {
    folder: PathBuf,
}

/// The copy of one window. As long as this value lives, no other process offers the copy.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    /// The content of the file beside the copy.
    about: Option<About>,
    /// Held, not used. Some file systems know no locks.
    _lock: Option<File>,
}

/// A copy that a window left behind.
#[derive(Debug)]
pub struct Left {
    /// Its folder, held: no other window offers it meanwhile.
    pub journal: Journal,
    /// The document that it is of.
    pub about: About,
    /// The time of its last change.
    pub when: SystemTime,
}

impl Store {
    /// The one in the user's data, for this program alone; `None` where there is no such folder.
    #[must_use]
    pub fn of_user() -> Option<Self> {
        Some(Self::new(program::own(assets::data_folder()?).join(FOLDER)))
    }

    /// One at any place. The folder need not exist yet.
    #[must_use]
    pub fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// Makes a folder for the copies of this window.
    ///
    /// # Errors
    /// When the folder cannot be made.
    pub fn begin(&self) -> io::Result<Journal> {
        make_folder(&self.folder, true)?;
        if fs::read_dir(&self.folder)?.take(MAX_COPIES).count() == MAX_COPIES {
            for left in self.left().into_iter().skip(MAX_COPIES - 1) {
                left.journal.remove();
            }
        }
        let seconds = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
        let name = format!("{seconds}-{}", std::process::id());
        let mut attempt = 0;
        let folder = loop {
            let folder =
                self.folder.join(if attempt == 0 { name.clone() } else { format!("{name}-{attempt}") });
            match make_folder(&folder, false) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists && attempt < 100 => attempt += 1,
                Err(e) => return Err(e),
                Ok(()) => break folder,
            }
        };
        let lock = first_lock(&folder).ok();
        Ok(Journal { folder, about: None, _lock: lock })
    }

    /// The copies of windows that run no longer, the latest first. Clears away what such windows left without a
    /// copy.
    #[must_use]
    pub fn left(&self) -> Vec<Left> {
        let Ok(entries) = fs::read_dir(&self.folder) else { return Vec::new() };
        let folders = entries.flatten().take(MAX_ENTRIES);
        // A link may lead to what is not ours.
        let folders = folders.filter(|e| e.file_type().is_ok_and(|t| t.is_dir())).map(|e| e.path());
        let mut found: Vec<_> = folders.filter_map(look).collect();
        found.sort_by_key(|left| std::cmp::Reverse(left.when));
        found
    }
}

/// The copy in the folder of a journal, unless that runs.
fn look(folder: PathBuf) -> Option<Left> {
    let scene = fs::metadata(folder.join(SCENE)).ok();
    // Without a copy, what is locked was started already: a folder that has no lock yet is not touched.
    let lock = lock(&folder, scene.is_some());
    if let Ok(None) = lock {
        return None;
    }
    // Before the lock was held, the window may have ended as it should.
    let scene = scene.and_then(|_| fs::metadata(folder.join(SCENE)).ok());
    let Some(scene) = scene else {
        let age = fs::metadata(&folder).and_then(|m| m.modified()).ok().and_then(|t| t.elapsed().ok());
        if lock.is_ok() || age.is_some_and(|age| age > STARTING) {
            let _ = fs::remove_dir_all(&folder);
        }
        return None;
    };
    let about = files::read(&folder.join(ABOUT), MAX_ABOUT_BYTES).ok();
    // The copy counts, even if the file about it is lost.
    let mut about = about.and_then(|bytes| serde_json::from_slice::<About>(&bytes).ok()).unwrap_or_default();
    if about.title.is_empty() {
        "Untitled scene".clone_into(&mut about.title);
    }
    let when = scene.modified().unwrap_or(UNIX_EPOCH);
    let journal = Journal { folder, about: Some(about.clone()), _lock: lock.ok().flatten() };
    Some(Left { journal, about, when })
}

/// Takes the lock of a journal: `None` while another process has it.
fn lock(folder: &Path, create: bool) -> io::Result<Option<File>> {
    let file =
        OpenOptions::new().read(true).write(true).create(create).truncate(false).open(folder.join(LOCK))?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Ok(None),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Makes the lock of a new journal. It is held before it gets its name, so that no other process can hold it first.
fn first_lock(folder: &Path) -> io::Result<File> {
    let hidden = folder.join(format!(".{LOCK}"));
    let file = OpenOptions::new().read(true).write(true).create_new(true).open(&hidden)?;
    file.try_lock().map_err(io::Error::from)?;
    fs::rename(hidden, folder.join(LOCK))?;
    Ok(file)
}

impl Journal {
    /// The file of the copy.
    #[must_use]
    pub fn file(&self) -> PathBuf {
        self.folder.join(SCENE)
    }

    /// Writes the copy, all or nothing.
    ///
    /// # Errors
    /// When it cannot be written, or is larger than any scene that can be read.
    pub fn write(&mut self, about: &About, text: &str) -> io::Result<()> {
        if text.len() as u64 > MAX_FILE_BYTES {
            return Err(io::Error::other("the scene is too large"));
        }
        if self.about.as_ref() != Some(about) {
            if self.about.take().is_some_and(|before| before.path != about.path) {
                // Between the two writes, the copy of one document must not pass for that of another.
                remove_file(&self.file())?;
            }
            files::write(&self.folder.join(ABOUT), &serde_json::to_vec(about)?)?;
            self.about = Some(about.clone());
        }
        Ok(files::write(&self.file(), text.as_bytes())?)
    }

    /// Removes the copy and all that belongs to it.
    pub fn remove(self) {
        // First what makes it one, so that half of it is none. What stays is cleared away at the next start.
        let _ = remove_file(&self.file());
        let _ = fs::remove_dir_all(&self.folder);
    }
}

impl Left {
    /// Reads the scene of the copy.
    ///
    /// # Errors
    /// Every problem, one sentence each, with the name of the file.
    pub fn scene(&self, registry: &Registry) -> Result<Scene, Vec<String>> {
        let file = self.journal.file();
        let name = file.shown().to_string();
        let bytes = files::read(&file, MAX_FILE_BYTES).map_err(|e| vec![format!("{name}: {e}")])?;
        // The files that it names are beside the file of the document, not beside the copy.
        let folder = self.about.path.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
        // Whatever it names was open in the window.
        outside::trusting(|| load::in_folder(&bytes, (&name, folder), registry, Defaults::Use))
            .map(|loaded| loaded.scene)
            .map_err(|e| e.to_string().lines().map(str::to_owned).collect())
    }
}

/// Makes a folder that only this user can look into.
fn make_folder(folder: &Path, with_parents: bool) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(with_parents);
    #[cfg(unix)]
    {
        use std::os::unix::fs::DirBuilderExt as _;
        builder.mode(0o700);
    }
    builder.create(folder)
}

fn remove_file(file: &Path) -> io::Result<()> {
    match fs::remove_file(file) {
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::save::to_json;

    fn about(title: &str) -> About {
        About { title: title.to_owned(), path: Some("/room.json".into()), ..About::default() }
    }

    /// A store in a folder of its own, and that folder.
    fn store() -> (Store, tempfile::TempDir) {
        let folder = tempfile::tempdir().expect("a folder");
        (Store::new(folder.path().join("a/b")), folder)
    }

    fn titles(store: &Store) -> Vec<String> {
        store.left().into_iter().map(|left| left.about.title).collect()
    }

    #[test]
    fn a_copy_is_offered_once_nobody_holds_it() {
        let (store, _folder) = store();
        let registry = Registry::builtin();
        assert!(store.left().is_empty());
        let mut journal = store.begin().expect("made");
        let scene = Scene { name: Some("Mine".to_owned()), ..Scene::default() };
        journal.write(&about("one"), &to_json(&Scene::default(), None, &registry)).expect("written");
        journal.write(&about("two"), &to_json(&scene, None, &registry)).expect("written");
        assert!(store.left().is_empty(), "its window runs");
        drop(journal);

        let left = store.left();
        assert_eq!(left.len(), 1);
        assert_eq!((&left[0].about, left[0].scene(&registry)), (&about("two"), Ok(scene)));
        assert!(left[0].when.elapsed().is_ok_and(|age| age < Duration::from_secs(600)));
        assert!(store.left().is_empty(), "another window asks about it");
        drop(left);
        // Nothing but the user's word removes it.
        for left in store.left() {
            left.journal.remove();
        }
        assert!(store.left().is_empty());
        assert_eq!(fs::read_dir(&store.folder).expect("there").count(), 0);
    }

    #[test]
    fn a_copy_that_cannot_be_read_is_named_and_stays() {
        let (store, _folder) = store();
        let registry = Registry::builtin();
        let text = to_json(&Scene::default(), None, &registry);
        for broken in
            [text.replace("lambert", "lost_model"), text[..text.len() / 2].to_owned(), String::new()]
        {
            let mut journal = store.begin().expect("made");
            journal.write(&about("room"), &broken).expect("written");
            drop(journal);
            let left = store.left().pop().expect("offered");
            let problems = left.scene(&registry).expect_err("broken");
            assert!(problems[0].contains(&left.journal.file().shown().to_string()), "{problems:?}");
            assert_eq!(fs::read_to_string(left.journal.file()).expect("there"), broken);
            left.journal.remove();
        }
    }

    #[test]
    fn a_copy_without_its_description_is_a_copy() {
        let (store, _folder) = store();
        let registry = Registry::builtin();
        let mut journal = store.begin().expect("made");
        journal.write(&about("room"), &to_json(&Scene::default(), None, &registry)).expect("written");
        fs::write(journal.folder.join(ABOUT), "{").expect("writable");
        drop(journal);
        let left = store.left().pop().expect("offered");
        let about = About { title: "Untitled scene".to_owned(), ..About::default() };
        assert_eq!((left.about.clone(), left.scene(&registry)), (about, Ok(Scene::default())));
    }

    #[test]
    fn the_copy_of_one_document_never_passes_for_that_of_another() {
        let (store, _folder) = store();
        let mut journal = store.begin().expect("made");
        journal.write(&about("room"), "text").expect("written");
        let other = About { path: Some("/hall.json".into()), ..about("hall") };
        let scene = journal.file();
        let too_large = " ".repeat(MAX_FILE_BYTES as usize + 1);
        assert!(journal.write(&other, &too_large).is_err());
        assert_eq!(fs::read_to_string(&scene).expect("there"), "text", "nothing was begun");
        // The second step fails, as if the process ended between the two.
        fs::remove_file(journal.folder.join(ABOUT)).expect("removed");
        fs::create_dir_all(journal.folder.join(ABOUT).join("in the way")).expect("made");
        assert!(journal.write(&other, "other").is_err());
        assert!(!scene.exists());
    }

    #[test]
    fn folders_without_a_copy_go_when_their_window_is_gone() {
        let (store, _folder) = store();
        let running = store.begin().expect("made");
        let ended = store.begin().expect("made");
        let gone = ended.folder.clone();
        drop(ended);
        // A window that starts has a folder before it has the lock.
        let starting = store.folder.join("starting");
        fs::create_dir(&starting).expect("made");
        assert!(store.left().is_empty());
        assert!(running.folder.exists() && starting.exists() && !gone.exists());
    }

    #[test]
    fn the_number_of_copies_is_bounded_and_the_oldest_give_way() {
        let (store, _folder) = store();
        for i in 0..MAX_COPIES + 3 {
            let mut journal = store.begin().expect("made");
            journal.write(&about(&i.to_string()), "{}").expect("written");
            let time = UNIX_EPOCH + Duration::from_secs(1000 * i as u64);
            File::options().write(true).open(journal.file()).expect("there").set_modified(time).expect("set");
        }
        let expected: Vec<_> = (3..MAX_COPIES + 3).rev().map(|i| i.to_string()).collect();
        assert_eq!(titles(&store), expected);
    }

    #[cfg(unix)]
    #[test]
    fn special_files_and_links_are_not_followed() {
        let (store, folder) = store();
        let outside = folder.path().join("outside");
        fs::create_dir_all(&store.folder).expect("made");
        fs::create_dir(&outside).expect("made");
        std::os::unix::fs::symlink(&outside, store.folder.join("link")).expect("made");
        fs::write(outside.join(SCENE), "{}").expect("writable");
        let journal = store.begin().expect("made");
        std::os::unix::fs::symlink("/dev/zero", journal.file()).expect("made");
        drop(journal);
        let left = store.left();
        assert_eq!(left.len(), 1);
        let problems = left[0].scene(&Registry::builtin()).expect_err("no end");
        assert!(problems[0].contains("it is a device, but it must be a file"), "{problems:?}");
    }
}
