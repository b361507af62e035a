//! The views of a scene in one picture.

mod area;
mod difference;
mod drawing;
mod side_by_side;
mod wipe;

use super::{pair::Unequal, shown::Shown};
use crate::scene::{Comparison, comparison::Layout};
use area::Area;
use drawing::Drawing;

pub use wipe::edge;

/// The drawing of a layout.
fn drawing(layout: Layout) -> &'static Drawing {
    match layout {
        Layout::Single | Layout::Blink => &Drawing::OF_A,
        Layout::SideBySide => &side_by_side::DRAWING,
        Layout::Wipe => &wipe::DRAWING,
        Layout::Difference => &difference::DRAWING,
    }
}

/// The drawing of a comparison that shows so many views: one alone is view A.
fn drawing_of(comparison: &Comparison, views: usize) -> &'static Drawing {
    if views > 1 { drawing(comparison.layout) } else { &Drawing::OF_A }
}

/// The position of a view in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// The view: 0 for A.
    pub view: usize,
    /// The distance from the left, pixels.
    pub left: u32,
    /// The distance from the top, pixels.
    pub top: u32,
    /// The width, pixels.
    pub width: u32,
    /// The height, pixels.
    pub height: u32,
}

/// The places of the views that a layout shows in a picture of some size, where a scene has this many variants. Those
/// beside each other have equal sizes; where views lie over each other, each has the size of the picture. `None` if the
/// picture has no room for them.
#[must_use]
pub fn cells(comparison: &Comparison, variants: usize, size: [u32; 2]) -> Option<Vec<Cell>> {
    let views = comparison.views(variants);
    (drawing_of(comparison, views.len()).cells)(&views, size)
}

/// The size of the picture in which every cell of [`cells`] has this size.
#[must_use]
pub fn size_around(comparison: &Comparison, variants: usize, size: [u32; 2]) -> [u32; 2] {
    let views = comparison.views(variants).len();
    (drawing_of(comparison, views).size_around)(views, size)
}

/// The picture of a layout: red, green, blue, row by row from the top. `shown` are the views of the layout in the order
/// of [`Comparison::views`], each of the size of its cell. A layout of two views shows view A if there is no other.
///
/// # Errors
/// Returns an error if overlaid pictures have different sizes, or if light is to be compared and one picture
/// has none.
///
/// # Panics
/// Panics if there are no pictures.
pub fn compose(comparison: &Comparison, size: [u32; 2], shown: &[Shown]) -> Result<Vec<u8>, Unequal> {
    (drawing_of(comparison, shown.len()).compose)(comparison, size, shown)
}

/// The areas of a picture in which the letters of this number of views are placed; none for a single view, or if
/// all views form one map.
pub(super) fn areas(comparison: &Comparison, size: [u32; 2], shown: usize) -> Vec<Area> {
    let views = if comparison.layout.is_beside() { (0..shown).collect() } else { vec![0, comparison.with] };
    (drawing_of(comparison, shown).areas)(comparison, size, &views)
}
