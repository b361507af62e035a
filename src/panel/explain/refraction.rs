//! Refraction at the point: the way of light through a solid body, Snell's angle, and the critical angle.

use super::{probe, rows, side};
use crate::{
    explain::Seen,
    panel::{keys, lesson::point, maths, prelude::*},
};

/// Shows the refraction of the view, for models that bend light. Returns true if the ray is to be seen from the side.
pub(super) fn refraction(ui: &mut Ui, seen: &Seen, session: &Session) -> bool {
    let spot = probe::shown_spot(ui.ctx(), seen);
    let Some(refraction) = spot.and_then(|(_, spot)| spot.refraction.as_ref()) else { return false };
    ui.add_space(6.0);
    let aside = ui.horizontal(|ui| {
        rows::heading(ui, "Through the surface");
        refraction.main_way().is_some() && from_the_side(ui, session)
    });
    for line in refraction.lines() {
        let mut text = maths::prose(ui, &rows::unbroken(ui, &line), TextStyle::Body);
        text.wrap.max_width = ui.available_width();
        let place = ui.add(Label::new(text).wrap().selectable(true)).rect;
        point::line(ui, &line, seen.position, place);
    }
    aside.inner
}

/// The button that turns the camera until the ray is seen from the side.
fn from_the_side(ui: &mut Ui, session: &Session) -> bool {
    let text = RichText::new("From the side").text_style(TextStyle::Small);
    let button = ui.add_enabled(side::has_sides(ui.ctx(), session), Button::new(text).small());
    let tip = keys::hint(ui.ctx(), "See from the side how the ray is bent", "side");
    let pin = format!("Pin the point first: {}.", keys::word(ui.ctx(), "explain"));
    button.on_hover_text(tip).on_disabled_hover_text(pin).clicked()
}
