//! Fits to a measurement: their buttons, and the window that lists every model by what remains.

use std::time::Duration;

use super::{
    draft, export, kept, matching,
    prelude::*,
    state::{Effect, Fits, MatchCommand, Running},
};
use crate::{
    matching::{digits, each::Matched},
    parameter::Value,
    progress::time_left,
};

/// Id and title of the window.
pub(super) const FITS: [&str; 2] = ["fits", "Fits to a measurement"];
/// Maximum height of the list, in points.
const LIST: f32 = 320.0;
/// Tooltip of the fit by one click.
pub(super) const ONE: &str = "Searches for the parameters of the model beside the measurement that come nearest to it, all numbers and \
    colours free, and sets them: one step of the history. If the measurement is not in view A, the views are swapped first. Without \
    a model beside it, fits every model.";
/// Tooltip of the fit of every model.
pub(super) const EVERY: &str =
    "Fits every model for opaque surfaces to the measurement, and lists them by what remains";

/// The buttons for a measured surface.
pub(super) fn buttons(ui: &mut Ui, context: &mut PanelContext<'_>) {
    ui.horizontal_wrapped(|ui| {
        let one = ui.small_button("Fit to it").on_hover_text(ONE);
        context.on_click(&one, || Action::Match(MatchCommand::Fit));
        let every = ui.small_button("Fit every model…").on_hover_text(EVERY);
        context.on_click(&every, || Action::Match(MatchCommand::Every(Default::default())));
    });
    ui.add_space(4.0);
}

/// The window.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let Some(fits) = &context.session().fits else { return };
    let (centre, asked) = (context.area().rect.center(), context.actions.len());
    if !draft::window(ui, FITS[0], FITS[1].to_owned(), centre, |ui| content(ui, fits, context)) {
        context.actions.truncate(asked);
        context.act(Action::Match(MatchCommand::CloseFits));
    }
}

fn content(ui: &mut Ui, fits: &Fits, context: &mut PanelContext<'_>) {
    let letter = LETTERS[fits.view.min(MAX_VARIANTS)];
    let about = format!(
        "Every model for opaque surfaces, with all its numbers, colours and choices free, and what remains of the difference from \
         the measurement in view {letter}. A click on a model puts it into another view."
    );
    ui.add(Label::new(theme::small(ui, about)).wrap());
    let running = context.session().facts.ranking.is_some();
    let mut measure = fits.measure;
    ui.add_enabled_ui(!running, |ui| matching::metric(ui, &mut measure.metric));
    if measure != fits.measure {
        context.act(Action::Match(MatchCommand::Every(measure)));
    }
    theme::note(ui, fits.measure.unit());
    ui.add_space(6.0);
    if running {
        ui.horizontal(|ui| strip(ui, context));
        step(ui, context);
    }
    let Some(ranking) = &fits.ranking else { return };
    let list = ScrollArea::vertical().max_height(LIST).auto_shrink([false, true]);
    list.show(ui, |ui| {
        egui::Grid::new("fits").num_columns(3).striped(true).show(ui, |ui| {
            for head in ["error", "model", "parameters"] {
                ui.label(theme::small(ui, head));
            }
            ui.end_row();
            for matched in &ranking.matched {
                row(ui, matched, fits.shown, context);
                ui.end_row();
            }
        });
        for (model, why) in &ranking.left_out {
            ui.add(Label::new(theme::small(ui, format!("{}: {why}", name(context, model)))).wrap());
        }
    });
    if !ranking.unfinished.is_empty() {
        let count = ranking.unfinished.len();
        let are = if count == 1 { "is" } else { "are" };
        let text = format!("Cancelled: {} {are} not in the list.", plural(count, "model"));
        ui.horizontal(|ui| {
            ui.label(theme::small(ui, text));
            let again = ui.small_button("Fit again");
            context.on_click(&again, || Action::Match(MatchCommand::Every(fits.measure)));
        });
    }
}

fn name(context: &PanelContext<'_>, model: &'static str) -> &'static str {
    context.registry().model(model).map_or(model, |entry| entry.declaration.name)
}

/// The step of the fits, and the time that is left by the speed so far.
fn step(ui: &mut Ui, context: &PanelContext<'_>) {
    let Some(Running { done, step, .. }) = &context.session().facts.ranking else { return };
    let now = ui.input(|i| i.time);
    let begun = kept::with(ui.ctx(), |Begun(at, last): &mut Begun| {
        if *done < *last {
            *at = now;
        }
        *last = *done;
        *at
    });
    let left = time_left(*done, Duration::from_secs_f64((now - begun).max(0.0)));
    let left = left.map_or_else(String::new, |left| format!(", about {:.0} s left", left.as_secs_f32()));
    theme::note(ui, format!("{:.0} %{left} · {step}", 100.0 * done));
}

/// When the fits began, in seconds of the window, and how far they were in the last frame.
#[derive(Clone, Copy)]
struct Begun(f64, f32);

impl Default for Begun {
    fn default() -> Self {
        Self(0.0, 1.0)
    }
}

/// A parameter with its value, as in the inspector.
fn said(name: &'static str, value: &Value, context: &PanelContext<'_>) -> String {
    let Some(p) = context.registry().material_parameter(name) else { return format!("{name} {value}") };
    let option = if let Value::Choice(id) = value { p.kind.option(id) } else { None };
    option.map_or_else(|| format!("{} {value}", p.label), |option| format!("{} {option}", p.label))
}

/// A model with its error and its parameters.
fn row(ui: &mut Ui, matched: &Matched, shown: Option<&str>, context: &mut PanelContext<'_>) {
    /// Width of the parameters, in points.
    const WIDTH: f32 = 260.0;
    let Matched { model, found } = matched;
    ui.label(digits(found.after));
    let label = name(context, model);
    let is_shown = shown == Some(*model);
    let button = ui.add(Button::selectable(is_shown, label));
    theme::says_chosen(&button, WidgetType::Button, is_shown, format!("Show the fit of {label}"));
    context.on_click(&button, || Action::Match(MatchCommand::Show(model)));
    let values: Vec<_> = found.values.iter().map(|(name, value)| said(name, value, context)).collect();
    let all = values.join(", ");
    let short = theme::elided(ui, &all, TextStyle::Small, Palette::here(ui).weak, WIDTH);
    let label = ui.add(Label::new(short).sense(Sense::click()).show_tooltip_when_elided(false));
    context.on_click(&label, || Action::Match(MatchCommand::Show(model)));
    theme::tip(label, 320.0, |ui| _ = ui.label(all));
}

/// The progress of the fits, while their window is closed.
pub(super) fn progress(ui: &mut Ui, context: &mut PanelContext<'_>) {
    if context.session().fits.is_none() {
        strip(ui, context);
    }
}

fn strip(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let Some(now) = &context.session().facts.ranking else { return };
    let stop = "Stop the fits; those found until then are listed";
    if export::strip(ui, "Fitting every model", (now.done, &now.step), stop) {
        context.act(Action::Do(Effect::CancelMatch));
    }
}
