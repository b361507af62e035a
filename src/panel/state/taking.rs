//! Options of saved pictures and sheets: asked for before the file dialog, kept between sessions.

use serde::{Deserialize, Serialize};

use super::{Effect, Pick, Session, Severity, SheetOf};
use crate::{channel::LayerKind, declared::with_defaults, reference::MAX_SIDE, sweep::MAX_RATE};

/// A command for saved pictures.
#[derive(Clone, Debug, PartialEq)]
pub enum TakeCommand {
    /// Ask for the options of something to save.
    Ask(Taken),
    /// Change the options in the window.
    Change(Box<TakeDraft>),
    /// Keep the options, and choose a file.
    Choose,
    /// Close the window; the options stay as they were.
    Close,
}

/// The subject to be saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    /// The picture of a single view, or of all as shown.
    Picture(Option<usize>),
    /// A sheet or a film.
    Sheet(SheetOf),
}

/// The options in the window.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeDraft {
    /// The subject to be saved.
    pub of: Taken,
    /// True with a caption.
    pub caption: bool,
    /// The other options of pictures.
    pub picture: PictureOptions,
    /// The options of sheets.
    pub sheet: SheetOptions,
}

/// The size of saved pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PictureSize {
    /// The size of the view.
    #[default]
    AsView,
    /// 1280×720.
    Hd,
    /// 1920×1080.
    FullHd,
    /// 3840×2160.
    UltraHd,
    /// 1080×1080.
    Square,
    /// Numbers of the user's own.
    Own,
}

impl PictureSize {
    /// Every size, in the order of presentation.
    pub const ALL: [Self; 6] = [Self::AsView, Self::Hd, Self::FullHd, Self::UltraHd, Self::Square, Self::Own];

    /// The name for people.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::AsView => "As the view",
            Self::Hd => "1280 × 720",
            Self::FullHd => "1920 × 1080",
            Self::UltraHd => "3840 × 2160",
            Self::Square => "1080 × 1080",
            Self::Own => "Own numbers",
        }
    }

    /// One sentence of explanation.
    #[must_use]
    pub const fn summary(self) -> &'static str {
        match self {
            Self::AsView => "The pixels that the view has in the window now.",
            Self::Hd => "For web pages and most slides.",
            Self::FullHd => "For projectors.",
            Self::UltraHd => "For print. It takes nine times as long as 1280 × 720.",
            Self::Square => "A square.",
            Self::Own => "Width and height as you enter them.",
        }
    }
}

with_defaults! {
    /// Options of saved pictures, except for the caption, which a command changes too:
    /// [`picture_caption`](super::Settings::picture_caption).
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default)]
    pub struct PictureOptions {
        /// The size.
        pub size: PictureSize = PictureSize::AsView,
        /// Width and height of a size of the user's own, in pixels.
        pub own: [u32; 2] = [1280, 720],
        /// True for four samples per pixel, which smooth edges. Pictures as the view have those of the view.
        pub smooth: bool = true,
        /// True if the caption has the numbers of the difference between views.
        pub numbers: bool = false,
        /// True if maps of differences and debug channels have their legends.
        pub legend: bool = true,
        /// The colour of the background, instead of that of the scene.
        pub background: Option<[u8; 3]> = None,
        /// Ids of the layers of OpenEXR files.
        pub layers: Vec<String> = LayerKind::ALL.iter().map(|kind| kind.id().to_owned()).collect(),
    }
}

impl PictureOptions {
    /// Width and height in pixels; `None` for those of the view.
    #[must_use]
    pub fn pixels(&self) -> Option<[u32; 2]> {
        match self.size {
            PictureSize::AsView => None,
            PictureSize::Hd => Some([1280, 720]),
            PictureSize::FullHd => Some([1920, 1080]),
            PictureSize::UltraHd => Some([3840, 2160]),
            PictureSize::Square => Some([1080, 1080]),
            PictureSize::Own => Some(self.own),
        }
    }

    /// Samples per pixel.
    #[must_use]
    pub fn samples(&self) -> u32 {
        samples(self.smooth)
    }

    /// The layers of OpenEXR files.
    #[must_use]
    pub fn kinds(&self) -> Vec<LayerKind> {
        self.layers.iter().filter_map(|id| LayerKind::from_id(id)).collect()
    }

    /// The options of a picture as it is shown, with its caption and legends.
    #[must_use]
    pub fn as_shown(&self) -> Self {
        Self { size: PictureSize::AsView, background: None, ..self.clone() }
    }

    pub(super) fn tidy(&mut self) {
        self.own = sides(self.own).unwrap_or(Self::default().own);
    }
}

with_defaults! {
    /// Options of saved sheets.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
    #[serde(default)]
    pub struct SheetOptions {
        /// Width and height of each picture, in pixels.
        pub size: [u32; 2] = [640, 360],
        /// Number of pictures in a row of the sheet; 0 leaves it to the program.
        pub columns: u32 = 0,
        /// True with labels and a caption.
        pub labels: bool = true,
        /// True with maps of the differences from one picture.
        pub differences: bool = true,
        /// The number of that picture, counted from 0.
        pub against: u32 = 0,
        /// Number of pictures of a turn.
        pub turn: u32 = 24,
        /// Pictures of a film per second.
        pub rate: u32 = 12,
        /// True for four samples per pixel, which smooth edges.
        pub smooth: bool = true,
    }
}

impl SheetOptions {
    /// Maximum number of columns.
    pub const MAX_COLUMNS: u32 = 100;
    /// Minimum number of pictures of a turn.
    pub const MIN_TURN: u32 = 2;

    /// Maximum number of pictures of a turn.
    pub const MAX_TURN: u32 = 360;

    /// Samples per pixel.
    #[must_use]
    pub fn samples(&self) -> u32 {
        samples(self.smooth)
    }

    pub(super) fn tidy(&mut self) {
        self.size = sides(self.size).unwrap_or(Self::default().size);
        self.columns = self.columns.min(Self::MAX_COLUMNS);
        self.turn = self.turn.clamp(Self::MIN_TURN, Self::MAX_TURN);
        self.rate = self.rate.clamp(1, MAX_RATE);
    }
}

fn samples(smooth: bool) -> u32 {
    if smooth { 4 } else { 1 }
}

/// Width and height, if a picture can have them.
fn sides(size: [u32; 2]) -> Option<[u32; 2]> {
    size.iter().all(|side| (1..=MAX_SIDE).contains(side)).then_some(size)
}

impl Session {
    pub(super) fn take(&mut self, command: TakeCommand) {
        match command {
            TakeCommand::Ask(of) => {
                let running = match of {
                    Taken::Picture(_) => self.facts.picture.is_some().then_some("picture"),
                    Taken::Sheet(_) => self.facts.sheet.is_some().then_some("sheet"),
                };
                if let Some(what) = running {
                    let text = format!("A {what} is still being drawn: wait for it, or cancel it below.");
                    return self.say(Severity::Info, text);
                }
                let kept = &self.settings;
                self.take_draft = Some(TakeDraft {
                    of,
                    caption: kept.picture_caption,
                    picture: kept.picture.clone(),
                    sheet: kept.sheet.clone(),
                });
            }
            TakeCommand::Change(draft) => self.take_draft = Some(*draft),
            TakeCommand::Choose => {
                let Some(TakeDraft { of, caption, picture, sheet }) = self.take_draft.take() else { return };
                let before = self.settings.clone();
                let kept = &mut self.settings;
                (kept.picture_caption, kept.picture, kept.sheet) = (caption, picture, sheet);
                if self.settings != before {
                    self.request(Effect::SaveSettings);
                }
                self.request(Effect::Pick(match of {
                    Taken::Picture(view) => Pick::Picture(view),
                    Taken::Sheet(subject) => Pick::Sheet(subject),
                }));
            }
            TakeCommand::Close => self.take_draft = None,
        }
    }
}
