//! Panoramas: pictures of the surroundings, which provide the light from every direction and
//! importance-sample directions.
//!
//! Pictures are equirectangular, seen from inside: the top row looks up (+y), the middle along −z, and +x is
//! to the right of the middle. A pixel is constant over its solid angle; nothing is interpolated, so that the
//! probability density of a direction is exact.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use crate::{
    optics::colour::luminance,
    parameter::{FileFormat, Shipped},
};

mod average;
mod read;

use average::Average;
pub use average::{MAX_COLUMNS, MAX_FILE_COLUMNS, MAX_LUMINANCE};

/// Pictures of surroundings in the Radiance and OpenEXR formats, distinguished by their first bytes. The
/// values are cd/m², linear Rec. 709. Renderers read
///
/// 1. the number of columns, of rows, and the integral of the luminance over all directions (0: sample uniformly);
/// 2. one number more than there are rows: the share of rows above, from 0 to 1;
/// 3. for each row one number more than there are columns: the share of the pixels to the left, from 0 to 1;
/// 4. red, green and blue of each pixel, row by row.
///
/// The shares are of luminance times solid angle. Pictures with more than [`MAX_COLUMNS`] columns are
/// averaged down to that number, each pixel weighted by its solid angle, so that all numbers take 8.4 MB:
/// graphics cards guarantee a buffer of 128 MiB for all files of a scene, and both renderers see the same
/// light.
pub static FORMAT: FileFormat = FileFormat {
    name: "an equirectangular Radiance (.hdr) or OpenEXR (.exr) picture",
    extensions: &["hdr", "exr"],
    max_bytes: 256 << 20,
    read: read::read,
    shipped: &[(
        "room.hdr",
        Shipped::Bytes(include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/room.hdr"))),
    )],
};

/// A picture in the layout of [`FORMAT`].
#[derive(Clone, Copy, Debug)]
pub struct Panorama<'a> {
    columns: usize,
    rows: usize,
    /// Integral of the luminance over all directions.
    total: f32,
    /// Shares of the rows above.
    above: &'a [f32],
    /// Shares of the pixels to the left, row by row.
    left: &'a [f32],
    /// Red, green and blue, row by row.
    pixels: &'a [f32],
}

impl<'a> Panorama<'a> {
    /// The picture in the numbers of a file; `None` if they are invalid.
    #[must_use]
    pub fn new(numbers: &'a [f32]) -> Option<Self> {
        let [columns, rows, total, rest @ ..] = numbers else { return None };
        let [columns, rows] = [*columns, *rows].map(|count| count as usize);
        if !(1..=MAX_COLUMNS).contains(&columns) || !(1..=MAX_COLUMNS).contains(&rows) {
            return None;
        }
        let (above, rest) = rest.split_at_checked(rows + 1)?;
        let (left, pixels) = rest.split_at_checked(rows * (columns + 1))?;
        let is_whole = pixels.len() == 3 * columns * rows;
        is_whole.then_some(Self { columns, rows, total: *total, above, left, pixels })
    }

    /// The numbers of columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// The number of numbers of a picture with so many columns, an even number, and half as many rows.
    #[must_use]
    pub fn count(columns: usize) -> usize {
        let rows = columns / 2;
        3 + (rows + 1) + rows * (columns + 1) + 3 * columns * rows
    }

    /// The numbers of the picture averaged down to so many columns, an even number, each pixel weighted by its solid
    /// angle; `None` if it has no more than that.
    #[must_use]
    pub fn reduced(&self, columns: usize) -> Option<Vec<f32>> {
        if columns >= self.columns {
            return None;
        }
        let mut average = Average::down_to(columns, self.columns, self.rows);
        for (i, [r, g, b]) in self.pixels.as_chunks::<3>().0.iter().enumerate() {
            average.add(i % self.columns, i / self.columns, [*r, *g, *b]);
        }
        average.numbers().ok()
    }

    /// The light from a unit direction, cd/m².
    #[must_use]
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        let sin = direction.x.hypot(direction.z);
        // As in the shader: the middle column at the poles, and the last one straight behind, whatever the
        // sign of zero.
        let phi = if sin < 1e-7 { 0.0 } else { (direction.x + 0.0).atan2(-direction.z) };
        let across = 0.5 + phi / TAU;
        let down = sin.atan2(direction.y) / PI;
        let [column, row] = [(across, self.columns), (down, self.rows)]
            .map(|(place, count)| ((place * count as f32) as usize).min(count - 1));
        Vec3::from_slice(&self.pixels[3 * (row * self.columns + column)..])
    }

    /// The light from a unit direction, cd/m², and its probability density in [`sample`](Self::sample), sr⁻¹.
    #[must_use]
    pub fn seen(&self, direction: Vec3) -> (Vec3, f32) {
        let radiance = self.radiance(direction);
        (radiance, if self.total == 0.0 { 0.5 / TAU } else { luminance(radiance) / self.total })
    }

    /// The probability density of a direction in [`sample`](Self::sample), sr⁻¹: proportional to its
    /// luminance.
    #[must_use]
    pub fn pdf(&self, direction: Vec3) -> f32 {
        self.seen(direction).1
    }

    /// A direction for a point of the unit square, with its light and probability density.
    #[must_use]
    pub fn sample(&self, u: Vec2) -> (Vec3, Vec3, f32) {
        let (row, v) = place(self.above, u.y);
        let (column, s) = place(&self.left[row * (self.columns + 1)..][..=self.columns], u.x);
        let [up, down] = [row, row + 1].map(|edge| (PI * edge as f32 / self.rows as f32).cos());
        let cos = up + v * (down - up);
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let phi = TAU * (column as f32 + s) / self.columns as f32;
        let direction = Vec3::new(-sin * phi.sin(), cos, sin * phi.cos());
        // A direction at an edge may be rounded into the next pixel: its light and density belong together.
        let (radiance, pdf) = self.seen(direction);
        (direction, radiance, pdf)
    }
}

/// The last bin that begins at or before `u`, and the position of `u` within it.
fn place(begins: &[f32], u: f32) -> (usize, f32) {
    // The largest number below 1.
    let u = u.clamp(0.0, 1.0 - 0.5 * f32::EPSILON);
    let i = begins.partition_point(|begin| *begin <= u).clamp(1, begins.len() - 1) - 1;
    (i, ((u - begins[i]) / (begins[i + 1] - begins[i])).clamp(0.0, 1.0))
}

/// The numbers of a picture with these pixels: column and row to colour.
#[cfg(test)]
pub(crate) fn of_pixels(width: usize, pixel: impl Fn(usize, usize) -> [f32; 3]) -> Vec<f32> {
    let mut average = Average::of_size(width, width / 2);
    for i in 0..width * width / 2 {
        average.add(i % width, i / width, pixel(i % width, i / width));
    }
    average.numbers().expect("legal values")
}

#[cfg(test)]
mod tests;
