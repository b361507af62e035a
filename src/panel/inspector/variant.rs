//! Overrides of the active view of a comparison: a list at the top, and marks beside the knobs.

use bevy_egui::egui::{
    Align, Color32, CursorIcon, Id, Layout, Rect, Sense, Stroke, TextStyle, Ui, WidgetInfo, WidgetType, vec2,
};

use super::part::{Text, text_field};
use crate::{
    document::{Edit, VariantField},
    panel::{
        icon::{self, Icon},
        state::{Action, CompareCommand, Session},
        theme::{self, Palette},
    },
    reflection::usage::unused,
    registry::Registry,
    scene::{Scene, Variant, limits::number, variant::LETTERS},
    text::{listed, plural},
};

/// Says which view is shown here, and what it overrides. Nothing where the scene has no variants.
pub(super) fn variant(ui: &mut Ui, session: &Session, registry: &Registry, actions: &mut Vec<Action>) {
    if session.document.variants.is_empty() {
        return;
    }
    let palette = Palette::here(ui);
    let view = session.active();
    let letter = LETTERS[view];
    let Some(variant) = session.variant() else {
        ui.label(theme::small(ui, "View A: the scene itself. Views inherit from it."));
        ui.add_space(4.0);
        return;
    };
    let own = overridden(variant, registry);
    let all = session.document.overrides(view).map_or_else(Vec::new, |all| overridden(&all, registry));
    let used = |field: &VariantField| match field {
        VariantField::Material(name, _) => uses(session, name, registry),
        _ => true,
    };
    let (used, unused): (Vec<_>, Vec<_>) = all.into_iter().partition(|(.., field)| used(field));
    let merged = session.document.overrides(view).unwrap_or_default();
    let (same, rows): (Vec<_>, Vec<_>) =
        used.into_iter().partition(|(.., field)| is_as_a(session, &merged, field, registry));
    ui.horizontal(|ui| {
        ui.label(theme::strong(ui, format!("View {letter}")));
        ui.label(theme::small(ui, if rows.is_empty() { "as A" } else { "differs from A in" }));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let name = variant.name.as_deref().unwrap_or_default();
            let width = (ui.available_width() - 8.0).min(150.0);
            let label = format!("Name of view {letter}");
            text_field(ui, "view name", &label, name, "name", width, Text::Name, |text| {
                actions.push(Action::Edit(Edit::Variant(view - 1, VariantField::Name(text))));
            });
        });
    });
    // What it has from the view that it is based on is that view's to change.
    let mine = |field: &VariantField| own.iter().any(|(.., known)| known == field);
    for (name, value, field) in rows {
        let ink = [palette.text, palette.accent];
        row(ui, (&name, &value), ink, mine(&field).then_some(field), (view, variant), actions);
    }
    if !same.is_empty() {
        let text = format!("also set in {letter}, to what A has now");
        ui.label(theme::small(ui, text)).on_hover_text("It stays as it is here when A changes.");
        for (name, value, field) in same {
            let ink = [palette.weak, palette.line];
            row(ui, (&name, &value), ink, mine(&field).then_some(field), (view, variant), actions);
        }
    }
    if !unused.is_empty() {
        let names: Vec<_> = unused.iter().map(|(name, ..)| name.as_str()).collect();
        let text = format!("And {}, which the model does not use.", plural(unused.len(), "value"));
        ui.label(theme::small(ui, text)).on_hover_text(listed(&names, "and"));
    }
    if variant.based_on.is_some() {
        let name = variant.based_on.as_deref().unwrap_or_default();
        ui.label(theme::small(ui, format!("The rest is inherited from “{name}”.")));
    }
    ui.label(theme::small(
        ui,
        format!(
            "Model, shading, material, terms and display are changed in {letter} alone, for all objects."
        ),
    ));
    ui.add_space(4.0);
}

/// A line with something that the variant of a view sets, in the inks of the text and the mark; with a button that takes it
/// back if it is the variant's own `field`.
fn row(
    ui: &mut Ui,
    (name, value): (&str, &str),
    [ink, mark]: [Color32; 2],
    field: Option<VariantField>,
    (view, variant): (usize, &Variant),
    actions: &mut Vec<Action>,
) {
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let base = variant.based_on.as_deref().map_or("A".to_owned(), |base| format!("“{base}”"));
            let help = format!("{name}: back to {base}");
            let mine = field.is_some();
            if let Some(field) = field
                && icon::button(ui, Icon::Reset, &help).clicked()
            {
                actions.push(Action::Compare(CompareCommand::Reset(view, field)));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if mine {
                    bar(ui, ui.max_rect(), mark);
                }
                ui.add_space(8.0);
                let room = ui.available_width();
                let text = format!("{name}  {value}");
                let galley = theme::elided(ui, &text, TextStyle::Body, ink, room);
                let (rect, response) = ui.allocate_exact_size(galley.size(), Sense::hover());
                ui.painter().galley(rect.min, galley, ink);
                response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &text));
            });
        });
    });
}

/// True if view A has what a variant sets: nothing to be seen differs in it.
fn is_as_a(session: &Session, variant: &Variant, field: &VariantField, registry: &Registry) -> bool {
    let scene: &Scene = &session.document;
    let display = scene.display;
    match field {
        VariantField::Model(_) => {
            scene.shown().all(|o| variant.reflection_model.as_deref() == Some(scene.model_of(o)))
        }
        VariantField::ShadingModel(_) => {
            scene.shown().all(|o| variant.shading_model.as_deref() == Some(scene.shading_model_of(o)))
        }
        VariantField::Material(name, _) => registry
            .material_parameter(name)
            .is_some_and(|p| scene.shown().all(|o| o.material.get(p) == variant.material.get(p))),
        VariantField::Terms(_) => variant.terms == Some(session.terms_of(0)),
        VariantField::ToneMapping(_) => variant.tone_mapping == Some(display.tone_mapping),
        VariantField::Exposure(_) => variant.exposure == Some(display.exposure),
        VariantField::Encoding(_) => variant.encoding == Some(display.encoding),
        VariantField::Tessellation(_) => scene.shown().all(|o| {
            let shape = registry.shape(&o.object_type);
            variant.tessellation == shape.map(|shape| shape.tessellation(o.tessellation))
        }),
        _ => false,
    }
}

/// True if the model of a visible object of the active view has a parameter, and uses it.
fn uses(session: &Session, name: &str, registry: &Registry) -> bool {
    session.scene().shown().any(|object| {
        let model = registry.model(session.scene().model_of(object));
        let parameter = model.and_then(|model| Some((model, model.parameter(name)?)));
        parameter.is_some_and(|(model, p)| unused(model.parameters, p, &object.material).is_none())
    })
}

/// The mark of what is overridden.
fn bar(ui: &Ui, rect: Rect, ink: Color32) {
    let x = rect.left() + 1.5;
    ui.painter().vline(x, rect.shrink2(vec2(0.0, 3.0)).y_range(), Stroke::new(3.0, ink));
}

/// Everything that a variant overrides: its name, its value, and the field that takes it back.
fn overridden(variant: &Variant, registry: &Registry) -> Vec<(String, String, VariantField)> {
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String, field| rows.push((name.to_owned(), value, field));
    if let Some(id) = &variant.reflection_model {
        let name = registry.model(id).map_or(id.as_str(), |m| m.declaration.name);
        row("reflection model", name.to_owned(), VariantField::Model(None));
    }
    if let Some(id) = &variant.shading_model {
        let name = registry.shading_model(id).map_or(id.as_str(), |m| m.declaration.name);
        row("shading model", name.to_owned(), VariantField::ShadingModel(None));
    }
    for (name, value) in &variant.material.0 {
        if let Some(p) = registry.material_parameter(name) {
            row(p.label, value.to_string(), VariantField::Material(p.name, None));
        }
    }
    if let Some(terms) = variant.terms {
        row("terms", terms.id().to_owned(), VariantField::Terms(None));
    }
    if let Some(tone) = variant.tone_mapping {
        row("tone mapping", tone.name().to_owned(), VariantField::ToneMapping(None));
    }
    if let Some(ev) = variant.exposure {
        row("exposure", format!("{} EV", number(f64::from(ev))), VariantField::Exposure(None));
    }
    if let Some(encoding) = variant.encoding {
        row("encoding", encoding.id().to_owned(), VariantField::Encoding(None));
    }
    if let Some(count) = variant.tessellation {
        row("tessellation", count.to_string(), VariantField::Tessellation(None));
    }
    rows
}

/// Shows a knob with a mark at the left edge if the active view overrides its value; a click on the mark takes the
/// override back.
pub(super) fn marked<T>(
    ui: &mut Ui,
    session: &Session,
    overrides: impl FnOnce(&Variant) -> Option<VariantField>,
    actions: &mut Vec<Action>,
    add: impl FnOnce(&mut Ui) -> T,
) -> T {
    let top = ui.cursor().top();
    let out = add(ui);
    let Some(field) = session.variant().and_then(overrides) else { return out };
    let bottom = ui.min_rect().bottom();
    let left = ui.max_rect().left() - 10.0;
    let rect = Rect::from_x_y_ranges(left..=left + 8.0, top..=bottom.max(top));
    let clip = ui.clip_rect();
    ui.set_clip_rect(clip.with_min_x(clip.left().min(left)));
    let mark = ui.interact(rect, Id::new(("override", format!("{field:?}"))), Sense::click());
    mark.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, "Overridden: back to A"));
    let palette = Palette::here(ui);
    let width = if mark.hovered() { 4.0 } else { 3.0 };
    ui.painter().vline(
        left + 2.0,
        rect.shrink2(vec2(0.0, 3.0)).y_range(),
        Stroke::new(width, palette.accent),
    );
    ui.set_clip_rect(clip);
    if mark.clicked() {
        actions.push(Action::Compare(CompareCommand::Reset(session.active(), field)));
    }
    mark.on_hover_cursor(CursorIcon::PointingHand).on_hover_text("Set in this view alone. Click: back to A");
    out
}
