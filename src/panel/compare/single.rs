//! One view.

use super::place::Arranging;
use crate::panel::state::Cell;

pub(super) static ARRANGING: Arranging = Arranging {
    arrange: |all, frame| {
        let rect = frame.below_header(frame.picture);
        let view = match frame.session.active() {
            0 if frame.session.view.blinking => {
                frame.comparison().with.min(frame.session.document.variants.len())
            }
            _ if frame.session.view.blinking => 0,
            active => active,
        };
        all.headers.push((view, frame.header(frame.picture)));
        all.cells.push(Cell { view, rect, part: rect });
    },
    ..Arranging::PLAIN
};
