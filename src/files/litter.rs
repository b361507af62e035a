//! Cleaning up after killed processes.

use std::{
    io::{self, Seek as _},
    path::{Path, PathBuf},
    time::{Duration, UNIX_EPOCH},
};

use super::shown::Shown as _;
use super::{
    FileError, Node, is_same, options,
    overwrite::{fill, open_to_overwrite},
    read, read_start,
};
use crate::platform::{
    self,
    fs::{self, File, Metadata, TryLockError},
};

/// File in the draft of a folder that is locked while its process lives.
pub(super) const LOCK: &str = "lock";
/// Name of the new content in the draft of a folder.
pub(super) const NEW: &str = "new";
/// Folder in the draft of a folder that holds the replaced folder, under its name.
pub(super) const OLD: &str = "old";

/// Prefix of all temporary files. The dot hides them from programs that watch the folder.
pub(super) const PREFIX: &str = ".lcm-";
/// Suffix of a draft.
pub(super) const DRAFT: &str = ".tmp";
/// Suffix of the complete copy of a file that is being overwritten.
const WHOLE: &str = ".whole";
/// Length of the random part of a name.
const RANDOM: usize = 6;
/// Age above which drafts of older versions, which have no lock, are abandoned; no write takes this long.
const LONG: Duration = Duration::from_secs(60);
/// Maximum size of a document.
const LARGEST: u64 = 64 << 20;

/// A file whose overwriting was interrupted when its process ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unfinished {
    /// The copy with the complete content.
    pub copy: PathBuf,
    /// The file, if it still exists.
    pub file: Option<PathBuf>,
}

impl std::fmt::Display for Unfinished {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let copy = self.copy.shown();
        match &self.file {
            Some(file) => {
                write!(f, "{} may be incomplete: saving it was interrupted", file.shown())?;
                write!(f, ". Its whole content is in {copy}; use that, or delete it.")
            }
            None => {
                write!(f, "{copy} is the whole content of a file that no longer exists")?;
                f.write_str("; use it, or delete it.")
            }
        }
    }
}

/// The name of the complete copy of a file during overwriting.
pub(super) fn whole(draft: &Path, old: &Metadata) -> PathBuf {
    let inode = Node::of(old).inode;
    let name = draft.file_name().unwrap_or_default().to_string_lossy();
    draft.with_file_name(format!("{}.{inode}-{}{WHOLE}", name.trim_end_matches(DRAFT), changed(old)))
}

/// The modification time of a file, in nanoseconds since 1970.
fn changed(file: &Metadata) -> u64 {
    let since = file.modified().ok().and_then(|at| at.duration_since(UNIX_EPOCH).ok());
    since.map_or(0, |since| since.as_nanos() as u64)
}

/// A name given by this program.
#[derive(Debug, PartialEq, Eq)]
enum Name {
    /// A draft, locked while its process lives.
    Draft,
    /// The complete copy of the file with this inode and modification time.
    Whole(u64, u64),
    /// A draft of a scene by an older version.
    OldScene,
    /// A draft of a picture by an older version.
    OldPicture,
}

impl Name {
    fn of(name: &str) -> Option<Self> {
        let random = |word: &str| word.len() == RANDOM && word.bytes().all(|b| b.is_ascii_alphanumeric());
        let digits = |word: &str| !word.is_empty() && word.bytes().all(|b| b.is_ascii_digit());
        if let Some(rest) = name.strip_prefix(PREFIX) {
            if rest.strip_suffix(DRAFT).is_some_and(random) {
                return Some(Self::Draft);
            }
            let (word, rest) = rest.strip_suffix(WHOLE)?.split_once('.')?;
            let (inode, time) = rest.split_once('-')?;
            let known = random(word) && digits(inode) && digits(time);
            return known.then(|| Some(Self::Whole(inode.parse().ok()?, time.parse().ok()?))).flatten();
        }
        if let Some((file, word)) = name.strip_suffix(DRAFT).and_then(|rest| rest.rsplit_once('.')) {
            // People write words; random names almost always mix cases or have digits.
            let classes = [u8::is_ascii_lowercase, u8::is_ascii_uppercase, u8::is_ascii_digit];
            let mixed = classes.iter().filter(|class| word.bytes().any(|b| class(&b))).count() > 1;
            let is_scene = file.len() >= ".x.json".len() && file.starts_with('.') && file.ends_with(".json");
            return (is_scene && random(word) && mixed).then_some(Self::OldScene);
        }
        let (file, process) = name.strip_suffix(".partial")?.rsplit_once('.')?;
        (digits(process) && file.len() > 4 && file.to_ascii_lowercase().ends_with(".png"))
            .then_some(Self::OldPicture)
    }
}

/// Removes abandoned drafts from a folder, and finishes interrupted overwriting. Returns those that could not
/// be finished.
#[must_use]
pub fn tidy(folder: &Path) -> Vec<Unfinished> {
    let mut unfinished = Vec::new();
    let Ok(entries) = fs::read_dir(folder) else { return unfinished };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(name) = name.to_str().and_then(Name::of) else { continue };
        let path = entry.path();
        match name {
            Name::Draft if entry.file_type().is_ok_and(|kind| kind.is_dir()) => {
                remove_folder_if_abandoned(&path)
            }
            Name::Draft => remove_if_abandoned(&path),
            Name::OldScene => remove_if_old(&path, b"{\n  \""),
            Name::OldPicture => remove_if_old(&path, b"\x89PNG"),
            Name::Whole(inode, time) => unfinished.extend(finish(folder, &path, inode, time)),
        }
    }
    unfinished
}

/// A regular file that no other process has locked, locked; never a link.
fn abandoned(path: &Path) -> Option<File> {
    if !fs::symlink_metadata(path).ok()?.is_file() {
        return None;
    }
    let file = options().read(true).open(path).ok()?;
    file.try_lock().ok()?;
    // It may have been renamed before it was locked, and another file may have its name.
    let there = fs::symlink_metadata(path).ok()?;
    (there.is_file() && is_same(&there, &file.metadata().ok()?)).then_some(file)
}

fn remove_if_abandoned(path: &Path) {
    if let Some(_lock) = abandoned(path) {
        // A file that cannot be removed is no news: the next tidying tries again.
        let _ = fs::remove_file(path);
    }
}

/// Removes the draft of a folder. The folder that it was about to replace is put back first, if nothing has taken its
/// place.
fn remove_folder_if_abandoned(path: &Path) {
    // One without a lock is that of a process killed at once, or of somebody else, who may have put something in it.
    let Some(lock) = abandoned(&path.join(LOCK)) else { return };
    // Not every system deletes open files.
    drop(lock);
    remove_draft(path);
}

/// Removes the abandoned draft of a folder, as [`remove_folder_if_abandoned`] does.
pub(super) fn remove_draft(path: &Path) {
    let old = fs::read_dir(path.join(OLD)).ok().and_then(|mut entries| entries.next());
    if let Some(old) = old {
        let Ok(old) = old else { return };
        let place = path.with_file_name(old.file_name());
        if fs::symlink_metadata(&place).is_err() && fs::rename(old.path(), &place).is_err() {
            return;
        }
    }
    let _ = fs::remove_dir_all(path);
}

/// Creates something temporary with a file that is locked while this process lives.
pub(super) fn locked<T>(
    mut make: impl FnMut() -> io::Result<T>,
    lock: impl Fn(&T) -> (&File, PathBuf),
) -> io::Result<T> {
    /// Another process that tidies up can delete a file between its creation and its lock.
    const ATTEMPTS: usize = 16;
    for _ in 0..ATTEMPTS {
        let made = make()?;
        let (file, path) = lock(&made);
        let locked = match file.try_lock() {
            Ok(()) => true,
            Err(TryLockError::WouldBlock) => false,
            // Not every file system has locks; those are never tidied.
            Err(TryLockError::Error(_)) => true,
        };
        let there = fs::symlink_metadata(path);
        if locked && there.is_ok_and(|there| file.metadata().is_ok_and(|m| is_same(&m, &there))) {
            return Ok(made);
        }
    }
    Err(io::Error::other("another process keeps deleting temporary files in its folder"))
}

/// Removes a file of an older version, if it is empty or begins as such a file does.
fn remove_if_old(path: &Path, beginning: &[u8]) {
    let Some(lock) = abandoned(path) else { return };
    let age = lock
        .metadata()
        .and_then(|m| m.modified())
        .ok()
        .and_then(|at| platform::now().duration_since(at).ok());
    let Ok(start) = read_start(path, beginning.len() as u64) else { return };
    if age.is_some_and(|age| age > LONG) && (start.is_empty() || start == beginning) {
        let _ = fs::remove_file(path);
    }
}

/// Finishes overwriting a file, if it was interrupted and is unchanged since.
fn finish(folder: &Path, copy: &Path, inode: u64, time: u64) -> Option<Unfinished> {
    // Locked: another process is working on it.
    let mut lock = abandoned(copy)?;
    let unfinished = |file| Some(Unfinished { copy: copy.to_owned(), file });
    let Some((file, metadata)) = with_inode(folder, inode) else { return unfinished(None) };
    let wanted = read(copy, LARGEST).ok()?;
    let there = match read(&file, LARGEST) {
        Ok(there) => there,
        Err(FileError::TooLarge(_)) => return unfinished(Some(file)),
        Err(_) => return None,
    };
    if there != wanted {
        // Only the effect of the interruption itself is undone, and only among files of one owner: in a
        // world-writable folder, the copy could come from anybody.
        let begun = wanted.starts_with(&there) || changed(&metadata) == time;
        let interrupted =
            begun && lock.metadata().is_ok_and(|m| Node::of(&m).owner == Node::of(&metadata).owner);
        let place = interrupted.then(|| open_to_overwrite(&file, &metadata)).flatten();
        let done =
            place.is_some_and(|mut place| lock.rewind().is_ok() && fill(&mut lock, &mut place).is_ok());
        if !done {
            return unfinished(Some(file));
        }
    }
    let _ = fs::remove_file(copy);
    None
}

/// The regular file in a folder with this inode.
#[cfg_attr(not(unix), allow(unused_variables))]
fn with_inode(folder: &Path, inode: u64) -> Option<(PathBuf, Metadata)> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{DirEntryExt as _, MetadataExt as _};
        let entry = fs::read_dir(folder).ok()?.flatten().find(|entry| entry.ino() == inode)?;
        let metadata = fs::symlink_metadata(entry.path()).ok()?;
        (metadata.is_file() && metadata.ino() == inode).then(|| (entry.path(), metadata))
    }
    #[cfg(not(unix))]
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_this_program_gives_are_litter() {
        for (name, expected) in [
            (".lcm-a1B2c3.tmp", Some(Name::Draft)),
            (".lcm-backup.tmp", Some(Name::Draft)),
            (".lcm-a1B2c3.123-45.whole", Some(Name::Whole(123, 45))),
            (".lcm-a1B2c3.123.whole", None),
            (".lcm-a1B2c3.123-.whole", None),
            (".room.json.a1B2c3.tmp", Some(Name::OldScene)),
            (".r.json.a1B2c3.tmp", Some(Name::OldScene)),
            ("room.png.4711.partial", Some(Name::OldPicture)),
            (".lcm-a1B2c.tmp", None),
            (".lcm-a1B2c3d.tmp", None),
            (".lcm-a1B2c3.tmp~", None),
            (".lcm-a-B2c3.tmp", None),
            ("lcm-a1B2c3.tmp", None),
            (".lcm-a1B2c3.whole", None),
            (".lcm-a1B2c3.12x.whole", None),
            (".lcm-.tmp", None),
            (".lcm-settings.json", None),
            (".room.json.backup.tmp", None),
            (".room.json.a1B2c3d.tmp", None),
            (".room.txt.a1B2c3.tmp", None),
            (".json.a1B2c3.tmp", None),
            ("room.json.a1B2c3.tmp", None),
            ("room.json", None),
            ("room.png.partial", None),
            ("room.png.x.partial", None),
            ("film.mkv.4711.partial", None),
            (".png.4711.partial", None),
        ] {
            assert_eq!(Name::of(name), expected, "{name}");
        }
    }
}
