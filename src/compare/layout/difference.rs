//! The difference between two views, as a map.

use super::drawing::Drawing;
use crate::compare::pair::Pair;

pub(super) static DRAWING: Drawing = Drawing {
    compose: |comparison, _, shown| Pair::new(&shown[0], &shown[1])?.map(comparison),
    ..Drawing::OF_A
};
