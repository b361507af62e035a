//! All views beside each other: two, or two rows of two.

use super::{
    Cell,
    area::{Area, letter},
    drawing::Drawing,
};
use crate::compare::{
    canvas::{Canvas, DARK},
    pair::Unequal,
};

pub(super) static DRAWING: Drawing = Drawing {
    cells,
    size_around: |views, [width, height]| {
        let with = |gap: u32| [2 * width + gap, if views > 2 { 2 * height + gap } else { height }];
        // A wider gap enlarges the picture, but hardly ever so much that the gap grows again.
        let mut size = with(gap(0));
        while size != with(gap(size[0].min(size[1]))) {
            size = with(gap(size[0].min(size[1])));
        }
        size
    },
    areas: |_, size, views| {
        let area = |(place, Cell { view, left, top, width, height })| {
            let rect = [left, top, width, height];
            Area { place, view, rect, corner: [false, false] }
        };
        cells(views, size).unwrap_or_default().into_iter().enumerate().map(area).collect()
    },
    compose: |comparison, size, shown| {
        let views: Vec<_> = (0..shown.len()).collect();
        let mut canvas = Canvas { size, rgb8: DARK.repeat(size[0] as usize * size[1] as usize) };
        for (cell, shown) in cells(&views, size).unwrap_or_default().into_iter().zip(shown) {
            let Cell { left, top, width, height, .. } = cell;
            if shown.size() != [width, height] {
                return Err(Unequal::Sizes([width, height], shown.size()));
            }
            canvas.copy(shown.rgb8(), width, [0, 0], [left, top, width, height]);
        }
        (DRAWING.areas)(comparison, size, &views).iter().for_each(|area| letter(&mut canvas, area));
        Ok(canvas.rgb8)
    },
};

fn cells(views: &[usize], [width, height]: [u32; 2]) -> Option<Vec<Cell>> {
    let rows = if views.len() > 2 { 2 } else { 1 };
    let gap = gap(width.min(height));
    let across = halves(width, gap)?;
    let down = if rows == 1 { [(0, height); 2] } else { halves(height, gap)? };
    let place = |(i, view): (usize, &usize)| {
        let (column, row): (usize, usize) = (i % 2, i / 2);
        let ((left, width), (top, height)) = (across[column], down[row]);
        Cell { view: *view, left, top, width, height }
    };
    Some(views.iter().enumerate().map(place).collect())
}

/// The gap between views in a picture whose shorter side has this length, pixels.
fn gap(length: u32) -> u32 {
    (length / 180).clamp(2, 16)
}

/// Two equal parts of a length, with the rest as a gap between them: start and length of each.
fn halves(length: u32, gap: u32) -> Option<[(u32, u32); 2]> {
    let half = length.checked_sub(gap)? / 2;
    (half > 0).then_some([(0, half), (length - half, half)])
}
