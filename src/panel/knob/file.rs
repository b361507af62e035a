//! A knob for a file.

use bevy_egui::egui::{Ui, WidgetType};

use super::{
    Declared, Knob,
    line::{Caption, button, explain, knob, tooltip},
};
use crate::{
    files::Shown as _,
    parameter::{NamedFile, Parameter, Value, kind::file::File},
};

/// Another file is chosen in a dialog: see [`file_knob`].
impl Knob for File {
    fn show(&self, _: &mut Ui, _: &Declared, _: &Value) -> Option<Value> {
        None
    }
}

/// A file: label at the left, and at the right a button with the file name. Returns true if the user wants another
/// file.
pub fn file_knob(ui: &mut Ui, p: &Parameter, file: &NamedFile, disabled: Option<&str>) -> bool {
    let symbol = if p.symbol == p.name { "" } else { p.symbol };
    let caption = Caption { salt: p.name, symbol, disabled, ..Caption::new(p.label, "", p.help) };
    knob(ui, &caption, |ui| {
        let (label, button) = button(ui, &caption, file.name(), "…", WidgetType::Button);
        explain(label, |ui| tooltip(ui, &caption, "", ""));
        let place = file.path().map_or("part of the program".to_owned(), |path| path.shown().to_string());
        let clicked = button.on_hover_text(file.problem().unwrap_or(place)).clicked();
        ui.add_space(4.0);
        clicked
    })
}
