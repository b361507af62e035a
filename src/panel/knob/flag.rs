//! The knob for a flag.

use bevy_egui::egui::{Ui, WidgetInfo, WidgetType};

use super::line::{CHOICE, Caption, Words, explain, head, knob, tooltip};

/// A flag: label at the left, checkbox at the right. Returns the new value.
pub fn flag_knob(ui: &mut Ui, caption: &Caption, on: bool) -> Option<bool> {
    let mut next = on;
    knob(ui, caption, |ui| {
        let (label, check) = head(ui, caption, Words::Leave(CHOICE), |ui| {
            ui.add_space(22.0);
            ui.checkbox(&mut next, "")
        });
        let enabled = caption.disabled.is_none();
        check.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, enabled, next, caption.label));
        for response in [label, check] {
            explain(response, |ui| tooltip(ui, caption, "", ""));
        }
        ui.add_space(4.0);
    });
    (next != on).then_some(next)
}
