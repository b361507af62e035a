//! What is kept of the state between sessions.

use std::path::PathBuf;

use serde::{Deserialize, Deserializer, Serialize};

use super::{GivenKeys, OwnKeys, RECENT_FILES, Session, ThemeChoice, View, nearest_scale};

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
    /// Keys of the user's own, by the ids of commands. The window only reads them.
    #[serde(skip_serializing_if = "GivenKeys::is_empty")]
    pub keys: GivenKeys,
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
        Self::of(View::default())
    }
}

impl Settings {
    /// The settings of a view, without files and keys.
    fn of(view: View) -> Self {
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
            keys: GivenKeys::default(),
        }
    }

    /// Replaces sizes that no screen has (after manual edits of the file) by defaults.
    pub(in crate::panel) fn tidy(mut self) -> Self {
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

impl Session {
    /// The settings to keep between sessions.
    #[must_use]
    pub fn settings(&self) -> Settings {
        let (recent_files, keys) = (self.recent_files.clone(), self.keys.given.clone());
        Settings { recent_files, keys, ..Settings::of(self.view.clone()) }
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
        self.keys = OwnKeys { given: settings.keys, checked: None };
    }
}
