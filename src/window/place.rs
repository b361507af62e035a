//! Positions of the picture and of its views in the window.

use bevy::window::Window;
use bevy_egui::egui::{Pos2, Rect, vec2};
use glam::{UVec2, Vec2};

use crate::panel::state::PictureArea;

/// The area between the panels; without panels, the whole window.
pub(super) fn area_of(area: Option<&PictureArea>, window: &Window) -> PictureArea {
    area.cloned().unwrap_or_else(|| {
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(window.width(), window.height()));
        PictureArea { rect, frame: rect, has_pointer: true, ..PictureArea::default() }
    })
}

/// Rectangle of the picture in the window, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PicturePlace {
    pub(super) at: UVec2,
    pub(super) size: UVec2,
}

impl PicturePlace {
    /// Rectangle of the main view; the other views have the same size.
    pub(super) fn of(area: &PictureArea, window: &Window) -> Self {
        Self::of_rect(area.cells.first().map_or(area.rect, |cell| cell.rect), area.zoom, window)
    }

    pub(super) fn of_rect(rect: Rect, zoom: f32, window: &Window) -> Self {
        let limit = window.physical_size();
        if !rect.is_finite() || !rect.is_positive() || limit.min_element() == 0 {
            return Self { at: UVec2::ZERO, size: UVec2::ZERO };
        }
        let pixels = |points: f32| (points * zoom * window.scale_factor()).round().max(0.0) as u32;
        let at = UVec2::new(pixels(rect.min.x), pixels(rect.min.y)).min(limit.saturating_sub(UVec2::ONE));
        let end = UVec2::new(pixels(rect.max.x), pixels(rect.max.y)).min(limit);
        Self { at, size: end.saturating_sub(at).max(UVec2::ONE) }
    }

    /// Converts a position in the window to pixels of the picture.
    pub(super) fn within(self, window: &Window, point: Vec2) -> Vec2 {
        point * window.scale_factor() - self.at.as_vec2()
    }
}
