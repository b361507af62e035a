//! The properties of an object.

use bevy_egui::egui::{Align, Layout, Ui};

use super::{
    model::{equation, missing_model, model_author, model_name, stage, terms},
    part::{header, knob_of, number, section, type_knob, vector},
    variant::marked,
};
use crate::{
    document::{Edit, Selection},
    panel::{
        knob::{self, Caption},
        linked::{self, Domain},
        model_override,
        state::{Action, Session},
        theme,
    },
    parameter::Value,
    reflection::ModelEntry,
    registry::Registry,
    scene::{Object, Part, Variant, limits},
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
    let shown = Shown { session, registry, part: Part::Object(i), object, model };
    let mut edits = Vec::new();
    shown.files(ui, i, actions);
    section(ui, "Reflection", true, |ui| shown.reflection(ui, &mut edits, actions));
    section(ui, "Material", true, |ui| shown.material(ui, &mut edits, actions));
    section(ui, "Shape and position", true, |ui| {
        linked::within(ui, Domain::Shape, |ui| shown.geometry(ui, &mut edits, actions));
    });
    actions.extend(edits.into_iter().map(Action::Edit));
}

/// The object that is shown, and its surroundings. The methods show it, and add edits of it.
pub(super) struct Shown<'a> {
    pub(super) session: &'a Session,
    pub(super) registry: &'a Registry,
    pub(super) part: Part,
    pub(super) object: &'a Object,
    pub(super) model: Option<&'a ModelEntry>,
}

impl Shown<'_> {
    /// The model with its equation and terms, and the stage that evaluates it.
    fn reflection(&self, ui: &mut Ui, edits: &mut Vec<Edit>, actions: &mut Vec<Action>) {
        let Self { session, registry, part, object, model } = *self;
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let chosen = model_override::control(ui, session, registry, object);
                edits.extend(chosen.map(|(field, id)| Edit::put(part, field, id)));
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
        edits: &mut Vec<Edit>,
    ) {
        let Self { part, object, .. } = *self;
        let own: Vec<_> = shading.parameters.iter().filter(|p| model.parameter(p.name).is_none()).collect();
        if own.is_empty() {
            return;
        }
        ui.add_space(4.0);
        ui.label(theme::small(ui, format!("{} shading", shading.declaration.name)));
        for p in own {
            if let Some(v) = knob_of(ui, p.name, p, shading.parameters, &object.material) {
                edits.push(Edit::material(part, p.name, v));
            }
        }
    }

    /// The object type, its size and its place.
    fn geometry(&self, ui: &mut Ui, edits: &mut Vec<Edit>, actions: &mut Vec<Action>) {
        let Self { session, registry, part, object, .. } = *self;
        let types = registry.shapes().iter().map(|s| s.declaration);
        if let Some(id) = type_knob(ui, types.map(|d| [d.id, d.name, d.summary]), &object.object_type) {
            edits.push(Edit::set(part, Object::object_type, id.to_owned()));
        }
        self.shape(ui, edits);
        let room = session.document.scene_size;
        let sizes = [object.size, Object::default().size];
        edits.extend(number(
            ui,
            part,
            Object::size,
            "The largest extent.",
            sizes,
            &limits::object_size(room),
        ));
        let help = "Position of the centre; y is up, the origin is a corner of the room.";
        edits.extend(vector(ui, part, Object::position, help, object.position, room));
        let help = "Turned about x first, then y, then z of the room.";
        edits.extend(vector(ui, part, Object::rotation, help, object.rotation, room));
        if let Some(shape) = registry.shape(&object.object_type) {
            let d = shape.declaration;
            let caption = Caption::new("tessellation", "", d.tessellation_help);
            let value = f64::from(shape.tessellation(object.tessellation));
            let default = f64::from(d.default_tessellation);
            if let Some(v) = marked(ui, session, Variant::tessellation, actions, |ui| {
                let limits = limits::tessellation(d);
                knob::number_knob(ui, "tessellation", &caption, value, Some(default), &limits)
            }) {
                edits.push(Edit::put(
                    part,
                    Object::tessellation,
                    Some(v as u32).filter(|n| *n != d.default_tessellation),
                ));
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
    fn shape(&self, ui: &mut Ui, edits: &mut Vec<Edit>) {
        let Self { registry, part, object, .. } = *self;
        let Some(shape) = registry.shape(&object.object_type) else { return };
        for p in shape.parameters {
            let salt = format!("shape {}", p.name);
            if let Some(v) = knob_of(ui, &salt, p, shape.parameters, &object.shape) {
                edits.push(Edit::parameter(part, p.name, v));
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
