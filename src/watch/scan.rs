//! Examines folders: the files in them, and the places to watch for changes.

use std::{
    collections::{HashMap, HashSet},
    ffi::{OsStr, OsString},
    path::{Component, Path, PathBuf},
    time::SystemTime,
};

use crate::{
    files::Node,
    platform::fs::{self, Metadata},
};

/// Maximum number of links followed in a chain.
const MAX_LINKS: usize = 16;
/// Maximum nesting of folders that is followed.
const MAX_DEPTH: usize = 32;

/// The state of a file, as far as it is known without reading it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Print {
    length: u64,
    modified: Option<SystemTime>,
    /// Distinguishes a file from another one that replaces it.
    number: u64,
}

impl Print {
    /// The state of a file; `None` if it does not exist.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        (!metadata.is_dir()).then(|| Self::from_metadata(&metadata))
    }

    fn from_metadata(metadata: &Metadata) -> Self {
        let number = Node::of(metadata).inode;
        Self { length: metadata.len(), modified: metadata.modified().ok(), number }
    }
}

/// A place where a change matters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// The folder, without links in its path.
    pub(super) folder: PathBuf,
    /// The name in it; `None` for every name.
    pub(super) name: Option<OsString>,
    /// The name of the file in reports, or of the files' folder; `None` where a change only means that
    /// everything must be checked again.
    pub(super) shown: Option<PathBuf>,
}

/// The result of a scan.
#[derive(Default)]
pub(super) struct Found {
    pub(super) files: HashMap<PathBuf, Print>,
    pub(super) places: Vec<Place>,
}

/// Examines a single file.
pub(super) fn file(path: &Path) -> Found {
    let mut found = Found::default();
    trace(path, Some(path), &mut found.places, 0);
    found.files.extend(Print::of(path).map(|print| (path.to_owned(), print)));
    found
}

/// Examines a folder and everything below it.
pub(super) fn folder(path: &Path) -> Found {
    let mut found = Found::default();
    trace(path, None, &mut found.places, 0);
    walk(path, &mut found, &mut HashSet::new(), 0);
    found
}

/// Follows a path name by name and lists the places where a change could redirect it: at the first missing
/// name, at every link, and at its end if that is a file.
fn trace(path: &Path, shown: Option<&Path>, places: &mut Vec<Place>, links: usize) {
    let Ok(absolute) = fs::absolute(path) else { return };
    let mut at = PathBuf::new();
    let mut names = absolute.components().peekable();
    while let Some(name) = names.next() {
        let parent = at.clone();
        at.push(name);
        let Component::Normal(name) = name else { continue };
        let metadata = fs::symlink_metadata(&at);
        let is_link = metadata.as_ref().is_ok_and(Metadata::is_symlink);
        let is_last = names.peek().is_none();
        let shown = shown.filter(|_| is_last);
        // On Linux a folder reports its own move.
        let is_end = is_last && (shown.is_some() || cfg!(not(target_os = "linux")));
        if is_link || is_end || metadata.is_err() {
            let Some(folder) = fs::canonicalize(&parent).ok().filter(|f| fs::is_dir(f)) else { return };
            places.push(Place { folder, name: Some(name.to_owned()), shown: shown.map(Path::to_owned) });
        }
        if is_link
            && links < MAX_LINKS
            && let Ok(target) = fs::read_link(&at)
        {
            trace(&parent.join(target), shown, places, links + 1);
        }
        if metadata.is_err() {
            return;
        }
    }
}

fn walk(shown: &Path, found: &mut Found, seen: &mut HashSet<PathBuf>, depth: usize) {
    let Ok(folder) = fs::canonicalize(shown) else { return };
    // Links may form a cycle.
    if depth > MAX_DEPTH || !fs::is_dir(&folder) || !seen.insert(folder.clone()) {
        return;
    }
    found.places.push(Place { folder, name: None, shown: Some(shown.to_owned()) });
    let Ok(entries) = fs::read_dir(shown) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        if is_temporary(&name) {
            continue;
        }
        let path = shown.join(name);
        if entry.file_type().is_ok_and(|t| t.is_symlink()) {
            trace(&path, Some(&path), &mut found.places, 0);
        }
        match fs::metadata(&path) {
            Ok(metadata) if metadata.is_dir() => walk(&path, found, seen, depth + 1),
            Ok(metadata) => drop(found.files.insert(path, Print::from_metadata(&metadata))),
            Err(_) => {}
        }
    }
}

/// True if the name looks like a temporary or backup file of an editor or tool, or is hidden.
pub(super) fn is_temporary(name: &OsStr) -> bool {
    let name = name.to_string_lossy();
    let extension = Path::new(&*name).extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    // The temporary files of `sed -i`.
    let is_seds = name
        .strip_prefix("sed")
        .is_some_and(|rest| rest.chars().count() == 6 && rest.chars().all(|c| c.is_ascii_alphanumeric()));
    // Vim tests for write permission with 4913, or a greater number if that is taken.
    let is_vims = name.len() >= 4 && name.chars().all(|c| c.is_ascii_digit());
    name.starts_with('.')
        || name.ends_with('~')
        || (name.starts_with('#') && name.ends_with('#'))
        || name.ends_with("___jb_tmp___")
        || name.ends_with("___jb_old___")
        || matches!(extension.as_deref(), Some("tmp" | "bak" | "swp" | "swo" | "swx" | "swpx" | "lock"))
        || is_seds
        || is_vims
}
