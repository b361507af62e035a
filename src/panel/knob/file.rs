//! A knob for a file.

use bevy_egui::egui::{Button, RichText, Ui, WidgetInfo, WidgetType, vec2};

use super::line::{CHOICE, Caption, Words, explain, head, tooltip};
use crate::files::Shown as _;
use crate::{
    panel::{linked, theme::Palette},
    parameter::{NamedFile, Parameter},
};

/// A file: label at the left, and at the right a button with the file name. Returns true if the user wants another
/// file.
pub fn file_knob(ui: &mut Ui, p: &Parameter, file: &NamedFile) -> bool {
    let palette = Palette::here(ui);
    let caption = Caption { symbol: p.symbol, label: p.label, help: p.help, ..Caption::default() };
    let (label, button) = head(ui, &caption, Words::Leave(CHOICE), |ui| {
        ui.add_space(22.0);
        let width = (ui.available_width() - 4.0).clamp(80.0, 190.0);
        let button = Button::new(file.name()).right_text(RichText::new("…").color(palette.weak)).truncate();
        let button = ui.add_sized(vec2(width, 24.0), button);
        button.widget_info(|| {
            WidgetInfo::labeled(WidgetType::Button, true, format!("{}: {}", caption.label, file.name()))
        });
        button
    });
    linked::touch(ui, label.rect.union(button.rect), &[p.symbol]);
    explain(label, |ui| tooltip(ui, &caption, "", ""));
    let place = file.path().map_or("part of the program".to_owned(), |path| path.shown().to_string());
    let text = file.problem().unwrap_or(place);
    let clicked = button.on_hover_text(text).clicked();
    ui.add_space(4.0);
    clicked
}
