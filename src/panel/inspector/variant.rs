//! Overrides of the active view of a comparison: a list at the top, and marks beside the knobs.

use super::part::{Text, text_field};
use crate::{
    panel::prelude::*,
    reflection::usage::unused,
    scene::{Key, Variant, field::Kind, part::Fields as _},
    text::listed,
};

/// Says which view is shown here, and what it overrides. Nothing where the scene has no variants.
pub(super) fn variant(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    if session.document.variants.is_empty() {
        return;
    }
    let view = session.active();
    let Some(variant) = session.variant() else {
        ui.label(theme::small(ui, "View A: the scene itself. Views inherit from it."));
        ui.add_space(4.0);
        return;
    };
    let letter = LETTERS[view];
    let merged = session.document.overrides(view).unwrap_or_default();
    let used = |(.., key): &Row| match *key {
        Key::Material(name) => uses(session, name, registry),
        Key::Own(_) => true,
    };
    let (used, unused): (Vec<_>, Vec<_>) = overridden(&merged, registry).into_iter().partition(used);
    let (same, differing): (Vec<_>, Vec<_>) =
        used.into_iter().partition(|(.., key)| is_as_a(session, &merged, *key, registry));
    title(ui, (view, variant), if differing.is_empty() { "as A" } else { "differs from A in" }, context);
    let palette = Palette::here(ui);
    let own = overridden(variant, registry);
    let mut list = |ui: &mut Ui, all: Vec<Row>, ink: [Color32; 2]| {
        for (name, value, key) in all {
            // What it has from the view that it is based on is that view's to change.
            let mine = own.iter().any(|(.., known)| *known == key);
            row(ui, (&name, &value), ink, mine.then_some(key), (view, variant), context);
        }
    };
    list(ui, differing, [palette.text, palette.accent]);
    if !same.is_empty() {
        let text = format!("also set in {letter}, to what A has now");
        ui.label(theme::small(ui, text)).on_hover_text("It stays as it is here when A changes.");
        list(ui, same, [palette.weak, palette.line]);
    }
    if !unused.is_empty() {
        let names: Vec<_> = unused.iter().map(|(name, ..)| name.as_str()).collect();
        let text = format!("And {}, which the model does not use.", plural(unused.len(), "value"));
        ui.label(theme::small(ui, text)).on_hover_text(listed(&names, "and"));
    }
    if let Some(name) = &variant.based_on {
        ui.label(theme::small(ui, format!("The rest is inherited from “{name}”.")));
    }
    let text = format!(
        "Model, shading, material, terms and display are changed in {letter} alone, for all objects."
    );
    ui.label(theme::small(ui, text));
    ui.add_space(4.0);
}

/// The letter of a view, what is said of it, and its name.
fn title(ui: &mut Ui, (view, variant): (usize, &Variant), says: &str, context: &mut PanelContext<'_>) {
    let letter = LETTERS[view];
    ui.horizontal(|ui| {
        ui.label(theme::strong(ui, format!("View {letter}")));
        ui.label(theme::small(ui, says));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let name = variant.name.as_deref().unwrap_or_default();
            let width = (ui.available_width() - 8.0).min(150.0);
            let label = format!("Name of view {letter}");
            text_field(ui, "view name", &label, name, "name", width, Text::Name, |text| {
                context.edit(Edit::set(Part::Variant(view - 1), Variant::name, text));
            });
        });
    });
}

/// A line with something that the variant of a view sets, in the inks of the text and the mark; with a button that takes it
/// back if it is the variant's own `key`.
fn row(
    ui: &mut Ui,
    (name, value): (&str, &str),
    [ink, mark]: [Color32; 2],
    key: Option<Key>,
    (view, variant): (usize, &Variant),
    context: &mut PanelContext<'_>,
) {
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let base = variant.based_on.as_deref().map_or("A".to_owned(), |base| format!("“{base}”"));
            let help = format!("{name}: back to {base}");
            let mine = key.is_some();
            if let Some(key) = key
                && icon::button(ui, Icon::Reset, &help).clicked()
            {
                context.act(Action::Compare(CompareCommand::Reset(view, key)));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if mine {
                    // The mark of what is overridden.
                    let rect = ui.max_rect();
                    let length = rect.shrink2(vec2(0.0, 3.0)).y_range();
                    ui.painter().vline(rect.left() + 1.5, length, Stroke::new(3.0, mark));
                }
                ui.add_space(8.0);
                let room = ui.available_width();
                let text = format!("{name}  {value}");
                let galley = theme::elided(ui, &text, TextStyle::Body, ink, room);
                let (rect, response) = ui.allocate_exact_size(galley.size(), Sense::hover());
                ui.painter().galley(rect.min, galley, ink);
                theme::says(&response, WidgetType::Label, &text);
            });
        });
    });
}

/// True if view A has what a variant sets: nothing to be seen differs in it.
fn is_as_a(session: &Session, variant: &Variant, key: Key, registry: &Registry) -> bool {
    let scene: &Scene = &session.document;
    let is = |id: &str| variant.value(key) == Some(id.into());
    match key {
        Key::Material(name) => registry
            .material_parameter(name)
            .is_some_and(|p| scene.shown().all(|o| o.material.get(p) == variant.material.get(p))),
        key if key == Variant::reflection_model.into() => scene.shown().all(|o| is(scene.model_of(o))),
        key if key == Variant::shading_model.into() => scene.shown().all(|o| is(scene.shading_model_of(o))),
        key if key == Variant::terms.into() => is(session.terms_of(0).id()),
        key if key == Variant::tessellation.into() => scene.shown().all(|o| {
            let shape = registry.shape(&o.object_type);
            variant.tessellation == shape.map(|shape| shape.tessellation(o.tessellation))
        }),
        key => variant.value(key) == scene.display.value(key),
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

/// Something that a variant overrides: its name, its value, and its key.
type Row = (String, String, Key);

/// Everything that a variant overrides.
fn overridden(variant: &Variant, registry: &Registry) -> Vec<Row> {
    let mut rows = Vec::new();
    variant.each(&mut |field, held, _| {
        let declared = |name: &str| registry.material_parameter(name);
        for (name, value) in held.values().iter().flat_map(|values| &values.0) {
            let Some(p) = declared(name) else { continue };
            // Numbers have the digits that they have in the heading.
            let words = p.kind.limits().and_then(|_| p.kind.caption(p.label, value));
            let words = words.unwrap_or_else(|| value.to_string());
            rows.push((p.label.to_owned(), words, Key::Material(p.name)));
        }
        if let Some(value) = held.value().filter(|_| !matches!(field.kind, Kind::Text(_))) {
            rows.push((field.label().to_owned(), field.shown(&value, registry), Key::Own(field.key)));
        }
    });
    rows
}

/// Shows a knob with a mark at the left edge if the active view overrides its value; a click on the mark takes the
/// override back.
pub(super) fn marked<T>(
    ui: &mut Ui,
    key: impl Into<Key>,
    context: &mut PanelContext<'_>,
    add: impl FnOnce(&mut Ui) -> T,
) -> T {
    let top = ui.cursor().top();
    let out = add(ui);
    let key = key.into();
    let session = context.session();
    if session.variant().is_none_or(|variant| variant.value(key).is_none()) {
        return out;
    }
    let bottom = ui.min_rect().bottom();
    let left = ui.max_rect().left() - 10.0;
    let rect = Rect::from_x_y_ranges(left..=left + 8.0, top..=bottom.max(top));
    let clip = ui.clip_rect();
    ui.set_clip_rect(clip.with_min_x(clip.left().min(left)));
    let mark = ui.interact(rect, Id::new(("override", key)), Sense::click());
    theme::says(&mark, WidgetType::Button, "Overridden: back to A");
    let stroke = Stroke::new(if mark.hovered() { 4.0 } else { 3.0 }, Palette::here(ui).accent);
    ui.painter().vline(left + 2.0, rect.shrink2(vec2(0.0, 3.0)).y_range(), stroke);
    ui.set_clip_rect(clip);
    context.on_click(&mark, || Action::Compare(CompareCommand::Reset(session.active(), key)));
    mark.on_hover_cursor(CursorIcon::PointingHand).on_hover_text("Set in this view alone. Click: back to A");
    out
}
