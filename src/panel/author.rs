//! Custom models and shaders: the dialog that names a new file, and the buttons that open files in an editor.

use std::ops::DerefMut;

use super::{
    draft, keys,
    prelude::*,
    state::{BUILT_IN, CodeCommand, ModelDraft, NameProblem, check_name},
};
use crate::{custom::source_path, library::status::Trouble};

/// Reacts to changes of the shaders since the last frame: unfolds the shader panel for a new problem, folds it after
/// the last one, and selects a requested model once it is available. Borrows `session` mutably only when something
/// changes.
pub fn notice_shaders(session: &mut impl DerefMut<Target = Session>, registry: &Registry) {
    // Without line and column: a problem that moves while the user types above it is not a new one.
    let words = |t: &Trouble| (t.problem.file.clone(), t.problem.message.clone());
    let now: Vec<_> = session.shaders.troubles.iter().map(words).collect();
    if now != session.authoring.seen_troubles {
        let session = &mut **session;
        if now.iter().any(|trouble| !session.authoring.seen_troubles.contains(trouble)) {
            session.unfold_shaders();
        } else if now.is_empty() {
            session.fold_shaders();
        }
        session.authoring.seen_troubles = now;
    }
    if session.authoring.wanted_model.as_ref().is_some_and(|id| registry.model(id).is_some()) {
        session.choose_wanted_model(registry);
    }
}

/// The buttons about custom models, for the chooser and the panel.
pub fn buttons(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let shown = registry.model(session.model_shown()).map(|m| m.declaration);
    let name = shown.map_or(session.model_shown(), |d| d.name);
    ui.horizontal_wrapped(|ui| {
        let help = "Writes a file with a small model that works, to be changed in an editor while the picture follows.";
        let new = ui.button("New model…").on_hover_text(help);
        context.on_click(&new, || Action::Model(ModelCommand::New));
        let copy = ui.add_enabled(shown.is_some(), Button::new("Duplicate as a file…"));
        let help = format!("Writes {name} to a file as a custom model, to be changed in an editor.");
        context.on_click(&copy.on_hover_text(help), || Action::Model(ModelCommand::Duplicate));
        let path = shown.map_or_else(|| source_path(session.model_shown()), |d| d.wgsl.path.to_owned());
        let file = session.shaders.folders.file_of(&path);
        // Of a built-in model it offers a copy, as it does everywhere.
        let code = ui.add_enabled(file.is_some() || shown.is_some(), Button::new("Edit code"));
        let help = match file {
            Some(_) => "Opens the file here, in the panel Code",
            None => "Opens the code here, in the panel Code, once the built-in model is copied as a file",
        };
        let help = keys::hint(ui.ctx(), help, "code");
        let code = code.on_hover_text(help).on_disabled_hover_text("The file of this model is gone.");
        context.on_click(&code, || Action::Code(CodeCommand::Model));
        let open = ui.add_enabled(file.is_some(), Button::new("Open in editor"));
        let open = open.on_disabled_hover_text(BUILT_IN);
        let help = file.map_or_else(String::new, |f| f.shown().to_string());
        context.on_click(&open.on_hover_text(help), || Action::Model(ModelCommand::EditShown));
    });
}

/// Id of the dialog.
pub(super) const DRAFT: &str = "model draft";
/// Title of the dialog.
pub(super) const DRAFT_TITLE: &str = "A new reflection model";

/// The dialog that asks for the name of a new model.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let Some(draft) = &context.session().authoring.draft else { return };
    let title = match &draft.of {
        Some(of) => {
            let name = context.registry().model(of).map_or(of.as_str(), |m| m.declaration.name);
            format!("{name} as a custom model")
        }
        None => DRAFT_TITLE.to_owned(),
    };
    let centre = context.area().rect.center();
    if !draft::window(ui, DRAFT, title, centre, |ui| ask(ui, draft, context)) {
        context.act(Action::Model(ModelCommand::Cancel));
    }
}

fn ask(ui: &mut Ui, draft: &ModelDraft, context: &mut PanelContext<'_>) {
    let checked = check_name(&draft.name, context.registry());
    ui.label("Name");
    let response = name_field(ui, draft, checked.is_ok(), context);
    ui.add_space(2.0);
    // Fixed height for either message, so that nothing below moves.
    let room = vec2(ui.available_width(), SAID);
    ui.allocate_ui_with_layout(room, Layout::top_down(Align::Min), |ui| {
        ui.set_min_height(SAID);
        said_of(ui, &checked, context);
    });
    let what = "It is selected once created, and listed under “Custom models”. The first lines of the file declare its name and \
                its parameters.";
    theme::note(ui, what);
    ui.add_space(12.0);
    let enter = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
    let [create, cancel] = draft::buttons(ui, "Create", checked.is_ok());
    if create.clicked() || enter {
        context.act(Action::Model(ModelCommand::Create));
    }
    context.on_click(&cancel, || Action::Model(ModelCommand::Cancel));
    if enter && checked.is_err() {
        response.request_focus();
    }
}

/// The field for the name. It takes the focus when the dialog opens.
fn name_field(ui: &mut Ui, draft: &ModelDraft, is_right: bool, context: &mut PanelContext<'_>) -> Response {
    let (response, typed) = draft::name_field(ui, DRAFT, "Name of the model", &draft.name, is_right);
    if let Some(name) = typed {
        context.act(Action::Model(ModelCommand::Type(name)));
    }
    response
}

/// Height of the line about the name, in points.
const SAID: f32 = 68.0;

/// Shows the identifier made from a name, or why the name is invalid.
fn said_of(ui: &mut Ui, checked: &Result<String, NameProblem>, context: &mut PanelContext<'_>) {
    let palette = Palette::here(ui);
    match checked {
        Ok(id) => {
            let path = context.session().shaders.folders.file_of(&source_path(id));
            let path = path.map_or_else(|| source_path(id), |p| p.shown().to_string());
            let text = format!("Identifier (also the file name): {id}");
            ui.label(RichText::new(text).small().color(palette.text));
            theme::note(ui, format!("Will be written to {path}"));
        }
        Err(NameProblem { why, instead }) => {
            let why = RichText::new(why).small().color(palette.error);
            icon::remark(ui, [14.0, 16.0], Severity::Error, Label::new(why).wrap());
            if let Some(id) = instead
                && ui.button(format!("Use “{id}”")).clicked()
            {
                context.act(Action::Model(ModelCommand::Type(id.clone())));
            }
        }
    }
}
