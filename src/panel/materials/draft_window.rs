//! The dialog that asks for the name of a material to be saved.

use super::super::{draft, prelude::*, state::MaterialCommand};
use crate::{
    custom::id_of_name,
    materials::{EXTENSION, Material, NO_FOLDER, beside},
};

/// Id of the dialog.
pub(in crate::panel) const DRAFT: &str = "material draft";
/// Title of the dialog.
pub(in crate::panel) const TITLE: &str = "Save the material";
/// Height of the lines about the name, in points.
const SAID: f32 = 52.0;

/// The dialog.
pub(in crate::panel) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let Some(material) = &context.session().materials.draft else { return };
    let centre = context.area().rect.center();
    if !draft::window(ui, DRAFT, TITLE.to_owned(), centre, |ui| ask(ui, material, context)) {
        context.act(Action::Material(MaterialCommand::Cancel));
    }
}

fn ask(ui: &mut Ui, material: &Material, context: &mut PanelContext<'_>) {
    let palette = Palette::here(ui);
    let folder = context.registry().custom_folder().map(beside);
    let checked = id_of_name(&material.name).map_err(|bad| bad.to_string()).and_then(|id| {
        let folder = folder.ok_or(NO_FOLDER)?;
        Ok(folder.join(id).with_extension(EXTENSION))
    });
    ui.label("Name");
    let says = "Name of the material";
    let (response, typed) = draft::name_field(ui, DRAFT, says, &material.name, checked.is_ok());
    if let Some(name) = typed {
        context.act(Action::Material(MaterialCommand::Type(name)));
    }
    ui.add_space(2.0);
    // Fixed height for either message, so that nothing below moves.
    let room = vec2(ui.available_width(), SAID);
    ui.allocate_ui_with_layout(room, Layout::top_down(Align::Min), |ui| {
        ui.set_min_height(SAID);
        match &checked {
            Ok(path) => _ = theme::note(ui, format!("Will be written to {}", path.shown())),
            Err(why) => {
                let why = RichText::new(why).small().color(palette.error);
                icon::remark(ui, [14.0, 16.0], Severity::Error, Label::new(why).wrap());
            }
        }
    });
    let model = super::model_name(material, context.registry());
    let what =
        format!("It appears in the panel Materials, with the model {model} and the values of the object.");
    theme::note(ui, what);
    ui.add_space(12.0);
    let enter = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
    let [save, cancel] = draft::buttons(ui, "Save", checked.is_ok());
    if checked.is_ok() && (save.clicked() || enter) {
        context.act(Action::Material(MaterialCommand::Save));
    }
    context.on_click(&cancel, || Action::Material(MaterialCommand::Cancel));
    if enter && checked.is_err() {
        response.request_focus();
    }
}
