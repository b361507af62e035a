//! The place that the panels leave to the picture.

use bevy::ecs::resource::Resource;
use bevy_egui::egui;

/// The place that the panels leave to the picture, and the input that is the picture's. Written by the panels.
#[derive(Clone, Debug, PartialEq, Resource)]
pub struct PictureArea {
    /// The rectangle of the picture, points of the panels.
    pub rect: egui::Rect,
    /// The part of it that shows what the observer sees; around it the picture goes on.
    pub frame: egui::Rect,
    /// The views that are shown, where there are several or one has overrides.
    pub cells: Vec<Cell>,
    /// The place of the map of a difference.
    pub map: Option<egui::Rect>,
    /// Points of the window per point of the panels.
    pub zoom: f32,
    /// True if the pointer is over the picture with no panel, menu or dialog between. What turns the camera must ask
    /// here first.
    pub has_pointer: bool,
    /// True if keys may steer the picture: no field has the focus and no question is open.
    pub has_keys: bool,
    /// True if a menu or a list is open, which the next click elsewhere closes and does nothing else.
    pub popup_open: bool,
    /// The places of badges, caption and axes, which marks keep clear of.
    pub written: Vec<egui::Rect>,
}

impl Default for PictureArea {
    fn default() -> Self {
        Self {
            rect: egui::Rect::NOTHING,
            frame: egui::Rect::NOTHING,
            cells: Vec::new(),
            map: None,
            zoom: 1.0,
            has_pointer: false,
            has_keys: true,
            popup_open: false,
            written: Vec::new(),
        }
    }
}

impl PictureArea {
    /// The view at a place, and the rectangle of its picture.
    #[must_use]
    pub fn cell_at(&self, point: egui::Pos2) -> Option<&Cell> {
        let shown = |cell: &&Cell| cell.part.contains(point);
        // A map of the difference is as large as the views that it compares.
        self.cells.iter().find(shown).or_else(|| self.cells.iter().find(|cell| cell.rect.contains(point)))
    }
}

/// The place of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The view: 0 is the scene itself, 1 view B.
    pub view: usize,
    /// The rectangle of its picture, points of the panels.
    pub rect: egui::Rect,
    /// The part of it that is shown.
    pub part: egui::Rect,
}
