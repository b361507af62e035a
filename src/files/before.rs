//! The state of a place before something is written to it.

use std::{
    path::Path,
    thread,
    time::{Duration, SystemTime},
};

use web_time::Instant;

use super::follow;
use crate::platform::{
    FileId, file_id,
    fs::{self, File},
};

/// Maximum wait for another process that is writing to the same folder.
const PATIENCE: Duration = Duration::from_secs(5);
/// The time between two attempts.
const PAUSE: Duration = Duration::from_millis(2);

/// The state of a place when it was examined: nothing, or a certain file or folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Before(Option<Held>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct Held {
    id: Option<FileId>,
    /// Length and modification time of a file; folders compare equal regardless of their contents.
    content: Option<(u64, Option<SystemTime>)>,
}

impl Before {
    /// The present state of a place, following links.
    #[must_use]
    pub fn of(path: &Path) -> Self {
        let place = follow(path).unwrap_or_else(|_| path.to_owned());
        Self(fs::metadata(&place).ok().map(|now| Held {
            id: file_id(&place),
            content: now.is_file().then(|| (now.len(), now.modified().ok())),
        }))
    }

    /// True if nothing was there.
    #[must_use]
    pub fn is_nothing(&self) -> bool {
        self.0.is_none()
    }
}

/// The turn of this process to examine a place in a folder and to write there: other instances of this
/// program wait.
pub(super) struct Turn(#[allow(dead_code, reason = "held, not read")] Option<File>);

impl Turn {
    /// Waits for the turn. If folders cannot be locked, or somebody keeps the lock, it continues without.
    pub(super) fn in_folder(folder: &Path) -> Self {
        let begin = Instant::now();
        let Ok(folder) = File::open(folder) else { return Self(None) };
        loop {
            match folder.try_lock() {
                Ok(()) => return Self(Some(folder)),
                Err(fs::TryLockError::WouldBlock) if begin.elapsed() < PATIENCE => thread::sleep(PAUSE),
                Err(_) => return Self(None),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::{Draft, FileError, FolderDraft};
    use std::io::Write as _;

    #[test]
    fn of_several_who_found_nothing_one_writes() -> Result<(), FileError> {
        let around = tempfile::tempdir()?;
        let (file, folder) = (around.path().join("file"), around.path().join("folder"));
        let found = [Before::of(&file), Before::of(&folder)];
        assert!(found.iter().all(Before::is_nothing));
        let write = |text: &str, found: &[Before; 2]| {
            let mut draft = Draft::new(&file).expect("begun");
            draft.write_all(text.as_bytes()).expect("written");
            let folders = FolderDraft::new(&folder).expect("begun");
            folders.add(text, b"", false).expect("written");
            [draft.replace_if(&found[0]), folders.replace_if(&found[1])]
        };
        let taken = |ended: [Result<(), FileError>; 2]| ended.map(|e| matches!(e, Err(FileError::Taken)));
        assert_eq!(taken(write("one", &found)), [false, false]);
        assert_eq!(taken(write("two", &found)), [true, true]);
        assert_eq!(fs::read(&file)?, b"one");
        assert!(folder.join("one").exists() && !folder.join("two").exists());
        // Permission to replace the first file applies once.
        let found = [Before::of(&file), Before::of(&folder)];
        assert_eq!(taken(write("three", &found)), [false, false]);
        assert_eq!(taken(write("four", &found)), [true, true]);
        assert_eq!(fs::read(&file)?, b"three");
        assert_eq!(fs::read_dir(around.path())?.count(), 2, "nothing temporary is left");
        Ok(())
    }
}
