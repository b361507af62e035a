//! The properties of an object.

use super::{
    model::{edit_code, equation, missing_model, model_author, model_name, parts, stage, terms},
    part::{header, knob_of, section, type_knob, vector},
    row,
    variant::marked,
};
use crate::{
    panel::{
        fits,
        knob::{self, Amount, Caption},
        linked::{self, Domain},
        model_override,
        prelude::*,
        state::{Effect, Pick},
    },
    parameter::Value,
    reflection::ModelEntry,
    scene::{Field, Key, Object, Variant, limits, part::Fields as _, rows::Row},
    shading::ShadingEntry,
};

/// What the picture lacks, and the remedy.
const NOT_DRAWN: &str = "Not drawn: the objects are too much for the window. Lower the tessellation of this one or of \
                         others, or hide others.";

pub(super) fn object(ui: &mut Ui, i: usize, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let Some(object) = session.scene().objects.get(i) else { return };
    header(ui, Selection::Object(i), object.name.as_deref(), context);
    if session.is_not_drawn(i) {
        not_drawn(ui);
    }
    let row = session.document.row(i);
    let (in_row, varied) = (row.is_some(), row.map_or_else(Vec::new, |row| fixed(&row, session, registry)));
    if in_row {
        row::which(ui, i, context);
        section(ui, "Row", true, |ui| row::row(ui, i, context));
    }
    let model = registry.model(session.scene().model_of(object));
    let shown = ObjectPanel { session, registry, part: Part::Object(i), object, model, varied };
    shown.files(ui, i, context);
    section(ui, "Reflection", true, |ui| shown.reflection(ui, context));
    section(ui, "Material", true, |ui| shown.material(ui, context));
    section(ui, "Shape and position", true, |ui| {
        linked::within(ui, Domain::Shape, |ui| shown.geometry(ui, context));
    });
    if !in_row {
        // Not the section of a row, which is open.
        section(ui, "Copies", false, |ui| row::row(ui, i, context));
    }
}

/// Says that the picture lacks the object.
fn not_drawn(ui: &mut Ui) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        icon::sign(ui, [16.0, 20.0], 6.0, Severity::Error);
        ui.add(Label::new(NOT_DRAWN).wrap());
    });
    ui.add_space(4.0);
}

/// The values of a row that its copies do not share. Those that the active view sets are its own.
fn fixed(row: &Row, session: &Session, registry: &Registry) -> Vec<Key> {
    let is_of_view = |key: &Key| {
        let sets = |variant: &Variant| matches!(key, Key::Material(_)) || variant.field(key.name()).is_some();
        session.variant().is_some_and(sets)
    };
    row.variables(registry).map(|one| one.key).filter(|key| !is_of_view(key)).collect()
}

/// The object that is shown, and its surroundings.
pub(super) struct ObjectPanel<'a> {
    pub(super) session: &'a Session,
    pub(super) registry: &'a Registry,
    pub(super) part: Part,
    pub(super) object: &'a Object,
    pub(super) model: Option<&'a ModelEntry>,
    /// The fields that differ from copy to copy of the object's row.
    pub(super) varied: Vec<Key>,
}

impl ObjectPanel<'_> {
    /// The reason why a value cannot be changed here.
    pub(super) fn fixed(&self, key: impl Into<Key>) -> Option<&'static str> {
        let why = "it differs from copy to copy: change its range or its list under “Row”, above";
        self.varied.contains(&key.into()).then_some(why)
    }

    /// The model with its equation and terms, and the stage that evaluates it.
    fn reflection(&self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let Self { session, registry, part, object, model, .. } = *self;
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let fixed = self.fixed(Object::reflection_model).or(self.fixed(Object::shading_model));
                let chosen = model_override::control(ui, session, registry, object, fixed);
                context.edits(chosen.map(|(field, id)| Edit::put(part, field, id)));
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    if let Some(model) = model {
                        model_name(ui, model);
                    }
                });
            });
        });
        match model {
            Some(model) => {
                ui.horizontal_wrapped(|ui| {
                    model_author(ui, model);
                    edit_code(ui, model.declaration.id, context);
                });
                let parts = parts(ui.ctx(), model, object);
                equation(ui, model, &parts);
                terms(ui, &parts, context);
                if model.declaration.measured {
                    fits::buttons(ui, context);
                }
            }
            None => missing_model(ui, session.scene().model_of(object), context),
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
        context: &mut PanelContext<'_>,
    ) {
        let Self { part, object, .. } = *self;
        let own: Vec<_> = shading.parameters.iter().filter(|p| model.parameter(p.name).is_none()).collect();
        if own.is_empty() {
            return;
        }
        ui.add_space(4.0);
        ui.label(theme::small(ui, format!("{} shading", shading.declaration.name)));
        for p in own {
            let value = knob_of(
                ui,
                p.name,
                p,
                (shading.parameters, &object.material),
                self.fixed(Key::Material(p.name)),
            );
            context.edits(value.map(|v| Edit::material(part, p.name, v)));
        }
    }

    /// The caption of a field of the object.
    fn caption(&self, field: Field) -> Caption<'static> {
        Caption { disabled: self.fixed(field), ..Caption::of(&field) }
    }

    /// The object type, its size and its place.
    fn geometry(&self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let Self { session, registry, part, object, .. } = *self;
        let types = registry.shapes().iter().map(|s| s.declaration);
        if let Some(id) = type_knob(
            ui,
            types.map(|d| [d.id, d.name, d.summary]),
            &object.object_type,
            self.fixed(Object::object_type),
        ) {
            context.edit(Edit::set(part, Object::object_type, id.to_owned()));
        }
        self.shape(ui, context);
        let room = session.document.scene_size;
        let [size, default] = [object.size, Object::default().size].map(f64::from);
        let caption = self.caption(Object::size);
        let limits = limits::object_size(room);
        let size = knob::number_knob(ui, &caption, Amount::new(size, Some(default), &limits));
        context.edits(size.map(|v| Edit::set(part, Object::size, v as f32)));
        context.edits(vector(ui, part, Object::position, object.position, room));
        // The axes are those of the room, which the documentation of the field leaves open.
        let help = "Turned about x first, then y, then z of the room.";
        let caption = Caption { help, ..self.caption(Object::rotation) };
        let limits = [0, 1, 2].map(|_| Object::rotation.limits());
        let rotation = knob::vector_knob(ui, &caption, object.rotation, &limits);
        context.edits(rotation.map(|v| Edit::set(part, Object::rotation, v)));
        if let Some(shape) = registry.shape(&object.object_type) {
            let d = shape.declaration;
            let disabled = self.fixed(Object::tessellation);
            let caption = Caption { disabled, ..Caption::new("tessellation", "", d.tessellation_help) };
            let value = f64::from(shape.tessellation(object.tessellation));
            let default = f64::from(d.default_tessellation);
            let chosen = marked(ui, Variant::tessellation, context, |ui| {
                let limits = limits::tessellation(d);
                knob::number_knob(ui, &caption, Amount::new(value, Some(default), &limits))
            });
            let number = |v: f64| Some(v as u32).filter(|n| *n != d.default_tessellation);
            context.edits(chosen.map(|v| Edit::put(part, Object::tessellation, number(v))));
        }
    }

    /// The files that make the object what it is.
    fn files(&self, ui: &mut Ui, i: usize, context: &mut PanelContext<'_>) {
        let Self { registry, object, .. } = *self;
        let Some(shape) = registry.shape(&object.object_type) else { return };
        for p in shape.parameters {
            if let Value::File(file) = object.shape.get(p)
                && linked::within(ui, Domain::Shape, |ui| knob::file_knob(ui, p, &file, None))
            {
                context.act(Action::Do(Effect::Pick(Pick::File(Selection::Object(i), Key::Own(p.name), p))));
            }
        }
    }

    /// The knobs of the parameters of the object type; its files have theirs above.
    fn shape(&self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let Self { registry, part, object, .. } = *self;
        let Some(shape) = registry.shape(&object.object_type) else { return };
        for p in shape.parameters {
            let salt = format!("shape {}", p.name);
            let value =
                knob_of(ui, &salt, p, (shape.parameters, &object.shape), self.fixed(Key::Own(p.name)));
            context.edits(value.map(|v| Edit::parameter(part, p.name, v)));
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
