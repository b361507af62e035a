//! One view.

use super::place::Arranging;
use crate::panel::state::Cell;

pub(super) static ARRANGING: Arranging = Arranging {
    arrange: |all, frame| {
        let rect = frame.below_header(frame.picture);
        let view = frame.session.shown_alone();
        all.headers.push((view, frame.header(frame.picture)));
        all.cells.push(Cell { view, rect, part: rect });
    },
    ..Arranging::PLAIN
};
