//! The numbers for the difference between two pictures: RMSE, PSNR, SSIM and ꟻLIP.
//!
//! The picture is processed in tiles. A tile that is equal in both pictures, including all pixels that the
//! filters reach, needs no filtering: there SSIM is 1 and ꟻLIP is 0.

use std::sync::LazyLock;

use fearless_simd::{Level, dispatch};
use rayon::prelude::*;

use super::{
    filter::{Padded, Plane, REACH, SIDE, TILE, Tile},
    flip,
    pair::Pair,
    ssim,
};
use crate::optics::colour::{Encoding, LUMINANCE};

/// The numbers for the difference between two pictures, over some of their pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metrics {
    /// The number of pixels.
    pub pixels: u64,
    /// The root of the mean squared difference of the display codes' channels, each from 0 to 1: 0 for equal pictures,
    /// at most 1.
    pub rmse: f64,
    /// The peak signal-to-noise ratio, decibels: −20 log₁₀ RMSE. Infinite for equal pictures, at least 0.
    pub psnr: f64,
    /// The mean structural similarity of luma: 1 for equal pictures, at least −1.
    pub ssim: f64,
    /// The mean of ꟻLIP: 0 for equal pictures, at most 1.
    pub flip: f64,
    /// The root of the mean squared difference of linear light's channels, if light is known.
    pub light_rmse: Option<f64>,
}

/// The numbers over all pixels, and over those that objects cover in either picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Over all pixels.
    pub all: Metrics,
    /// Over the covered pixels: those of which an object covers at least one sample. `None` if there are none, or they
    /// are unknown.
    pub covered: Option<Metrics>,
}

/// The sums from which the numbers are calculated.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    pixels: u64,
    /// The sum of squared differences of codes.
    squares: u64,
    ssim: f64,
    flip: f64,
    light: f64,
}

impl Sums {
    fn plus(self, other: Self) -> Self {
        Self {
            pixels: self.pixels + other.pixels,
            squares: self.squares + other.squares,
            ssim: self.ssim + other.ssim,
            flip: self.flip + other.flip,
            light: self.light + other.light,
        }
    }

    /// Adds some pixels of a row.
    fn add(&mut self, row: &Row, pixels: impl Iterator<Item = usize>) {
        let (mut squares, mut ssim, mut flip, mut light) = (0, 0.0, 0.0, 0.0);
        for x in pixels {
            self.pixels += 1;
            squares += row.squares[x];
            ssim += row.ssim[x];
            flip += row.flip[x];
            light += row.light[x];
        }
        self.squares += u64::from(squares);
        self.ssim += f64::from(ssim);
        self.flip += f64::from(flip);
        self.light += f64::from(light);
    }

    fn metrics(self, has_light: bool) -> Option<Metrics> {
        let pixels = (self.pixels > 0).then_some(self.pixels as f64)?;
        let rmse = (self.squares as f64 / (3.0 * pixels)).sqrt() / 255.0;
        Some(Metrics {
            pixels: self.pixels,
            rmse,
            psnr: -20.0 * rmse.log10(),
            ssim: self.ssim / pixels,
            flip: self.flip / pixels,
            light_rmse: has_light.then(|| (self.light / (3.0 * pixels)).sqrt()),
        })
    }
}

/// The instruction set of this machine.
static LEVEL: LazyLock<Level> = LazyLock::new(Level::new);
/// Linear light of each display code.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| Encoding::Srgb.decode([code as u8; 3]).x));

/// The memory of the calculation of a tile.
#[derive(Default)]
struct Scratch {
    opponents: [[Plane<Padded>; 3]; 2],
    luma: [Plane<Padded>; 2],
    for_flip: flip::Scratch,
    seen: [flip::Seen; 2],
    for_ssim: ssim::Scratch,
    flip: Plane<Tile>,
    ssim: Plane<Tile>,
}

impl Pair<'_> {
    /// The numbers for the difference; `None` for pictures without pixels.
    #[must_use]
    pub fn measure(&self) -> Option<Measured> {
        let [width, height] = self.a.size().map(|side| side as usize);
        let (across, down) = (width.div_ceil(TILE), height.div_ceil(TILE));
        // Collected in order, so that the sums are reproducible.
        let tiles: Vec<[Sums; 2]> = (0..across * down)
            .into_par_iter()
            .map_init(Scratch::default, |scratch, i| self.tile(scratch, i % across * TILE, i / across * TILE))
            .collect();
        let [all, covered] =
            tiles.into_iter().fold([Sums::default(); 2], |[a, b], [c, d]| [a.plus(c), b.plus(d)]);
        let has_light = self.a.light().is_some() && self.b.light().is_some();
        Some(Measured { all: all.metrics(has_light)?, covered: covered.metrics(has_light) })
    }

    /// The sums of a tile: over all pixels, and over the covered ones.
    fn tile(&self, scratch: &mut Scratch, left: usize, top: usize) -> [Sums; 2] {
        let [width, height] = self.a.size().map(|side| side as usize);
        let (columns, rows) = (left..width.min(left + TILE), top..height.min(top + TILE));
        let around = |from: usize, to: usize, most: usize| from.saturating_sub(REACH)..most.min(to + REACH);
        let (wide, high) = (around(left, columns.end, width), around(top, rows.end, height));
        let (a, b) = (self.a.rgb8().as_chunks::<3>().0, self.b.rgb8().as_chunks::<3>().0);
        let equal = high.clone().all(|y| {
            let row = y * width + wide.start..y * width + wide.end;
            a[row.clone()] == b[row]
        });
        if !equal {
            let place = Place { left, top, width, height };
            dispatch!(*LEVEL, _simd => filter(scratch, [a, b], &place));
        }

        let covered = self.covered();
        let light = self.a.light().zip(self.b.light());
        let mut sums = [Sums::default(); 2];
        for y in rows {
            let line = y * width + columns.start..y * width + columns.end;
            let mut row =
                Row { ssim: &[1.0; TILE], flip: &[0.0; TILE], squares: [0; TILE], light: [0.0; TILE] };
            if !equal {
                (row.ssim, row.flip) = (&scratch.ssim[y - top], &scratch.flip[y - top]);
                for ((sum, a), b) in row.squares.iter_mut().zip(&a[line.clone()]).zip(&b[line.clone()]) {
                    let square = |c: usize| u32::from(a[c].abs_diff(b[c])).pow(2);
                    *sum = square(0) + square(1) + square(2);
                }
            }
            if let Some((a, b)) = light {
                let pixels = a.pixels[line.clone()].iter().zip(&b.pixels[line.clone()]);
                for (sum, (a, b)) in row.light.iter_mut().zip(pixels) {
                    *sum = (*b - *a).truncate().length_squared();
                }
            }
            sums[0].add(&row, 0..columns.len());
            if let Some(covered) = covered {
                sums[1].add(&row, (0..columns.len()).filter(|x| covered(line.start + x)));
            }
        }
        sums
    }
}

/// The numbers for a row of a tile.
struct Row<'a> {
    ssim: &'a [f32; TILE],
    flip: &'a [f32; TILE],
    squares: [u32; TILE],
    light: [f32; TILE],
}

/// The position of a tile in pictures of this size.
struct Place {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

/// Reads a tile with its surroundings from both pictures, and filters it. Outside a picture, the nearest
/// pixels at its edge are repeated.
#[inline(always)]
fn filter(scratch: &mut Scratch, pictures: [&[[u8; 3]]; 2], place: &Place) {
    let linear = &*LINEAR;
    let within = |at: usize, most: usize| at.saturating_sub(REACH).min(most - 1);
    let columns: [usize; SIDE] = std::array::from_fn(|x| within(place.left + x, place.width));
    for (picture, (opponents, luma)) in
        pictures.into_iter().zip(scratch.opponents.iter_mut().zip(&mut scratch.luma))
    {
        for y in 0..SIDE {
            let row = &picture[within(place.top + y, place.height) * place.width..][..place.width];
            let mut light = [[0.0; SIDE]; 3];
            for (x, column) in columns.iter().enumerate() {
                let codes = row[*column];
                for c in 0..3 {
                    light[c][x] = linear[usize::from(codes[c])];
                }
                let (r, g, b) = (f32::from(codes[0]), f32::from(codes[1]), f32::from(codes[2]));
                luma[y][x] = (LUMINANCE.x * r + LUMINANCE.y * g + LUMINANCE.z * b) / 255.0 - ssim::CENTRE;
            }
            for x in 0..SIDE {
                let values = flip::opponent([light[0][x], light[1][x], light[2][x]]);
                for c in 0..3 {
                    opponents[c][y][x] = values[c];
                }
            }
        }
    }
    flip::tile(&scratch.opponents, &mut scratch.for_flip, &mut scratch.seen, &mut scratch.flip);
    ssim::tile(&scratch.luma, &mut scratch.for_ssim, &mut scratch.ssim);
}
