//! The chooser of measured materials.

use bevy_egui::egui::{self, Sense, Ui, vec2};

use crate::{
    panel::{
        chooser,
        knob::{self, Caption},
        maths,
        theme::{self, Palette},
    },
    parameter::Value,
    reflection::{Measured, ModelEntry, preset},
    registry::Registry,
    scene::Object,
};

/// The chooser of measured materials, for models that can be one. Returns the parameters of the chosen.
pub(super) fn measured(
    ui: &mut Ui,
    registry: &Registry,
    model: &ModelEntry,
    object: &Object,
) -> Option<Vec<(&'static str, Value)>> {
    let offered: Vec<_> = preset::all().iter().filter(|m| !(model.preset)(m).is_empty()).collect();
    if offered.is_empty() {
        return None;
    }
    let is = |m: &Measured| {
        (model.preset)(m)
            .iter()
            .all(|(name, value)| model.parameter(name).is_some_and(|p| object.material.get(p) == *value))
    };
    let present = offered.iter().find(|m| is(m)).copied();
    let caption = Caption {
        label: "measured material",
        help: "Sets the parameters below to those measured on a real material, and those of the other physically based models too. Shows “none” once one of them differs.",
        ..Caption::default()
    };
    let words = chooser::Words {
        label: "Search measured materials",
        hint: "Search materials",
        none: "No material has that in its name or source.",
        foot: "The numbers are F₀ over the whole spectrum, as red, green and blue; models that calculate with n and k at three wavelengths differ a little.",
    };
    let chosen =
        knob::list_knob(ui, "measured material", &caption, present.map_or("none", |m| m.name), |ui, id| {
            let height = 0.45 * ui.ctx().content_rect().height();
            let find = |search: &str| -> Vec<&'static Measured> {
                let hit =
                    |m: &&&'static Measured| chooser::matches(&[m.name, m.id, m.source].join(" "), search);
                offered.iter().filter(hit).copied().collect()
            };
            let entry = |m: &&'static Measured| chooser::Entry {
                heading: if m.metal { "Metals and semiconductors" } else { "Dielectrics" },
                name: m.name,
                note: m.f0.to_array().map(|v| format!("{v:.2}")).join("  "),
                number: None,
                swatch: Some(theme::swatch(m.f0)),
                current: present == Some(*m),
            };
            chooser::list(ui, id, words, height, find, entry, |ui, m| measurement(ui, m))
        });
    chosen.map(|material| crate::registry::along(model, material, registry))
}

/// The measured values of a material, and their source.
fn measurement(ui: &mut Ui, material: &Measured) {
    let palette = Palette::here(ui);
    ui.label(theme::strong(ui, material.name));
    egui::Grid::new("measurement").num_columns(5).spacing(vec2(14.0, 3.0)).show(ui, |ui| {
        ui.label("");
        for wavelength in ["630 nm", "532 nm", "465 nm"] {
            ui.label(theme::small(ui, wavelength));
        }
        ui.end_row();
        let rows = [("n", material.n), ("k", material.k), ("F_0", material.f0.to_array())];
        for (symbol, values) in rows {
            maths::symbol(ui, symbol, 15.0);
            for v in values {
                // The k of glass and water is about 10⁻⁸.
                let text = if v > 0.0 && v < 5e-4 {
                    format!("{v:.0e}").replace('-', "−")
                } else {
                    format!("{v:.3}")
                };
                ui.label(text);
            }
            if symbol == "F_0" {
                let (rect, _) = ui.allocate_exact_size(vec2(30.0, 16.0), Sense::hover());
                let stroke = egui::Stroke::new(1.0, palette.weak);
                ui.painter().rect(rect, 3.0, theme::swatch(material.f0), stroke, egui::StrokeKind::Inside);
            }
            ui.end_row();
        }
    });
    ui.label(theme::small(ui, "F₀ is a linear sRGB colour of the whole spectrum"));
    ui.label(theme::small(ui, format!("Measured by {}", material.source)));
}
