//! RMSE: the root of the mean squared difference of the display codes' channels, each from 0 to 1: 0 for equal pictures,
//! at most 1.

use super::{InWindow, Metric, Pixels, Way, in_thousandths};

pub(super) static METRIC: Metric = Metric {
    id: "rmse",
    of_likeness: false,
    way: Way::Pixels(&SQUARES, number),
    shown: Some(InWindow {
        place: 0,
        name: "RMSE",
        text: in_thousandths,
        help: |letter, everywhere| {
            format!(
                "Root mean square error of {letter} against A, in display codes from 0 to 1, over the pixels that \
                 objects cover; over all pixels {everywhere:.3}."
            )
        },
    }),
    row: Some(["root of the mean squared difference", "0 to 1", "0"]),
};

/// The squared differences of the codes, from 0 to 255, of all channels: whole numbers whose sum over a row of a tile is
/// exact.
pub(super) static SQUARES: Pixels = Pixels {
    where_equal: Some(0.0),
    measure: || {
        Box::new(|place, out| {
            for (out, y) in out.iter_mut().zip(place.rows()) {
                let [a, b] = place.codes(y);
                for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
                    let square = |c: usize| u32::from(a[c].abs_diff(b[c])).pow(2);
                    *out = (square(0) + square(1) + square(2)) as f32;
                }
            }
        })
    },
};

pub(super) fn number(squares: f64, pixels: f64) -> f64 {
    (squares / (3.0 * pixels)).sqrt() / 255.0
}
