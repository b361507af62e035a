//! Two pictures that can be compared, and the differences of their pixels.

use rayon::prelude::*;
use thiserror::Error;

use super::shown::Shown;
use crate::{
    optics::colour::LUMINANCE,
    scene::comparison::{Channel, Compared, Comparison},
};

/// The reason why two pictures cannot be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Unequal {
    /// The pictures have different sizes.
    #[error(
        "one picture has {}×{} pixels, the other {}×{}; they must have the same size", .0[0], .0[1], .1[0], .1[1]
    )]
    Sizes([u32; 2], [u32; 2]),
    /// Light is to be compared, but the light of one picture is unknown.
    #[error("the linear light of a picture is unknown; compare display codes")]
    NoLight,
}

/// Two pictures of the same size: view A, and the other.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    pub(super) a: &'a Shown,
    pub(super) b: &'a Shown,
}

/// The largest difference between two pictures, and its position.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Largest {
    /// The distance from the left, pixels, counted from 0.
    pub x: u32,
    /// The distance from the top, pixels, counted from 0.
    pub y: u32,
    /// The signed difference: the other view minus view A, before amplification.
    pub difference: f32,
    /// The display codes of view A at this pixel.
    pub a: [u8; 3],
    /// The display codes of the other view at this pixel.
    pub b: [u8; 3],
}

/// The differences of two pictures' pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Differences {
    /// The values row by row from the top: the other view minus view A.
    pub pixels: Vec<f32>,
    /// The difference of the largest absolute value; the first if several are equal. `None` if the pictures
    /// are equal.
    pub largest: Option<Largest>,
}

/// The value of a pixel's difference.
pub(super) fn number(channel: Channel, [r, g, b]: [f32; 3]) -> f32 {
    match channel {
        Channel::Red => r,
        Channel::Green => g,
        Channel::Blue => b,
        Channel::Luminance => LUMINANCE.x * r + LUMINANCE.y * g + LUMINANCE.z * b,
        Channel::Largest => {
            let larger = if g.abs() > r.abs() { g } else { r };
            if b.abs() > larger.abs() { b } else { larger }
        }
    }
}

impl<'a> Pair<'a> {
    /// Pairs view A with another view.
    ///
    /// # Errors
    /// Returns an error if their sizes differ.
    pub fn new(a: &'a Shown, b: &'a Shown) -> Result<Self, Unequal> {
        if a.size() == b.size() { Ok(Self { a, b }) } else { Err(Unequal::Sizes(a.size(), b.size())) }
    }

    /// True if objects cover a pixel in either picture; `None` if neither knows.
    pub(super) fn covered(&self) -> Option<impl Fn(usize) -> bool + Copy + Sync + 'a> {
        let (a, b) = (self.a.covered(), self.b.covered());
        let of = |mask: Option<&[bool]>, i: usize| mask.is_some_and(|mask| mask[i]);
        (a.is_some() || b.is_some()).then_some(move |i| of(a, i) || of(b, i))
    }

    /// The differences of the pixels, in the channel and the kind of values of a comparison.
    ///
    /// # Errors Returns an error if light is to be compared, and the light of one picture is unknown.
    pub fn differences(&self, comparison: &Comparison) -> Result<Differences, Unequal> {
        let channel = comparison.channel;
        match comparison.values {
            Compared::Codes => {
                let (a, b) = (self.a.rgb8().as_chunks::<3>().0, self.b.rgb8().as_chunks::<3>().0);
                let one = |a: &[u8; 3], b: &[u8; 3]| {
                    number(channel, [0, 1, 2].map(|c| f32::from(b[c]) - f32::from(a[c])))
                };
                Ok(self.each(a, b, one))
            }
            Compared::Light => {
                let (Some(a), Some(b)) = (self.a.light(), self.b.light()) else {
                    return Err(Unequal::NoLight);
                };
                let one = |a: &glam::Vec4, b: &glam::Vec4| number(channel, (*b - *a).truncate().to_array());
                Ok(self.each(&a.pixels, &b.pixels, one))
            }
        }
    }

    fn each<T: PartialEq + Sync>(&self, a: &[T], b: &[T], one: impl Fn(&T, &T) -> f32 + Sync) -> Differences {
        let width = self.a.size()[0].max(1) as usize;
        let mut pixels = vec![0.0; a.len()];
        // The largest of each row, so that the result does not depend on the order in which rows are finished.
        let largest: Vec<(usize, f32)> = pixels
            .par_chunks_mut(width)
            .zip(a.par_chunks(width).zip(b.par_chunks(width)))
            .map(|(out, (a, b))| {
                let mut largest = (0, 0.0_f32);
                if a == b {
                    return largest;
                }
                for (x, (out, (a, b))) in out.iter_mut().zip(a.iter().zip(b)).enumerate() {
                    *out = one(a, b);
                    if out.abs() > largest.1.abs() {
                        largest = (x, *out);
                    }
                }
                largest
            })
            .collect();
        let mut found: Option<(usize, usize, f32)> = None;
        for (y, (x, difference)) in largest.into_iter().enumerate() {
            if difference.abs() > found.map_or(0.0, |(_, _, most)| most.abs()) {
                found = Some((x, y, difference));
            }
        }
        let largest = found.map(|(x, y, difference)| {
            let codes = |shown: &Shown| shown.rgb8().as_chunks().0[y * width + x];
            Largest { x: x as u32, y: y as u32, difference, a: codes(self.a), b: codes(self.b) }
        });
        Differences { pixels, largest }
    }
}
