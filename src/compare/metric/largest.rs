//! The size of the largest difference, in the channel and the values of the comparison.

use super::{Metric, Way};

pub(super) static METRIC: Metric = Metric {
    id: "largest",
    of_likeness: false,
    way: Way::Largest(|largest| largest.difference.abs().into()),
    // It is shown with its place.
    shown: None,
    row: None,
};
