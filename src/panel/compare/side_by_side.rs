//! All views beside each other.

use super::place::{Arranging, Frame, GAP};
use crate::panel::{prelude::*, state::Cell};

pub(super) static ARRANGING: Arranging = Arranging {
    arrange: |all, frame| {
        let columns = columns(frame);
        let size = place(frame, columns);
        let shown = frame.views.iter().copied().map(Some).chain([None]);
        for (i, view) in shown.enumerate().take(columns * lines(frame, columns)) {
            let at = vec2((i % columns) as f32, (i / columns) as f32) * (size + Vec2::splat(GAP));
            let place = Rect::from_min_size(frame.picture.min + at, size);
            let rect = frame.below_header(place);
            match view {
                Some(view) => {
                    all.headers.push((view, frame.header(place)));
                    all.cells.push(Cell { view, rect, part: rect });
                }
                None => all.vacant = Some(place),
            }
        }
    },
    ..Arranging::PLAIN
};

/// The number of lines of views in so many columns.
fn lines(frame: &Frame, columns: usize) -> usize {
    frame.views.len().div_ceil(columns)
}

/// Size of the place of each view, with its header, in so many columns.
fn place(frame: &Frame, columns: usize) -> Vec2 {
    let counts = vec2(columns as f32, lines(frame, columns) as f32);
    (frame.picture.size() + Vec2::splat(GAP)) / counts - Vec2::splat(GAP)
}

/// The number of columns: two, or in a presentation all views in one line if their pictures are larger there; in a narrow
/// window one for two views that would be taller than wide beside each other.
fn columns(frame: &Frame) -> usize {
    let all = frame.views.len().max(2);
    let beside = place(frame, 2) - vec2(0.0, frame.high + frame.band);
    if frame.session.view.narrow && all == 2 && beside.y > beside.x {
        return 1;
    }
    let least = |columns: usize| (place(frame, columns) - vec2(0.0, frame.high)).min_elem();
    if frame.session.view.presenting && least(all) > least(2) { all } else { 2 }
}
