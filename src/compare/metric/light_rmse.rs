//! The root of the mean squared difference of linear light's channels, where light is known.

use super::{Metric, Pixels, Way};

pub(super) static METRIC: Metric = Metric {
    id: "light_rmse",
    of_likeness: false,
    way: Way::Pixels(&SQUARES, |squares, pixels| (squares / (3.0 * pixels)).sqrt()),
    shown: None,
    row: Some([
        "root of the mean squared difference of light",
        "0 or more; null where light is unknown",
        "0",
    ]),
};

static SQUARES: Pixels = Pixels {
    where_equal: None,
    measure: || {
        Box::new(|place, out| {
            for (out, y) in out.iter_mut().zip(place.rows()) {
                let [a, b] = place.light(y);
                for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
                    *out = (*b - *a).truncate().length_squared();
                }
            }
        })
    },
};
