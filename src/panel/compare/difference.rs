//! The difference between two views, as a map.

use super::{
    bar::choose,
    place::{Arranging, over_each_other},
};
use crate::{
    compare::fitting_amplification,
    panel::{
        prelude::*,
        segmented::{segment_width, values},
    },
    scene::{
        Comparison,
        comparison::{Channel, Compared, Sign},
        limits::Limits,
    },
};

pub(super) static ARRANGING: Arranging = Arranging {
    arrange: |all, frame| {
        all.map = Some(frame.below_header(frame.picture));
        over_each_other(all, frame, [Rect::NOTHING; 2]);
    },
    rows: [1, 2],
    choices: |ui, session, now, row, wide| {
        if row > 0 {
            chosen_values(ui, now, 0.0);
            return;
        }
        sign(ui, now);
        if wide {
            chosen_values(ui, now, AMPLIFICATION);
        }
        amplification(ui, session, now);
    },
    largest_apart: true,
    ..Arranging::PLAIN
};

/// Width of the labels and lists of [`chosen_values`], and of the choices of the amplification with their label, in points;
/// in a narrower column there are no labels.
const VALUES: f32 = 360.0;
const AMPLIFICATION: f32 = 160.0;
/// Width of the choices of the amplification without their label, in points.
const NARROW_AMPLIFICATION: f32 = 120.0;

/// Width of the signs beside each other.
fn signs(ui: &Ui) -> f32 {
    Sign::ALL.iter().map(|sign| segment_width(ui, sign.name())).sum()
}

/// Selects the sign: a list where there is no room for all signs.
fn sign(ui: &mut Ui, now: &mut Comparison) {
    let room = ui.available_width();
    if signs(ui) + NARROW_AMPLIFICATION > room {
        let width = (room - NARROW_AMPLIFICATION).max(48.0);
        choose(ui, "sign", Sign::ALL, &mut now.sign, Sign::name, Sign::summary, Some(width));
        return;
    }
    let tip = |ui: &mut Ui, sign: Sign| _ = ui.label(sign.summary());
    if let Some(sign) = values(ui, "Sign", Sign::ALL, now.sign, Sign::name, tip) {
        now.sign = sign;
    }
}

/// Selects the values to compare, with room for something else of this width in the same row.
fn chosen_values(ui: &mut Ui, now: &mut Comparison, other: f32) {
    let room = ui.available_width() - other;
    let width = (room < VALUES).then_some(0.5 * (room - ui.spacing().item_spacing.x));
    choose(ui, "channel", Channel::ALL, &mut now.channel, Channel::name, Channel::summary, width);
    choose(ui, "values", Compared::ALL, &mut now.values, Compared::name, Compared::summary, width);
}

/// The amplification: a number, or automatic to fit the largest difference.
fn amplification(ui: &mut Ui, session: &Session, now: &mut Comparison) {
    let Limits { min, max, .. } = Comparison::amplification.limits();
    let help = format!("Differences are multiplied by this before they become colours, {min} to {max}.");
    let label = if ui.available_width() < AMPLIFICATION { "×" } else { "amplify ×" };
    ui.label(theme::small(ui, label)).on_hover_text(&help);
    // Equal views have no largest difference.
    let largest = session.numbers().map(|numbers| numbers.largest.unwrap_or(0.0));
    let used = now.amplification.or_else(|| Some(fitting_amplification(now.values, largest?)));
    let mut factor = used.unwrap_or(min as f32);
    let mut field = egui::DragValue::new(&mut factor).range(min..=max).speed(0.2).max_decimals(0);
    if used.is_none() {
        field = field.custom_formatter(|_, _| "…".to_owned());
    }
    if ui.add(field).on_hover_text(help).changed() {
        now.amplification = Some(factor);
    }
    let fits = now.amplification.is_none();
    let fit = ui.add(Button::new("auto").small().selected(fits));
    theme::says_chosen(&fit, WidgetType::Checkbox, fits, "Amplify automatically");
    let fit = fit.on_hover_text("Amplify so that the largest difference has nearly the last colour.");
    if fit.clicked() {
        now.amplification = if fits { used } else { None };
    }
}
