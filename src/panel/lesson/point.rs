//! Points at the controls that a step names: each gets a ring, and is scrolled into view once.
//!
//! The code that shows a control reports it by [`knob`], [`menu`], [`button`], [`tab`], [`part`] or [`line()`]; without
//! a lesson that costs a look-up in egui's memory.

use bevy_egui::egui::{LayerId, WidgetRect};

use crate::{lesson::Control, panel::prelude::*};

/// Duration of the pulse of a new ring, in seconds, and the number of pulses.
const MOMENT: f64 = 1.2;
const SWELLS: f64 = 2.0;
/// Within so many passes what is folded unfolds, and a knob that is sought is found.
const PATIENCE: u64 = 60;
/// Within so many passes panels that a step has changed have settled.
const SETTLED: u64 = 12;
/// Between a control and its ring, points.
const GAP: f32 = 3.0;

/// Controls that the step names, and their rectangles in this frame.
#[derive(Clone, Debug, Default)]
struct Pointed {
    controls: Vec<Control>,
    /// Number of the entry into the step.
    entry: u64,
    /// Time of the entry, in seconds.
    since: f64,
    /// The pass after which nothing is scrolled into view any more.
    until: u64,
    /// Controls that were scrolled into view, or already are in view; lines with the point that they explain.
    revealed: Vec<(Control, Option<Vec3>)>,
    found: Vec<(Rect, Rect, LayerId)>,
}

/// The knob that was asked for by name, and the pass after which it is not sought any more.
#[derive(Clone, Default)]
struct Sought(Option<(String, u64)>);

/// Starts a frame.
pub(in crate::panel) fn begin(ctx: &Context, session: &Session) {
    let pass = ctx.cumulative_pass_nr();
    kept::with(ctx, |Sought(sought)| _ = sought.take_if(|(_, until)| pass > *until));
    let named = session.lesson.as_ref().and_then(|open| Some((open.entries, open.now()?)));
    let Some((entry, step)) = named.filter(|(_, step)| !step.points.is_empty()) else {
        kept::set(ctx, Pointed::default());
        return;
    };
    let now = ctx.input(|input| input.time);
    kept::with(ctx, |pointed: &mut Pointed| {
        if pointed.entry != entry || pointed.controls != step.points {
            let controls = step.points.clone();
            *pointed = Pointed { controls, entry, since: now, until: pass + SETTLED, ..Pointed::default() };
        }
        pointed.found.clear();
    });
}

/// Reports that a control is shown here.
fn shown(ui: &Ui, rect: Rect, is: impl Fn(&Control) -> bool) {
    shown_of(ui, None, rect, is);
}

/// Reports that a control is shown here, which is scrolled into view once for each point that it explains.
fn shown_of(ui: &Ui, point: Option<Vec3>, rect: Rect, is: impl Fn(&Control) -> bool) {
    let found = kept::with(ui.ctx(), |pointed: &mut Pointed| {
        let control = pointed.controls.iter().find(|control| is(control))?.clone();
        let control = (control, point);
        Some((pointed.revealed.contains(&control), control))
    });
    let Some((revealed, control)) = found.filter(|_| ui.is_visible() && rect.is_positive()) else { return };
    let clip = ui.clip_rect();
    let hidden = !clip.contains_rect(rect);
    if !revealed && hidden {
        ui.scroll_to_rect(rect, Some(Align::Center));
        ui.ctx().request_repaint();
    }
    let (place, pass) = ((rect, clip, ui.layer_id()), ui.ctx().cumulative_pass_nr());
    kept::with(ui.ctx(), |pointed: &mut Pointed| {
        // Panels that settle may move it out of sight again, but what has no room is not sought for ever.
        if !revealed && (!hidden || pass > pointed.until) {
            pointed.revealed.retain(|(known, _)| *known != control.0);
            pointed.revealed.push(control);
        }
        pointed.found.push(place);
    });
}

/// True while a control that the step names may be out of sight: a jump there needs fewer frames than a glide, and frames
/// may be slow.
pub(in crate::panel) fn jumps(ui: &Ui) -> bool {
    kept::with(ui.ctx(), |pointed: &mut Pointed| pointed.revealed.len() < pointed.controls.len())
}

/// Normalises a name, so that spellings compare equal.
fn plain(name: &str) -> String {
    let name = name.trim_start_matches("shape ").replace([' ', '-'], "_").to_lowercase();
    match name.as_str() {
        "luminous_flux" => "flux".to_owned(),
        "colour_temperature" => "temperature".to_owned(),
        _ => name,
    }
}

/// Brings the knob of this name into sight, and gives it the focus.
pub(in crate::panel) fn seek(ctx: &Context, name: &str) {
    kept::set(ctx, Sought(Some((name.to_owned(), ctx.cumulative_pass_nr() + PATIENCE))));
    ctx.request_repaint();
}

/// True while a knob is sought: what is folded may hide it.
pub(in crate::panel) fn seeks(ui: &Ui) -> bool {
    kept::with(ui.ctx(), |Sought(sought)| sought.is_some())
}

fn is_sought(ui: &Ui, name: &str) -> bool {
    kept::with(ui.ctx(), |Sought(sought)| sought.as_ref().is_some_and(|(wanted, _)| wanted == name))
}

/// Gives the first widget of a knob the focus.
fn take_focus(ui: &Ui, rect: Rect) {
    let layer = ui.layer_id();
    let within = |w: &&WidgetRect| {
        w.enabled && w.sense.is_focusable() && w.rect.is_positive() && rect.contains(w.rect.center())
    };
    let first = ui.ctx().viewport(|viewport| {
        let all = viewport.this_pass.widgets.get_layer(layer).filter(within);
        all.min_by(|a, b| a.rect.left().total_cmp(&b.rect.left())).map(|w| w.id)
    });
    if let Some(id) = first {
        ui.memory_mut(|m| m.request_focus(id));
    }
    kept::set(ui.ctx(), Sought::default());
}

/// The knob of a parameter is shown here.
pub(in crate::panel) fn knob(ui: &Ui, name: &str, rect: Rect) {
    if is_sought(ui, name) && ui.is_visible() {
        ui.scroll_to_rect(rect, Some(Align::Center));
        take_focus(ui, rect);
    }
    shown(ui, rect, |control| matches!(control, Control::Knob(wanted) if plain(wanted) == plain(name)));
}

/// True if the step points at the knob of a parameter, or if it is sought, so that it must be in sight.
pub(in crate::panel) fn at_knob(ui: &Ui, name: &str) -> bool {
    let is = |control: &Control| matches!(control, Control::Knob(wanted) if plain(wanted) == plain(name));
    is_sought(ui, name) || kept::with(ui.ctx(), |pointed: &mut Pointed| pointed.controls.iter().any(is))
}

/// Reports the button that opens the menu of this name.
pub(in crate::panel) fn menu(ui: &Ui, name: &str, rect: Rect) {
    shown(ui, rect, |control| matches!(control, Control::Menu(wanted) if plain(wanted) == plain(name)));
}

/// Reports the button of a choice: `shading`, `reflection`, `terms`.
pub(in crate::panel) fn button(ui: &Ui, name: &str, rect: Rect) {
    shown(ui, rect, |control| matches!(control, Control::Button(wanted) if plain(wanted) == plain(name)));
}

/// Reports the tab of the panel with this id.
pub(in crate::panel) fn tab(ui: &Ui, id: &str, rect: Rect) {
    shown(ui, rect, |control| matches!(control, Control::Tab(wanted) if plain(wanted) == plain(id)));
}

/// Reports the row of a part of the scene.
pub(in crate::panel) fn part(ui: &Ui, session: &Session, part: Selection, rect: Rect) {
    let document = &session.document;
    shown(ui, rect, |control| matches!(control, Control::Part(name) if name.find(document) == Some(part)));
}

/// Reports the button that brings the panels at a place into sight, which stands for the controls in them.
pub(in crate::panel) fn behind(ui: &Ui, place: Place, rect: Rect) {
    let is = |control: &Control| match control {
        Control::Part(_) => place == Place::Left,
        Control::Knob(_) => place == Place::Right,
        Control::Tab(_) | Control::Line(_) => place == Place::Bottom,
        Control::Menu(_) | Control::Button(_) => false,
    };
    let found = (rect, ui.clip_rect(), ui.layer_id());
    kept::with(ui.ctx(), |pointed: &mut Pointed| {
        if pointed.controls.iter().any(is) {
            pointed.found.push(found);
        }
    });
}

/// Reports a line of *Explain* about a point.
pub(in crate::panel) fn line(ui: &Ui, text: &str, point: Vec3, rect: Rect) {
    let gives = |value: &str| text.contains(&format!("{value} = "));
    shown_of(ui, Some(point), rect, |control| matches!(control, Control::Line(value) if gives(value)));
}

/// True if the step points at a part of the scene, so that the scene list must be visible.
pub(in crate::panel) fn at_part(session: &Session) -> bool {
    let step = session.lesson.as_ref().and_then(|open| open.now());
    step.is_some_and(|step| step.points.iter().any(|control| matches!(control, Control::Part(_))))
}

/// Paints the rings, once everything else is shown.
pub(in crate::panel) fn show(ctx: &Context, palette: &Palette) {
    let pointed: Pointed = kept::get(ctx);
    if pointed.controls.is_empty() {
        return;
    }
    let age = ctx.input(|input| input.time) - pointed.since;
    let swell = if age < MOMENT {
        ctx.request_repaint();
        (std::f64::consts::PI * SWELLS * age / MOMENT).sin().abs() as f32
    } else {
        0.0
    };
    for (rect, clip, layer) in pointed.found {
        let painter = ctx.layer_painter(layer).with_clip_rect(clip.expand(GAP + 4.0));
        let stroke = Stroke::new(2.0 + swell, palette.accent);
        painter.rect_stroke(rect.expand(GAP + 2.0 * swell), 5.0, stroke, StrokeKind::Outside);
    }
}
