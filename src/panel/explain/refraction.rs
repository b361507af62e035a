//! Refraction at the point: Snell's angle, the critical angle, and the ways of light through a solid body.

use super::{probe, rows};
use crate::{
    explain::Seen,
    panel::{maths, prelude::*},
};

/// Shows the refraction of the view, for models that bend light.
pub(super) fn refraction(ui: &mut Ui, seen: &Seen) {
    let spot = probe::shown_spot(ui.ctx(), seen);
    let Some(refraction) = spot.and_then(|(_, spot)| spot.refraction.as_ref()) else { return };
    ui.add_space(6.0);
    rows::heading(ui, "Through the surface");
    for line in refraction.lines() {
        let mut text = maths::prose(ui, &line, TextStyle::Body);
        text.wrap.max_width = ui.available_width();
        ui.add(Label::new(text).wrap().selectable(true));
    }
}
