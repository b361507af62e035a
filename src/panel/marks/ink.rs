//! Lines that can be seen on any picture.

use bevy_egui::egui::{Color32, Painter, Pos2, Shape, Stroke};
use glam::Vec3;

use super::lens::Lens;

/// Around every line.
pub(in crate::panel) const OUTLINE: Color32 = Color32::from_rgb(8, 8, 8);
/// Width of a line, points.
const LINE: f32 = 1.75;
/// Width of the outline on either side, points.
pub(super) const RIM: f32 = 1.5;

/// Lines with their outlines; no outline covers another line.
pub(in crate::panel) struct Ink {
    /// The way from the room to the picture.
    pub(in crate::panel) lens: Lens,
    below: Vec<Shape>,
    above: Vec<Shape>,
}

/// The colour around a line.
fn rim(colour: Color32) -> Color32 {
    if colour.is_opaque() { OUTLINE } else { OUTLINE.gamma_multiply(f32::from(colour.a()) / 255.0) }
}

impl Ink {
    pub(in crate::panel) fn new(lens: Lens) -> Self {
        Self { lens, below: Vec::new(), above: Vec::new() }
    }

    pub(super) fn line(&mut self, points: Vec<Pos2>, colour: Color32) {
        self.stroke(points, LINE, colour);
    }

    /// A line of another width. The outline of a faint one is as faint.
    pub(in crate::panel) fn stroke(&mut self, mut points: Vec<Pos2>, width: f32, colour: Color32) {
        if points.len() < 2 {
            return;
        }
        self.above.push(Shape::line(points.clone(), Stroke::new(width, colour)));
        // The outline goes around the ends too.
        let end = points.len() - 1;
        let (first, last) = (points[0] - points[1], points[end] - points[end - 1]);
        points[0] += first.normalized() * RIM;
        points[end] += last.normalized() * RIM;
        self.below.push(Shape::line(points, Stroke::new(width + 2.0 * RIM, rim(colour))));
    }

    /// A closed line.
    pub(super) fn ring(&mut self, points: Vec<Pos2>, colour: Color32) {
        if points.len() < 2 {
            return;
        }
        self.below.push(Shape::closed_line(points.clone(), Stroke::new(LINE + 2.0 * RIM, rim(colour))));
        self.above.push(Shape::closed_line(points, Stroke::new(LINE, colour)));
    }

    /// A filled convex shape.
    pub(in crate::panel) fn fill(&mut self, corners: Vec<Pos2>, colour: Color32) {
        let outline = Stroke::new(2.0 * RIM, rim(colour));
        self.below.push(Shape::closed_line(corners.clone(), outline));
        self.above.push(Shape::convex_polygon(corners, colour, Stroke::NONE));
    }

    pub(super) fn path(&mut self, points: &[Vec3], colour: Color32) {
        for run in self.lens.path(points) {
            self.line(run, colour);
        }
    }

    pub(in crate::panel) fn disc(&mut self, at: Pos2, radius: f32, colour: Color32) {
        self.above.push(Shape::circle_filled(at, radius + RIM, rim(colour)));
        self.above.push(Shape::circle_filled(at, radius, colour));
    }

    pub(super) fn arrow(&mut self, from: Vec3, to: Vec3, colour: Color32) {
        self.path(&[from, to], colour);
        let (Some(a), Some(b)) = (self.lens.project(from), self.lens.project(to)) else { return };
        let tip = 6.0;
        // Seen from its end, an arrow has no sides.
        if (b - a).length() < tip {
            return;
        }
        let back = (a - b).normalized() * tip;
        let side = back.rot90() * 0.55;
        self.line(vec![b + back + side, b, b + back - side], colour);
    }

    pub(in crate::panel) fn paint(self, painter: &Painter) {
        painter.extend(self.below);
        painter.extend(self.above);
    }
}
