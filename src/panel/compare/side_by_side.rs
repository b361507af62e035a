//! All views beside each other.

use super::place::{Arranging, GAP, halves};
use crate::panel::{prelude::*, state::Cell};

pub(super) static ARRANGING: Arranging = Arranging {
    arrange: |all, frame| {
        let picture = frame.picture;
        let lines = if frame.views.len() > 2 { 2 } else { 1 };
        let height = (picture.height() - (lines - 1) as f32 * GAP) / lines as f32;
        let shown = frame.views.iter().copied().map(Some).chain([None]);
        for (i, view) in shown.enumerate().take(2 * lines) {
            let top = picture.top() + (i / 2) as f32 * (height + GAP);
            let line = Rect::from_min_size(pos2(picture.left(), top), vec2(picture.width(), height));
            let place = halves(line)[i % 2];
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
