//! The chooser of materials: measured ones and, where a model has some, those of artists.

use crate::{
    panel::{
        chooser,
        knob::{self, Caption},
        maths,
        prelude::*,
    },
    parameter::Value,
    reflection::{Measured, ModelEntry, preset},
    scene::{
        Object,
        examples::{Look, looks},
    },
};

/// The chooser of materials, for models that can be one. Returns the parameters of the chosen.
pub(super) fn measured(
    ui: &mut Ui,
    registry: &Registry,
    model: &ModelEntry,
    object: &Object,
) -> Option<Vec<(&'static str, Value)>> {
    let measured = preset::all().iter().filter(|m| !(model.preset)(m).is_empty()).map(Offer::Measured);
    let looks = looks().iter().filter(|look| look.model == model.declaration.id).map(Offer::Look);
    let offered: Vec<_> = looks.chain(measured).collect();
    let (label, help) = match offered.first()? {
        Offer::Look(_) => (
            "material preset",
            "Sets the parameters below to those of a material: one that artists reach for, which sets all of them, or one that was measured. Shows “none” once one of them differs.",
        ),
        Offer::Measured(_) => (
            "measured material",
            "Sets the parameters below to those measured on a real material, and those of the other physically based models too. Shows “none” once one of them differs.",
        ),
    };
    let is = |offer: &Offer| {
        let set = |(name, value): &(&str, Value)| {
            model.parameter(name).is_some_and(|p| object.material.get(p) == *value)
        };
        offer.values(model).iter().all(set)
    };
    let present = offered.iter().position(is);
    let shown = present.map_or("none", |i| offered[i].name());
    let caption = Caption { salt: "measured material", ..Caption::new(label, "", help) };
    let chosen = knob::list_knob(ui, &caption, shown, |ui, id| {
        let height = 0.45 * ui.ctx().content_rect().height();
        let find = |search: &str| -> Vec<(usize, Offer)> {
            let hit = |(_, offer): &(usize, Offer)| chooser::matches(&offer.words(), search);
            offered.iter().copied().enumerate().filter(hit).collect()
        };
        let entry = |(i, offer): &(usize, Offer)| offer.entry(present == Some(*i));
        chooser::list(ui, id, WORDS, height, find, entry, |ui, (_, offer)| offer.about(ui))
    });
    chosen.map(|(_, offer)| match offer {
        Offer::Look(_) => offer.values(model),
        Offer::Measured(material) => crate::registry::along(model, material, registry),
    })
}

const WORDS: chooser::Words = chooser::Words {
    label: "Search materials",
    hint: "Search materials",
    none: "No material has that in its name or source.",
    foot: "The numbers are F₀ over the whole spectrum, as red, green and blue; models that calculate with n and k at three wavelengths differ a little.",
    roomy: false,
};

/// A material that can be chosen.
#[derive(Clone, Copy)]
enum Offer {
    /// One of artists, for this model alone.
    Look(&'static Look),
    /// One with measured optical constants.
    Measured(&'static Measured),
}

impl Offer {
    fn name(self) -> &'static str {
        match self {
            Self::Look(look) => &look.name,
            Self::Measured(m) => m.name,
        }
    }

    /// The words by which it is found.
    fn words(self) -> String {
        match self {
            Self::Look(look) => [&*look.name, &look.description].join(" "),
            Self::Measured(m) => [m.name, m.id, m.source].join(" "),
        }
    }

    /// The values of the model's parameters that it sets.
    fn values(self, model: &ModelEntry) -> Vec<(&'static str, Value)> {
        match self {
            Self::Look(look) => model.parameters.iter().map(|p| (p.name, look.material.get(p))).collect(),
            Self::Measured(m) => (model.preset)(m),
        }
    }

    fn entry(self, current: bool) -> chooser::Entry<'static> {
        let entry = chooser::Entry { name: self.name(), current, ..chooser::Entry::default() };
        match self {
            Self::Look(_) => chooser::Entry { heading: "For artists", ..entry },
            Self::Measured(m) => chooser::Entry {
                heading: if m.metal { "Metals and semiconductors" } else { "Dielectrics" },
                note: m.f0.to_array().map(|v| format!("{v:.2}")).join("  "),
                swatch: Some(theme::swatch(m.f0)),
                ..entry
            },
        }
    }

    /// The tooltip.
    fn about(self, ui: &mut Ui) {
        ui.label(theme::strong(ui, self.name()));
        match self {
            Self::Look(look) => _ = ui.label(&look.description),
            Self::Measured(m) => measurement(ui, m),
        }
    }
}

/// The measured values of a material, and their source.
fn measurement(ui: &mut Ui, material: &Measured) {
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
                let tiny = v > 0.0 && v < 5e-4;
                ui.label(if tiny { format!("{v:.0e}").replace('-', "−") } else { format!("{v:.3}") });
            }
            if symbol == "F_0" {
                let (rect, _) = ui.allocate_exact_size(vec2(30.0, 16.0), Sense::hover());
                let stroke = Stroke::new(1.0, Palette::here(ui).weak);
                ui.painter().rect(rect, 3.0, theme::swatch(material.f0), stroke, StrokeKind::Inside);
            }
            ui.end_row();
        }
    });
    ui.label(theme::small(ui, "F₀ is a linear sRGB colour of the whole spectrum"));
    ui.label(theme::small(ui, format!("Measured by {}", material.source)));
}
