//! The difference between two views, as a map.

use super::{
    bar::choose,
    place::{Arranging, over_each_other},
};
use crate::{
    compare::fitting_amplification,
    panel::{prelude::*, segmented::values},
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
            chosen_values(ui, now);
            return;
        }
        let tip = |ui: &mut Ui, sign: Sign| _ = ui.label(sign.summary());
        if let Some(sign) = values(ui, "Sign", Sign::ALL, now.sign, Sign::name, tip) {
            now.sign = sign;
        }
        if wide {
            chosen_values(ui, now);
        }
        amplification(ui, session, now);
    },
    largest_apart: true,
    ..Arranging::PLAIN
};

/// Selects the values to compare.
fn chosen_values(ui: &mut Ui, now: &mut Comparison) {
    choose(ui, "channel", Channel::ALL, &mut now.channel, Channel::name, Channel::summary);
    choose(ui, "values", Compared::ALL, &mut now.values, Compared::name, Compared::summary);
}

/// The amplification: a number, or automatic to fit the largest difference.
fn amplification(ui: &mut Ui, session: &Session, now: &mut Comparison) {
    let Limits { min, max, .. } = Comparison::amplification.limits();
    let help = format!("Differences are multiplied by this before they become colours, {min} to {max}.");
    ui.label(theme::small(ui, "amplify ×")).on_hover_text(&help);
    // Equal views have no largest difference.
    let largest = session.facts.comparison.as_ref().map(|numbers| numbers.largest.unwrap_or(0.0));
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
