//! View settings.

use std::sync::atomic::{AtomicU64, Ordering};

use super::{Effect, LobeChoice, Pin, Place, Session, probe::EXPLAIN_TAB};
use crate::{channel::DebugChannel, optics::TermSelection, scene::variant::MAX_VARIANTS};

/// Id of the panel that shows the messages.
pub const MESSAGES_TAB: &str = "messages";
/// Id of the panel that shows the plots.
pub const PLOTS_TAB: &str = "plots";
/// Id of the panel that shows the shaders.
pub const SHADER_TAB: &str = "shader";

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

/// The effect of the handles in the picture, and of the keys that nudge the selection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HandleMode {
    /// Move the selection.
    #[default]
    Move,
    /// Turn the selection.
    Turn,
    /// Resize the selection.
    Size,
}

impl HandleMode {
    /// All modes, in the order of the key.
    pub const ALL: [Self; 3] = [Self::Move, Self::Turn, Self::Size];

    /// Display name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Move => "Move",
            Self::Turn => "Turn",
            Self::Size => "Size",
        }
    }

    /// The next mode, in a cycle.
    #[must_use]
    pub const fn next(self) -> Self {
        match self {
            Self::Move => Self::Turn,
            Self::Turn => Self::Size,
            Self::Size => Self::Move,
        }
    }
}

/// A change of the handles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandleChange {
    /// See [`View::show_handles`].
    Show(bool),
    /// See [`View::handles`]; also shows the handles.
    Mode(HandleMode),
}

/// The labels of objects in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Labels {
    /// Never.
    #[default]
    Off,
    /// Always.
    On,
    /// In presentations.
    Presentation,
}

impl Labels {
    /// All options, in menu order.
    pub const ALL: [Self; 3] = [Self::Off, Self::On, Self::Presentation];

    /// The id of its command.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::On => "on",
            Self::Presentation => "presentation",
        }
    }

    /// The name for people.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "No labels",
            Self::On => "Names, models and values",
            Self::Presentation => "Only in a presentation",
        }
    }
}

/// View settings.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Light or dark theme.
    pub theme: ThemeChoice,
    /// Interface scale, in per cent: one of [`SCALES`].
    pub scale: u16,
    /// True if the strip of examples is shown below the picture.
    pub examples_open: bool,
    /// True if the picture fills the screen, with the equation over it and without panels.
    pub presenting: bool,
    /// True if the window fills the screen.
    pub fullscreen: bool,
    /// Value of `fullscreen` before the presentation started.
    pub fullscreen_before: bool,
    /// True if lights have markers in the picture.
    pub show_gizmos: bool,
    /// True if the selection has handles in the picture.
    pub show_handles: bool,
    /// Effect of the handles.
    pub handles: HandleMode,
    /// True if the outline of the room is drawn.
    pub show_room: bool,
    /// When objects have labels.
    pub labels: Labels,
    /// True if only parameters that differ from their defaults have knobs.
    pub only_changed: bool,
    /// True if clipped pixels are marked.
    pub show_clipping: bool,
    /// True if saved or copied pictures have a caption.
    pub picture_caption: bool,
    /// Visible terms of the equation.
    pub terms: TermSelection,
    /// Debug channels that replace the pictures of the views, view A first.
    pub channels: [Option<DebugChannel>; MAX_VARIANTS + 1],
    /// The active view, which the panels show and change: 0 is the scene, 1 view B.
    pub active: usize,
    /// True while the other view is shown instead of view A.
    pub blinking: bool,
    /// True if the strip at the bottom is unfolded.
    pub bottom_open: bool,
    /// Id of the panel in the bottom strip.
    pub bottom_tab: String,
    /// True if the scene list at the left is shown.
    pub left_open: bool,
    /// True if the properties at the right are shown.
    pub right_open: bool,
    /// The pinned pixel, which stays explained wherever the pointer is.
    pub pinned: Option<Pin>,
    /// Unique number of the pin.
    pub pin_number: u64,
    /// Display options of the lobe at the explained point.
    pub lobe: LobeChoice,
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
    /// Id of the guest panel that the user chose in the bottom strip. The panel may be unknown to this window.
    pub guest_tab: Option<String>,
    /// True if the list of keyboard shortcuts is open.
    pub keys_open: bool,
    /// True if the *About* window is open.
    pub about_open: bool,
    /// True if the chooser of reflection models is open.
    pub chooser_open: bool,
    /// True if the finder of commands is open.
    pub finder_open: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            theme: ThemeChoice::Dark,
            scale: 100,
            examples_open: false,
            presenting: false,
            fullscreen: false,
            fullscreen_before: false,
            show_gizmos: true,
            show_handles: true,
            handles: HandleMode::Move,
            show_room: true,
            labels: Labels::Off,
            only_changed: false,
            show_clipping: false,
            picture_caption: true,
            terms: TermSelection::All,
            channels: [None; MAX_VARIANTS + 1],
            active: 0,
            blinking: false,
            bottom_open: false,
            bottom_tab: MESSAGES_TAB.to_owned(),
            left_open: true,
            right_open: true,
            pinned: None,
            pin_number: 0,
            lobe: LobeChoice::default(),
            left_width: 208.0,
            lesson_width: 340.0,
            right_width: 344.0,
            bottom_height: 144.0,
            hidden_panels: Vec::new(),
            folded_panels: Vec::new(),
            guest_tab: None,
            keys_open: false,
            about_open: false,
            chooser_open: false,
            finder_open: false,
        }
    }
}

/// A change of the view settings.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewChange {
    /// See [`View::theme`].
    Theme(ThemeChoice),
    /// See [`View::scale`]; rounded to the nearest of [`SCALES`].
    Scale(u16),
    /// Select the next larger of [`SCALES`].
    Larger,
    /// Select the next smaller of [`SCALES`].
    Smaller,
    /// See [`View::examples_open`].
    Examples(bool),
    /// See [`View::presenting`].
    Presenting(bool),
    /// See [`View::fullscreen`].
    Fullscreen(bool),
    /// See [`View::show_gizmos`].
    Gizmos(bool),
    /// See [`View::show_handles`] and [`View::handles`].
    Handles(HandleChange),
    /// See [`View::show_room`].
    Room(bool),
    /// See [`View::labels`].
    Labels(Labels),
    /// See [`View::only_changed`].
    OnlyChanged(bool),
    /// See [`View::show_clipping`].
    Clipping(bool),
    /// See [`View::picture_caption`].
    PictureCaption(bool),
    /// See [`View::terms`].
    Terms(TermSelection),
    /// Set the debug channel of the active view; see [`View::channels`].
    Channel(Option<DebugChannel>),
    /// Unfold or fold the strip at the bottom.
    Bottom(bool),
    /// Show a panel in the strip at the bottom, and unfold the strip.
    BottomTab(String),
    /// Show or hide a guest panel at a side; showing also opens that side.
    Panel(String, bool),
    /// Fold or unfold a guest panel at a side.
    Fold(String, bool),
    /// See [`View::pinned`]; pinning also opens the explanation.
    Pin(Option<Pin>),
    /// See [`View::lobe`].
    Lobe(LobeChoice),
    /// See [`View::left_open`].
    Left(bool),
    /// See [`View::right_open`].
    Right(bool),
    /// Store the panel sizes after dragging: scene list, properties, bottom strip.
    Sizes {
        /// See [`View::left_width`].
        left: f32,
        /// See [`View::right_width`].
        right: f32,
        /// See [`View::bottom_height`].
        bottom: f32,
    },
    /// See [`View::keys_open`].
    Keys(bool),
    /// See [`View::about_open`].
    About(bool),
    /// See [`View::chooser_open`].
    Chooser(bool),
    /// See [`View::finder_open`].
    Finder(bool),
}

/// Adds an id to a list, or removes it.
fn set(list: &mut Vec<String>, id: String, on: bool) {
    list.retain(|known| *known != id);
    if on {
        list.push(id);
    }
}

impl View {
    /// Pins a pixel, or unpins. Pinning the same pixel again creates a new pin, for the point that is there now.
    pub fn pin(&mut self, pin: Option<Pin>) {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        self.pinned = pin;
        self.pin_number = NEXT.fetch_add(1, Ordering::Relaxed);
    }

    /// Unfolds the strip at the bottom with the given panel.
    pub fn unfold(&mut self, tab: &str) {
        self.bottom_open = true;
        tab.clone_into(&mut self.bottom_tab);
    }

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

    fn change(&mut self, change: ViewChange) {
        match change {
            ViewChange::Theme(theme) => self.theme = theme,
            ViewChange::Scale(percent) => self.scale = nearest_scale(percent),
            ViewChange::Larger => {
                self.scale = SCALES.into_iter().find(|s| *s > self.scale).unwrap_or(self.scale)
            }
            ViewChange::Smaller => {
                self.scale = SCALES.into_iter().rfind(|s| *s < self.scale).unwrap_or(self.scale);
            }
            ViewChange::Examples(on) => self.examples_open = on,
            ViewChange::Presenting(on) if on != self.presenting => {
                let before = std::mem::replace(&mut self.fullscreen_before, self.fullscreen);
                self.fullscreen = on || before;
                self.presenting = on;
            }
            ViewChange::Presenting(_) => {}
            ViewChange::Fullscreen(on) => self.fullscreen = on,
            ViewChange::Gizmos(on) => self.show_gizmos = on,
            ViewChange::Handles(HandleChange::Show(on)) => self.show_handles = on,
            ViewChange::Handles(HandleChange::Mode(mode)) => {
                (self.handles, self.show_handles) = (mode, true);
            }
            ViewChange::Room(on) => self.show_room = on,
            ViewChange::Labels(labels) => self.labels = labels,
            ViewChange::OnlyChanged(on) => self.only_changed = on,
            ViewChange::Clipping(on) => self.show_clipping = on,
            ViewChange::PictureCaption(on) => self.picture_caption = on,
            ViewChange::Terms(terms) => self.terms = terms,
            ViewChange::Channel(channel) => {
                if let Some(shown) = self.channels.get_mut(self.active) {
                    *shown = channel;
                }
            }
            ViewChange::Bottom(open) => self.bottom_open = open,
            ViewChange::BottomTab(id) => {
                self.unfold(&id);
            }
            ViewChange::Panel(id, shown) => set(&mut self.hidden_panels, id, !shown),
            ViewChange::Fold(id, folded) => set(&mut self.folded_panels, id, folded),
            ViewChange::Pin(pin) => {
                self.pin(pin);
                if pin.is_some() {
                    self.unfold(EXPLAIN_TAB);
                }
            }
            ViewChange::Lobe(lobe) => self.lobe = lobe,
            ViewChange::Left(open) => self.left_open = open,
            ViewChange::Right(open) => self.right_open = open,
            ViewChange::Sizes { left, right, bottom } => {
                (self.left_width, self.right_width, self.bottom_height) = (left, right, bottom);
            }
            ViewChange::Keys(open) => self.keys_open = open,
            ViewChange::About(open) => self.about_open = open,
            ViewChange::Chooser(open) => self.chooser_open = open,
            ViewChange::Finder(open) => self.finder_open = open,
        }
    }
}

impl Session {
    /// The change that folds the strip at the bottom, or unfolds it with the messages.
    #[must_use]
    pub fn strip_change(&self) -> ViewChange {
        if self.view.bottom_open {
            ViewChange::Bottom(false)
        } else {
            ViewChange::BottomTab(MESSAGES_TAB.to_owned())
        }
    }

    pub(super) fn change_view(&mut self, change: ViewChange) -> Vec<Effect> {
        let before = self.settings();
        let place = |id: &str| self.panels.iter().find(|p| p.guest && p.id == id).map(|p| p.place);
        match &change {
            ViewChange::Panel(id, true) => match place(id) {
                Some(Place::Left) => self.view.left_open = true,
                Some(Place::Right) => self.view.right_open = true,
                _ => {}
            },
            ViewChange::BottomTab(id) => self.view.guest_tab = place(id).map(|_| id.clone()),
            ViewChange::Bottom(false) => self.view.guest_tab = None,
            _ => {}
        }
        if matches!(change, ViewChange::Bottom(_) | ViewChange::BottomTab(_)) {
            self.keep_strip();
        }
        let left = self.view.left_width;
        self.view.change(change);
        if self.lesson.is_some() {
            // The panel at the left is the lesson.
            let width = std::mem::replace(&mut self.view.left_width, left);
            if width != left {
                self.view.lesson_width = width;
            }
        }
        if before == self.settings() { Vec::new() } else { vec![Effect::SaveSettings] }
    }
}
