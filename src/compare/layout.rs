//! The views of a scene in one picture.

use super::{
    canvas::{BRIGHT, Canvas, DARK, Rect},
    pair::{Pair, Unequal},
    shown::Shown,
};
use crate::{
    lettering::Lettering,
    scene::{
        Comparison,
        comparison::{Edge, Layout},
        variant::LETTERS,
    },
};

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
pub fn cells(comparison: &Comparison, variants: usize, [width, height]: [u32; 2]) -> Option<Vec<Cell>> {
    let views = comparison.views(variants);
    let side_by_side = comparison.layout == Layout::SideBySide && views.len() > 1;
    if !side_by_side {
        return Some(views.into_iter().map(|view| Cell { view, left: 0, top: 0, width, height }).collect());
    }
    let rows = if views.len() > 2 { 2 } else { 1 };
    let gap = gap(width.min(height));
    let across = halves(width, gap)?;
    let down = if rows == 1 { [(0, height); 2] } else { halves(height, gap)? };
    let place = |(i, view)| {
        let (column, row): (usize, usize) = (i % 2, i / 2);
        let ((left, width), (top, height)) = (across[column], down[row]);
        Cell { view, left, top, width, height }
    };
    Some(views.into_iter().enumerate().map(place).collect())
}

/// The gap between views in a picture whose shorter side has this length, pixels.
fn gap(length: u32) -> u32 {
    (length / 180).clamp(2, 16)
}

/// The size of the picture in which every cell of [`cells`] has this size.
#[must_use]
pub fn size_around(comparison: &Comparison, variants: usize, [width, height]: [u32; 2]) -> [u32; 2] {
    let views = comparison.views(variants).len();
    if comparison.layout != Layout::SideBySide || views < 2 {
        return [width, height];
    }
    let with = |gap: u32| [2 * width + gap, if views > 2 { 2 * height + gap } else { height }];
    // A wider gap enlarges the picture, but hardly ever so much that the gap grows again.
    let mut size = with(gap(0));
    while size != with(gap(size[0].min(size[1]))) {
        size = with(gap(size[0].min(size[1])));
    }
    size
}

/// Two equal parts of a length, with the rest as a gap between them: start and length of each.
fn halves(length: u32, gap: u32) -> Option<[(u32, u32); 2]> {
    let half = length.checked_sub(gap)? / 2;
    (half > 0).then_some([(0, half), (length - half, half)])
}

/// The number of pixels of a wipe to the left of the edge, or above it.
#[must_use]
pub fn edge(split: f32, length: u32) -> u32 {
    (split.clamp(0.0, 1.0) * length as f32).round() as u32
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
    let (a, b) = (&shown[0], shown.get(1));
    match (comparison.layout, b) {
        (Layout::Wipe, Some(b)) => wipe(comparison, &Pair::new(a, b)?),
        (Layout::Difference, Some(b)) => Pair::new(a, b)?.map(comparison),
        (Layout::SideBySide, Some(_)) => side_by_side(comparison, size, shown),
        _ => Ok(a.rgb8().to_vec()),
    }
}

fn side_by_side(comparison: &Comparison, size: [u32; 2], shown: &[Shown]) -> Result<Vec<u8>, Unequal> {
    let mut canvas = Canvas::new(size, DARK);
    let cells = cells(comparison, shown.len() - 1, size).unwrap_or_default();
    for (cell, shown) in cells.into_iter().zip(shown) {
        let Cell { left, top, width, height, .. } = cell;
        if shown.size() != [width, height] {
            return Err(Unequal::Sizes([width, height], shown.size()));
        }
        canvas.copy(shown.rgb8(), width, [0, 0], [left, top, width, height]);
    }
    areas(comparison, size, shown.len()).iter().for_each(|area| letter(&mut canvas, area));
    Ok(canvas.rgb8)
}

/// The parts of a picture of this size on both sides of the edge of a wipe.
fn sides(comparison: &Comparison, [width, height]: [u32; 2]) -> [Rect; 2] {
    match comparison.edge {
        Edge::Vertical => {
            let at = edge(comparison.split, width);
            [[0, 0, at, height], [at, 0, width - at, height]]
        }
        Edge::Horizontal => {
            let at = edge(comparison.split, height);
            [[0, 0, width, at], [0, at, width, height - at]]
        }
    }
}

fn wipe(comparison: &Comparison, pair: &Pair) -> Result<Vec<u8>, Unequal> {
    let size @ [width, height] = pair.a.size();
    let mut canvas = Canvas { size, rgb8: pair.a.rgb8().to_vec() };
    let vertical = comparison.edge == Edge::Vertical;
    let length = if vertical { width } else { height };
    let at = edge(comparison.split, length);
    let [_, b] = sides(comparison, size);
    canvas.copy(pair.b.rgb8(), width, [b[0], b[1]], b);
    // A view that is not visible has no letter and no edge.
    if at > 0 && at < length {
        let line = (2.0 * canvas.scale()).round().max(1.0) as u32;
        for (extra, colour) in [(1, DARK), (0, BRIGHT)] {
            let start = at.saturating_sub(line.div_ceil(2) + extra);
            let thick = line + 2 * extra;
            let rect = if vertical { [start, 0, thick, height] } else { [0, start, width, thick] };
            canvas.fill(rect, colour, 1.0);
        }
    }
    areas(comparison, size, 2).iter().for_each(|area| letter(&mut canvas, area));
    Ok(canvas.rgb8)
}

/// A part of a picture that shows one of several views, with the view's letter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    /// The index of the view among those of the layout.
    pub(super) place: usize,
    view: usize,
    rect: Rect,
    /// The corner of the letter; the flags select right and bottom.
    pub(super) corner: [bool; 2],
}

/// The areas of a picture in which the letters of this number of views are placed; none for a single view, or if
/// all views form one map.
pub(super) fn areas(comparison: &Comparison, size: [u32; 2], shown: usize) -> Vec<Area> {
    match comparison.layout {
        _ if shown < 2 => Vec::new(),
        Layout::SideBySide => {
            let cells = cells(comparison, shown - 1, size).unwrap_or_default();
            let area = |(place, Cell { view, left, top, width, height })| {
                let rect = [left, top, width, height];
                Area { place, view, rect, corner: [false, false] }
            };
            cells.into_iter().enumerate().map(area).collect()
        }
        Layout::Wipe => {
            let [a, b] = sides(comparison, size);
            let vertical = comparison.edge == Edge::Vertical;
            let corner = [vertical, !vertical];
            let a = Area { place: 0, view: 0, rect: a, corner: [false, false] };
            let b = Area { place: 1, view: comparison.with, rect: b, corner };
            [a, b].into_iter().filter(|area| area.rect[2] > 0 && area.rect[3] > 0).collect()
        }
        Layout::Single | Layout::Difference | Layout::Blink => Vec::new(),
    }
}

/// The size of view letters at a scale of 1, pixels.
const LETTER: f32 = 20.0;

impl Area {
    /// The rectangle of the letter's plate in the corner; `None` without room.
    fn plate(&self, canvas: &Canvas) -> Option<Rect> {
        let letter = LETTERS.get(self.view)?;
        let ([left, top, width, height], [at_right, at_bottom]) = (self.rect, self.corner);
        let (scale, style) = (canvas.scale(), Lettering::Semibold);
        let px = LETTER * scale;
        let line = style.height(px);
        let margin = (8.0 * scale).round() as u32;
        let plate = [line.max(style.width(px, letter) + margin), line];
        if width < plate[0] + 2 * margin || height < plate[1] + 2 * margin {
            return None;
        }
        let x = if at_right { left + width - plate[0] - margin } else { left + margin };
        let y = if at_bottom { top + height - plate[1] - margin } else { top + margin };
        Some([x, y, plate[0], plate[1]])
    }

    /// The part of the area below the letter, or above it.
    pub(super) fn clear_of_letter(&self, canvas: &Canvas) -> Rect {
        let [left, top, width, height] = self.rect;
        let Some([_, y, _, line]) = self.plate(canvas) else { return self.rect };
        if self.corner[1] {
            [left, top, width, y - top]
        } else {
            let below = y + line;
            [left, below, width, top + height - below]
        }
    }
}

/// Draws the letter of a view on its plate.
fn letter(canvas: &mut Canvas, area: &Area) {
    let (Some(letter), Some(plate)) = (LETTERS.get(area.view), area.plate(canvas)) else { return };
    let (px, style) = (LETTER * canvas.scale(), Lettering::Semibold);
    let [x, y, width, _] = plate;
    canvas.fill(plate, DARK, 0.88);
    canvas.text(style, [x + (width - style.width(px, letter)) / 2, y], px, letter);
}
