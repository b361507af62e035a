//! Replaces folders, all or nothing.

use std::{
    collections::BTreeSet,
    ffi::OsStr,
    io,
    path::{Component, Path, PathBuf},
};

use super::shown::Shown as _;
use super::{
    FileError,
    before::{Before, Turn},
    draft::make_executable,
    folder_of, follow, litter,
    living::{self, Living, Temporary},
    tidy,
};
use crate::platform::{
    fs::{self, File},
    temporary::{self, TempDir},
};

/// The new content of a folder, not yet in place. Dropping it deletes it.
///
/// The draft is made next to its destination, in a folder called `.lcm-XXXXXX.tmp` like other drafts. The
/// file `lock` in it is locked while its process lives, `new` is the new content, and `old/NAME` is the
/// replaced folder, from the first of two renames to the end: [`tidy`] restores it if the process was killed
/// between them.
#[derive(Debug)]
pub struct FolderDraft {
    // Dropped first: not every system deletes open files.
    _lock: File,
    /// The destination, with links resolved.
    target: PathBuf,
    folder: TempDir,
    _living: Living,
}

impl FolderDraft {
    /// An empty draft, after [`tidy`] in the enclosing folder.
    ///
    /// # Errors
    /// Returns an error if the path leads to anything but a folder, or the enclosing folder is not writable.
    pub fn new(path: &Path) -> Result<Self, FileError> {
        let target = follow(path)?;
        if fs::symlink_metadata(&target).is_ok_and(|there| !there.is_dir()) {
            return Err(io::Error::new(io::ErrorKind::NotADirectory, "it is not a folder").into());
        }
        let around = folder_of(&target);
        let make = || {
            let draft = litter::locked(
                || {
                    let mut builder = temporary::Builder::new();
                    let folder = builder.prefix(litter::PREFIX).suffix(litter::DRAFT).tempdir_in(around)?;
                    let path = folder.path().join(litter::LOCK);
                    let lock = File::create_new(&path)?;
                    Ok((lock, folder))
                },
                |(lock, folder)| (lock, folder.path().join(litter::LOCK)),
            )?;
            fs::create_dir(draft.1.path().join(litter::NEW))?;
            Ok(draft)
        };
        let ((lock, folder), living) =
            Living::making(make, |(_, folder)| Temporary::Draft(folder.path().to_owned()))?;
        let _ = tidy(around);
        Ok(Self { _lock: lock, target, folder, _living: living })
    }

    /// Adds a file; `path` is its path within the folder, with `/`.
    ///
    /// # Errors
    /// Returns an error if the path leads out of the folder, or cannot be written.
    pub fn add(&self, path: &str, bytes: &[u8], executable: bool) -> io::Result<()> {
        let within = Path::new(path);
        if path.is_empty() || !within.components().all(|part| matches!(part, Component::Normal(_))) {
            let message = format!("{path} leads out of the folder");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        let path = self.folder.path().join(litter::NEW).join(within);
        let _step = living::step();
        fs::create_dir_all(folder_of(&path))?;
        fs::write(&path, bytes)?;
        if executable { make_executable(&File::open(&path)?) } else { Ok(()) }
    }

    /// Puts the draft in place, replacing any folder there.
    ///
    /// # Errors
    /// Returns an error if the place holds anything but a folder, and any error of the operating system; the
    /// place is then unchanged.
    pub fn replace(mut self) -> io::Result<()> {
        let step = living::step();
        let exchanged = self.exchange();
        // Dropping the draft is a separate step.
        drop(step);
        exchanged
    }

    /// Puts the draft in place, if the place is unchanged.
    ///
    /// # Errors
    /// Returns [`FileError::Taken`] if the place has changed, and the errors of [`replace`](Self::replace).
    pub fn replace_if(self, before: &Before) -> Result<(), FileError> {
        let _turn = Turn::in_folder(folder_of(&self.target));
        let same = *before == Before::of(&self.target);
        if same { Ok(self.replace()?) } else { Err(FileError::Taken) }
    }

    /// Moves the old folder away, if any, and the new one into place.
    fn exchange(&mut self) -> io::Result<()> {
        let new = self.folder.path().join(litter::NEW);
        match fs::symlink_metadata(&self.target) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => return fs::rename(&new, &self.target),
            Err(e) => return Err(e),
            Ok(there) if !there.is_dir() => {
                return Err(io::Error::new(io::ErrorKind::NotADirectory, "it is not a folder"));
            }
            Ok(_) => {}
        }
        let old = self.folder.path().join(litter::OLD);
        fs::create_dir(&old)?;
        let old = old.join(self.target.file_name().unwrap_or(OsStr::new("folder")));
        fs::rename(&self.target, &old)?;
        let exchanged = fs::rename(&new, &self.target);
        if exchanged.is_err() && fs::rename(&old, &self.target).is_err() {
            // The old folder must not be deleted with the draft; tidying restores it when possible.
            self.folder.disable_cleanup(true);
        }
        exchanged
    }
}

/// Removes the files of a folder that are the program's own, and the folder if it is then empty. Nothing depends on
/// whether this succeeds.
pub fn clear(folder: &Path, is_own: impl Fn(&Path) -> bool) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()).filter(|path| is_own(path)) {
        let _ = fs::remove_file(path);
    }
    let _ = fs::remove_dir(folder);
}

/// Writes something into a folder, which is created first, with its parents. If writing fails, the new
/// folders are removed.
///
/// # Errors
/// Returns an error if the folder cannot be created, and the errors of `write`.
pub fn in_folder<T, E: From<io::Error>>(folder: &Path, write: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    let new = missing_folders(folder)?;
    // Recorded until the end, in case this process is terminated meanwhile.
    let _living = Living::making(|| Ok(()), |()| Temporary::Folders(folder.to_owned(), new.len()))?;
    let made = fs::create_dir_all(folder).map_err(|error| {
        match (error.kind(), folder.ancestors().find(|f| fs::is_there(f))) {
            (io::ErrorKind::NotFound, Some(there)) => super::missing(there),
            _ => error,
        }
    });
    made.map_err(E::from).and_then(|()| write()).inspect_err(|_| {
        // Only empty folders are removed.
        new.iter().for_each(|folder| drop(fs::remove_dir(folder)));
    })
}

/// The folders that must be made before something can be written into a folder, the innermost first.
///
/// # Errors
/// Returns an error if they cannot be made: below a file, or with a name or a path too long for the system.
pub(super) fn missing_folders(folder: &Path) -> io::Result<Vec<&Path>> {
    let mut missing = Vec::new();
    for at in folder.ancestors().take_while(|at| !at.as_os_str().is_empty()) {
        match fs::metadata(at) {
            Ok(there) if there.is_dir() => break,
            Ok(_) => {
                let message = format!("{} is not a folder", at.shown());
                return Err(io::Error::new(io::ErrorKind::NotADirectory, message));
            }
            Err(error) if error.kind() == io::ErrorKind::InvalidFilename => return Err(error),
            Err(_) => missing.push(at),
        }
    }
    // The system looks at names only in folders that exist.
    let there = missing.last().map_or(folder, |outermost| folder_of(outermost));
    let refused = |name: &OsStr| {
        let error = fs::symlink_metadata(there.join(name)).err();
        error.filter(|error| error.kind() == io::ErrorKind::InvalidFilename)
    };
    let refused = missing.iter().filter_map(|at| at.file_name()).find_map(refused);
    refused.map_or(Ok(missing), Err)
}

/// Removes files that were just written, and those of these folders that are empty then.
pub fn take_back(written: &[PathBuf], folders: &BTreeSet<PathBuf>) {
    written.iter().for_each(|path| drop(fs::remove_file(path)));
    // Inner ones first.
    folders.iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("readable").flatten();
        let mut names: Vec<_> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// A draft whose process was killed: the lock is gone, but the draft is not.
    fn killed(draft: FolderDraft) -> PathBuf {
        let FolderDraft { folder, .. } = draft;
        folder.keep()
    }

    #[test]
    fn a_folder_is_replaced_whole() -> Result<(), FileError> {
        let around = tempfile::tempdir()?;
        let place = around.path().join("made");
        for text in ["one", "two"] {
            let draft = FolderDraft::new(&place)?;
            draft.add(&format!("{text}.txt"), text.as_bytes(), false)?;
            draft.add("deep/er/file", b"", true)?;
            draft.replace()?;
            assert_eq!(names(&place), ["deep".to_owned(), format!("{text}.txt")]);
            assert_eq!(names(around.path()), ["made"]);
        }
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            let mode = |path: &str| fs::metadata(place.join(path)).map(|m| m.permissions().mode());
            assert_eq!(mode("deep/er/file")? & 0o100, 0o100);
            assert_eq!(mode("two.txt")? & 0o111, 0);
        }
        // Dropping it leaves nothing.
        FolderDraft::new(&place)?.add("x", b"", false)?;
        assert_eq!(names(around.path()), ["made"]);
        Ok(())
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn very_many_missing_folders_are_made_and_removed_at_once() {
        let around = tempfile::tempdir().expect("a folder");
        let begin = std::time::Instant::now();
        let deep = |levels| around.path().join("z/".repeat(levels));
        // The path of a file in it is shorter than 4096 bytes.
        let said = in_folder(&deep(1500), || -> io::Result<()> {
            assert!(deep(1500).is_dir());
            Err(io::Error::other("no"))
        });
        assert_eq!(said.expect_err("it fails").to_string(), "no");
        for path in [deep(3000), deep(2).join("z".repeat(300)).join("z")] {
            let said = in_folder(&path, || -> Result<(), FileError> { panic!("made") });
            assert_eq!(said.expect_err("too long").to_string(), "the name is too long");
        }
        assert!(names(around.path()).is_empty() && begin.elapsed().as_secs() < 10, "{:?}", begin.elapsed());
    }

    #[test]
    fn nothing_is_written_outside_the_folder() -> Result<(), FileError> {
        let around = tempfile::tempdir()?;
        let draft = FolderDraft::new(&around.path().join("made"))?;
        for path in ["", "../x", "a/../../x", "/tmp/lcm-x", ".."] {
            assert!(draft.add(path, b"", false).is_err(), "{path}");
        }
        let file = around.path().join("file");
        fs::write(&file, "")?;
        assert!(FolderDraft::new(&file).is_err_and(|e| e.to_string() == "it is not a folder"));
        Ok(())
    }

    #[test]
    fn drafts_of_killed_processes_are_tidied_and_those_of_others_are_not() -> Result<(), FileError> {
        let around = tempfile::tempdir()?;
        let living = FolderDraft::new(&around.path().join("a"))?;
        let dead = killed(FolderDraft::new(&around.path().join("b"))?);
        fs::write(dead.join(litter::NEW).join("half"), "")?;
        // Of somebody else, with the same name: it has no lock.
        let foreign = around.path().join(".lcm-abcdef.tmp");
        fs::create_dir(&foreign)?;
        fs::write(foreign.join("precious"), "")?;
        assert_eq!(tidy(around.path()), []);
        assert!(!dead.exists() && living.folder.path().exists() && foreign.join("precious").exists());
        living.add("x", b"", false)?;
        Ok(living.replace()?)
    }

    #[test]
    fn what_was_there_comes_back_if_the_process_was_killed_between_the_renames() -> Result<(), FileError> {
        let around = tempfile::tempdir()?;
        let place = around.path().join("made");
        for (present, expected) in [(false, "old"), (true, "new")] {
            let _ = fs::remove_dir_all(&place);
            let dead = killed(FolderDraft::new(&place)?);
            fs::create_dir_all(dead.join(litter::OLD).join("made/old"))?;
            if present {
                fs::create_dir_all(place.join("new"))?;
            }
            assert_eq!(tidy(around.path()), []);
            assert_eq!(names(&place), [expected]);
            assert_eq!(names(around.path()), ["made"]);
        }
        Ok(())
    }
}
