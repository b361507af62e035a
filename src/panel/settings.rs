//! Settings that are kept between sessions: theme, scale, panel sizes, recent files.

use std::{
    io,
    path::{Path, PathBuf},
};

use serde::{Serialize, de::DeserializeOwned};

use super::prelude::*;
pub use super::state::Settings;
use crate::{
    files::{self, FileError, tidy},
    platform, program,
};

/// Environment variable that overrides the folder of the settings.
pub const FOLDER_VARIABLE: &str = "LCM_CONFIG_DIR";
/// File name.
const FILE: &str = "settings.json";
/// The name of one that could not be read.
const KEPT: &str = "settings.unreadable.json";
/// Settings and progress are not larger; long names of recent files included. The library that reads them goes 128 levels
/// deep.
const MAX_BYTES: u64 = 1 << 20;

/// The folder of the settings: given by [`FOLDER_VARIABLE`], otherwise the usual one of the operating system; `None` if
/// there is neither. Each program has [its own](program::own).
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let shared = match std::env::var_os(FOLDER_VARIABLE) {
        Some(folder) if !folder.is_empty() => Some(PathBuf::from(folder)),
        _ => platform::settings_folder(program::LAB),
    };
    shared.map(program::own)
}

/// The file of the settings, if there is a folder for it.
#[must_use]
pub fn file() -> Option<PathBuf> {
    folder().map(|folder| folder.join(FILE))
}

/// Reads the settings in a folder. No file means defaults; a file that cannot be read means defaults
/// and a sentence that says so.
#[must_use]
pub fn load(folder: &Path) -> (Settings, Option<String>) {
    let path = folder.join(FILE);
    match read::<Settings>(&path) {
        Ok(found) => (found.unwrap_or_default().tidy(), None),
        Err(why) => {
            let kept = match why {
                Unreadable::File(_) => String::new(),
                Unreadable::Text(..) => {
                    format!(" When settings are next written, the file is kept as {KEPT}.")
                }
            };
            let path = path.shown();
            let text =
                format!("The settings in {path} cannot be read ({why}); defaults are used instead.{kept}");
            (Settings::default(), Some(text))
        }
    }
}

/// Why nothing was read from a file.
#[derive(thiserror::Error, Debug)]
pub(super) enum Unreadable {
    /// The file.
    #[error("{0}")]
    File(FileError),
    /// The mistake, and the content of the file.
    #[error("{0}")]
    Text(serde_json::Error, Vec<u8>),
}

/// The value in a file, if there is one.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, Unreadable> {
    match files::read(path, MAX_BYTES) {
        Ok(bytes) => serde_json::from_slice(&bytes).map(Some).map_err(|e| Unreadable::Text(e, bytes)),
        Err(FileError::Io(e)) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(Unreadable::File(e)),
    }
}

/// Writes a value to a file, all or nothing.
pub(super) fn write(path: &Path, value: &impl Serialize) -> Result<(), FileError> {
    let mut text = serde_json::to_string_pretty(value).map_err(io::Error::from)?;
    text.push('\n');
    files::write(path, text.as_bytes())
}

/// Writes the settings to a folder, all or nothing. Keys of the user's own and the address of a page stay as they stand in the
/// file, which was edited by hand; so does a text that cannot be read, in another file.
///
/// # Errors
/// Returns an error, as a sentence, if the folder or the file cannot be written.
pub fn save(folder: &Path, settings: &Settings) -> Result<(), String> {
    let path = folder.join(FILE);
    let write = || -> Result<(), FileError> {
        platform::fs::create_dir_all(folder)?;
        let mut settings = settings.clone();
        match read::<Settings>(&path) {
            Ok(Some(found)) => {
                (settings.keys, settings.web_address) = (found.keys, found.web_address);
            }
            Err(Unreadable::Text(_, bytes)) => files::write(&folder.join(KEPT), &bytes)?,
            Ok(None) | Err(Unreadable::File(_)) => {}
        }
        self::write(&path, &settings)
    };
    write().map_err(|e| format!("The settings cannot be written to {}: {e}.", path.shown()))
}

/// Loads the user's settings of the last session. Returns a complaint too if that fails.
#[must_use]
pub fn load_own() -> (Settings, Option<String>) {
    let Some(folder) = folder() else { return Default::default() };
    // Only settings could be left unfinished there, and they are loaded next.
    let _ = tidy(&folder);
    load(&folder)
}

/// Saves the user's settings for the next session.
///
/// # Errors
/// Returns a complaint.
pub fn save_own(settings: &Settings) -> Result<(), String> {
    folder().map_or(Ok(()), |folder| save(&folder, settings))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::state::{PictureOptions, PictureSize, SheetOptions, ThemeChoice};

    #[test]
    fn what_is_saved_is_loaded() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let settings = Settings {
            theme: ThemeChoice::Light,
            scale: 150,
            recent_files: vec![PathBuf::from("a.json")],
            picture: PictureOptions { size: PictureSize::UltraHd, numbers: true, ..Default::default() },
            sheet: SheetOptions { columns: 3, ..Default::default() },
            ..Settings::default()
        };
        save(folder.path(), &settings)?;
        assert_eq!(load(folder.path()), (settings, None));
        Ok(())
    }

    #[test]
    fn no_file_means_defaults_and_a_broken_one_says_so() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        assert_eq!(load(folder.path()), (Settings::default(), None));
        std::fs::write(folder.path().join(FILE), "{ \"theme\": ")?;
        let (settings, complaint) = load(folder.path());
        assert_eq!(settings, Settings::default());
        assert!(complaint.is_some_and(|c| c.contains("cannot be read")));
        Ok(())
    }

    #[test]
    fn keys_of_the_user_stay_as_they_were_typed_right_or_wrong() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let file = folder.path().join(FILE);
        for keys in [r#"{"save":"Ctrl+Shift+X","sav":7,"save":null,"open":[{"a":[]}]}"#, "5", "null", "[1,2]"]
        {
            std::fs::write(&file, format!("{{ \"keys\": {keys}, \"theme\": \"light\" }}"))?;
            let (settings, complaint) = load(folder.path());
            assert_eq!((settings.theme, complaint), (ThemeChoice::Light, None), "{keys}");
            // What is edited meanwhile stays too.
            let edited = std::fs::read_to_string(&file)?.replace("Shift+X", "Shift+Y");
            std::fs::write(&file, edited)?;
            save(folder.path(), &settings)?;
            let written: String = std::fs::read_to_string(&file)?.split_whitespace().collect();
            let keys = keys.replace("Shift+X", "Shift+Y");
            assert!(written.contains(&format!("\"keys\":{keys}")), "{keys}: {written}");
        }
        Ok(())
    }

    #[test]
    fn the_address_of_a_page_stays_as_it_was_typed() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        save(folder.path(), &Settings::default())?;
        let file = folder.path().join(FILE);
        assert!(!std::fs::read_to_string(&file)?.contains("web_address"));
        std::fs::write(&file, r#"{ "web_address": " https://lab.example.org/a/?scene=gem#x " }"#)?;
        // Typed while a window was open.
        save(folder.path(), &Settings::default())?;
        let (settings, complaint) = load(folder.path());
        assert_eq!((settings.page(), complaint), (Some("https://lab.example.org/a/"), None));
        for none in ["", " ", "#scene=1."] {
            let settings = Settings { web_address: Some(none.to_owned()), ..Settings::default() };
            assert_eq!(settings.page(), None, "{none:?}");
        }
        Ok(())
    }

    #[test]
    fn a_file_that_cannot_be_read_is_kept_when_settings_are_written() -> Result<(), Box<dyn std::error::Error>>
    {
        let folder = tempfile::tempdir()?;
        let broken = "{ \"keys\": { \"save\": \"F4\", } }";
        std::fs::write(folder.path().join(FILE), broken)?;
        let (settings, complaint) = load(folder.path());
        assert!(complaint.is_some_and(|c| c.contains("kept as settings.unreadable.json")));
        save(folder.path(), &settings)?;
        assert_eq!(std::fs::read_to_string(folder.path().join(KEPT))?, broken);
        assert_eq!(load(folder.path()), (settings, None));
        Ok(())
    }

    #[test]
    fn sizes_that_no_screen_has_become_the_defaults() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let text =
            r#"{ "left_width": 1e9, "large_type": true, "picture": { "size": "own", "own": [0, 99999] } }"#;
        std::fs::write(folder.path().join(FILE), text)?;
        let (settings, _) = load(folder.path());
        assert_eq!((settings.picture.size, settings.picture.own), (PictureSize::Own, [1280, 720]));
        assert_eq!(settings.left_width, Settings::default().left_width);
        assert_eq!(settings.scale, 150, "earlier versions had large type");
        Ok(())
    }

    #[test]
    fn a_scale_that_there_is_not_becomes_the_nearest() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        for (written, read) in [("130", 125), ("9000", 200), ("0", 100)] {
            std::fs::write(folder.path().join(FILE), format!("{{ \"scale\": {written} }}"))?;
            assert_eq!(load(folder.path()).0.scale, read);
        }
        Ok(())
    }
}
