//! The calculation of metrics.
//!
//! The picture is taken in tiles. A tile that is equal in both pictures, with everything that the filters reach, needs
//! no filter: its numbers are declared.

use std::ops::Range;

use glam::Vec4;
use rayon::prelude::*;

use super::{
    ALL, Measure, Metric, Pixels, Way,
    filter::{REACH, SIDE, TILE, Tile},
};
use crate::compare::pair::Pair;

/// The numbers for the difference between two pictures, over some of their pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Metrics {
    /// The number of pixels.
    pub pixels: u64,
    /// The number of each metric that is about pixels, with its id; `None` where light would have to be known.
    pub numbers: Vec<(&'static str, Option<f64>)>,
}

impl Metrics {
    /// The number of the metric with an id, if it is known.
    #[must_use]
    pub fn of(&self, id: &str) -> Option<f64> {
        self.numbers.iter().find(|(known, _)| *known == id)?.1
    }
}

/// The numbers over all pixels, and over those that objects cover in either picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Over all pixels.
    pub all: Metrics,
    /// Over the covered pixels: those of which an object covers at least one sample. `None` if there are none, or they
    /// are unknown.
    pub covered: Option<Metrics>,
}

/// The sums of which the numbers are made, one for each kind of pixels' numbers.
#[derive(Clone)]
struct Sums {
    pixels: u64,
    sums: Vec<f64>,
}

impl Sums {
    fn plus(mut self, other: Self) -> Self {
        self.pixels += other.pixels;
        self.sums.iter_mut().zip(other.sums).for_each(|(sum, other)| *sum += other);
        self
    }

    fn metrics(&self, metrics: &[&'static Metric], kinds: &[&Pixels]) -> Option<Metrics> {
        let pixels = (self.pixels > 0).then_some(self.pixels as f64)?;
        let number = |metric: &&'static Metric| match metric.way {
            Way::Pixels(of, number) => {
                let known = kinds.iter().position(|kind| std::ptr::eq(*kind, of));
                Some((metric.id, known.map(|i| number(self.sums[i], pixels))))
            }
            Way::Largest(_) => None,
        };
        Some(Metrics { pixels: self.pixels, numbers: metrics.iter().filter_map(number).collect() })
    }
}

/// The memory of the calculation of a tile.
struct Scratch {
    measure: Measure,
    out: Box<Tile>,
}

impl Pair<'_> {
    /// The numbers for the difference; `None` for pictures without pixels.
    #[must_use]
    pub fn measure(&self) -> Option<Measured> {
        self.measure_by(&ALL)
    }

    /// The numbers of some metrics, also such as the program does not know; `None` for pictures without pixels.
    #[must_use]
    pub fn measure_by(&self, metrics: &[&'static Metric]) -> Option<Measured> {
        let has_light = self.a.light().is_some() && self.b.light().is_some();
        let has_codes = self.a.has_codes() && self.b.has_codes();
        let mut kinds: Vec<&Pixels> = Vec::new();
        for metric in metrics {
            if let Way::Pixels(of, _) = metric.way
                && (if of.where_equal.is_some() { has_codes } else { has_light })
                && !kinds.iter().any(|kind| std::ptr::eq(*kind, of))
            {
                kinds.push(of);
            }
        }
        let [width, height] = self.a.size().map(|side| side as usize);
        let (across, down) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let scratch = || {
            let one =
                |kind: &&Pixels| Scratch { measure: (kind.measure)(), out: Box::new([[0.0; TILE]; TILE]) };
            kinds.iter().map(one).collect::<Vec<_>>()
        };
        // Collected in order, so that the sums are reproducible.
        let tiles: Vec<[Sums; 2]> = (0..across * down)
            .into_par_iter()
            .map_init(scratch, |scratch, i| self.tile(&kinds, scratch, i % across * TILE, i / across * TILE))
            .collect();
        let none = Sums { pixels: 0, sums: vec![0.0; kinds.len()] };
        let [all, covered] =
            tiles.into_iter().fold([none.clone(), none], |[a, b], [c, d]| [a.plus(c), b.plus(d)]);
        Some(Measured { all: all.metrics(metrics, &kinds)?, covered: covered.metrics(metrics, &kinds) })
    }

    /// The sums of a tile: over all pixels, and over the covered ones.
    fn tile(&self, kinds: &[&Pixels], scratch: &mut [Scratch], left: usize, top: usize) -> [Sums; 2] {
        let mut place = Place::new(self, left, top);
        let (width, equal) = (place.columns.len(), place.is_equal());
        if !equal {
            place.read();
        }
        let covered = self.covered().map(|covered| {
            let row = |y: usize| {
                let start = (top + y) * place.width + left;
                (0..width).filter(|x| covered(start + x)).collect::<Vec<_>>()
            };
            (0..place.rows.len()).map(row).collect::<Vec<_>>()
        });
        let mut all = Sums { pixels: (width * place.rows.len()) as u64, sums: Vec::new() };
        let pixels = covered.iter().flatten().map(|row| row.len() as u64).sum();
        let mut of_covered = Sums { pixels, sums: Vec::new() };
        for (kind, Scratch { measure, out }) in kinds.iter().zip(scratch) {
            match kind.where_equal {
                Some(number) if equal => **out = [[number; TILE]; TILE],
                _ => measure(&place, out),
            }
            // Rows in 32 bits, their sum in 64.
            let rows = || out.iter().take(place.rows.len());
            all.sums.push(rows().map(|row| f64::from(row[..width].iter().sum::<f32>())).sum());
            let part = |(row, covered): (&[f32; TILE], &Vec<usize>)| {
                f64::from(covered.iter().map(|x| row[*x]).sum::<f32>())
            };
            of_covered.sums.push(rows().zip(covered.iter().flatten()).map(part).sum());
        }
        [all, of_covered]
    }
}

/// A tile of two pictures of the same size.
pub struct Place<'a> {
    codes: [&'a [[u8; 3]]; 2],
    light: [&'a [Vec4]; 2],
    columns: Range<usize>,
    rows: Range<usize>,
    width: usize,
    height: usize,
    /// The codes of the tile with its surroundings, row by row, if both pictures differ there.
    around: [Vec<[[u8; 3]; SIDE]>; 2],
}

impl<'a> Place<'a> {
    fn new(pair: &Pair<'a>, left: usize, top: usize) -> Self {
        let [width, height] = pair.a.size().map(|side| side as usize);
        let pictures = [pair.a, pair.b];
        Self {
            codes: pictures.map(|shown| shown.rgb8().as_chunks::<3>().0),
            light: pictures.map(|shown| shown.light().map_or(&[][..], |light| &light.pixels)),
            columns: left..width.min(left + TILE),
            rows: top..height.min(top + TILE),
            width,
            height,
            around: [Vec::new(), Vec::new()],
        }
    }

    /// True if the codes are equal, with everything around that filters reach.
    fn is_equal(&self) -> bool {
        let around =
            |of: &Range<usize>, most: usize| of.start.saturating_sub(REACH)..most.min(of.end + REACH);
        let (wide, mut high) = (around(&self.columns, self.width), around(&self.rows, self.height));
        let [a, b] = self.codes;
        high.all(|y| {
            let row = y * self.width + wide.start..y * self.width + wide.end;
            a[row.clone()] == b[row]
        })
    }

    /// The rows of the tile, as far as they are in the picture.
    #[must_use]
    pub fn rows(&self) -> Range<usize> {
        self.rows.clone()
    }

    fn line<T>(&self, pixels: [&'a [T]; 2], y: usize) -> [&'a [T]; 2] {
        pixels.map(|all| &all[y * self.width..][self.columns.clone()])
    }

    /// The display codes of a row of the tile, as far as they are in the picture: of view A, and of the other.
    #[must_use]
    pub fn codes(&self, y: usize) -> [&'a [[u8; 3]]; 2] {
        self.line(self.codes, y)
    }

    /// The light of a row of the tile.
    #[must_use]
    pub fn light(&self, y: usize) -> [&'a [Vec4]; 2] {
        self.line(self.light, y)
    }

    /// Reads the tile with its surroundings. Beyond a picture its outermost pixels go on.
    fn read(&mut self) {
        let within = |at: usize, most: usize| at.saturating_sub(REACH).min(most - 1);
        let columns: [usize; SIDE] = std::array::from_fn(|x| within(self.columns.start + x, self.width));
        for (codes, around) in self.codes.into_iter().zip(&mut self.around) {
            around.extend((0..SIDE).map(|y| {
                let line = &codes[within(self.rows.start + y, self.height) * self.width..][..self.width];
                columns.map(|x| line[x])
            }));
        }
    }

    /// The codes of a row of the tile with its surroundings in one picture, counted from the first row above.
    #[inline(always)]
    pub(super) fn padded(&self, picture: usize, y: usize) -> &[[u8; 3]; SIDE] {
        &self.around[picture][y]
    }
}
