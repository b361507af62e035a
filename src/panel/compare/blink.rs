//! Two views, one after the other.

use bevy_egui::egui::Rect;

use super::place::{Arranging, over_each_other};

pub(super) static ARRANGING: Arranging = Arranging {
    hint: "Hold Space to see the other view.",
    arrange: |all, frame| {
        let rect = frame.below_header(frame.picture);
        let parts = if frame.session.view.blinking { [Rect::NOTHING, rect] } else { [rect, Rect::NOTHING] };
        over_each_other(all, frame, parts);
    },
    ..Arranging::PLAIN
};
