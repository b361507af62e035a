//! The area of the picture between the panels.

use bevy::ecs::resource::Resource;
use bevy_egui::egui;

use crate::declared::with_defaults;

with_defaults! {
    /// The area of the picture between the panels, and the input that belongs to the picture. Written by the panels.
    #[derive(Clone, Debug, PartialEq, Resource)]
    pub struct PictureArea {
        /// Rectangle of the picture, in points of the panels.
        pub rect: egui::Rect = egui::Rect::NOTHING,
        /// The part of the picture that the observer sees; the picture extends around it.
        pub frame: egui::Rect = egui::Rect::NOTHING,
        /// The visible views, if there are several or one has overrides.
        pub cells: Vec<Cell> = Vec::new(),
        /// Rectangle of the difference map.
        pub map: Option<egui::Rect> = None,
        /// Size of the letters of the map's legend, in points of the panels.
        pub letters: f32 = 11.5,
        /// Points of the window per point of the panels.
        pub zoom: f32 = 1.0,
        /// True if the pointer is over the picture and no panel, menu or dialog is in between. Anything that moves the
        /// camera must check this first.
        pub has_pointer: bool = false,
        /// True if keys may steer the picture: no field has the focus and no question is open.
        pub has_keys: bool = true,
        /// True if a menu or a list is open, which the next click elsewhere only closes.
        pub popup_open: bool = false,
        /// Rectangles of badges, caption and axes, which marks avoid.
        pub written: Vec<egui::Rect> = Vec::new(),
    }
}

impl PictureArea {
    /// The ratio of width to height of the pictures, which is the same for all views; `None` if there are none.
    #[must_use]
    pub fn aspect(&self) -> Option<f32> {
        let rect = self.cells.first().map_or(self.frame, |cell| cell.rect);
        (rect.is_finite() && rect.is_positive()).then(|| rect.aspect_ratio())
    }

    /// The view at a point, and the rectangle of its picture.
    #[must_use]
    pub fn cell_at(&self, point: egui::Pos2) -> Option<&Cell> {
        let shown = |cell: &&Cell| cell.part.contains(point);
        // A difference map is as large as the compared views.
        self.cells.iter().find(shown).or_else(|| self.cells.iter().find(|cell| cell.rect.contains(point)))
    }
}

/// The area of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The view: 0 is the scene itself, 1 view B.
    pub view: usize,
    /// Rectangle of the view's picture, in points of the panels.
    pub rect: egui::Rect,
    /// The visible part of the rectangle.
    pub part: egui::Rect,
}
