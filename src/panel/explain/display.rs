//! The way from light to the code on the display.

use bevy_egui::egui::Ui;

use super::rows;
use crate::{explain::Explanation, optics::colour::Encoding, panel::theme};

/// The steps, one below the other, each with its result.
pub(super) fn display(ui: &mut Ui, explanation: &Explanation) {
    ui.spacing_mut().item_spacing.y = 3.0;
    let (steps, display) = (&explanation.steps, &explanation.display);
    rows::heading(ui, "From light to the code on the display");
    if explanation.seen.is_some() {
        rows::named(ui, "light of the pixel", "", "Linear, before exposure");
        rows::inset(ui, |ui| drop(rows::light(ui, "", steps.light, false)));
        let (ev, factor) = (rows::short(display.exposure), rows::short(steps.exposure));
        rows::note(ui, &format!("exposure {ev} EV, so times {factor}"));
        rows::inset(ui, |ui| drop(rows::light(ui, "=", steps.exposed, false)));
    } else {
        rows::note(ui, "background, whatever the exposure");
        rows::inset(ui, |ui| drop(rows::light(ui, "", steps.exposed, false)));
    }
    if display.encoding == Encoding::Off {
        rows::note(
            ui,
            "without encoding, the numbers themselves are to reach the display: clipped to 0–1 and decoded, since the last \
             step encodes",
        );
        rows::inset(ui, |ui| drop(rows::light(ui, "=", steps.input, false)));
    }
    rows::note(ui, &format!("tone mapping: {}", display.tone_mapping.name()));
    rows::inset(ui, |ui| drop(rows::light(ui, "=", steps.mapped, false)));
    if steps.mapped.is_nan() {
        rows::note(ui, "what is no number is shown as 0");
    } else if steps.mapped.max_element() > 1.0 || steps.mapped.min_element() < 0.0 {
        rows::note(ui, "what is beyond 0–1 is clipped");
    }
    rows::note(ui, "sRGB encoding");
    // Not light any more: the numbers of the display.
    let encoded = format!("= {}", rows::short_triple(steps.encoded));
    rows::inset(ui, |ui| drop(rows::named(ui, "", &encoded, &rows::spoken(steps.encoded))));
    rows::note(ui, "× 255, rounded: the code");
    let [r, g, b] = steps.codes;
    rows::inset(ui, |ui| {
        ui.horizontal(|ui| {
            rows::chip(ui, steps.codes, bevy_egui::egui::vec2(28.0, 18.0));
            ui.label(theme::strong(ui, format!("{r}, {g}, {b}")));
        });
    });
}
