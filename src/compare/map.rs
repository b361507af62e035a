//! The difference of two pictures as a map: a colour for each number, a legend, and a mark at the largest.

use rayon::prelude::*;

use super::{
    canvas::Canvas,
    colours::Colours,
    legend,
    pair::{Differences, Pair, Unequal},
};
use crate::scene::Comparison;

impl Differences {
    /// A colour for each difference: red, green, blue, row by row from the top.
    #[must_use]
    pub fn colours(&self, comparison: &Comparison) -> Vec<u8> {
        let (sign, factor) = (comparison.sign, comparison.amplification / legend::full(comparison.values));
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
    /// The map of the differences with its legend and the mark: red, green, blue, row by row from the top.
    ///
    /// # Errors
    /// If light is to be compared, and one picture has none.
    pub fn map(&self, comparison: &Comparison) -> Result<Vec<u8>, Unequal> {
        let differences = self.differences(comparison)?;
        let mut canvas = Canvas { size: self.a.size(), rgb8: differences.colours(comparison) };
        if let Some(largest) = &differences.largest {
            legend::mark(&mut canvas, largest);
        }
        legend::draw(&mut canvas, comparison, differences.largest.as_ref());
        Ok(canvas.rgb8)
    }
}
