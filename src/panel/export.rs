//! Exports: their menu, the progress of the running export, and shaders for the clipboard.

use bevy_egui::egui::ProgressBar;

use super::{prelude::*, state::Effect};
use crate::{
    export::{FORMS, Form, Request, shaders},
    text::capitalised,
};

/// Size of exported pictures, in pixels.
pub const SIZE: (u32, u32) = (1280, 720);

/// The tooltip of an export form: the result and its subject, as a sentence.
pub(super) fn help(session: &Session, form: &Form) -> String {
    match form.of_object.then(|| object(session)).flatten() {
        Some(i) => format!("{} The object is {}.", sentence(form), name(session, i)),
        None => sentence(form),
    }
}

/// The summary of a format as a sentence.
fn sentence(form: &Form) -> String {
    format!("{}.", capitalised(form.summary))
}

/// The object whose shader is exported: the selected one, or the first visible one.
#[must_use]
pub fn object(session: &Session) -> Option<usize> {
    match session.selection {
        Selection::Object(i) if i < session.document.objects.len() => Some(i),
        _ => session.document.objects.iter().position(|object| object.visible),
    }
}

fn name(session: &Session, i: usize) -> String {
    let object = &session.document.objects[i];
    object.name.as_ref().map_or_else(|| format!("the {}", object.object_type), |name| format!("“{name}”"))
}

/// The progress of the running export, with a button that stops it.
pub(super) fn progress(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let Some(export) = &context.session().facts.export else { return };
    let name = format!("Exporting as {}", export.label);
    if strip(ui, &name, (export.done, &export.step), "Stop the export; nothing of it stays on disk") {
        context.act(Action::Do(Effect::CancelExport));
    }
}

/// A running task: name, completed fraction, current step, and a stop button with the tooltip `stop`. Returns true if
/// the button was clicked.
pub(super) fn strip(ui: &mut Ui, name: &str, (done, step): (f32, &str), stop: &str) -> bool {
    /// In points.
    const WIDTH: f32 = 120.0;
    ui.label(theme::small(ui, name));
    let step = if step.is_empty() { "starting" } else { step };
    ui.add(ProgressBar::new(done).desired_width(WIDTH).desired_height(10.0)).on_hover_text(step);
    ui.add(Button::new(theme::small(ui, "Cancel")).small()).on_hover_text(stop).clicked()
}

/// The menu that copies the shader of the object to the clipboard, in each text-based shader language.
pub(super) fn copy_menu(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let Some(object) = object(session) else { return };
    let help = format!(
        "Copy the shader of {}, lit by the lights of this scene: alone, without what it does not use",
        name(session, object)
    );
    let menu = ui.menu_button("Copy as…", |ui| {
        for form in FORMS.iter().filter(|form| shaders::is_text(form)) {
            if ui.button(form.name).clicked() {
                context.actions.push(copied(form, object, session, registry));
                ui.close();
            }
        }
    });
    menu.response.on_hover_text(help);
}

/// The shader of an object for the clipboard, and the message about it.
fn copied(form: &Form, object: usize, session: &Session, registry: &Registry) -> Action {
    let scene = &session.document;
    let request = Request { scene, registry, stem: "scene", size: SIZE, object, point: None };
    match shaders::text(form, &request) {
        Ok(text) => Action::Copy(text, format!("Copied: {}.", form.name)),
        Err(error) => Action::Say(Severity::Error, format!("Not copied: {error}.")),
    }
}
