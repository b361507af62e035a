//! The file with the user's progress in lessons, in the folder of the user's data.

use std::path::{Path, PathBuf};

use super::{prelude::*, settings, state::Progress};
use crate::{
    files::{FileError, tidy},
    library::assets::data_folder,
    program,
};

/// File name.
const FILE: &str = "lessons.json";

/// Loads the progress. A missing file means no progress; an unreadable file means no progress and a message.
#[must_use]
pub fn load(folder: &Path) -> (Progress, Option<String>) {
    let path = folder.join(FILE);
    match settings::read(&path) {
        Ok(found) => (found.unwrap_or_default(), None),
        Err(why) => {
            let path = path.shown();
            let text = format!(
                "Your progress in the lessons cannot be read from {path} ({why}); all lessons start from the beginning."
            );
            (Progress::default(), Some(text))
        }
    }
}

/// Saves the progress in the lesson of this name. Keeps the other lessons in the file, which another window may have
/// written.
///
/// # Errors
/// Returns an error, as a sentence, if the folder or the file cannot be written.
pub fn save(folder: &Path, progress: &Progress, name: &str) -> Result<(), String> {
    let path = folder.join(FILE);
    let write = || -> Result<(), FileError> {
        crate::platform::fs::create_dir_all(folder)?;
        let (mut all, _) = load(folder);
        all.last.clone_from(&progress.last);
        if let Some(past) = progress.of(name) {
            all.lessons.insert(name.to_owned(), past.clone());
        }
        settings::write(&path, &all)
    };
    write().map_err(|e| format!("Your progress in the lessons cannot be written to {}: {e}.", path.shown()))
}

/// The folder of this program in the user's data.
fn own_folder() -> Option<PathBuf> {
    data_folder().map(program::own)
}

/// Loads the user's progress in earlier sessions. Returns a complaint too if that fails.
#[must_use]
pub fn load_own() -> (Progress, Option<String>) {
    let Some(folder) = own_folder() else { return Default::default() };
    let _ = tidy(&folder);
    load(&folder)
}

/// Saves the user's progress in a lesson.
///
/// # Errors
/// Returns a complaint.
pub fn save_own(progress: &Progress, name: &str) -> Result<(), String> {
    own_folder().map_or(Ok(()), |folder| save(&folder, progress, name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::state::Past;

    fn past(step: usize) -> Past {
        Past { title: "Gamma".to_owned(), step, steps: 9, done: [0, 2].into(), ..Past::default() }
    }

    #[test]
    fn what_is_saved_is_loaded_and_other_windows_lose_nothing() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let one = Progress { last: Some("a".to_owned()), lessons: [("a".to_owned(), past(3))].into() };
        save(folder.path(), &one, "a")?;
        assert_eq!(load(folder.path()), (one, None));
        // A window that does not know about it.
        let two = Progress { last: Some("b".to_owned()), lessons: [("b".to_owned(), past(1))].into() };
        save(folder.path(), &two, "b")?;
        let (both, _) = load(folder.path());
        assert_eq!((both.of("a"), both.of("b")), (Some(&past(3)), Some(&past(1))));
        assert_eq!(both.last.as_deref(), Some("b"));
        Ok(())
    }

    #[test]
    fn no_file_means_nothing_and_a_broken_one_says_so() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        assert_eq!(load(folder.path()), (Progress::default(), None));
        for broken in ["{ \"lessons\": ", "[1, 2]", "{ \"lessons\": { \"a\": { \"step\": -1 } } }", "\u{0}"] {
            std::fs::write(folder.path().join(FILE), broken)?;
            let (progress, complaint) = load(folder.path());
            assert_eq!(progress, Progress::default(), "{broken}");
            assert!(
                complaint.is_some_and(|c| c.contains(FILE) && c.contains("start from the beginning")),
                "{broken}"
            );
            save(folder.path(), &Progress { last: Some("a".to_owned()), ..Progress::default() }, "a")?;
            assert_eq!(load(folder.path()).1, None, "it is whole again");
        }
        Ok(())
    }

    #[test]
    fn progress_in_words() {
        assert_eq!((past(3).words(), past(3).fraction()), ("step 4 of 9".to_owned(), 3.0 / 9.0));
        let finished = Past { finished: true, ..past(0) };
        assert_eq!((finished.words(), finished.fraction()), ("finished".to_owned(), 1.0));
    }
}
