//! Values derived from those of the knobs.

use bevy_egui::egui::{self, Align, Sense, Stroke, Ui, WidgetInfo, WidgetType, vec2};

use super::line::{Caption, NUMBER, Words, head, unit};
use crate::{
    panel::{
        linked,
        theme::{self, Palette},
    },
    reflection::{Readout, ReadoutValue},
};

/// A derived value: symbol, label at least `indent` points from the left, and the value with a colour sample.
pub fn readout(ui: &mut Ui, readout: &Readout, indent: f32) {
    let palette = Palette::here(ui);
    let caption = Caption { symbol: readout.symbol, label: readout.label, indent, ..Caption::default() };
    let digits = |v: f32| format!("{v:.3}");
    let text = match readout.value {
        ReadoutValue::Number(v) => digits(v),
        ReadoutValue::Reflectance(rgb) => rgb.to_array().map(digits).join("  "),
    };
    let value = |ui: &mut Ui| {
        unit(ui, "");
        if let ReadoutValue::Reflectance(rgb) = readout.value {
            let (rect, _) = ui.allocate_exact_size(vec2(22.0, 14.0), Sense::hover());
            let stroke = Stroke::new(1.0, palette.weak);
            ui.painter().rect(rect, 3.0, theme::swatch(rgb), stroke, egui::StrokeKind::Inside);
        }
        let value = ui.label(&text);
        let spoken = format!("{}: {text}", readout.label);
        value.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &spoken));
        value
    };
    let tip = |ui: &mut Ui| {
        ui.set_max_width(300.0);
        ui.label(theme::strong(ui, readout.label));
        ui.label(readout.help);
    };
    let (label, value) = match readout.value {
        ReadoutValue::Number(_) => head(ui, &caption, Words::Leave(NUMBER), value),
        // Three numbers and the sample need a separate line.
        ReadoutValue::Reflectance(_) => {
            let spacing = std::mem::take(&mut ui.spacing_mut().item_spacing.y);
            let (label, ()) = head(ui, &caption, Words::Leave(0.0), |_| ());
            let row = vec2(ui.available_width(), 20.0);
            let layout = egui::Layout::right_to_left(Align::Center);
            let value = ui.allocate_ui_with_layout(row, layout, value).inner;
            ui.spacing_mut().item_spacing.y = spacing;
            (label, value)
        }
    };
    linked::touch(ui, label.rect.union(value.rect), &[readout.symbol]);
    label.on_hover_ui(tip);
    value.on_hover_ui(tip);
}
