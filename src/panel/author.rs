//! Custom models and shaders: the question before a file is written, and the files that an editor can open.

use std::{ops::DerefMut, path::PathBuf};

use bevy_egui::egui::{
    self, Align, Button, Id, Key, Layout, RichText, TextEdit, Ui, WidgetInfo, Window, vec2,
};

use super::{
    icon,
    state::{Action, Effect, PictureArea, Session, Severity},
    theme::{self, Palette},
};
use crate::{
    custom::{id_of_name, source_path},
    library::status::{Reloaded, Trouble},
    reflection::law_report::LawReport,
    registry::Registry,
};

/// Id of the panel that shows the shaders.
pub const SHADER_TAB: &str = "shader";

/// A command about custom models and shaders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelCommand {
    /// Begin a new model: ask what it shall be called.
    New,
    /// Begin a copy of the shown model: ask what it shall be called.
    Duplicate,
    /// The name of the model, as typed.
    Type(String),
    /// Write the file of the model.
    Create,
    /// Do not write it.
    Cancel,
    /// Open the file of the shown model in an editor.
    EditShown,
    /// Open a file in an editor.
    Edit {
        /// The file.
        path: PathBuf,
        /// The line to go to, from 1.
        line: usize,
    },
    /// Try to find the laws of the shown model broken.
    CheckLaws,
    /// Choose a folder and write the shaders into it.
    ExportDialog,
    /// Write the shaders into a folder.
    Export(PathBuf),
}

/// A model that is about to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelDraft {
    /// Id of the model that is copied; none for a new one.
    pub of: Option<String>,
    /// Its name, as typed; its identifier follows.
    pub name: String,
}

/// A check of the laws of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct LawCheck {
    /// The id of the model.
    pub model: String,
    /// The change that the picture showed when the check began: a later one makes it out of date.
    pub since: Option<Reloaded>,
    /// The findings, or why there are none; nothing while the check runs.
    pub outcome: Option<Result<LawReport, String>>,
}

/// The reason why a name can't be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameProblem {
    /// A sentence.
    pub why: String,
    /// An identifier that is near to it and free.
    pub instead: Option<String>,
}

/// The identifier for a new model that is to be called by a name.
///
/// # Errors
/// The rule that the name breaks, and a name that would do.
pub fn check_name(name: &str, registry: &Registry) -> Result<String, NameProblem> {
    let problem = |why: String, instead: Option<String>| Err(NameProblem { why, instead });
    if name.trim().is_empty() {
        return problem("Type a name, such as My velvet.".to_owned(), None);
    }
    let id = match id_of_name(name) {
        Ok(id) => id,
        Err(bad) => {
            let instead = bad.instead.map(|id| free_id(&id, registry));
            let hint = instead.as_ref().map_or_else(String::new, |id| format!(": “{id}” would do"));
            let rule = "Only letters a–z, digits and spaces, beginning with a letter, at most 40";
            return problem(format!("{rule}{hint}."), instead);
        }
    };
    // A file that gives no model is a file too.
    let taken = if registry.model(&id).is_some() {
        format!("There is already a model “{id}”")
    } else if registry.broken_model(&id).is_some() {
        format!("There is already a file {}", source_path(&id))
    } else {
        return Ok(id);
    };
    let free = free_id(&id, registry);
    problem(format!("{taken}; “{free}” is free."), Some(free))
}

/// An id that no model has: the one given, or that with a number.
fn free_id(id: &str, registry: &Registry) -> String {
    let taken = |id: &str| registry.model(id).is_some() || registry.broken_model(id).is_some();
    let numbered = (2..).map(|n| format!("{id}_{n}"));
    std::iter::once(id.to_owned()).chain(numbered).find(|id| !taken(id)).unwrap_or_default()
}

/// Looks at what changed about the shaders since the last frame: a new problem unfolds the panel that tells of it,
/// and a model that was asked for is chosen once it is there. `session` is borrowed mutably only when something
/// changes.
pub fn notice_shaders(session: &mut impl DerefMut<Target = Session>, registry: &Registry) {
    // Without line and column: a problem that moves while one types above it is not a new one.
    let words = |t: &Trouble| (t.problem.file.clone(), t.problem.message.clone());
    let now: Vec<_> = session.shaders.troubles.iter().map(words).collect();
    if now != session.seen_troubles {
        let session = &mut **session;
        if now.iter().any(|trouble| !session.seen_troubles.contains(trouble)) {
            session.view.unfold(SHADER_TAB);
        }
        session.seen_troubles = now;
    }
    if session.wanted_model.as_ref().is_some_and(|id| registry.model(id).is_some())
        && let Some(id) = session.wanted_model.take()
    {
        let (edit, news) = (session.edit_model(&id), session.has_news());
        // An edit asks for no file.
        let _ = session.apply(Action::Edit(edit), registry);
        if news {
            session.keep_news();
        }
    }
}

impl Session {
    /// Carries out what is asked about custom models and shaders.
    pub(super) fn author(&mut self, ask: ModelCommand, registry: &Registry) -> Vec<Effect> {
        match ask {
            ModelCommand::New => {
                self.draft = Some(ModelDraft { of: None, name: free_id("my_model", registry) })
            }
            ModelCommand::Duplicate => {
                let of = self.model_shown().to_owned();
                if registry.model(&of).is_none() {
                    self.say(Severity::Warning, format!("The model “{of}” is not there to be copied."));
                    return Vec::new();
                }
                let name = free_id(&format!("my_{}", of.trim_start_matches("my_")), registry);
                self.draft = Some(ModelDraft { of: Some(of), name });
            }
            ModelCommand::Type(text) => {
                if let Some(draft) = &mut self.draft {
                    draft.name = text;
                }
            }
            ModelCommand::Create => return self.create(registry),
            ModelCommand::Cancel => self.draft = None,
            ModelCommand::EditShown => return self.edit_shown(registry),
            ModelCommand::Edit { path, line } => return vec![Effect::OpenInEditor { path, line }],
            ModelCommand::CheckLaws => return self.check_laws(),
            ModelCommand::ExportDialog => return vec![Effect::PickShaderFolder],
            ModelCommand::Export(folder) => return vec![Effect::ExportShaders(folder)],
        }
        Vec::new()
    }

    fn create(&mut self, registry: &Registry) -> Vec<Effect> {
        // What is wrong stands beside the field.
        let checked = self.draft.as_ref().and_then(|draft| check_name(&draft.name, registry).ok());
        let Some((id, draft)) = checked.and_then(|id| Some((id, self.draft.take()?))) else {
            return Vec::new();
        };
        let ModelDraft { of, name } = draft;
        let name = name.trim().to_owned();
        vec![match of {
            Some(model) => Effect::DuplicateModel { model, id, name },
            None => Effect::NewModel { id, name },
        }]
    }

    fn check_laws(&mut self) -> Vec<Effect> {
        let running = self.laws.as_ref().is_some_and(|check| check.outcome.is_none());
        if running {
            return Vec::new();
        }
        let model = self.model_shown().to_owned();
        self.laws = Some(LawCheck { model: model.clone(), since: self.shaders.last.clone(), outcome: None });
        vec![Effect::CheckLaws(model)]
    }

    /// Takes what a check of the laws of a model found.
    pub fn laws_checked(&mut self, model: &str, outcome: Result<LawReport, String>) {
        if let Some(check) = self.laws.as_mut().filter(|check| check.model == model) {
            check.outcome = Some(outcome);
        }
    }

    fn edit_shown(&mut self, registry: &Registry) -> Vec<Effect> {
        let id = self.model_shown();
        let path = registry.model(id).map_or_else(|| source_path(id), |m| m.declaration.wgsl.path.to_owned());
        match self.shaders.folders.file_of(&path) {
            Some(file) => vec![Effect::OpenInEditor { path: file, line: self.line_of_trouble(&path) }],
            None => {
                self.say(Severity::Info, BUILT_IN);
                self.view.unfold(SHADER_TAB);
                Vec::new()
            }
        }
    }

    /// The line of the first problem in a file; 1 when there is none.
    #[must_use]
    pub fn line_of_trouble(&self, path: &str) -> usize {
        self.shaders.troubles.iter().find(|t| t.problem.file == path).map_or(1, |t| t.problem.line)
    }
}

/// The reason why a file can't be opened.
pub const BUILT_IN: &str = "The shaders are built in, so there is no file to open. Export the shaders first: \
     Edit, “Export shaders for editing…”. Or copy the model as a file.";

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
            .on_hover_text(file.map_or_else(String::new, |f| f.display().to_string()));
        if open.clicked() {
            actions.push(Action::Model(ModelCommand::EditShown));
        }
    });
    actions
}

/// Asks what a new model shall be called, while there is a draft. Stands in nobody's way.
pub fn show(ctx: &egui::Context, session: &Session, area: &PictureArea, registry: &Registry) -> Vec<Action> {
    let Some(draft) = &session.draft else {
        ctx.data_mut(|d| d.remove::<bool>(Id::new(FOCUSED)));
        return Vec::new();
    };
    let mut actions = Vec::new();
    let title = match &draft.of {
        Some(of) => {
            let name = registry.model(of).map_or(of.as_str(), |m| m.declaration.name);
            format!("{name} as a custom model")
        }
        None => "A new reflection model".to_owned(),
    };
    let mut open = true;
    Window::new(RichText::new(title).heading())
        .id(Id::new("model draft"))
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .default_width(440.0)
        .pivot(egui::Align2::CENTER_CENTER)
        .default_pos(area.rect.center())
        .show(ctx, |ui| {
            ui.set_width(440.0);
            actions.extend(ask(ui, session, registry, draft));
        });
    if !open || ctx.input(|i| i.key_pressed(Key::Escape)) {
        actions.push(Action::Model(ModelCommand::Cancel));
    }
    actions
}

const FOCUSED: &str = "model draft focused";

fn ask(ui: &mut Ui, session: &Session, registry: &Registry, draft: &ModelDraft) -> Vec<Action> {
    let mut actions = Vec::new();
    let palette = Palette::here(ui);
    let checked = check_name(&draft.name, registry);
    ui.label("Name");
    let mut text = draft.name.clone();
    let stroke = match &checked {
        Ok(_) => egui::Stroke::new(1.5, palette.accent),
        Err(_) => egui::Stroke::new(1.5, palette.error),
    };
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
    response.widget_info(|| {
        let mut info = WidgetInfo::text_edit(true, &draft.name, &text, "");
        info.label = Some("Name of the model".to_owned());
        info
    });
    if !ui.data_mut(|d| std::mem::replace(d.get_temp_mut_or_default(Id::new(FOCUSED)), true)) {
        response.request_focus();
        // Typing replaces the proposal.
        let mut state = edit.state;
        let all = egui::text::CCursorRange::two(
            egui::text::CCursor::new(0),
            egui::text::CCursor::new(draft.name.chars().count()),
        );
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), id);
    }
    if response.changed() {
        actions.push(Action::Model(ModelCommand::Type(text)));
    }
    ui.add_space(2.0);
    // The room for either, so that nothing moves between them.
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

/// The height of what is said of a name, points.
const SAID: f32 = 68.0;

/// What becomes of a name, or why nothing does.
fn said_of(ui: &mut Ui, session: &Session, checked: &Result<String, NameProblem>) -> Option<Action> {
    let palette = Palette::here(ui);
    match checked {
        Ok(id) => {
            let path = session.shaders.folders.file_of(&source_path(id));
            let path = path.map_or_else(|| source_path(id), |p| p.display().to_string());
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_taken_as_the_command_line_takes_them_and_the_message_says_one_that_would_do() {
        let registry = Registry::builtin();
        for (good, id) in [
            ("my_velvet", "my_velvet"),
            ("x", "x"),
            ("Student toon", "student_toon"),
            ("  My  GGX-2 (test)! ", "my_ggx_2_test"),
            ("a__b", "a__b"),
        ] {
            assert_eq!(check_name(good, &registry).as_deref(), Ok(id), "{good}");
            assert_eq!(id_of_name(good).as_deref(), Ok(id), "{good}");
        }
        for (bad, word) in [
            ("", "such as My velvet"),
            ("2 fast", "“fast” would do"),
            ("../evil", "“evil” would do"),
            ("velvet.wgsl", "“velvet_wgsl” would do"),
            ("größe", "“groesse” would do"),
            ("Évolué", "“evolue” would do"),
            ("漢字", "“han_zi” would do"),
            ("42", "at most 40."),
            (&"x".repeat(41), &format!("“{}” would do", "x".repeat(40))),
        ] {
            let said = check_name(bad, &registry).expect_err(bad).why;
            assert!(said.contains(word), "{bad}: {said}");
            assert!(id_of_name(bad).is_err(), "{bad}");
        }
        let said = check_name("Phong", &registry).expect_err("there is one");
        assert_eq!(said.why, "There is already a model “phong”; “phong_2” is free.");
        assert_eq!(said.instead.as_deref(), Some("phong_2"));
        assert!(check_name(&"x".repeat(40), &registry).is_ok());
        let mut registry = Registry::builtin();
        registry.mark_broken("my_velvet", "why".to_owned());
        let said = check_name("My velvet", &registry).expect_err("there is a file");
        assert_eq!(said.why, "There is already a file models/my_velvet.wgsl; “my_velvet_2” is free.");
    }
}
