//! The folder of recovery copies: one folder per window, locked while that window runs.

use std::{
    ffi::OsStr,
    io,
    path::{Path, PathBuf},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use super::About;
use crate::{
    files::{self, Shown as _},
    library::assets,
    parameter::Outside,
    platform::{
        self,
        fs::{self, File, OpenOptions, TryLockError},
    },
    program,
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults, MAX_FILE_BYTES},
    },
    text::{listed, shortened},
};

/// Maximum number of copies; the oldest are dropped.
pub const MAX_COPIES: usize = 20;
/// Name of the folder with the copies, in the user's data.
const FOLDER: &str = "recovery";
/// Names of the files in a journal.
const SCENE: &str = "scene.json";
const ABOUT: &str = "about.json";
const LOCK: &str = "lock";
/// Maximum size of the file about a document, in bytes; the library that reads it handles 128 levels of
/// nesting. The copy itself is a scene file, with the limits of scene files.
const MAX_ABOUT_BYTES: u64 = 1 << 16;
/// Maximum number of entries of the folder that are examined.
const MAX_ENTRIES: usize = 1000;
/// Age up to which a folder without a lock is assumed to belong to a window that is starting.
const STARTING: Duration = Duration::from_secs(24 * 3600);

/// The folder with the copies of all windows.
#[derive(Clone, Debug)]
pub struct Store {
    folder: PathBuf,
}

/// The copy of one window. While this value exists, no other process offers the copy.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    /// Contents of the file next to the copy.
    about: Option<About>,
    /// Held, not used; `None` on file systems without locks.
    _lock: Option<File>,
}

/// A copy left behind by a window.
#[derive(Debug)]
pub struct Abandoned {
    /// The folder, held: no other window offers it meanwhile.
    pub journal: Journal,
    /// The copied document.
    pub about: About,
    /// Time of the last change.
    pub when: SystemTime,
}

impl Store {
    /// The store in the user's data, readable only by this program's user; `None` without such a folder.
    #[must_use]
    pub fn of_user() -> Option<Self> {
        Some(Self::new(program::own(assets::data_folder()?).join(FOLDER)))
    }

    /// A store in any folder, which need not exist yet.
    #[must_use]
    pub fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// Creates a folder for the copies of this window.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be created.
    pub fn begin(&self) -> io::Result<Journal> {
        make_folder(&self.folder, true)?;
        if fs::read_dir(&self.folder)?.take(MAX_COPIES).count() == MAX_COPIES {
            for copy in self.abandoned().into_iter().skip(MAX_COPIES - 1) {
                copy.journal.remove();
            }
        }
        let seconds = platform::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs();
        let name = format!("{seconds}-{}", platform::process());
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

    /// The copies of windows that no longer run, latest first. Removes what such windows left without a copy.
    #[must_use]
    pub fn abandoned(&self) -> Vec<Abandoned> {
        let Ok(entries) = fs::read_dir(&self.folder) else { return Vec::new() };
        let folders = entries.flatten().take(MAX_ENTRIES);
        // A link may lead to a folder of somebody else.
        let folders = folders.filter(|e| e.file_type().is_ok_and(|t| t.is_dir()) && is_ours(&e.file_name()));
        let folders = folders.map(|e| e.path());
        let mut found: Vec<_> = folders.filter_map(abandoned).collect();
        found.sort_by_key(|copy| std::cmp::Reverse(copy.when));
        found
    }
}

/// The copy in the folder of a journal, unless that runs.
fn abandoned(folder: PathBuf) -> Option<Abandoned> {
    let scene = fs::metadata(folder.join(SCENE)).ok();
    // A folder without a copy is removed only if it has a lock: one without a lock may belong to a window
    // that is starting.
    let lock = lock(&folder, scene.is_some());
    if let Ok(None) = lock {
        return None;
    }
    // The window may have ended regularly before the lock was acquired.
    let scene = scene.and_then(|_| fs::metadata(folder.join(SCENE)).ok());
    let Some(scene) = scene else {
        let age = fs::metadata(&folder)
            .and_then(|m| m.modified())
            .ok()
            .and_then(|t| platform::now().duration_since(t).ok());
        if lock.is_ok() || age.is_some_and(|age| age > STARTING) {
            remove_own(&folder);
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
    Some(Abandoned { journal, about, when })
}

/// True for the name of a journal's folder: seconds, process, and perhaps an attempt. Others are somebody else's.
fn is_ours(name: &OsStr) -> bool {
    let numbers =
        name.to_str().map(|name| name.split('-').map(|n| n.parse::<u64>().is_ok()).collect::<Vec<_>>());
    matches!(numbers.as_deref(), Some([true, true] | [true, true, true]))
}

/// Removes what a journal writes, and its folder if nothing else is in it. The scene goes first, so that an incomplete removal
/// leaves no copy; the rest is removed at the next start.
fn remove_own(folder: &Path) {
    for name in [SCENE, ABOUT] {
        let _ = remove_file(&folder.join(name));
    }
    let _ = files::tidy(folder);
    for name in [format!(".{LOCK}"), LOCK.to_owned()] {
        let _ = remove_file(&folder.join(name));
    }
    let _ = fs::remove_dir(folder);
}

/// Acquires the lock of a journal: `None` while another process holds it.
fn lock(folder: &Path, create: bool) -> io::Result<Option<File>> {
    let file =
        OpenOptions::new().read(true).write(true).create(create).truncate(false).open(folder.join(LOCK))?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Ok(None),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Creates the lock of a new journal. It is held before it gets its name, so that no other process can
/// acquire it first.
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
    /// Returns an error if the copy cannot be written, or is larger than any readable scene.
    pub fn write(&mut self, about: &About, text: &str) -> io::Result<()> {
        if text.len() as u64 > MAX_FILE_BYTES {
            return Err(io::Error::other("the scene is too large"));
        }
        if self.about.as_ref() != Some(about) {
            if self.about.take().is_some_and(|before| before.path != about.path) {
                // Between the two writes, the copy of one document must not be mistaken for that of another.
                remove_file(&self.file())?;
            }
            files::write(&self.folder.join(ABOUT), &serde_json::to_vec(about)?)?;
            self.about = Some(about.clone());
        }
        Ok(files::write(&self.file(), text.as_bytes())?)
    }

    /// Removes the copy and everything that belongs to it.
    pub fn remove(self) {
        remove_own(&self.folder);
    }
}

impl Abandoned {
    /// Reads the scene of the copy.
    ///
    /// # Errors
    /// Returns every problem with the name of the file, but only the unknown models if there are some: what they lack is
    /// the cause of the others.
    pub fn scene(&self, registry: &Registry) -> Result<Scene, Vec<String>> {
        let file = self.journal.file();
        let name = file.shown().to_string();
        let bytes = files::read(&file, MAX_FILE_BYTES).map_err(|e| vec![format!("{name}: {e}")])?;
        // Paths in the scene are relative to the document's file, not to the copy.
        let folder = self.about.path.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
        // All files named in it were open in the window.
        load::in_folder(&bytes, (&name, folder), registry, Defaults::Use.allowing(Outside::ALL))
            .map(|loaded| loaded.scene)
            .map_err(|e| match self.unknown_models(&bytes, registry) {
                Some(unknown) => vec![format!("{name}: {unknown}")],
                None => e.to_string().lines().map(str::to_owned).collect(),
            })
    }

    /// The models of the copy that are not known, and where custom models are read; `None` if all are known.
    fn unknown_models(&self, bytes: &[u8], registry: &Registry) -> Option<String> {
        let is_unknown = |id: &String| registry.model(id).is_none() && registry.broken_model(id).is_none();
        let named = load::models_named(bytes, SCENE, registry).into_iter().filter(is_unknown);
        let names: Vec<_> = named.map(|id| format!("“{}”", shortened(&id))).collect();
        let (which, are) = match names.len() {
            0 => return None,
            1 => ("the model", "is"),
            _ => ("the models", "are"),
        };
        let now = registry.custom_folder();
        let absolute = now.and_then(|folder| fs::absolute(folder).ok());
        let hint = match (self.about.models.as_deref(), now) {
            (Some(then), _) if absolute.as_deref() != Some(then) => format!(
                "The window of this copy read custom models from {}; start with --models and that folder.",
                then.shown()
            ),
            (_, Some(now)) => {
                format!("Custom models are read from {}, or from FOLDER with --models FOLDER.", now.shown())
            }
            (_, None) => "Custom models are read from FOLDER with --models FOLDER.".to_owned(),
        };
        Some(format!("{which} {} {are} not known. {hint}", listed(&names, "and")))
    }
}

/// Creates a folder that only this user can access.
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

    /// A store in a new folder, and that folder.
    fn store() -> (Store, tempfile::TempDir) {
        let folder = tempfile::tempdir().expect("a folder");
        (Store::new(folder.path().join("a/b")), folder)
    }

    fn titles(store: &Store) -> Vec<String> {
        store.abandoned().into_iter().map(|copy| copy.about.title).collect()
    }

    #[test]
    fn a_copy_is_offered_once_nobody_holds_it() {
        let (store, _folder) = store();
        let registry = Registry::builtin();
        assert!(store.abandoned().is_empty());
        let mut journal = store.begin().expect("made");
        let scene = Scene { name: Some("Mine".to_owned()), ..Scene::default() };
        journal.write(&about("one"), &to_json(&Scene::default(), None, &registry)).expect("written");
        journal.write(&about("two"), &to_json(&scene, None, &registry)).expect("written");
        assert!(store.abandoned().is_empty(), "its window runs");
        drop(journal);

        let copies = store.abandoned();
        assert_eq!(copies.len(), 1);
        assert_eq!((&copies[0].about, copies[0].scene(&registry)), (&about("two"), Ok(scene)));
        assert!(copies[0].when.elapsed().is_ok_and(|age| age < Duration::from_secs(600)));
        assert!(store.abandoned().is_empty(), "another window asks about it");
        drop(copies);
        // Nothing but the user's word removes it.
        for copy in store.abandoned() {
            copy.journal.remove();
        }
        assert!(store.abandoned().is_empty());
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
            let copy = store.abandoned().pop().expect("offered");
            let problems = copy.scene(&registry).expect_err("broken");
            assert!(problems[0].contains(&copy.journal.file().shown().to_string()), "{problems:?}");
            assert_eq!(fs::read_to_string(copy.journal.file()).expect("there"), broken);
            copy.journal.remove();
        }
    }

    #[test]
    fn a_copy_with_models_of_another_folder_says_where_they_were() {
        let (store, _folder) = store();
        let mut registry = Registry::builtin();
        let text = to_json(&Scene::default(), None, &registry).replace("lambert", "my_model");
        let mut said = |models: Option<&str>, here: Option<&str>| {
            let mut journal = store.begin().expect("made");
            let about = About { models: models.map(PathBuf::from), ..about("room") };
            journal.write(&about, &text).expect("written");
            drop(journal);
            if let Some(here) = here {
                registry.set_custom_folder(Path::new(here));
            }
            let copy = store.abandoned().pop().expect("offered");
            assert_eq!(copy.about, about);
            let file = format!("{}: ", copy.journal.file().shown());
            let problems = copy.scene(&registry).expect_err("unknown");
            copy.journal.remove();
            assert_eq!(problems.len(), 1, "{problems:?}");
            problems[0].strip_prefix(&file).expect("the file").to_owned()
        };
        let unknown = "the model “my_model” is not known. ";
        let there =
            "The window of this copy read custom models from /mods2; start with --models and that folder.";
        let anywhere = "Custom models are read from FOLDER with --models FOLDER.";
        let here = "Custom models are read from /mods2, or from FOLDER with --models FOLDER.";
        assert_eq!(said(None, None), format!("{unknown}{anywhere}"));
        assert_eq!(said(Some("/mods2"), None), format!("{unknown}{there}"));
        assert_eq!(said(Some("/mods2"), Some("/models")), format!("{unknown}{there}"));
        assert_eq!(said(Some("/mods2"), Some("/mods2")), format!("{unknown}{here}"));
        assert_eq!(said(None, None), format!("{unknown}{here}"));
    }

    #[test]
    fn a_copy_without_its_description_is_a_copy() {
        let (store, _folder) = store();
        let registry = Registry::builtin();
        let mut journal = store.begin().expect("made");
        journal.write(&about("room"), &to_json(&Scene::default(), None, &registry)).expect("written");
        fs::write(journal.folder.join(ABOUT), "{").expect("writable");
        drop(journal);
        let copy = store.abandoned().pop().expect("offered");
        let about = About { title: "Untitled scene".to_owned(), ..About::default() };
        assert_eq!((copy.about.clone(), copy.scene(&registry)), (about, Ok(Scene::default())));
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
        // A window that is starting has a folder before it has the lock.
        let starting = store.folder.join("starting");
        fs::create_dir(&starting).expect("made");
        assert!(store.abandoned().is_empty());
        assert!(running.folder.exists() && starting.exists() && !gone.exists());
    }

    #[test]
    fn what_others_put_there_is_neither_offered_nor_removed() {
        let (store, _folder) = store();
        let mut journal = store.begin().expect("made");
        journal.write(&about("room"), "{}").expect("written");
        let (ours, precious) = (journal.folder.clone(), journal.folder.join("thesis.txt"));
        drop(journal);
        fs::write(&precious, "").expect("writable");
        let long_ago = UNIX_EPOCH + Duration::from_secs(1000);
        for name in ["notes", "1-2-x", "17"] {
            let foreign = store.folder.join(name);
            fs::create_dir(&foreign).expect("made");
            [SCENE, LOCK].iter().for_each(|file| fs::write(foreign.join(file), "{}").expect("writable"));
            File::open(&foreign).and_then(|folder| folder.set_modified(long_ago)).expect("set");
        }
        let copies = store.abandoned();
        assert_eq!(copies.len(), 1, "{copies:?}");
        copies.into_iter().for_each(|copy| copy.journal.remove());
        assert!(precious.exists() && !ours.join(SCENE).exists() && !ours.join(LOCK).exists());
        assert!(store.abandoned().is_empty() && precious.exists());
        assert!(["notes", "1-2-x", "17"].iter().all(|name| store.folder.join(name).join(SCENE).exists()));
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
        let copies = store.abandoned();
        assert_eq!(copies.len(), 1);
        let problems = copies[0].scene(&Registry::builtin()).expect_err("no end");
        assert!(problems[0].contains("it is a device, but it must be a file"), "{problems:?}");
    }
}
