//! Checks the pixels of a file, and averages them down to the resolution of the renderers.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};

use crate::optics::colour::LUMINANCE;

/// Maximum number of columns in a file's picture, and twice that of rows.
pub const MAX_FILE_COLUMNS: usize = 8192;
/// Maximum number of columns for renderers, and twice that of rows.
pub const MAX_COLUMNS: usize = 1024;
/// Maximum value of a pixel, cd/m²: the sun has 1.6 × 10⁹.
pub const MAX_LUMINANCE: f32 = 1e12;

/// Integral of the luminance below which a picture counts as dark: GPUs may flush smaller numbers to zero.
const DARK: f64 = 1e-30;

/// Collects the pixels of a file in any order.
#[derive(Clone, Debug)]
pub(super) struct Average {
    /// Columns and rows.
    size: [usize; 2],
    /// For each column of the file, the target columns to which it contributes, and its weights.
    columns: Vec<[(usize, f64); 2]>,
    /// For each row of the file, the target rows to which it contributes, and its weights.
    rows: Vec<[(usize, f64); 2]>,
    sums: Vec<DVec3>,
    /// Factor from values in the file to cd/m².
    scale: DVec3,
    /// The first invalid value: row, column and message.
    problem: Option<(usize, usize, String)>,
}

impl Average {
    /// Checks the numbers of columns and rows of a file.
    pub(super) fn check_size(width: usize, height: usize) -> Result<(), String> {
        let [most, half] = [MAX_FILE_COLUMNS, MAX_FILE_COLUMNS / 2];
        if height == 0 || width > most || height > half || width != 2 * height {
            return Err(format!(
                "it has {width} × {height} pixels, but an equirectangular picture is twice as wide as high, from 2 × 1 to \
                 {most} × {half} pixels"
            ));
        }
        Ok(())
    }

    /// An empty average for a file with these checked numbers of columns and rows.
    pub(super) fn of_size(width: usize, height: usize) -> Self {
        Self::down_to(MAX_COLUMNS, width, height)
    }

    /// An empty average with at most so many columns, for a picture with these numbers of columns and rows.
    pub(super) fn down_to(most: usize, width: usize, height: usize) -> Self {
        let columns = width.min(most);
        let size = [columns, columns / 2];
        Self {
            size,
            columns: shares(width, columns, |from, to| (to - from) as f64),
            rows: shares(height, size[1], |from, to| band(from, to, height * size[1])),
            sums: vec![DVec3::ZERO; columns * size[1]],
            scale: DVec3::ONE,
            problem: None,
        }
    }

    /// The average for a file whose values times `scale` are cd/m².
    pub(super) fn scaled(self, scale: DVec3) -> Self {
        Self { scale, ..self }
    }

    /// Adds a pixel of the file; ignores pixels outside.
    pub(super) fn add(&mut self, column: usize, row: usize, colour: [f32; 3]) {
        let (Some(columns), Some(rows)) = (self.columns.get(column), self.rows.get(row)) else { return };
        let colour = DVec3::from_array(colour.map(f64::from)) * self.scale;
        let legal = 0.0..=f64::from(MAX_LUMINANCE);
        if let Some((value, name)) = colour
            .to_array()
            .into_iter()
            .zip(["red", "green", "blue"])
            .find(|(value, _)| !legal.contains(value))
        {
            if self.problem.as_ref().is_none_or(|(r, c, _)| (row, column) < (*r, *c)) {
                let message = format!(
                    "the pixel in column {}, row {} has {name} {:?}; values must be numbers from 0 to {MAX_LUMINANCE:e} cd/m²",
                    column + 1,
                    row + 1,
                    value as f32
                );
                self.problem = Some((row, column, message));
            }
            return;
        }
        for (j, height) in rows {
            for (i, width) in columns {
                if height * width > 0.0 {
                    self.sums[j * self.size[0] + i] += colour * (height * width);
                }
            }
        }
    }

    /// The numbers for renderers.
    pub(super) fn numbers(self) -> Result<Vec<f32>, String> {
        if let Some((.., message)) = self.problem {
            return Err(message);
        }
        let [columns, rows] = self.size;
        let pixels: Vec<Vec3> = self.sums.iter().map(|sum| sum.as_vec3()).collect();
        let solid = |row: usize| TAU / columns as f64 * band(row, row + 1, rows);
        let light =
            |(i, pixel): (usize, &Vec3)| LUMINANCE.as_dvec3().dot(pixel.as_dvec3()) * solid(i / columns);
        let mut weights: Vec<f64> = pixels.iter().enumerate().map(light).collect();
        let mut total: f64 = weights.iter().sum();
        if total < DARK {
            total = 0.0;
            weights = (0..pixels.len()).map(|i| solid(i / columns)).collect();
        }
        let of_rows: Vec<f64> = weights.chunks(columns).map(|row| row.iter().sum()).collect();
        let mut numbers = vec![columns as f32, rows as f32, total as f32];
        numbers.extend(cumulative(&of_rows));
        weights.chunks(columns).for_each(|row| numbers.extend(cumulative(row)));
        numbers.extend(pixels.iter().flat_map(|pixel| pixel.to_array()));
        Ok(numbers)
    }
}

/// For each of `from` equal parts of a whole, the overlapping ones of the `to` ≤ `from` equal parts of it,
/// and its share in them. `measure` is the size of a range in units of 1/(`from` × `to`) of the whole.
fn shares(from: usize, to: usize, measure: impl Fn(usize, usize) -> f64) -> Vec<[(usize, f64); 2]> {
    let share = |begin: usize, end: usize, i: usize| {
        if begin < end { measure(begin, end) / measure(i * from, (i + 1) * from) } else { 0.0 }
    };
    let part = |x: usize| {
        let (begin, end) = (x * to, (x + 1) * to);
        let i = begin / from;
        let edge = end.min((i + 1) * from);
        let next = (i + 1).min(to - 1);
        [(i, share(begin, edge, i)), (next, share(edge, end, next))]
    };
    (0..from).map(part).collect()
}

/// The solid angle between two polar angles, divided by 2π: the difference of their cosines. The angles are
/// in units of π/`n`.
fn band(from: usize, to: usize, n: usize) -> f64 {
    let unit = 0.5 * PI / n as f64;
    2.0 * ((from + to) as f64 * unit).sin() * ((to - from) as f64 * unit).sin()
}

/// The cumulative share of a sum before each of its terms, and 1 at the end; equal shares if all are zero.
fn cumulative(summands: &[f64]) -> impl Iterator<Item = f32> {
    let total: f64 = summands.iter().sum();
    let mut before = 0.0;
    let begins = summands.iter().enumerate().map(move |(i, summand)| {
        let share = if total > 0.0 { before / total } else { i as f64 / summands.len() as f64 };
        before += summand;
        share.min(1.0) as f32
    });
    begins.chain([1.0])
}
