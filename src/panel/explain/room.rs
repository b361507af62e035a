//! Free space in a picture, for labels.

use std::collections::HashSet;

use crate::panel::prelude::*;

/// Side of a cell, in points.
const CELL: f32 = 6.0;
/// Distance between candidate positions, in points, and the number of such steps to the farthest.
const STEP: f32 = 18.0;
const STEPS: usize = 12;
/// Distance beyond which a label is connected to its point by a line, in points.
pub(super) const APART: f32 = 30.0;

/// Occupied parts of a picture: cells covered by surfaces, and plates.
#[derive(Debug, Default)]
pub(super) struct Room {
    cells: HashSet<[i32; 2]>,
    plates: Vec<Rect>,
}

/// Cells that a rectangle touches.
fn cells(rect: Rect) -> impl Iterator<Item = [i32; 2]> {
    let cell = |points: f32| (points / CELL).floor() as i32;
    let (left, right) = (cell(rect.left()), cell(rect.right()));
    let rows = cell(rect.top())..=cell(rect.bottom());
    rows.flat_map(move |row| (left..=right).map(move |column| [column, row]))
}

impl Room {
    /// Marks the area of a small triangle as occupied.
    pub(super) fn take_triangle(&mut self, corners: [Pos2; 3], picture: Rect) {
        let place = Rect::from_points(&corners).intersect(picture);
        if place.is_finite() && !place.is_negative() {
            self.cells.extend(cells(place));
        }
    }

    pub(super) fn take_plate(&mut self, plate: Rect) {
        self.plates.push(plate);
    }

    /// True if no plate overlaps and, unless `over_surface`, no surface does.
    fn is_free(&self, plate: Rect, over_surface: bool) -> bool {
        let written = self.plates.iter().any(|other| other.intersects(plate));
        !written && (over_surface || !cells(plate).any(|cell| self.cells.contains(&cell)))
    }

    /// The free position nearest to a point for a plate of the given size within a rectangle; the point itself if
    /// nothing is free.
    pub(super) fn find(&self, at: Pos2, size: Vec2, within: Rect) -> Rect {
        let place = |offset: Vec2| Rect::from_center_size(at + offset, size);
        let around = (0..=STEPS).flat_map(|ring| {
            let count = if ring < 3 { 8 } else { 16 };
            let turn = move |k: usize| Vec2::angled(k as f32 / count as f32 * std::f32::consts::TAU);
            (0..if ring == 0 { 1 } else { count }).map(move |k| turn(k) * (STEP * ring as f32))
        });
        let free = |over_surface| {
            let fits = move |plate: &Rect| within.contains_rect(*plate) && self.is_free(*plate, over_surface);
            around.clone().map(place).find(fits)
        };
        free(false).or_else(|| free(true)).unwrap_or(place(Vec2::ZERO))
    }
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{pos2, vec2};

    use super::*;

    #[test]
    fn a_plate_keeps_clear_of_surfaces_and_plates() {
        let picture = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 300.0));
        let (at, size) = (pos2(200.0, 150.0), vec2(20.0, 16.0));
        let mut room = Room::default();
        assert_eq!(room.find(at, size, picture).center(), at);
        let corners = [at + vec2(-40.0, -40.0), at + vec2(40.0, -40.0), at + vec2(0.0, 60.0)];
        room.take_triangle(corners, picture);
        let first = room.find(at, size, picture);
        let surface = Rect::from_points(&corners);
        assert!(!first.intersects(surface) && first.center().distance(at) < 80.0, "{first}");
        room.take_plate(first);
        let second = room.find(at, size, picture);
        assert!(!second.intersects(first) && !second.intersects(surface), "{second}");
        // With a surface everywhere, the plate overlaps the surface, but no other plate.
        room.take_triangle([Pos2::ZERO, pos2(400.0, 0.0), pos2(0.0, 300.0)], picture);
        room.take_plate(Rect::from_center_size(at, vec2(6.0, 6.0)));
        let third = room.find(at, size, picture);
        assert!(third.center().distance(at) < 40.0 && third.center() != at, "{third}");
    }
}
