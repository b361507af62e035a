//! Messages that a presentation shows for a moment: the way out, and what happened. It has no status line.

use std::{thread, time::Duration};

use bevy_egui::egui::{Align2, Context, FontId, Id, Rect, Ui, vec2};

use super::{
    icon,
    state::{Session, Severity},
    theme::{self, Palette},
};

/// Time for which something is said, seconds; a problem is read twice as long.
const MOMENT: f64 = 5.0;
/// The part of the width that it takes at most.
const WIDTH: f32 = 0.55;

/// The messages of a presentation.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    /// The pass in which it was shown last.
    pass: u64,
    /// The messages that were added until then.
    added: usize,
    /// When the last one was, if it was within the presentation, seconds.
    since: Option<f64>,
}

/// Says it in the corner of `rect`, in letters of this size; the presentation began at `since`, seconds.
pub(super) fn show(ui: &Ui, rect: Rect, size: f32, since: f64, session: &Session) {
    let (now, pass) = (ui.input(|i| i.time), ui.ctx().cumulative_pass_nr());
    let id = Id::new("told in the presentation");
    let mut told: Told = ui.data(|d| d.get_temp(id)).unwrap_or_default();
    let added = session.messages.added();
    if told.pass + 2 <= pass {
        told = Told { added, ..Told::default() };
    } else if told.added != added {
        (told.added, told.since) = (added, Some(now));
    }
    told.pass = pass;
    ui.data_mut(|d| d.insert_temp(id, told));
    let message = session.messages.last().zip(told.since);
    let message = message.filter(|(message, said)| now - said <= moment(Some(message.severity)));
    match message {
        Some((message, said)) => plate(ui, rect, size, &message.text, Some(message.severity), said == now),
        None if now - since <= moment(None) => {
            plate(ui, rect, size, "Esc leaves the presentation", None, since == now);
        }
        None => {}
    }
}

/// Time for which it is said, seconds.
fn moment(severity: Option<Severity>) -> f64 {
    if severity.is_some_and(|severity| severity > Severity::Info) { 2.0 * MOMENT } else { MOMENT }
}

/// Draws the panels again after so many seconds: nothing else wakes a window at rest.
pub(super) fn wake(ctx: &Context, seconds: f64) {
    let (ctx, wait) = (ctx.clone(), Duration::from_secs_f64(seconds.max(0.0)));
    thread::spawn(move || {
        thread::sleep(wait);
        ctx.request_repaint();
    });
}

fn plate(ui: &Ui, rect: Rect, size: f32, text: &str, severity: Option<Severity>, first: bool) {
    if first {
        wake(ui.ctx(), moment(severity) + 0.1);
    }
    let palette = Palette::here(ui);
    let left = if severity.is_some() { 1.2 * size } else { 0.0 };
    let room = WIDTH * rect.width() - left;
    let galley = ui.painter().layout(text.to_owned(), FontId::proportional(size), palette.text, room);
    let place = Align2::RIGHT_BOTTOM.anchor_size(
        rect.right_bottom() - vec2(12.0, 12.0),
        galley.size() + vec2(left, 0.0) + vec2(24.0, 12.0),
    );
    ui.painter().rect_filled(place, theme::UNIT, palette.panel);
    if let Some(severity) = severity {
        let line = galley.rows.first().map_or(size, |row| row.height());
        let at = place.min + vec2(12.0 + 0.4 * size, 6.0 + 0.5 * line);
        icon::severity(ui.painter(), at, 0.4 * size, severity, &palette);
    }
    ui.painter().galley(place.min + vec2(12.0 + left, 6.0), galley, palette.text);
}
