//! The conversion of light to the display code.

use super::rows;
use crate::{explain::Explanation, optics::colour::Encoding, panel::prelude::*, reference::DisplaySteps};

/// Shows the steps one below the other, each with its result.
pub(super) fn display(ui: &mut Ui, explanation: &Explanation) {
    rows::close(ui);
    let (steps, display) = (&explanation.steps, &explanation.display);
    let step = |ui: &mut Ui, what: &str, of: fn(&DisplaySteps) -> Vec3| {
        rows::step(ui, what, of(steps), explanation.error_of(of));
    };
    rows::heading(ui, "From light to the code on the display");
    if explanation.seen.is_some() || explanation.lamp.is_some() {
        rows::measured_step(ui, "light of the pixel", steps.light, explanation.error_of(|steps| steps.light));
        let (ev, factor) = (rows::short(display.exposure), rows::short(steps.exposure));
        step(ui, &format!("exposure {ev} EV, × {factor}"), |steps| steps.exposed);
    } else if explanation.shows_backdrop() {
        step(ui, "background, as the scene gives it", |steps| steps.exposed);
    } else {
        step(ui, "background, whatever the exposure", |steps| steps.exposed);
    }
    if display.encoding == Encoding::Off && !explanation.shows_backdrop() {
        let text = "Without encoding, the numbers themselves are to reach the display: clipped to 0–1 and decoded, since the \
                    last step encodes.";
        theme::note(ui, text);
        step(ui, "decoded", |steps| steps.input);
    }
    if !explanation.shows_backdrop() {
        step(ui, &format!("tone mapping, {}", display.tone_mapping.name()), |steps| steps.mapped);
    }
    if steps.mapped.is_nan() {
        theme::note(ui, "What is no number is shown as 0.");
    } else if steps.mapped.max_element() > 1.0 || steps.mapped.min_element() < 0.0 {
        theme::note(ui, "What is beyond 0–1 is clipped.");
    }
    // From here on, display values rather than light.
    let encoded = explanation.error_of(|steps| steps.encoded);
    rows::named_within(ui, "sRGB encoding:", steps.encoded, encoded);
    ui.horizontal(|ui| {
        ui.label(theme::small(ui, "× 255, rounded:"));
        rows::chip(ui, steps.codes, vec2(28.0, 16.0));
        ui.label(theme::strong(ui, rows::codes(steps.codes)));
    });
}
