//! Messages that a presentation, which has no status line, shows for a moment: how to leave it, and what happened.

use std::time::Duration;

use super::{prelude::*, state::Messages};
use crate::platform;

/// Time for which a message is shown, in seconds; twice as long for problems.
const MOMENT: f64 = 5.0;
/// Time for which the presentation says how to leave it, in seconds: it may cover other text.
const HINT: f64 = 3.0;
/// Maximum width, as a fraction of the screen.
const WIDTH: f32 = 0.55;

/// State of the messages of a presentation.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    /// Pass in which a message was last shown.
    pass: u64,
    /// Number of messages added until then.
    added: usize,
    /// Time of the latest message within the presentation, in seconds.
    since: Option<f64>,
}

/// Shows the current message on a screen in letters of this size, where `place` puts a plate of its size; the
/// presentation started at `since`, in seconds.
pub(super) fn show(
    ui: &Ui,
    screen: (Rect, f32),
    since: f64,
    messages: &Messages,
    place: impl Fn(Vec2) -> Rect,
) {
    let (now, pass) = (ui.input(|i| i.time), ui.ctx().cumulative_pass_nr());
    let mut told: Told = kept::get(ui.ctx());
    let added = messages.added();
    if told.pass + 2 <= pass {
        told = Told { added, ..Told::default() };
    } else if told.added != added {
        (told.added, told.since) = (added, Some(now));
    }
    told.pass = pass;
    kept::set(ui.ctx(), told);
    let message = messages.last().zip(told.since);
    let message = message.filter(|(message, said)| now - said <= moment(Some(message.severity)));
    match message {
        Some((message, said)) => {
            plate(ui, screen, &message.text, (Some(message.severity), said == now), place);
        }
        None if now - since <= moment(None) => {
            plate(ui, screen, "Esc leaves the presentation", (None, since == now), place);
        }
        None => {}
    }
}

/// Time for which a message is shown, in seconds.
fn moment(severity: Option<Severity>) -> f64 {
    match severity {
        None => HINT,
        Some(Severity::Info) => MOMENT,
        Some(_) => 2.0 * MOMENT,
    }
}

/// A time that something waits for, at which the panels are redrawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wait {
    /// The time, in seconds.
    until: f64,
    /// Time at which the window is woken, in seconds.
    wakes: f64,
}

impl Default for Wait {
    /// One that has long been over.
    fn default() -> Self {
        Self { until: f64::NEG_INFINITY, wakes: 0.0 }
    }
}

impl Wait {
    /// Lets it last so many seconds from now on.
    pub(super) fn begin(&mut self, now: f64, seconds: f64) {
        self.until = now + seconds;
    }

    pub(super) fn lasts(&self, now: f64) -> bool {
        self.until > now
    }

    /// Wakes the window when it is over. One that begins anew meanwhile is woken twice, and not once for each beginning.
    pub(super) fn wake(&mut self, ctx: &Context, now: f64) {
        if self.wakes <= now {
            self.wakes = self.until + 0.05;
            wake(ctx, self.wakes - now);
        }
    }
}

/// Redraws the panels after a number of seconds: nothing else wakes an idle window.
fn wake(ctx: &Context, seconds: f64) {
    let (ctx, wait) = (ctx.clone(), Duration::from_secs_f64(seconds.max(0.0)));
    platform::later(wait, move || ctx.request_repaint());
}

fn plate(
    ui: &Ui,
    (screen, size): (Rect, f32),
    text: &str,
    (severity, first): (Option<Severity>, bool),
    place: impl Fn(Vec2) -> Rect,
) {
    if first {
        wake(ui.ctx(), moment(severity) + 0.1);
    }
    let palette = Palette::here(ui);
    let left = if severity.is_some() { 1.2 * size } else { 0.0 };
    let room = WIDTH * screen.width() - left;
    let galley = ui.painter().layout(text.to_owned(), FontId::proportional(size), palette.text, room);
    let extent = galley.size() + vec2(left, 0.0) + vec2(24.0, 12.0);
    let place = place(extent);
    ui.painter().rect_filled(place, theme::UNIT, palette.panel);
    if let Some(severity) = severity {
        let line = galley.rows.first().map_or(size, |row| row.height());
        let at = place.min + vec2(12.0 + 0.4 * size, 6.0 + 0.5 * line);
        icon::severity(ui.painter(), at, 0.4 * size, severity, &palette);
    }
    ui.painter().galley(place.min + vec2(12.0 + left, 6.0), galley, palette.text);
}
