//! Matching: the dialog that matches a view to view A, and the progress of the running match.

use bevy_egui::egui::{self, Align, Button, Id, Layout, ScrollArea, Ui, WidgetInfo, WidgetType, vec2};

use super::{
    Panel, PanelContext, Place, draft, export, is_panel,
    segmented::segmented,
    state::{Action, MatchCommand, MatchDraft, Over, Session},
    theme::{self, Palette},
};
use crate::{
    matching::What,
    registry::Registry,
    scene::{
        Scene,
        variant::{LETTERS, MAX_VARIANTS},
    },
};

/// Height of the description of an option, in points: the same for all, so that nothing moves.
const SENTENCE: f32 = 34.0;
/// Maximum height of the parameter list, in points.
const LIST: f32 = 240.0;
/// Key of the flag that the dialog has received the focus.
const FOCUSED: &str = "match draft focused";

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
pub(super) struct Draft;

impl Panel for Draft {
    is_panel!("match draft", "Match to A", Place::Over(Over::Window));

    fn is_open(&self, session: &Session) -> bool {
        session.match_draft.is_some()
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let (session, registry) = (context.session(), context.registry());
        let Some(draft) = &session.match_draft else {
            ui.data_mut(|d| d.remove::<bool>(Id::new(FOCUSED)));
            return;
        };
        // The view may be gone, or show other models now.
        let now = crate::matching::parameters(&session.document, draft.view, registry);
        let is_right = now.iter().map(|(p, _)| p.name).eq(draft.parameters.iter().map(|(p, _)| p.name));
        let mut actions = Vec::new();
        let title = format!("Match {} to A", letter(draft.view));
        let ask = |ui: &mut Ui| actions = ask(ui, session, registry, draft);
        if is_right && draft::window(ui, self.id(), title, context, ask) {
            context.actions.extend(actions);
        } else {
            context.act(Action::Match(MatchCommand::Close));
        }
    }
}

fn ask(ui: &mut Ui, session: &Session, registry: &Registry, draft: &MatchDraft) -> Vec<Action> {
    let palette = Palette::here(ui);
    let mut next = draft.clone();
    ui.horizontal(|ui| {
        ui.label("Compare the");
        let names = What::ALL.map(What::id);
        let at = What::ALL.iter().position(|what| *what == draft.what);
        let tip = |ui: &mut Ui, i: usize| {
            ui.set_max_width(300.0);
            ui.label(What::ALL[i].summary());
        };
        if let Some(i) = segmented(ui, "Compare", &names, at, tip) {
            next.what = What::ALL[i];
        }
    });
    ui.add_space(2.0);
    let room = vec2(ui.available_width(), SENTENCE);
    ui.allocate_ui_with_layout(room, Layout::top_down(Align::Min), |ui| {
        ui.set_min_height(SENTENCE);
        ui.add(egui::Label::new(theme::small(ui, draft.what.summary())).wrap());
    });
    ui.add_space(8.0);
    ui.label(theme::strong(ui, format!("Free parameters of view {}", letter(draft.view))));
    let seen = session.document.seen(draft.view, registry).map(|(scene, _)| scene);
    parameters(ui, registry, seen.as_ref(), &mut next);
    ui.add_space(12.0);
    let mut actions = Vec::new();
    let ready = draft.free().next().is_some();
    let line = vec2(ui.available_width(), 28.0);
    ui.allocate_ui_with_layout(line, Layout::right_to_left(Align::Center), |ui| {
        let mut button = Button::new(theme::strong(ui, "Match")).min_size(vec2(80.0, 28.0));
        if ready {
            button = button.fill(palette.chosen).stroke(egui::Stroke::new(1.0, palette.accent));
        }
        let start = ui.add_enabled(ready, button).on_disabled_hover_text("Free at least one parameter.");
        if !ui.data_mut(|d| std::mem::replace(d.get_temp_mut_or_default(Id::new(FOCUSED)), true)) {
            start.request_focus();
        }
        if start.clicked() {
            actions.push(Action::Match(MatchCommand::Start));
        }
        if ui.add(Button::new("Cancel").min_size(vec2(80.0, 28.0))).clicked() {
            actions.push(Action::Match(MatchCommand::Close));
        }
    });
    if next != *draft {
        actions.push(Action::Match(MatchCommand::Change(next)));
    }
    actions
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
                check.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, *free, &name));
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
pub(super) fn progress(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let Some(now) = &session.facts.matching else { return };
    let name = format!("Matching {} to A", letter(now.view));
    if export::strip(ui, &name, (now.done, &now.step), "Stop the match; the view stays as it is") {
        actions.push(Action::Match(MatchCommand::Cancel));
    }
}
