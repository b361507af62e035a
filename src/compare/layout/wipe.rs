//! Two views over each other, with an edge between them that moves.

use super::{
    area::{Area, letter},
    drawing::Drawing,
};
use crate::{
    compare::{
        canvas::{BRIGHT, Canvas, DARK, Rect},
        pair::{Pair, Unequal},
    },
    scene::{Comparison, comparison::Edge},
};

pub(super) static DRAWING: Drawing = Drawing {
    areas: |comparison, size, views| {
        let [a, b] = sides(comparison, size);
        let vertical = comparison.edge == Edge::Vertical;
        let corner = [vertical, !vertical];
        let a = Area { place: 0, view: views[0], rect: a, corner: [false, false] };
        let b = Area { place: 1, view: views[1], rect: b, corner };
        [a, b].into_iter().filter(|area| area.rect[2] > 0 && area.rect[3] > 0).collect()
    },
    compose: |comparison, _, shown| wipe(comparison, &Pair::new(&shown[0], &shown[1])?),
    ..Drawing::OF_A
};

/// The number of pixels of a wipe to the left of the edge, or above it.
#[must_use]
pub fn edge(split: f32, length: u32) -> u32 {
    (split.clamp(0.0, 1.0) * length as f32).round() as u32
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
    (DRAWING.areas)(comparison, size, &[0, comparison.with])
        .iter()
        .for_each(|area| letter(&mut canvas, area));
    Ok(canvas.rgb8)
}
