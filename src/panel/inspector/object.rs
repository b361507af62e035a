//! The properties of an object.

use bevy_egui::egui::{Align, Layout, Ui};

use super::{
    measured::measured,
    model::{equation, missing_model, model_author, model_name, stage, terms},
    part::{header, position_limits, section, thrice},
};
use crate::{
    document::{Edit, ObjectField, Selection, limits},
    panel::{
        knob::{self, Caption},
        model_override,
        state::{Action, Session},
        theme,
    },
    reflection::{ModelEntry, usage},
    registry::Registry,
    scene::Object,
};

pub(super) fn object(
    ui: &mut Ui,
    session: &Session,
    registry: &Registry,
    i: usize,
    actions: &mut Vec<Action>,
) {
    let Some(object) = session.document.objects.get(i) else { return };
    let set: Set = &|field| Action::Edit(Edit::Object(i, field));
    header(ui, session, registry, Selection::Object(i), object.name.as_deref(), actions);

    let model = registry.model(session.document.model_of(object));
    section(ui, "Reflection", true, |ui| reflection(ui, session, registry, object, model, set, actions));
    section(ui, "Material", true, |ui| material(ui, session, registry, object, model, set, actions));
    section(ui, "Shape and position", true, |ui| geometry(ui, session, registry, object, set, actions));
}

/// An edit of the object from a new value of one of its fields.
type Set<'a> = &'a dyn Fn(ObjectField) -> Action;

/// The model with its equation and terms, and the stage that evaluates it.
fn reflection(
    ui: &mut Ui,
    session: &Session,
    registry: &Registry,
    object: &Object,
    model: Option<&ModelEntry>,
    set: Set,
    actions: &mut Vec<Action>,
) {
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            actions.extend(model_override::control(ui, session, registry, object).map(set));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                if let Some(model) = model {
                    model_name(ui, model);
                }
            });
        });
    });
    match model {
        Some(model) => {
            model_author(ui, model);
            equation(ui, model);
            terms(ui, session, registry, model, actions);
        }
        None => missing_model(ui, session, registry, session.document.model_of(object), actions),
    }
    if let Some(shading) = registry.shading_model(session.document.shading_model_of(object)) {
        stage(ui, shading);
    }
}

/// The knobs of the parameters of the model, and the parameters that it does not use.
fn material(
    ui: &mut Ui,
    session: &Session,
    registry: &Registry,
    object: &Object,
    model: Option<&ModelEntry>,
    set: Set,
    actions: &mut Vec<Action>,
) {
    let Some(model) = model else {
        ui.label(theme::small(ui, "The parameters come back with the model."));
        return;
    };
    if let Some(values) = measured(ui, registry, model, object) {
        actions.push(set(ObjectField::Preset(values)));
    }
    for p in model.parameters {
        let unused = usage::unused(model.parameters, p, &object.material);
        if let Some(v) = knob::parameter_knob(ui, p.name, p, &object.material.get(p), unused.as_deref()) {
            actions.push(set(ObjectField::Material(p.name, v)));
        }
    }
    if model.parameters.is_empty() {
        ui.label(theme::small(ui, "This model has no knobs."));
    }
    readouts(ui, session, model, object);
    let unused: Vec<_> = registry
        .material_parameters()
        .filter(|p| model.parameter(p.name).is_none() && object.material.0.contains_key(p.name))
        .collect();
    if !unused.is_empty() {
        let reason = format!("Not used by {}", model.declaration.name);
        ui.add_space(4.0);
        ui.label(theme::small(ui, format!("{reason} (values kept)")));
        ui.add_space(2.0);
        for p in unused {
            knob::parameter_knob(ui, p.name, p, &object.material.get(p), Some(&reason));
        }
    }
}

/// The object type, its size and its place.
fn geometry(
    ui: &mut Ui,
    session: &Session,
    registry: &Registry,
    object: &Object,
    set: Set,
    actions: &mut Vec<Action>,
) {
    let types: Vec<_> = registry.shapes().iter().map(|s| s.declaration).collect();
    let names: Vec<_> = types.iter().map(|d| d.name).collect();
    let chosen = types.iter().position(|d| d.id == object.object_type);
    let help = chosen.map_or("", |k| types[k].summary);
    let caption = Caption { label: "type", help, ..Caption::default() };
    if let Some(k) = knob::choice_knob(ui, "type", &caption, chosen.unwrap_or(usize::MAX), &names) {
        actions.push(set(ObjectField::Type(types[k].id.to_owned())));
    }
    let caption = Caption { label: "size", unit: "m", help: "The largest extent.", ..Caption::default() };
    let size_limits = limits::object_size(session.document.scene_size);
    let default = f64::from(crate::scene::DEFAULT_SIZE);
    if let Some(v) =
        knob::number_knob(ui, "size", &caption, f64::from(object.size), Some(default), &size_limits)
    {
        actions.push(set(ObjectField::Size(v as f32)));
    }
    let caption = Caption {
        label: "position",
        unit: "m",
        help: "Position of the centre; y is up, the origin is a corner of the room.",
        ..Caption::default()
    };
    if let Some(p) = knob::vector_knob(
        ui,
        "position",
        &caption,
        object.position,
        &position_limits(session.document.scene_size),
    ) {
        actions.push(set(ObjectField::Position(p)));
    }
    let caption = Caption {
        label: "rotation",
        unit: "°",
        help: "Turned about x first, then y, then z of the room.",
        ..Caption::default()
    };
    if let Some(r) = knob::vector_knob(ui, "rotation", &caption, object.rotation, &thrice(limits::rotation()))
    {
        actions.push(set(ObjectField::Rotation(r)));
    }
    if let Some(shape) = registry.shape(&object.object_type) {
        let d = shape.declaration;
        let caption = Caption { label: "tessellation", help: d.tessellation_help, ..Caption::default() };
        let value = f64::from(shape.tessellation(object.tessellation));
        let default = f64::from(d.default_tessellation);
        if let Some(v) =
            knob::number_knob(ui, "tessellation", &caption, value, Some(default), &limits::tessellation(d))
        {
            actions.push(set(ObjectField::Tessellation(
                Some(v as u32).filter(|n| *n != d.default_tessellation),
            )));
        }
    }
}

/// The values derived from those of the knobs.
fn readouts(ui: &mut Ui, session: &Session, model: &ModelEntry, object: &Object) {
    let readouts = model.instantiate(&object.material, session.document.display.encoding).readouts();
    if readouts.is_empty() {
        return;
    }
    ui.add_space(2.0);
    ui.label(theme::small(ui, "Derived values"));
    let indent = readouts.iter().map(|r| knob::symbol_column(ui, r.symbol)).fold(0.0, f32::max);
    for readout in &readouts {
        knob::readout(ui, readout, indent);
    }
    ui.add_space(4.0);
}
