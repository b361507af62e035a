//! The manual as a file, in the folder of the user's data, for the browser.

use std::{
    io,
    path::{Path, PathBuf},
    sync::{Arc, Mutex},
    time::Duration,
};

use bevy::ecs::prelude::*;

use crate::{
    caught::lock,
    files::{self, Shown as _},
    library::assets::data_folder,
    panel::manual,
    platform, program,
};

/// File name.
const FILE: &str = "manual.html";
/// A browser that fails within this time is reported.
const PATIENCE: Duration = Duration::from_secs(1);

/// The folder of the manual: that of the user's data, or else one for temporary files. Each program has
/// [its own](program::own).
#[must_use]
pub fn folder() -> PathBuf {
    program::own(data_folder().unwrap_or_else(|| platform::temporary_folder().join(program::LAB)))
}

/// Writes the manual of this version to a folder. Returns the file.
///
/// # Errors
/// Returns an error, as a sentence, if the folder or the file cannot be written.
pub fn write(folder: &Path) -> Result<PathBuf, String> {
    let path = folder.join(FILE);
    let page = manual::page();
    // An up-to-date file stays untouched while a browser shows it.
    if files::read(&path, page.len() as u64).is_ok_and(|known| known == page.as_bytes()) {
        return Ok(path);
    }
    crate::platform::fs::create_dir_all(folder)
        .map_err(files::FileError::from)
        .and_then(|()| files::write(&path, page.as_bytes()))
        .map_err(|why| format!("The manual could not be written to {}: {why}.", path.shown()))?;
    Ok(path)
}

/// Writes the manual and opens it in the browser, which takes up to a second: browsers report by their exit status that
/// they cannot start. Returns a message.
///
/// # Errors
/// Returns a message, with the path of the file, if the manual cannot be written or no browser opens it.
pub fn show() -> Result<String, String> {
    show_with(&folder(), |path| platform::open_within(path, PATIENCE))
}

fn show_with(folder: &Path, open: impl FnOnce(&Path) -> io::Result<()>) -> Result<String, String> {
    let path = write(folder)?;
    match open(&path) {
        Ok(()) => Ok(format!("The manual opens in the browser. Its file is {}.", path.shown())),
        Err(why) => {
            let (why, path) = (files::words(&why), path.shown());
            Err(format!("The manual could not be opened in a browser ({why}). Open it by hand: {path}"))
        }
    }
}

/// The outcomes of opening the manual, collected from the threads that wait for the browser.
#[derive(Clone, Debug, Default, Resource)]
pub struct Manuals {
    outcomes: Arc<Mutex<Vec<Result<String, String>>>>,
}

impl Manuals {
    /// Opens the manual and returns at once. Calls `wake` when the outcome is known.
    pub(super) fn open(&self, wake: impl FnOnce() + Send + 'static) {
        let outcomes = self.outcomes.clone();
        platform::once(move || {
            let outcome = show();
            lock(&outcomes).push(outcome);
            wake();
        });
    }

    /// The messages since the last call.
    pub(super) fn take(&self) -> Vec<Result<String, String>> {
        std::mem::take(&mut *lock(&self.outcomes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_browser_that_does_not_start_is_reported_with_the_path() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join(FILE).display().to_string();
        let opened = show_with(folder.path(), |_| Ok(())).expect("a browser opens it");
        assert!(opened.contains(&file), "{opened}");
        let failed = show_with(folder.path(), |_| Err(io::Error::other("exit status: 3")));
        let failed = failed.expect_err("none opens it");
        assert!(failed.contains("could not be opened") && failed.contains(&file), "{failed}");
        assert!(failed.contains("exit status: 3"), "{failed}");
    }
}
