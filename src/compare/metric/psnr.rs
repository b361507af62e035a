//! PSNR: the peak signal-to-noise ratio, decibels: −20 log₁₀ RMSE. Infinite for equal pictures, at least 0.

use super::{InWindow, Metric, Way, rmse};

pub(super) static METRIC: Metric = Metric {
    id: "psnr",
    of_likeness: true,
    way: Way::Pixels(&rmse::SQUARES, |squares, pixels| -20.0 * rmse::number(squares, pixels).log10()),
    shown: Some(InWindow {
        place: 3,
        name: "PSNR",
        text: |number| if number.is_finite() { format!("{number:.1} dB") } else { "∞".to_owned() },
        help: |_, _| {
            "Peak signal-to-noise ratio: 20 log₁₀ of 1 / RMSE, over the pixels that objects cover.".to_owned()
        },
    }),
    row: Some(["peak signal-to-noise ratio, dB", "0 or more", "null, for infinite"]),
};
