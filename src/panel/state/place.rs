//! Places of panels, and their entries in menus.

/// Place of a panel, in the order of F6.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Place {
    /// Along the top.
    Top,
    /// At the left, in a foldable section below the scene list.
    Left,
    /// At the right, in a foldable section below the properties.
    Right,
    /// In the strip at the bottom, where several panels become tabs.
    Bottom,
    /// The status line.
    Status,
    /// In a strip below the picture.
    Strip,
    /// Between all others.
    Picture,
    /// Over all others.
    Over(Over),
}

/// The kinds of overlays, from the lowest to the highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Over {
    /// A list that a click elsewhere closes.
    List,
    /// A window beside which everything can be used.
    Window,
    /// A dialog, which takes the input from everything else until it is closed.
    Dialog,
    /// A question, which takes the input from everything else until it is answered.
    Question,
}

/// Entry of a panel in menus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PanelInfo {
    /// See [`Panel::id`](crate::panel::Panel::id).
    pub id: &'static str,
    /// See [`Panel::title`](crate::panel::Panel::title).
    pub title: &'static str,
    /// See [`Panel::place`](crate::panel::Panel::place).
    pub place: Place,
    /// True for a panel that is not one of the window's own.
    pub guest: bool,
}
