//! View settings.

use std::sync::atomic::{AtomicU64, Ordering};

use super::{
    Effect, LobeChoice, MESSAGES_TAB, Pin, Place, SCALES, Session, Settings, ThemeChoice, nearest_scale,
    probe::EXPLAIN_TAB,
};
use crate::{
    channel::DebugChannel,
    declared::{choice, with_defaults},
    optics::TermSelection,
    registry::Registry,
    scene::variant::MAX_VARIANTS,
};

choice! {
    /// The effect of the handles in the picture, and of the keys that nudge the selection; in the order of the key.
    HandleMode {
        #[default]
        Move "move" "Move" "Move the selection.",
        Turn "turn" "Turn" "Turn the selection.",
        Size "size" "Size" "Resize the selection.",
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

choice! {
    /// The labels of objects in the picture, in menu order.
    Labels {
        #[default]
        Off "off" "No labels" "Never.",
        On "on" "Names, models and values" "Always.",
        Presentation "presentation" "Only in a presentation" "In presentations.",
    }
}

with_defaults! {
    /// View settings.
    #[derive(Clone, Debug, PartialEq)]
    pub struct View {
        /// True if the strip of examples is shown below the picture.
        pub examples_open: bool = false,
        /// True if the picture fills the screen, with the equation over it and without panels.
        pub presenting: bool = false,
        /// True if the window fills the screen.
        pub fullscreen: bool = false,
        /// Value of `fullscreen` before the presentation started.
        pub fullscreen_before: bool = false,
        /// True if lights have markers in the picture.
        pub show_markers: bool = true,
        /// True if the selection has handles in the picture.
        pub show_handles: bool = true,
        /// Effect of the handles.
        pub handles: HandleMode = HandleMode::Move,
        /// True if the outline of the room is drawn.
        pub show_room: bool = true,
        /// When objects have labels.
        pub labels: Labels = Labels::Off,
        /// True if only parameters that differ from their defaults have knobs.
        pub only_changed: bool = false,
        /// True if clipped pixels are marked.
        pub show_clipping: bool = false,
        /// Visible terms of the equation.
        pub terms: TermSelection = TermSelection::All,
        /// Debug channels that replace the pictures of the views, view A first.
        pub channels: [Option<DebugChannel>; MAX_VARIANTS + 1] = [None; MAX_VARIANTS + 1],
        /// The active view, which the panels show and change: 0 is the scene, 1 view B.
        pub active: usize = 0,
        /// True while the other view is shown instead of view A.
        pub blinking: bool = false,
        /// True if the strip at the bottom is unfolded.
        pub bottom_open: bool = false,
        /// Id of the panel in the bottom strip.
        pub bottom_tab: String = MESSAGES_TAB.to_owned(),
        /// True if the scene list at the left is shown.
        pub left_open: bool = true,
        /// True if the properties at the right are shown.
        pub right_open: bool = true,
        /// True if the window is too narrow for panels beside the picture.
        pub narrow: bool = false,
        /// The place of the panel that was asked for last: a narrow window shows it alone, below the picture;
        /// [`Place::Picture`] if it shows none.
        pub front: Place = Place::Strip,
        /// The pinned pixel, which stays explained wherever the pointer is.
        pub pinned: Option<Pin> = None,
        /// Unique number of the pin.
        pub pin_number: u64 = 0,
        /// Display options of the lobe at the explained point.
        pub lobe: LobeChoice = LobeChoice::default(),
        /// True if the list of keyboard shortcuts is open.
        pub keys_open: bool = false,
        /// True if the *About* window is open.
        pub about_open: bool = false,
        /// True if the chooser of reflection models is open.
        pub chooser_open: bool = false,
        /// True if the finder of commands is open.
        pub finder_open: bool = false,
    }
}

/// A change of the view settings.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewChange {
    /// See [`Settings::theme`].
    Theme(ThemeChoice),
    /// See [`Settings::scale`]; rounded to the nearest of [`SCALES`].
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
    /// See [`View::show_markers`].
    Markers(bool),
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
    /// See [`Settings::picture_caption`].
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
    /// Open the panels at a place, and bring them to the front of a narrow window; see [`View::front`].
    Front(Place),
    /// Store the panel sizes after dragging: scene list, properties, bottom strip.
    Sizes {
        /// See [`Settings::left_width`].
        left: f32,
        /// See [`Settings::right_width`].
        right: f32,
        /// See [`Settings::strip_height`]: of the panel that the strip shows.
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
        self.open(Place::Bottom, true);
        tab.clone_into(&mut self.bottom_tab);
    }

    /// True if the panels at a place that can be closed are open.
    #[must_use]
    pub fn is_open(&self, place: Place) -> bool {
        match place {
            Place::Left => self.left_open,
            Place::Right => self.right_open,
            Place::Bottom => self.bottom_open,
            Place::Strip => self.examples_open,
            _ => false,
        }
    }

    /// Opens or closes the panels at a place. What is opened comes to the front.
    pub(super) fn open(&mut self, place: Place, open: bool) {
        match place {
            Place::Left => self.left_open = open,
            Place::Right => self.right_open = open,
            Place::Bottom => self.bottom_open = open,
            Place::Strip => self.examples_open = open,
            _ => {}
        }
        if open {
            if place == Place::Bottom {
                // The user goes on; with both, the picture would be lower than the strip.
                self.examples_open = false;
            }
            self.front = place;
        }
    }

    /// The place whose panel a narrow window shows below the picture: that of the one asked for last if it is open, or
    /// else the first that is.
    #[must_use]
    pub fn in_front(&self) -> Option<Place> {
        let all = [self.front, Place::Left, Place::Right, Place::Bottom, Place::Strip];
        let picture_alone = self.front == Place::Picture;
        all.into_iter().find(|place| !picture_alone && self.is_open(*place))
    }

    /// True if the strip at the bottom is in sight.
    #[must_use]
    pub fn shows_strip(&self) -> bool {
        self.bottom_open && !(self.narrow && self.in_front() != Some(Place::Bottom))
    }

    fn change(&mut self, change: ViewChange, kept: &mut Settings) {
        match change {
            ViewChange::Theme(theme) => kept.theme = theme,
            ViewChange::Scale(percent) => kept.scale = nearest_scale(percent),
            ViewChange::Larger => {
                kept.scale = SCALES.into_iter().find(|s| *s > kept.scale).unwrap_or(kept.scale);
            }
            ViewChange::Smaller => {
                kept.scale = SCALES.into_iter().rfind(|s| *s < kept.scale).unwrap_or(kept.scale);
            }
            ViewChange::Examples(on) => self.open(Place::Strip, on),
            ViewChange::Presenting(on) if on != self.presenting => {
                let before = std::mem::replace(&mut self.fullscreen_before, self.fullscreen);
                self.fullscreen = on || before;
                self.presenting = on;
            }
            ViewChange::Presenting(_) => {}
            ViewChange::Fullscreen(on) => self.fullscreen = on,
            ViewChange::Markers(on) => self.show_markers = on,
            ViewChange::Handles(HandleChange::Show(on)) => self.show_handles = on,
            ViewChange::Handles(HandleChange::Mode(mode)) => {
                (self.handles, self.show_handles) = (mode, true);
            }
            ViewChange::Room(on) => self.show_room = on,
            ViewChange::Labels(labels) => self.labels = labels,
            ViewChange::OnlyChanged(on) => self.only_changed = on,
            ViewChange::Clipping(on) => self.show_clipping = on,
            ViewChange::PictureCaption(on) => kept.picture_caption = on,
            ViewChange::Terms(terms) => self.terms = terms,
            ViewChange::Channel(channel) => {
                if let Some(shown) = self.channels.get_mut(self.active) {
                    *shown = channel;
                }
            }
            ViewChange::Bottom(open) => self.open(Place::Bottom, open),
            ViewChange::BottomTab(id) => self.unfold(&id),
            ViewChange::Panel(id, shown) => set(&mut kept.hidden_panels, id, !shown),
            ViewChange::Fold(id, folded) => set(&mut kept.folded_panels, id, folded),
            ViewChange::Pin(pin) => {
                self.pin(pin);
                if pin.is_some() {
                    self.unfold(EXPLAIN_TAB);
                }
            }
            ViewChange::Lobe(lobe) => self.lobe = lobe,
            ViewChange::Left(open) => self.open(Place::Left, open),
            ViewChange::Right(open) => self.open(Place::Right, open),
            ViewChange::Front(place) => self.open(place, true),
            ViewChange::Sizes { left, right, bottom } => {
                (kept.left_width, kept.right_width) = (left, right);
                *kept.strip_height_mut(&self.bottom_tab) = bottom;
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
        if self.view.shows_strip() {
            ViewChange::Bottom(false)
        } else {
            ViewChange::BottomTab(MESSAGES_TAB.to_owned())
        }
    }

    /// Changes the view. The terms of another view than the first are its own.
    pub(super) fn change_active_view(&mut self, change: ViewChange, registry: &Registry) {
        match change {
            ViewChange::Terms(terms) if self.active() > 0 => self.override_terms(terms, registry),
            change => self.change_view(change),
        }
    }

    pub(super) fn change_view(&mut self, change: ViewChange) {
        let before = self.settings.clone();
        let place = |id: &str| self.panels.iter().find(|p| p.guest && p.id == id).map(|p| p.place);
        match &change {
            ViewChange::Panel(id, true) => {
                if let Some(place @ (Place::Left | Place::Right)) = place(id) {
                    self.view.open(place, true);
                }
            }
            ViewChange::BottomTab(id) => self.settings.guest_tab = place(id).map(|_| id.clone()),
            ViewChange::Bottom(false) => self.settings.guest_tab = None,
            _ => {}
        }
        if matches!(change, ViewChange::Bottom(_) | ViewChange::BottomTab(_)) {
            self.keep_strip();
        }
        let left = self.settings.left_width;
        self.view.change(change, &mut self.settings);
        if self.lesson.is_some() {
            // The panel at the left is the lesson.
            let width = std::mem::replace(&mut self.settings.left_width, left);
            if width != left {
                self.settings.lesson_width = width;
            }
        }
        if before != self.settings {
            self.request(Effect::SaveSettings);
        }
    }
}
