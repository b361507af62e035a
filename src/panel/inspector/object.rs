//! The properties of an object.

use bevy_egui::egui::{Align, Layout, Ui};

use super::{
    model::{equation, missing_model, model_author, model_name, stage, terms},
    part::{header, position_limits, section, thrice},
    variant::marked,
};
use crate::{
    document::{Edit, ObjectField, Selection, VariantField},
    panel::{
        knob::{self, Caption},
        linked::{self, Domain},
        model_override,
        state::{Action, Session},
        theme,
    },
    parameter::Value,
    reflection::{ModelEntry, usage},
    registry::Registry,
    scene::{Object, Variant, limits},
    shading::ShadingEntry,
};

pub(super) fn object(
    ui: &mut Ui,
    session: &Session,
    registry: &Registry,
    i: usize,
    actions: &mut Vec<Action>,
) {
    let Some(object) = session.scene().objects.get(i) else { return };
    header(ui, session, registry, Selection::Object(i), object.name.as_deref(), actions);
    let model = registry.model(session.scene().model_of(object));
    let shown = Shown { session, registry, object, model };
    let mut fields = Vec::new();
    shown.files(ui, i, actions);
    section(ui, "Reflection", true, |ui| shown.reflection(ui, &mut fields, actions));
    section(ui, "Material", true, |ui| shown.material(ui, &mut fields, actions));
    section(ui, "Shape and position", true, |ui| {
        linked::within(ui, Domain::Shape, |ui| shown.geometry(ui, &mut fields, actions));
    });
    actions.extend(fields.into_iter().map(|field| Action::Edit(Edit::Object(i, field))));
}

/// The object that is shown, and its surroundings. The methods show it, and add new values of its fields.
pub(super) struct Shown<'a> {
    pub(super) session: &'a Session,
    pub(super) registry: &'a Registry,
    pub(super) object: &'a Object,
    pub(super) model: Option<&'a ModelEntry>,
}

impl Shown<'_> {
    /// The model with its equation and terms, and the stage that evaluates it.
    fn reflection(&self, ui: &mut Ui, fields: &mut Vec<ObjectField>, actions: &mut Vec<Action>) {
        let Self { session, registry, object, model } = *self;
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                fields.extend(model_override::control(ui, session, registry, object));
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
            None => missing_model(ui, session, registry, session.scene().model_of(object), actions),
        }
        if let Some(shading) = registry.shading_model(session.scene().shading_model_of(object)) {
            stage(ui, shading);
        }
    }

    /// The knobs of the parameters that only the shading model has.
    pub(super) fn shading(
        &self,
        ui: &mut Ui,
        model: &ModelEntry,
        shading: &ShadingEntry,
        fields: &mut Vec<ObjectField>,
    ) {
        let Self { object, .. } = *self;
        let own: Vec<_> = shading.parameters.iter().filter(|p| model.parameter(p.name).is_none()).collect();
        if own.is_empty() {
            return;
        }
        ui.add_space(4.0);
        ui.label(theme::small(ui, format!("{} shading", shading.declaration.name)));
        for p in own {
            let unused = usage::unused(shading.parameters, p, &object.material);
            if let Some(v) = knob::parameter_knob(ui, p.name, p, &object.material.get(p), unused.as_deref()) {
                fields.push(ObjectField::Material(p.name, v));
            }
        }
    }

    /// The object type, its size and its place.
    fn geometry(&self, ui: &mut Ui, fields: &mut Vec<ObjectField>, actions: &mut Vec<Action>) {
        let Self { session, registry, object, .. } = *self;
        let types: Vec<_> = registry.shapes().iter().map(|s| s.declaration).collect();
        let names: Vec<_> = types.iter().map(|d| d.name).collect();
        let chosen = types.iter().position(|d| d.id == object.object_type);
        let help = chosen.map_or("", |k| types[k].summary);
        let caption = Caption { label: "type", help, ..Caption::default() };
        if let Some(k) = knob::choice_knob(ui, "type", &caption, chosen.unwrap_or(usize::MAX), &names) {
            fields.push(ObjectField::Type(types[k].id.to_owned()));
        }
        self.shape(ui, fields);
        let caption = Caption { label: "size", unit: "m", help: "The largest extent.", ..Caption::default() };
        let size_limits = limits::object_size(session.document.scene_size);
        let default = f64::from(crate::scene::DEFAULT_SIZE);
        if let Some(v) =
            knob::number_knob(ui, "size", &caption, f64::from(object.size), Some(default), &size_limits)
        {
            fields.push(ObjectField::Size(v as f32));
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
            fields.push(ObjectField::Position(p));
        }
        let caption = Caption {
            label: "rotation",
            unit: "°",
            help: "Turned about x first, then y, then z of the room.",
            ..Caption::default()
        };
        if let Some(r) =
            knob::vector_knob(ui, "rotation", &caption, object.rotation, &thrice(limits::rotation()))
        {
            fields.push(ObjectField::Rotation(r));
        }
        if let Some(shape) = registry.shape(&object.object_type) {
            let d = shape.declaration;
            let caption = Caption { label: "tessellation", help: d.tessellation_help, ..Caption::default() };
            let value = f64::from(shape.tessellation(object.tessellation));
            let default = f64::from(d.default_tessellation);
            let own = |variant: &Variant| variant.tessellation.map(|_| VariantField::Tessellation(None));
            if let Some(v) = marked(ui, session, own, actions, |ui| {
                let limits = limits::tessellation(d);
                knob::number_knob(ui, "tessellation", &caption, value, Some(default), &limits)
            }) {
                fields
                    .push(ObjectField::Tessellation(Some(v as u32).filter(|n| *n != d.default_tessellation)));
            }
        }
    }

    /// The files that make the object what it is.
    fn files(&self, ui: &mut Ui, i: usize, actions: &mut Vec<Action>) {
        let Self { registry, object, .. } = *self;
        let Some(shape) = registry.shape(&object.object_type) else { return };
        for p in shape.parameters {
            if let Value::File(file) = object.shape.get(p)
                && linked::within(ui, Domain::Shape, |ui| knob::file_knob(ui, p, &file))
            {
                actions.push(Action::FileDialog(Selection::Object(i), p));
            }
        }
    }

    /// The knobs of the parameters of the object type; its files have theirs above.
    fn shape(&self, ui: &mut Ui, fields: &mut Vec<ObjectField>) {
        let Self { registry, object, .. } = *self;
        let Some(shape) = registry.shape(&object.object_type) else { return };
        for p in shape.parameters {
            if matches!(object.shape.get(p), Value::File(_)) {
                continue;
            }
            let unused = usage::unused(shape.parameters, p, &object.shape);
            let salt = format!("shape {}", p.name);
            if let Some(v) = knob::parameter_knob(ui, &salt, p, &object.shape.get(p), unused.as_deref()) {
                fields.push(ObjectField::Shape(p.name, v));
            }
        }
    }

    /// The values derived from those of the knobs.
    pub(super) fn readouts(&self, ui: &mut Ui, model: &ModelEntry) {
        let readouts =
            model.instantiate(&self.object.material, self.session.scene().display.encoding).readouts();
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
}
