//! The parts of a scene, each read from its JSON object by the declarations of its fields. A value that cannot be read
//! becomes not-a-number or the default.

use glam::Vec3;

use super::{Reader, keys::scene_keys};
use crate::{
    light::LightEntry,
    parameter::{Parameter, Value, Values, kind::colour},
    scene::{
        Field, Light, Object, Repeat, Repetition, Scene, Variant, Varied, check,
        declaration::Declared,
        field::{Absent, Ids, Kind},
        part::Structure,
        rows::Variable,
    },
    shape::ShapeEntry,
    text::json::{Ast, Cursor, Fields, Reader as _},
};

impl Reader<'_> {
    pub(super) fn scene(&mut self, root: Cursor) -> Scene {
        let mut scene = Scene { name: None, description: None, ..Scene::default() };
        let Some(fields) = self.fields(root, &scene_keys(), Scene::WHAT) else { return scene };
        if let Some(value) = fields.get("$schema") {
            self.string(value, "the address of the schema must be text");
        }
        match fields.get(Scene::scene_size.key) {
            None => {
                let [x, y, z] = scene.scene_size.corner().to_array();
                let key = Scene::scene_size.key;
                self.missing(fields.path(key), fields.of.start(), format!("{y} × {x} × {z} m"));
            }
            Some(value) => scene.scene_size = self.part(value),
        }
        self.fill(&mut scene, &fields);
        scene.lights = self.list(&fields, Scene::lights.key, check::light_count, Self::light);
        if let Some(value) = fields.get(Scene::observer.key) {
            match value.list() {
                Some(list) => {
                    let count = list.len();
                    let predicate = format!("is a list of {count}, but a scene has exactly one observer");
                    self.report(value.start(), value.path(), None, &predicate);
                }
                None => scene.observer = self.part(value),
            }
        }
        scene.objects = self.list(&fields, Scene::objects.key, check::object_count, Self::object);
        if let Some(value) = fields.get(Scene::display.key) {
            scene.display = self.part(value);
        }
        if fields.get(Scene::variants.key).is_some() {
            scene.variants =
                self.list(&fields, Scene::variants.key, check::variant_count, Self::part::<Variant>);
        }
        if let Some(value) = fields.get(Scene::comparison.key) {
            scene.comparison = self.part(value);
        }
        scene
    }

    /// A part without parameters of its own.
    pub(in crate::scene) fn part<P: Structure>(&mut self, value: Cursor) -> P {
        let mut part = P::default();
        match self.fields(value, &P::keys(), P::WHAT) {
            Some(fields) => self.fill(&mut part, &fields),
            // A room of unknown size counts as the largest, so that nothing seems to be outside.
            None => part.each_mut(&mut |field, held| _ = held.put(unreadable(field))),
        }
        part
    }

    /// Reads the fields of a part, except other parts and the parameters of its type.
    fn fill<P: Structure>(&mut self, part: &mut P, fields: &Fields) {
        let mut object_type = None;
        part.each_mut(&mut |field, held| match (field.kind, fields.get(field.key)) {
            (Kind::Part, None) => {
                if let Absent::Error(why) = field.absent {
                    self.lacking(fields, field.key, why);
                }
            }
            (Kind::Part | Kind::Parts | Kind::Parameters | Kind::List, _) => {}
            (Kind::Material, Some(value)) => {
                held.values_mut().into_iter().for_each(|values| *values = self.material(value));
            }
            (_, Some(value)) => {
                if let Kind::Id(Ids::ObjectType) = field.kind {
                    object_type = value.text().and_then(|id| self.registry.shape(id));
                }
                let read = self.field(value, field, object_type);
                held.put(read.or_else(|| unreadable(field)));
            }
            (_, None) => match field.absent {
                Absent::Allowed => {}
                Absent::Asked => {
                    let shown = match held.value() {
                        Some(Value::Number(v)) => format!("{v} {}", field.unit),
                        default => default.map_or_else(String::new, |default| default.to_string()),
                    };
                    self.missing(fields.path(field.key), fields.of.start(), shown);
                }
                Absent::Error(why) => {
                    let why = if why.is_empty() { field.rule(self.registry) } else { why.to_owned() };
                    self.lacking(fields, field.key, &why);
                    held.put(unreadable(field));
                }
            },
        });
    }

    /// The value of a field, if it has the type. The rules of most fields are long, and are only made when broken.
    fn field(
        &mut self,
        value: Cursor,
        field: &'static Field,
        object_type: Option<&ShapeEntry>,
    ) -> Option<Value> {
        let registry = self.registry;
        let rule = || match (field.kind, object_type) {
            (Kind::Count(_), Some(shape)) => check::tessellation_rule(shape),
            (Kind::Count(_), None) if value.number().is_some_and(|n| n > u32::MAX as f32) => {
                format!("{} and at most {}", field.rule(registry), u32::MAX)
            }
            _ => field.rule(registry),
        };
        match field.kind {
            Kind::Number { .. } => value.number().or_else(|| self.number(value, &rule())).map(Value::Number),
            Kind::Count(_) => {
                let count = value.integer().or_else(|| self.integer(value, &rule()))?;
                u32::try_from(count).map_err(|_| self.wrong(value, &rule())).ok().map(Value::from)
            }
            Kind::Flag(_) => match value.value {
                Ast::BooleanLit(flag) => Some(flag.value.into()),
                _ => {
                    self.wrong(value, &rule());
                    None
                }
            },
            Kind::Text(_) | Kind::Id(_) | Kind::Choice(_) => {
                let Some(text) = value.text() else {
                    self.wrong(value, &rule());
                    return None;
                };
                field.check_text(text).map_err(|rule| self.wrong(value, &rule)).ok()?;
                Some(text.into())
            }
            Kind::Position | Kind::Direction | Kind::Step | Kind::Rotation => {
                Some(self.vector(value, matches!(field.kind, Kind::Position), rule).into())
            }
            Kind::Colour => colour::read(self, value, &rule()).map(Value::Colour),
            Kind::Material | Kind::Parameters | Kind::List | Kind::Part | Kind::Parts => None,
        }
    }

    pub(in crate::scene) fn light(&mut self, value: Cursor) -> Light {
        let mut light = Light { position: None, ..Light::default() };
        let keys = self.light_keys.clone();
        let Some(fields) = self.fields(value, &keys, Light::WHAT) else { return light };
        self.fill(&mut light, &fields);
        if fields.get(Light::light_type.key).is_some_and(|id| id.text().is_none()) {
            light.light_type.clear();
        }
        let entry = self.registry.light(&light.light_type);
        if let Some(entry) = entry.filter(|_| fields.get(Light::intensity.key).is_none()) {
            light.intensity = entry.declaration.default_intensity;
        }
        for field in Light::FIELDS {
            let Some(other) = field.instead else { continue };
            // The check reports that the type has no flux, which is enough.
            let possible = other != Light::luminous_flux.key || entry.is_none_or(LightEntry::has_flux);
            if let (Some(_), Some(value), true) = (fields.get(field.key), fields.get(other), possible) {
                let predicate = format!("conflicts with {}; a light has one or the other", field.key);
                self.report(value.start(), value.path(), None, &predicate);
            }
        }
        let own = entry.map_or(&[][..], |entry| entry.parameters);
        let of_any = self.registry.lights().iter().flat_map(|l| l.parameters);
        light.parameters = self.parameters(&fields, own.iter().chain(of_any));
        light
    }

    pub(in crate::scene) fn object(&mut self, value: Cursor) -> Object {
        let mut object = Object { position: Vec3::NAN, ..Object::default() };
        let keys = std::mem::take(&mut self.object_keys);
        let fields = self.fields(value, &keys, Object::WHAT);
        self.object_keys = keys;
        let Some(fields) = fields else { return object };
        self.fill(&mut object, &fields);
        let own = self.registry.shape(&object.object_type).map_or(&[][..], |shape| shape.parameters);
        let of_any = self.registry.shapes().iter().flat_map(|shape| shape.parameters);
        object.shape = self.parameters(&fields, own.iter().chain(of_any));
        if let Some(value) = fields.get(Object::repeat.key) {
            object.repeat = self.repeat(value, &object.object_type);
        }
        object
    }

    /// The row of an object of a type.
    fn repeat(&mut self, value: Cursor, object_type: &str) -> Repetition {
        let mut repeat = Repeat::default();
        let Some(fields) = self.fields(value, &Repeat::keys(), Repeat::WHAT) else { return Repetition::None };
        self.fill(&mut repeat, &fields);
        if let Some(value) = fields.get(Repeat::vary.key) {
            match value.list() {
                Some(list) => repeat.vary = list.map(|value| self.varied(value, object_type)).collect(),
                None => self.wrong(value, "a row must have a list of varied values"),
            }
        }
        Repetition::Entry(Box::new(repeat))
    }

    fn varied(&mut self, value: Cursor, object_type: &str) -> Varied {
        let mut varied = Varied::default();
        let Some(fields) = self.fields(value, &Varied::keys(), Varied::WHAT) else { return varied };
        self.fill(&mut varied, &fields);
        let Some(value) = fields.get(Varied::values.key) else { return varied };
        let Some(list) = value.list() else {
            self.wrong(value, &Varied::values.rule(self.registry));
            return varied;
        };
        // An unknown path is reported by the checks.
        let Some(variable) = Variable::with_path(&varied.parameter, object_type, self.registry) else {
            return varied;
        };
        let (count, shape) = (list.len(), self.registry.shape(object_type));
        let read = |value| match variable.declared {
            Declared::Field(field) => self.field(value, field, shape),
            Declared::Parameter(p) => self.parameter(value, p),
        };
        varied.values = list.filter_map(read).collect();
        if varied.values.len() < count {
            self.unread(value.path());
        }
        varied
    }

    /// The given parameters of a type; the first declaration of a name counts.
    fn parameters(
        &mut self,
        fields: &Fields,
        declared: impl Iterator<Item = &'static Parameter> + Clone,
    ) -> Values {
        let mut values = Values::default();
        for (key, value) in fields.iter() {
            if let Some(parameter) = declared.clone().find(|p| p.name == key)
                && let Some(value) = self.parameter(value, parameter)
            {
                values.set(parameter.name, value);
            }
        }
        values
    }

    fn material(&mut self, value: Cursor) -> Values {
        let keys = std::mem::take(&mut self.material_keys);
        let fields = self.fields(value, &keys, "a material");
        self.material_keys = keys;
        let mut values = Values::default();
        for (key, value) in fields.iter().flat_map(Fields::iter) {
            if let Some(parameter) = self.registry.material_parameter(key)
                && let Some(value) = self.parameter(value, parameter)
            {
                values.set(parameter.name, value);
            }
        }
        values
    }
}

/// The value of a field that was given but could not be read, or was missing: no rule about other parts applies to it.
fn unreadable(field: &Field) -> Option<Value> {
    match field.kind {
        Kind::Number { .. } => Some(f32::NAN.into()),
        Kind::Position | Kind::Direction | Kind::Step => Some(Vec3::NAN.into()),
        _ => None,
    }
}
