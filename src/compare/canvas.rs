//! A picture to draw on: rectangles, a circle, text.

use crate::lettering::{Lettering, pixel};

/// The background of plates with text, and the colour between pictures.
pub(super) const DARK: [u8; 3] = [22, 22, 22];
/// The colour of text on a plate.
pub(super) const BRIGHT: [u8; 3] = [240, 240, 240];

/// A rectangle of pixels: left, top, width, height.
pub(super) type Rect = [u32; 4];

/// A rectangle of a size in a corner of another one; the flags select right and bottom.
pub(super) fn in_corner(
    [left, top, across, down]: Rect,
    [at_right, at_bottom]: [bool; 2],
    [width, height]: [u32; 2],
    margin: u32,
) -> Rect {
    let x = if at_right { left + across - width - margin } else { left + margin };
    let y = if at_bottom { top + down - height - margin } else { top + margin };
    [x, y, width, height]
}

/// A picture of RGB bytes.
pub(super) struct Canvas {
    pub(super) size: [u32; 2],
    pub(super) rgb8: Vec<u8>,
}

impl Canvas {
    /// The scale of text and lines, proportional to the picture: 1 if its shorter side has 720 pixels.
    pub(super) fn scale(&self) -> f32 {
        (self.size[0].min(self.size[1]) as f32 / 720.0).clamp(0.6, 4.0)
    }

    /// Mixes a colour into a pixel; does nothing outside the picture.
    fn blend(&mut self, x: i64, y: i64, colour: [u8; 3], part: f32) {
        let Some(pixel) = pixel(&mut self.rgb8, self.size, [x, y]) else { return };
        for (old, new) in pixel.iter_mut().zip(colour) {
            let (from, to) = (f32::from(*old), f32::from(new));
            *old = (from + part * (to - from)).round() as u8;
        }
    }

    /// Fills a rectangle with this opacity; 1 covers the previous content.
    pub(super) fn fill(&mut self, [left, top, width, height]: Rect, colour: [u8; 3], part: f32) {
        for y in top..top.saturating_add(height).min(self.size[1]) {
            for x in left..left.saturating_add(width).min(self.size[0]) {
                self.blend(x.into(), y.into(), colour, part);
            }
        }
    }

    /// Copies a part of a picture of this width to a position in this one.
    pub(super) fn copy(&mut self, from: &[u8], width: u32, [x, y]: [u32; 2], [left, top, w, h]: Rect) {
        let bytes = |x: u32, y: u32, width: u32| 3 * (y as usize * width as usize + x as usize);
        for row in 0..h {
            let source = bytes(x, y + row, width);
            let target = bytes(left, top + row, self.size[0]);
            let length = 3 * w as usize;
            self.rgb8[target..target + length].copy_from_slice(&from[source..source + length]);
        }
    }

    /// Draws a ring around the centre of a pixel, with smooth edges.
    pub(super) fn ring(&mut self, [x, y]: [u32; 2], radius: f32, width: f32, colour: [u8; 3]) {
        let reach = (radius + width).ceil() as i64 + 1;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let from_line = ((dx * dx + dy * dy) as f32).sqrt() - radius;
                let part = (0.5 * width + 0.5 - from_line.abs()).clamp(0.0, 1.0);
                self.blend(i64::from(x) + dx, i64::from(y) + dy, colour, part);
            }
        }
    }

    /// Draws a line of text with its upper left corner at this position.
    pub(super) fn text(&mut self, style: Lettering, [x, y]: [u32; 2], px: f32, text: &str) {
        let at = [x, y].map(|v| i32::try_from(v).unwrap_or(i32::MAX));
        style.draw(&mut self.rgb8, self.size, at, px, BRIGHT, text);
    }
}
