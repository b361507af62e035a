//! The pixel that is explained, once it is pinned.

use super::Session;

/// Id of the panel that explains a pixel.
pub const EXPLAIN_TAB: &str = "explain";

/// A place in the picture of a view, which stays where it is when the picture gets another size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// The view: 0 is the scene itself, 1 view B.
    pub view: usize,
    /// Fractions of width and height, from the top left.
    pub at: [f32; 2],
}

impl Pin {
    /// The middle of the picture of a view.
    #[must_use]
    pub const fn middle(view: usize) -> Self {
        Self { view, at: [0.5, 0.5] }
    }

    /// The centre of a pixel in a picture of that size.
    #[must_use]
    pub fn of_pixel(view: usize, pixel: [u32; 2], size: [u32; 2]) -> Self {
        let part = |i: usize| ((f64::from(pixel[i]) + 0.5) / f64::from(size[i].max(1))) as f32;
        Self { view, at: [part(0), part(1)] }
    }

    /// The pixel in a picture of that size.
    #[must_use]
    pub fn pixel(&self, size: [u32; 2]) -> [u32; 2] {
        let pixel = |i: usize| {
            let at = f64::from(self.at[i]) * f64::from(size[i]);
            (at.floor().max(0.0) as u32).min(size[i].saturating_sub(1))
        };
        [pixel(0), pixel(1)]
    }
}

impl Session {
    /// True if the panel that explains a pixel is in sight.
    #[must_use]
    pub fn explains(&self) -> bool {
        self.view.bottom_open && self.view.bottom_tab == EXPLAIN_TAB && !self.view.presenting
    }

    /// Pins the pixel in the middle of the active view, or lets go of the one that is pinned. What is pinned out of
    /// sight is shown first.
    pub(super) fn toggle_pin(&mut self) {
        let seen = self.explains();
        self.view.pinned = match self.view.pinned {
            Some(_) if seen => None,
            pinned => Some(pinned.unwrap_or(Pin::middle(self.active()))),
        };
        self.view.unfold(EXPLAIN_TAB);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_is_found_again_in_a_picture_of_any_size() {
        for size in [[1, 1], [728, 396], [1919, 1079], [16_384, 3]] {
            for pixel in [[0, 0], [size[0] / 2, size[1] / 3], [size[0] - 1, size[1] - 1]] {
                assert_eq!(Pin::of_pixel(1, pixel, size).pixel(size), pixel);
            }
        }
        assert_eq!(Pin { view: 0, at: [1.0, -0.1] }.pixel([8, 8]), [7, 0]);
        assert_eq!(Pin { view: 0, at: [f32::NAN, 2.0] }.pixel([0, 0]), [0, 0]);
    }
}
