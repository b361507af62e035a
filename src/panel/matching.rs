//! Matching: the dialog that matches a view to view A, and the progress of the running match.

use super::{
    draft, export,
    prelude::*,
    segmented,
    state::{Effect, MatchCommand, MatchDraft},
};
use crate::matching::{Metric, What};

/// Height of the description of an option, in points: the same for all, so that nothing moves.
const SENTENCE: f32 = 34.0;
/// Maximum height of the parameter list, in points.
const LIST: f32 = 240.0;
/// Id of the dialog.
pub(super) const DRAFT: &str = "match draft";

/// Letter of a view.
fn letter(view: usize) -> &'static str {
    LETTERS[view.min(MAX_VARIANTS)]
}

/// The entry in the menu of a view. Returns true if clicked.
pub(super) fn entry(ui: &mut Ui, view: usize) -> bool {
    let button = ui.add(Button::new(format!("Match {} to A…", letter(view))).frame(false));
    let help = format!(
        "Searches for the parameters of view {} that come nearest to view A, and sets them. One step of the history.",
        letter(view)
    );
    button.on_hover_text(help).clicked()
}

/// The dialog about the match that is about to start.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let Some(draft) = &session.match_draft else { return };
    // The view may be gone, or show other models now.
    let now = crate::matching::parameters(&session.document, draft.view, registry);
    let is_right = now.iter().map(|(p, _)| p.name).eq(draft.parameters.iter().map(|(p, _)| p.name));
    let title = format!("Match {} to A", letter(draft.view));
    let (centre, asked) = (context.area().rect.center(), context.actions.len());
    if !is_right || !draft::window(ui, DRAFT, title, centre, |ui| ask(ui, draft, context)) {
        context.actions.truncate(asked);
        context.act(Action::Match(MatchCommand::Close));
    }
}

fn ask(ui: &mut Ui, draft: &MatchDraft, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let (mut next, now) = (draft.clone(), draft.measure);
    ui.horizontal(|ui| {
        ui.label("Compare the");
        let tip = |ui: &mut Ui, what: What| {
            ui.set_max_width(300.0);
            ui.label(what.summary());
        };
        next.measure.what =
            segmented::values(ui, "Compare", &What::ALL, now.what, What::id, tip).unwrap_or(now.what);
    });
    ui.add_space(2.0);
    let room = vec2(ui.available_width(), SENTENCE);
    ui.allocate_ui_with_layout(room, Layout::top_down(Align::Min), |ui| {
        ui.set_min_height(SENTENCE);
        theme::note(ui, now.what.summary());
    });
    if now.metric().is_some() {
        metric(ui, &mut next.measure.metric);
    }
    ui.add_space(8.0);
    ui.label(theme::strong(ui, format!("Free parameters of view {}", letter(draft.view))));
    let seen = session.document.seen(draft.view, registry).map(|(scene, _)| scene);
    parameters(ui, registry, seen.as_ref(), &mut next);
    ui.add_space(12.0);
    let [start, cancel] = draft::buttons(ui, "Match", draft.free().next().is_some());
    let start = start.on_disabled_hover_text("Free at least one parameter.");
    if draft::is_new(ui, DRAFT) {
        start.request_focus();
    }
    context.on_click(&start, || Action::Match(MatchCommand::Start));
    context.on_click(&cancel, || Action::Match(MatchCommand::Close));
    if next != *draft {
        context.act(Action::Match(MatchCommand::Change(next)));
    }
}

/// The choice of the metric.
pub(super) fn metric(ui: &mut Ui, now: &mut Metric) {
    ui.horizontal(|ui| {
        ui.label("Metric");
        let tip = |ui: &mut Ui, metric: Metric| {
            ui.set_max_width(300.0);
            ui.label(metric.summary());
            ui.label(theme::small(ui, metric.source().replace('*', "")));
        };
        *now = segmented::values(ui, "Metric", &Metric::ALL, *now, Metric::id, tip).unwrap_or(*now);
    });
}

/// The parameters of a view, each with its value and a box that frees it.
fn parameters(ui: &mut Ui, registry: &Registry, seen: Option<&Scene>, next: &mut MatchDraft) {
    ScrollArea::vertical().max_height(LIST).auto_shrink([false, true]).show(ui, |ui| {
        for (parameter, free) in &mut next.parameters {
            let now = seen.and_then(|scene| {
                let has =
                    |id: &str| registry.model(id).is_some_and(|m| m.parameter(parameter.name).is_some());
                let object = scene.shown().find(|object| has(scene.model_of(object)))?;
                Some(object.material.get(parameter).to_string())
            });
            ui.horizontal(|ui| {
                let name = format!("Free: {}", parameter.label);
                let check = ui.checkbox(free, parameter.label).on_hover_text(parameter.help);
                theme::says_chosen(&check, WidgetType::Checkbox, *free, name);
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    // The scroll bar floats over this margin.
                    ui.add_space(12.0);
                    ui.label(theme::small(ui, now.unwrap_or_default()));
                });
            });
        }
    });
}

/// The progress of the running match, with a button that stops it.
pub(super) fn progress(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let Some(now) = &context.session().facts.matching else { return };
    let name = format!("Matching {} to A", letter(now.label));
    if export::strip(ui, &name, (now.done, &now.step), "Stop the match; the view stays as it is") {
        context.act(Action::Do(Effect::CancelMatch));
    }
}
