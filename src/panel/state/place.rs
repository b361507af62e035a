//! The places of panels, and their entries in menus.

/// The place of a panel, in the order in which F6 goes through them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Place {
    /// Across the top.
    Top,
    /// At the left, below the list of the scene, in a section that folds.
    Left,
    /// At the right, below the properties, in a section that folds.
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
    /// True if it is not one of the window's own.
    pub guest: bool,
}
