//! The manual as a file, in the folder of the user's data, for the browser.

use std::path::{Path, PathBuf};

use crate::{
    files::{self, Shown as _},
    library::assets::data_folder,
    panel::manual,
};

/// File name.
const FILE: &str = "manual.html";

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
    std::fs::create_dir_all(folder)
        .map_err(files::FileError::from)
        .and_then(|()| files::write(&path, page.as_bytes()))
        .map_err(|why| format!("The manual could not be written to {}: {why}.", path.shown()))?;
    Ok(path)
}

/// Shows the manual in the browser. Returns a message in either case.
pub(super) fn show() -> Result<String, String> {
    let folder = data_folder().unwrap_or_else(|| std::env::temp_dir().join("lights-camera-models"));
    let path = write(&folder)?;
    match ::open::that_detached(&path) {
        Ok(()) => Ok(format!("The browser shows the manual, {}.", path.shown())),
        Err(why) => {
            let why = files::words(&why);
            Err(format!("No browser could be started ({why}): the manual is {}.", path.shown()))
        }
    }
}
