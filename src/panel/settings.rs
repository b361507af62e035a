//! Settings that are kept between sessions: theme, scale, panel sizes, recent files.

use std::{
    io,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Deserializer, Serialize};

use super::state::{RECENT_FILES, Session, Severity, ThemeChoice, View, nearest_scale};
use crate::files::Shown as _;
use crate::{
    files::{self, FileError, tidy},
    program,
};

/// Environment variable that overrides the folder of the settings.
pub const FOLDER_VARIABLE: &str = "LCM_CONFIG_DIR";
/// File name.
const FILE: &str = "settings.json";
/// Maximum size of the file, enough for long names of recent files. The JSON library limits the depth to 128 levels.
const MAX_BYTES: u64 = 1 << 20;

/// Settings that are kept between sessions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Light or dark theme.
    pub theme: ThemeChoice,
    /// Interface scale, in per cent. Earlier versions stored only whether type was large.
    #[serde(alias = "large_type", deserialize_with = "scale")]
    pub scale: u16,
    /// Width of the scene list, in points.
    pub left_width: f32,
    /// Width of a lesson, in points.
    pub lesson_width: f32,
    /// Width of the properties panel, in points.
    pub right_width: f32,
    /// Height of the bottom strip, in points.
    pub bottom_height: f32,
    /// Ids of hidden guest panels.
    pub hidden_panels: Vec<String>,
    /// Ids of folded guest panels.
    pub folded_panels: Vec<String>,
    /// Id of the guest panel in the bottom strip.
    pub guest_tab: Option<String>,
    /// True if saved or copied pictures have a caption.
    pub picture_caption: bool,
    /// Files opened or saved, latest first.
    pub recent_files: Vec<PathBuf>,
}

fn scale<'de, D: Deserializer<'de>>(value: D) -> Result<u16, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Scale {
        LargeType(bool),
        Percent(u16),
    }
    Ok(nearest_scale(match Scale::deserialize(value)? {
        Scale::LargeType(large) => {
            if large {
                150
            } else {
                100
            }
        }
        Scale::Percent(percent) => percent,
    }))
}

impl Default for Settings {
    fn default() -> Self {
        let view = View::default();
        Self {
            theme: view.theme,
            scale: view.scale,
            left_width: view.left_width,
            lesson_width: view.lesson_width,
            right_width: view.right_width,
            bottom_height: view.bottom_height,
            hidden_panels: view.hidden_panels,
            folded_panels: view.folded_panels,
            guest_tab: view.guest_tab,
            picture_caption: view.picture_caption,
            recent_files: Vec::new(),
        }
    }
}

/// The folder of the settings: given by [`FOLDER_VARIABLE`], otherwise the usual one of the operating system; `None` if
/// there is neither. Each program has [its own](program::own).
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let shared = match std::env::var_os(FOLDER_VARIABLE) {
        Some(folder) if !folder.is_empty() => Some(PathBuf::from(folder)),
        _ => directories::ProjectDirs::from("", "", program::LAB).map(|d| d.config_dir().to_owned()),
    };
    shared.map(program::own)
}

/// Loads the settings from a folder. A missing file means defaults; an unreadable file means defaults and a message.
#[must_use]
pub fn load(folder: &Path) -> (Settings, Option<String>) {
    let path = folder.join(FILE);
    let bytes = match files::read(&path, MAX_BYTES) {
        Ok(bytes) => bytes,
        Err(FileError::Io(e)) if e.kind() == io::ErrorKind::NotFound => return (Settings::default(), None),
        Err(e) => return (Settings::default(), Some(unreadable(&path, &e))),
    };
    match serde_json::from_slice::<Settings>(&bytes) {
        Ok(settings) => (settings.tidy(), None),
        Err(e) => (Settings::default(), Some(unreadable(&path, &e))),
    }
}

fn unreadable(path: &Path, why: &dyn std::fmt::Display) -> String {
    format!("The settings in {} cannot be read ({why}); defaults are used instead.", path.shown())
}

/// Saves the settings to a folder, completely or not at all.
///
/// # Errors
/// Returns an error, as a sentence, if the folder or the file cannot be written.
pub fn save(folder: &Path, settings: &Settings) -> Result<(), String> {
    let path = folder.join(FILE);
    let write = || -> Result<(), FileError> {
        std::fs::create_dir_all(folder)?;
        let mut text = serde_json::to_string_pretty(settings).map_err(io::Error::from)?;
        text.push('\n');
        files::write(&path, text.as_bytes())
    };
    write().map_err(|e| format!("The settings cannot be written to {}: {e}.", path.shown()))
}

/// Loads the settings of the last session into the state, and reports if that fails.
pub fn load_settings(session: &mut Session) {
    if let Some(folder) = folder() {
        // Only settings could be left unfinished there, and they are loaded next.
        let _ = tidy(&folder);
        let (settings, complaint) = load(&folder);
        session.adopt(settings);
        if let Some(complaint) = complaint {
            session.say(Severity::Warning, complaint);
        }
    }
}

/// Saves the settings for the next session, and reports if that fails.
pub fn save_settings(session: &mut Session) {
    if let Some(folder) = folder()
        && let Err(complaint) = save(&folder, &session.settings())
    {
        session.say(Severity::Warning, complaint);
    }
}

impl Session {
    /// The settings to keep between sessions.
    #[must_use]
    pub fn settings(&self) -> Settings {
        Settings {
            theme: self.view.theme,
            scale: self.view.scale,
            left_width: self.view.left_width,
            lesson_width: self.view.lesson_width,
            right_width: self.view.right_width,
            bottom_height: self.view.bottom_height,
            hidden_panels: self.view.hidden_panels.clone(),
            folded_panels: self.view.folded_panels.clone(),
            guest_tab: self.view.guest_tab.clone(),
            picture_caption: self.view.picture_caption,
            recent_files: self.recent_files.clone(),
        }
    }

    /// Applies settings of an earlier session.
    pub fn adopt(&mut self, settings: Settings) {
        self.view.theme = settings.theme;
        self.view.scale = settings.scale;
        self.view.left_width = settings.left_width;
        self.view.lesson_width = settings.lesson_width;
        self.view.right_width = settings.right_width;
        self.view.bottom_height = settings.bottom_height;
        self.view.hidden_panels = settings.hidden_panels;
        self.view.folded_panels = settings.folded_panels;
        self.view.guest_tab = settings.guest_tab;
        self.view.picture_caption = settings.picture_caption;
        self.recent_files = settings.recent_files;
        self.recent_files.truncate(RECENT_FILES);
    }
}

impl Settings {
    /// Replaces sizes that no screen has (after manual edits of the file) by defaults.
    fn tidy(mut self) -> Self {
        let default = Self::default();
        let tidy = |value: &mut f32, default: f32| {
            if !value.is_finite() || !(64.0..=2000.0).contains(value) {
                *value = default;
            }
        };
        tidy(&mut self.left_width, default.left_width);
        tidy(&mut self.lesson_width, default.lesson_width);
        tidy(&mut self.right_width, default.right_width);
        tidy(&mut self.bottom_height, default.bottom_height);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_saved_is_loaded() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let settings = Settings {
            theme: ThemeChoice::Light,
            scale: 150,
            recent_files: vec![PathBuf::from("a.json")],
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
    fn sizes_that_no_screen_has_become_the_defaults() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        std::fs::write(folder.path().join(FILE), "{ \"left_width\": 1e9, \"large_type\": true }")?;
        let (settings, _) = load(folder.path());
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
