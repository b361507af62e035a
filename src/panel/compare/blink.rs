//! Two views, one after the other.

use super::place::{Arranging, over_each_other};
use crate::panel::{keys, prelude::*};

pub(super) static ARRANGING: Arranging = Arranging {
    hint: Some(|ctx| format!("Hold {} to see the other view.", keys::word(ctx, "blink"))),
    arrange: |all, frame| {
        let rect = frame.below_header(frame.picture);
        let parts = if frame.session.view.blinking { [Rect::NOTHING, rect] } else { [rect, Rect::NOTHING] };
        over_each_other(all, frame, parts);
    },
    ..Arranging::PLAIN
};
