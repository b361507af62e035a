//! The pinned pixel to explain.

use glam::Vec3;

use super::Session;
use crate::scene::observer::{ViewAngle, aspect, half_tangents, line_of_sight};

/// Id of the panel that explains a pixel.
pub const EXPLAIN_TAB: &str = "explain";

/// A line of sight of the camera, which identifies a pixel in the picture of a view: in a picture of another size it
/// leads to the same point of the scene. The point of the object that it hits stays pinned when the camera or the
/// object moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// The view: 0 is the scene itself, 1 view B.
    pub view: usize,
    /// Tangents of the angles to the right and upwards from the direction of view.
    pub at: [f32; 2],
}

/// Tangents of half the field of view of a picture, across and up.
fn half_angles(size: [u32; 2], angle: ViewAngle) -> [f64; 2] {
    half_tangents(size, angle.vertical(aspect(size) as f32))
}

impl Pin {
    /// The centre of the picture of a view.
    #[must_use]
    pub const fn middle(view: usize) -> Self {
        Self { view, at: [0.0, 0.0] }
    }

    /// The centre of a pixel in a picture of the given size, for an observer with the given field of view.
    #[must_use]
    pub fn of_pixel(view: usize, pixel: [u32; 2], size: [u32; 2], angle: ViewAngle) -> Self {
        Self { view, at: line_of_sight(pixel, size, angle.vertical(aspect(size) as f32)) }
    }

    /// The pixel in a picture of the given size, clamped to the picture.
    #[must_use]
    pub fn pixel(&self, size: [u32; 2], angle: ViewAngle) -> [u32; 2] {
        let [across, up] = half_angles(size, angle);
        let parts = [f64::from(self.at[0]) / across, -f64::from(self.at[1]) / up];
        let pixel = |i: usize| {
            let at = 0.5 * (parts[i] + 1.0) * f64::from(size[i]);
            (at.floor().max(0.0) as u32).min(size[i].saturating_sub(1))
        };
        [pixel(0), pixel(1)]
    }

    /// The pixel in a picture of the given size, if it is inside.
    #[must_use]
    pub fn inside(&self, size: [u32; 2], angle: ViewAngle) -> Option<[u32; 2]> {
        let half = half_angles(size, angle);
        let within = (0..2).all(|i| f64::from(self.at[i]).abs() < half[i]);
        within.then(|| self.pixel(size, angle))
    }

    /// True if the line of sight passes close to a point in camera space: x to the right, y up, −z ahead.
    #[must_use]
    pub(in crate::panel) fn aims_at(&self, seen: Vec3) -> bool {
        /// Tangent of an angle larger than a pixel.
        const ABOUT: f32 = 0.02;
        let off = seen / -seen.z - Vec3::new(self.at[0], self.at[1], -1.0);
        seen.z < 0.0 && off.length() < ABOUT
    }
}

impl Session {
    /// True if the panel that explains a pixel is visible.
    #[must_use]
    pub fn explains(&self) -> bool {
        self.view.bottom_open && self.view.bottom_tab == EXPLAIN_TAB && !self.view.presenting
    }

    /// True if the picture shows the vectors of a pixel: while it is explained, and in a presentation if it is pinned.
    #[must_use]
    pub fn shows_vectors(&self) -> bool {
        let pinned = self.view.presenting && self.view.pinned.is_some();
        self.explains() || pinned && self.view.bottom_open && self.view.bottom_tab == EXPLAIN_TAB
    }

    /// Pins the pixel at the centre of the active view, or unpins. If the panel is closed, an existing pin is kept and
    /// shown.
    pub(super) fn toggle_pin(&mut self) {
        let seen = self.explains();
        match self.view.pinned {
            Some(_) if seen => self.view.pin(None),
            Some(_) => {}
            None => self.view.pin(Some(Pin::middle(self.active()))),
        }
        self.view.unfold(EXPLAIN_TAB);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::observer::WIDE;

    const ANGLE: ViewAngle = ViewAngle { degrees: 45.0, keeps: WIDE };

    #[test]
    fn a_line_of_sight_is_the_same_pixel_in_a_picture_of_any_size() {
        for size in [[1, 1], [728, 396], [1919, 1079], [300, 700], [16_384, 3]] {
            for pixel in [[0, 0], [size[0] / 2, size[1] / 3], [size[0] - 1, size[1] - 1]] {
                assert_eq!(Pin::of_pixel(1, pixel, size, ANGLE).pixel(size, ANGLE), pixel);
            }
        }
        // A wide picture that loses half its height shows half as much to the sides.
        let pin = Pin::of_pixel(0, [400, 100], [1600, 800], ANGLE);
        assert_eq!(pin.pixel([1600, 400], ANGLE), [600, 50]);
        assert_eq!(Pin { view: 0, at: [9.0, 9.0] }.pixel([8, 8], ANGLE), [7, 0]);
        assert_eq!(pin.inside([1600, 400], ANGLE), Some([600, 50]));
        // What a wider picture shows beyond the sides of another one is outside that one.
        let beyond = Pin::of_pixel(0, [1599, 7], [1600, 800], ANGLE);
        assert_eq!((beyond.inside([1280, 720], ANGLE), beyond.pixel([1280, 720], ANGLE)), (None, [1279, 6]));
        assert_eq!(Pin { view: 0, at: [f32::NAN, 2.0] }.pixel([0, 0], ANGLE), [0, 0]);
    }
}
