//! The menu that saves and copies pictures.

use bevy_egui::egui::{Button, RichText, Ui};

use super::{
    keys::{self, Binding},
    menu::submenu,
    state::{Action, PictureCommand, Session, ViewChange},
    theme::Palette,
};
use crate::scene::variant::LETTERS;

/// Adds the submenu.
pub(super) fn menu(ui: &mut Ui, session: &Session, table: &[Binding], actions: &mut Vec<Action>) {
    submenu(ui, "Picture", |ui| {
        ui.set_width(232.0);
        let mut item = |ui: &mut Ui, text: &str, help: &str, command: PictureCommand| {
            let action = Action::Picture(command);
            let keys = RichText::new(keys::keys_of(table, &action)).color(Palette::here(ui).weak);
            if ui.add(Button::new(text).shortcut_text(keys)).on_hover_text(help).clicked() {
                actions.push(action);
                ui.close();
            }
        };
        let alone = !session.document.variants.is_empty();
        let letter = LETTERS.get(session.active()).copied().unwrap_or_default();
        let view = session.active();
        let (save, copy) = if alone { ("Save all views…", "Copy all views") } else { ("Save…", "Copy") };
        let file = "Write the picture as it is shown to a PNG file, without handles and labels. The file holds the scene, \
                    so it can be opened again.";
        item(ui, save, file, PictureCommand::Dialog(None));
        if alone {
            let help = "Write the picture of the active view to a PNG file";
            item(ui, &format!("Save view {letter} alone…"), help, PictureCommand::Dialog(Some(view)));
        }
        item(ui, copy, "Put the picture as it is shown on the clipboard", PictureCommand::Copy(None));
        if alone {
            let help = "Put the picture of the active view on the clipboard";
            item(ui, &format!("Copy view {letter} alone"), help, PictureCommand::Copy(Some(view)));
        }
        ui.separator();
        let mut caption = session.view.picture_caption;
        let help = "Add a strip below the picture: models, values that differ from the defaults, tone mapping, version";
        if ui.checkbox(&mut caption, "With a caption").on_hover_text(help).clicked() {
            actions.push(Action::View(ViewChange::PictureCaption(caption)));
        }
    });
}
