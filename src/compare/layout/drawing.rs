//! The declaration of a layout's picture.

use super::{Cell, area::Area};
use crate::{
    compare::{pair::Unequal, shown::Shown},
    scene::Comparison,
};

/// The way in which a layout is drawn where it shows several views.
pub(super) struct Drawing {
    /// The places of the views in a picture of a size; `None` without room.
    pub(super) cells: fn(&[usize], [u32; 2]) -> Option<Vec<Cell>>,
    /// The size of the picture in which each of so many cells has a size.
    pub(super) size_around: fn(usize, [u32; 2]) -> [u32; 2],
    /// The parts of a picture of a size in which views have their letters.
    pub(super) areas: fn(&Comparison, [u32; 2], &[usize]) -> Vec<Area>,
    /// The picture of a size, from those of the views.
    pub(super) compose: fn(&Comparison, [u32; 2], &[Shown]) -> Result<Vec<u8>, Unequal>,
}

impl Drawing {
    /// View A; views lie over each other.
    pub(super) const OF_A: Self = Self {
        cells: |views, [width, height]| {
            Some(views.iter().map(|view| Cell { view: *view, left: 0, top: 0, width, height }).collect())
        },
        size_around: |_, size| size,
        areas: |_, _, _| Vec::new(),
        compose: |_, _, shown| Ok(shown[0].rgb8().to_vec()),
    };
}
