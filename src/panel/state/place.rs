//! The places of panels, and their entries in menus.

/// The place of a panel, in the order in which F6 goes through them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Place {
    /// Across the top.
    Top,
    /// At the left; several stand one above the other.
    Left,
    /// At the right; several stand one above the other.
    Right,
    /// In the strip at the bottom; several are tabs.
    Bottom,
    /// The last line.
    Status,
}

/// The entry of a panel in menus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PanelInfo {
    /// See [`Panel::id`](crate::panel::Panel::id).
    pub id: &'static str,
    /// See [`Panel::title`](crate::panel::Panel::title).
    pub title: &'static str,
    /// See [`Panel::place`](crate::panel::Panel::place).
    pub place: Place,
}
