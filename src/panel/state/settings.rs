//! The part of the state that is kept between sessions.

use std::path::PathBuf;

use serde::{Deserialize, Deserializer, Serialize};

use super::{GivenKeys, MESSAGES_TAB, OwnKeys, PictureOptions, Session, SheetOptions};
use crate::declared::with_defaults;

/// Maximum length of the list of recent files.
pub const RECENT_FILES: usize = 10;

/// Available interface scales, in per cent.
pub const SCALES: [u16; 6] = [100, 110, 125, 150, 175, 200];

/// The nearest of [`SCALES`].
#[must_use]
pub fn nearest_scale(percent: u16) -> u16 {
    SCALES.into_iter().min_by_key(|s| s.abs_diff(percent)).unwrap_or(100)
}

/// Light or dark theme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThemeChoice {
    /// Near-black panels, for judging pictures.
    #[default]
    Dark,
    /// Near-white panels, for bright rooms and projectors.
    Light,
}

with_defaults! {
    /// Settings that are kept between sessions.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default)]
    pub struct Settings {
        /// Light or dark theme.
        pub theme: ThemeChoice = ThemeChoice::Dark,
        /// Interface scale, in per cent: one of [`SCALES`]. Earlier versions stored only whether type was large.
        #[serde(alias = "large_type", deserialize_with = "scale")]
        pub scale: u16 = 100,
        /// Width of the scene list, in points.
        pub left_width: f32 = 208.0,
        /// Width of a lesson, in points.
        pub lesson_width: f32 = 340.0,
        /// Width of the properties panel, in points.
        pub right_width: f32 = 344.0,
        /// Height of the bottom strip, in points.
        pub bottom_height: f32 = 144.0,
        /// Height of the bottom strip while it shows messages, which need less than the other panels, in points.
        pub messages_height: f32 = 144.0,
        /// Ids of hidden guest panels.
        pub hidden_panels: Vec<String> = Vec::new(),
        /// Ids of folded guest panels.
        pub folded_panels: Vec<String> = Vec::new(),
        /// Id of the guest panel that the user chose in the bottom strip. The panel may be unknown to this window.
        pub guest_tab: Option<String> = None,
        /// True if saved or copied pictures have a caption.
        pub picture_caption: bool = true,
        /// The other options of saved pictures.
        pub picture: PictureOptions = PictureOptions::default(),
        /// Options of saved sheets.
        pub sheet: SheetOptions = SheetOptions::default(),
        /// Files opened or saved, latest first.
        pub recent_files: Vec<PathBuf> = Vec::new(),
        /// Address of a page with the laboratory, with which links begin. The window only reads it.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub web_address: Option<String> = None,
        /// Keys of the user's own, by the ids of commands. The window only reads them.
        #[serde(skip_serializing_if = "GivenKeys::is_empty")]
        pub keys: GivenKeys = GivenKeys::default(),
    }
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

impl Settings {
    /// True if a guest panel is hidden.
    #[must_use]
    pub fn hides(&self, id: &str) -> bool {
        self.hidden_panels.iter().any(|hidden| hidden == id)
    }

    /// True if a guest panel is folded.
    #[must_use]
    pub fn folds(&self, id: &str) -> bool {
        self.folded_panels.iter().any(|folded| folded == id)
    }

    /// The address of a page with the laboratory, without what may follow in it.
    #[must_use]
    pub fn page(&self) -> Option<&str> {
        let page = self.web_address.as_deref()?.trim();
        page.split(['?', '#']).next().filter(|page| !page.is_empty())
    }

    /// Height of the bottom strip with this panel, in points.
    #[must_use]
    pub fn strip_height(&self, tab: &str) -> f32 {
        if tab == MESSAGES_TAB { self.messages_height } else { self.bottom_height }
    }

    /// The height of the bottom strip with this panel, to change it.
    pub(super) fn strip_height_mut(&mut self, tab: &str) -> &mut f32 {
        if tab == MESSAGES_TAB { &mut self.messages_height } else { &mut self.bottom_height }
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
        tidy(&mut self.messages_height, default.messages_height);
        self.picture.tidy();
        self.sheet.tidy();
        self
    }
}

impl Session {
    /// Applies settings of an earlier session.
    pub fn adopt(&mut self, settings: Settings) {
        self.settings = settings;
        self.settings.recent_files.truncate(RECENT_FILES);
        self.keys = OwnKeys::default();
    }
}
