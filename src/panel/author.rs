//! Custom models and shaders: the dialog that names a new file, and the buttons that open files in an editor.

use std::ops::DerefMut;

use bevy_egui::egui::{self, Align, Button, Id, Key, Layout, RichText, TextEdit, Ui, vec2};

use super::{
    Panel, PanelContext, Place, draft, icon, is_panel,
    state::{Action, BUILT_IN, ModelCommand, ModelDraft, NameProblem, Over, Session, Severity, check_name},
    theme::{self, Palette},
};
use crate::files::Shown as _;
use crate::{custom::source_path, library::status::Trouble, registry::Registry};

/// Reacts to changes of the shaders since the last frame: unfolds the shader panel for a new problem, folds it after
/// the last one, and selects a requested model once it is available. Borrows `session` mutably only when something
/// changes.
pub fn notice_shaders(session: &mut impl DerefMut<Target = Session>, registry: &Registry) {
    // Without line and column: a problem that moves while the user types above it is not a new one.
    let words = |t: &Trouble| (t.problem.file.clone(), t.problem.message.clone());
    let now: Vec<_> = session.shaders.troubles.iter().map(words).collect();
    if now != session.seen_troubles {
        let session = &mut **session;
        if now.iter().any(|trouble| !session.seen_troubles.contains(trouble)) {
            session.unfold_shaders();
        } else if now.is_empty() {
            session.fold_shaders();
        }
        session.seen_troubles = now;
    }
    if session.wanted_model.as_ref().is_some_and(|id| registry.model(id).is_some())
        && let Some(id) = session.wanted_model.take()
    {
        let (edit, news) = (session.edit_model(&id), session.has_news());
        // An edit never requests a file.
        let _ = session.apply(Action::Edit(edit), registry);
        if news {
            session.keep_news();
        }
    }
}

/// The buttons about custom models, for the chooser and the panel.
pub fn buttons(ui: &mut Ui, session: &Session, registry: &Registry) -> Vec<Action> {
    let mut actions = Vec::new();
    let shown = registry.model(session.model_shown()).map(|m| m.declaration);
    let name = shown.map_or(session.model_shown(), |d| d.name);
    ui.horizontal_wrapped(|ui| {
        let new = ui.button("New model…").on_hover_text(
            "Writes a file with a small model that works, to be changed in an editor while the picture follows.",
        );
        if new.clicked() {
            actions.push(Action::Model(ModelCommand::New));
        }
        let copy = ui
            .add_enabled(shown.is_some(), Button::new("Duplicate as a file…"))
            .on_hover_text(format!("Writes {name} to a file as a custom model, to be changed in an editor."));
        if copy.clicked() {
            actions.push(Action::Model(ModelCommand::Duplicate));
        }
        let path = shown.map_or_else(|| source_path(session.model_shown()), |d| d.wgsl.path.to_owned());
        let file = session.shaders.folders.file_of(&path);
        let open = ui
            .add_enabled(file.is_some(), Button::new("Open in editor"))
            .on_disabled_hover_text(BUILT_IN)
            .on_hover_text(file.map_or_else(String::new, |f| f.shown().to_string()));
        if open.clicked() {
            actions.push(Action::Model(ModelCommand::EditShown));
        }
    });
    actions
}

/// The dialog that asks for the name of a new model.
pub(super) struct Draft;

impl Panel for Draft {
    is_panel!("model draft", "A new reflection model", Place::Over(Over::Window));

    fn is_open(&self, session: &Session) -> bool {
        session.draft.is_some()
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let (session, registry) = (context.session(), context.registry());
        let Some(draft) = &session.draft else {
            ui.data_mut(|d| d.remove::<bool>(Id::new(FOCUSED)));
            return;
        };
        let title = match &draft.of {
            Some(of) => {
                let name = registry.model(of).map_or(of.as_str(), |m| m.declaration.name);
                format!("{name} as a custom model")
            }
            None => self.title().to_owned(),
        };
        let mut actions = Vec::new();
        let ask = |ui: &mut Ui| actions = ask(ui, session, registry, draft);
        if !draft::window(ui, self.id(), title, context, ask) {
            actions.push(Action::Model(ModelCommand::Cancel));
        }
        context.actions.extend(actions);
    }
}

const FOCUSED: &str = "model draft focused";

fn ask(ui: &mut Ui, session: &Session, registry: &Registry, draft: &ModelDraft) -> Vec<Action> {
    let mut actions = Vec::new();
    let palette = Palette::here(ui);
    let checked = check_name(&draft.name, registry);
    ui.label("Name");
    let response = name_field(ui, draft, checked.is_ok(), &mut actions);
    ui.add_space(2.0);
    // Fixed height for either message, so that nothing below moves.
    let room = vec2(ui.available_width(), SAID);
    ui.allocate_ui_with_layout(room, Layout::top_down(Align::Min), |ui| {
        ui.set_min_height(SAID);
        actions.extend(said_of(ui, session, &checked));
    });
    let what = "It is selected once created, and listed under “Custom models”. The first lines of the file declare its name and \
                its parameters.";
    ui.add(egui::Label::new(theme::small(ui, what)).wrap());
    ui.add_space(12.0);
    let enter = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
    let line = vec2(ui.available_width(), 28.0);
    ui.allocate_ui_with_layout(line, Layout::right_to_left(Align::Center), |ui| {
        let mut button = Button::new(theme::strong(ui, "Create")).min_size(vec2(80.0, 28.0));
        if checked.is_ok() {
            button = button.fill(palette.chosen).stroke(egui::Stroke::new(1.0, palette.accent));
        }
        if ui.add_enabled(checked.is_ok(), button).clicked() || enter {
            actions.push(Action::Model(ModelCommand::Create));
        }
        if ui.add(Button::new("Cancel").min_size(vec2(80.0, 28.0))).clicked() {
            actions.push(Action::Model(ModelCommand::Cancel));
        }
    });
    if enter && checked.is_err() {
        response.request_focus();
    }
    actions
}

/// The field for the name. It takes the focus when the dialog opens.
fn name_field(ui: &mut Ui, draft: &ModelDraft, is_right: bool, actions: &mut Vec<Action>) -> egui::Response {
    let palette = Palette::here(ui);
    let mut text = draft.name.clone();
    let stroke = egui::Stroke::new(1.5, if is_right { palette.accent } else { palette.error });
    let id = Id::new("model draft id");
    let edit = TextEdit::singleline(&mut text)
        .id(id)
        .desired_width(f32::INFINITY)
        .frame(
            egui::Frame::new()
                .fill(palette.field)
                .stroke(stroke)
                .corner_radius(4.0)
                .inner_margin(egui::Margin::symmetric(6, 5)),
        )
        .show(ui);
    let response = edit.response.response;
    theme::names_field(&response, "Name of the model", [&draft.name, &text, ""]);
    if !ui.data_mut(|d| std::mem::replace(d.get_temp_mut_or_default(Id::new(FOCUSED)), true)) {
        response.request_focus();
        // Typing replaces the suggested name.
        theme::select_all(ui, id, &draft.name);
    }
    if response.changed() {
        actions.push(Action::Model(ModelCommand::Type(text)));
    }
    response
}

/// Height of the line about the name, in points.
const SAID: f32 = 68.0;

/// Shows the identifier made from a name, or why the name is invalid.
fn said_of(ui: &mut Ui, session: &Session, checked: &Result<String, NameProblem>) -> Option<Action> {
    let palette = Palette::here(ui);
    match checked {
        Ok(id) => {
            let path = session.shaders.folders.file_of(&source_path(id));
            let path = path.map_or_else(|| source_path(id), |p| p.shown().to_string());
            ui.label(
                RichText::new(format!("Identifier (also the file name): {id}")).small().color(palette.text),
            );
            ui.add(egui::Label::new(theme::small(ui, format!("Will be written to {path}"))).wrap());
        }
        Err(NameProblem { why, instead }) => {
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = 6.0;
                let (rect, _) = ui.allocate_exact_size(vec2(14.0, 16.0), egui::Sense::hover());
                icon::severity(ui.painter(), rect.center(), 5.5, Severity::Error, &palette);
                ui.add(egui::Label::new(RichText::new(why).small().color(palette.error)).wrap());
            });
            if let Some(id) = instead
                && ui.button(format!("Use “{id}”")).clicked()
            {
                return Some(Action::Model(ModelCommand::Type(id.clone())));
            }
        }
    }
    None
}
