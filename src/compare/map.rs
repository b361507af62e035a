//! The difference between two pictures as a map: a colour for each value, a legend, and a mark at the largest
//! one.

use rayon::prelude::*;

use super::{
    canvas::{BRIGHT, Canvas, DARK},
    colours::Colours,
    legend,
    pair::{Differences, Pair, Unequal},
};
use crate::scene::{Comparison, comparison::Sign};

/// The opacity of an outline over the colours below it.
const OUTLINE: f32 = 0.6;

impl Differences {
    /// The factor by which a comparison multiplies these differences: the one that it specifies, or the one
    /// that fits the largest difference.
    #[must_use]
    pub fn amplification(&self, comparison: &Comparison) -> f32 {
        let largest = self.largest.as_ref().map_or(0.0, |largest| largest.difference.abs());
        comparison.amplification.unwrap_or_else(|| legend::fitting_amplification(comparison.values, largest))
    }

    /// A colour for each difference: red, green, blue, row by row from the top.
    #[must_use]
    pub fn colours(&self, comparison: &Comparison) -> Vec<u8> {
        let (sign, factor) =
            (comparison.sign, self.amplification(comparison) / legend::full(comparison.values));
        let colours = Colours::of(sign);
        let none = colours.of_difference(sign, 0.0);
        let mut out = vec![0; 3 * self.pixels.len()];
        out.par_chunks_mut(3 * 4096).zip(self.pixels.par_chunks(4096)).for_each(|(out, pixels)| {
            for (out, &difference) in out.as_chunks_mut::<3>().0.iter_mut().zip(pixels) {
                *out =
                    if difference == 0.0 { none } else { colours.of_difference(sign, factor * difference) };
            }
        });
        out
    }
}

impl Pair<'_> {
    /// The map of the differences with the outlines of objects, if known, its legend and the mark: red,
    /// green, blue, row by row from the top.
    ///
    /// # Errors
    /// Returns an error if light is to be compared, and one picture has none.
    pub fn map(&self, comparison: &Comparison) -> Result<Vec<u8>, Unequal> {
        self.map_in_letters(comparison, None)
    }

    /// Like [`map`](Self::map), with a legend in letters of `px` pixels, if there is room for them, and smaller
    /// ones where it would hide objects.
    ///
    /// # Errors
    /// Returns the errors of [`map`](Self::map).
    pub fn map_in_letters(&self, comparison: &Comparison, px: Option<f32>) -> Result<Vec<u8>, Unequal> {
        let (mut canvas, differences) = self.marked(comparison)?;
        let factor = differences.amplification(comparison);
        let outlines = self.a.outlines().or(self.b.outlines());
        legend::draw(&mut canvas, comparison, factor, differences.largest.as_ref(), (px, outlines));
        Ok(canvas.rgb8)
    }

    /// Like [`map`](Self::map), without the legend.
    ///
    /// # Errors
    /// Returns the errors of [`map`](Self::map).
    pub fn bare_map(&self, comparison: &Comparison) -> Result<Vec<u8>, Unequal> {
        Ok(self.marked(comparison)?.0.rgb8)
    }

    /// The map with outlines and the mark, and its differences.
    fn marked(&self, comparison: &Comparison) -> Result<(Canvas, Differences), Unequal> {
        let differences = self.differences(comparison)?;
        let mut canvas = Canvas { size: self.a.size(), rgb8: differences.colours(comparison) };
        self.outline(&mut canvas, comparison.sign);
        if let Some(largest) = &differences.largest {
            legend::mark(&mut canvas, largest);
        }
        Ok((canvas, differences))
    }

    /// Draws thin lines around objects, so that a map without large differences still shows its subject.
    fn outline(&self, canvas: &mut Canvas, sign: Sign) {
        let Some(outlines) = self.a.outlines().or(self.b.outlines()) else { return };
        // Signed differences are brightest at 0, absolute ones darkest.
        let ink = match sign {
            Sign::Absolute => BRIGHT,
            Sign::Signed => DARK,
        };
        let width = canvas.size[0].max(1) as usize;
        let thick = canvas.scale().round().max(1.0) as u32;
        for i in outlines.iter().enumerate().filter_map(|(i, on)| on.then_some(i)) {
            canvas.fill([(i % width) as u32, (i / width) as u32, thick, thick], ink, OUTLINE);
        }
    }
}
