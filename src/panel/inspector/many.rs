//! The properties that several lights and objects have in common. A dash stands where their values differ; what is set
//! here is set in all.

use super::{
    material::group_of_knobs,
    part::{section, type_knob},
};
use crate::{
    panel::{
        chooser, keys,
        knob::{self, Amount, Caption},
        lesson::point,
        prelude::*,
        state::Effect,
    },
    parameter::{Parameter, Value},
    reflection::{ModelEntry, ungrouped, usage::unused},
    scene::{Field, Key, Light, Object, limits, part::Fields as _, rows::Variable},
    text::capitalised,
};

/// The value of the first of several parts, and where the others have another: in each component of a vector.
#[derive(Clone, Debug, PartialEq)]
struct Common {
    value: Value,
    differs: [bool; 3],
}

impl Common {
    /// What these values have in common; `None` without values.
    fn of(mut values: impl Iterator<Item = Value>) -> Option<Self> {
        let value = values.next()?;
        let mut differs = [false; 3];
        for other in values {
            match (&value, &other) {
                (Value::Triple(a), Value::Triple(b)) => (0..3).for_each(|i| differs[i] |= a[i] != b[i]),
                (a, b) if a == b => {}
                _ => differs = [true; 3],
            }
            if differs == [true; 3] {
                break;
            }
        }
        Some(Self { value, differs })
    }

    fn is_one(&self) -> bool {
        self.differs == [false; 3]
    }

    /// The word that all have.
    fn word(&self) -> Option<&str> {
        match &self.value {
            Value::Choice(word) if self.is_one() => Some(word),
            _ => None,
        }
    }

    /// The components, without those that differ.
    fn vector(&self) -> Option<Vec3> {
        let Value::Triple(v) = self.value else { return None };
        Some(Vec3::from_array(std::array::from_fn(|i| if self.differs[i] { f32::NAN } else { v[i] })))
    }
}

/// A new value of a part that has another one: components that are not numbers stay as they are.
fn merged(new: &Value, own: &Value) -> Value {
    match (new, own) {
        (Value::Triple(new), Value::Triple(own)) => {
            Value::Triple(std::array::from_fn(|i| if new[i].is_nan() { own[i] } else { new[i] }))
        }
        (new, _) => new.clone(),
    }
}

/// A value that all parts have.
#[derive(Clone, Debug)]
struct Shared {
    key: Key,
    what: What,
    common: Common,
    /// Why none of the parts uses it, if so.
    off: Option<String>,
}

impl Shared {
    fn new(key: Key, what: What, common: Common) -> Self {
        Self { key, what, common, off: None }
    }
}

#[derive(Clone, Debug)]
enum What {
    Field(Field),
    Parameter(&'static Parameter),
    /// The reflection model, which may be that of the scene.
    Model,
    /// The type of light or object.
    Type,
}

/// Values under the heading of their group; without a name, those in no group.
struct Group {
    name: &'static str,
    values: Vec<Shared>,
}

impl Group {
    /// Values in no group.
    fn none(values: Vec<Shared>) -> Vec<Self> {
        vec![Self { name: "", values }]
    }

    /// Number of its parameters that some part does not leave at the default.
    fn changed(&self) -> usize {
        let is_default = |one: &&Shared| match one.what {
            What::Parameter(p) => one.common.is_one() && one.common.value == p.default_value(),
            _ => true,
        };
        self.values.len() - self.values.iter().filter(is_default).count()
    }
}

/// Sections with their titles, which are those of a single part.
type Sections = Vec<(&'static str, Vec<Group>)>;

/// What several parts are, and the sections of the values that all of them have.
struct All {
    parts: Vec<Part>,
    name: String,
    sections: Sections,
}

pub(super) fn many(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let document = &session.document;
    let others = kept::Same(document.others().clone());
    let key = (document.revision(), session.selection, others, session.active(), registry.models().len());
    let id = Id::new("what several have in common");
    let all = kept::of_key(ui.ctx(), id, key, || Arc::new(All::of(session, registry)));
    all.header(ui, session, context);
    for (title, groups) in &all.sections {
        section(ui, title, true, |ui| groups.iter().for_each(|group| all.group(ui, group, context)));
    }
}

impl All {
    fn of(session: &Session, registry: &Registry) -> Self {
        let scene = session.scene();
        let parts: Vec<Part> = session.entries().into_iter().map(Part::from).collect();
        let objects: Vec<_> = parts.iter().filter_map(|part| object(scene, *part)).collect();
        let lights: Vec<_> = parts.iter().filter_map(|part| light(scene, *part)).collect();
        let mut sections = match (&lights[..], &objects[..]) {
            ([], objects) => of_objects(objects, scene, registry),
            (lights, []) => of_lights(lights, registry),
            (lights, objects) => {
                let positions = lights.iter().map(|light| light.position);
                let positions = positions.chain(objects.iter().map(|object| Some(object.position)));
                let field = positions.collect::<Option<Vec<_>>>().and_then(|all| {
                    let common = Common::of(all.into_iter().map(Value::from))?;
                    Some(Shared::new(Object::position.into(), What::Field(Object::position), common))
                });
                vec![("Position", Group::none(field.into_iter().collect()))]
            }
        };
        sections.retain(|(_, groups)| groups.iter().any(|group| !group.values.is_empty()));
        Self { parts, name: session.name_of_group(), sections }
    }

    /// What is selected, and buttons that look at it, duplicate and delete it.
    fn header(&self, ui: &mut Ui, session: &Session, context: &mut PanelContext<'_>) {
        let name = &self.name;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let buttons = 3.0 * icon::SIZE + 2.0 * ui.spacing().item_spacing.x;
            let room = (ui.available_width() - buttons - 4.0).max(20.0);
            let colour = Palette::here(ui).text;
            let galley = theme::elided(ui, name, TextStyle::Heading, colour, room);
            let (rect, label) = ui.allocate_exact_size(vec2(room, galley.size().y), Sense::hover());
            ui.painter().galley(rect.min, galley, colour);
            theme::says(&label, WidgetType::Label, name);
            let look = keys::hint(ui.ctx(), &format!("Look at {name} "), "focus");
            let look = icon::button(ui, Icon::Target, &look);
            context.on_click(&look, || Action::Do(Effect::FocusSelection));
            let copy = icon::button(ui, Icon::Duplicate, &format!("Duplicate {name}"));
            context.on_click(&copy, || Action::Duplicate(session.selection));
            let bin = icon::button(ui, Icon::Bin, &format!("Delete {name}"));
            context.on_click(&bin, || Action::Remove(session.selection));
        });
        let text = "What is changed here changes all of them; – stands where they differ.";
        ui.add(Label::new(theme::small(ui, text)).wrap());
        if self.sections.is_empty() {
            ui.add(Label::new(theme::small(ui, "They have nothing in common that can be set.")).wrap());
        }
    }

    /// The knobs of a group, under its heading if it has one.
    fn group(&self, ui: &mut Ui, group: &Group, context: &mut PanelContext<'_>) {
        let (session, registry) = (context.session(), context.registry());
        let sought = group.values.iter().any(|one| point::at_knob(ui, one.key.name()));
        let mut knobs = |ui: &mut Ui| {
            for one in &group.values {
                let edit = self.knob(ui, one, session, registry);
                context.edits(edit);
            }
        };
        match group.name {
            "" => knobs(ui),
            name => group_of_knobs(ui, name, group.changed(), sought, knobs),
        }
    }

    /// The knob of a value. Returns the edit that sets it in all parts.
    fn knob(&self, ui: &mut Ui, one: &Shared, session: &Session, registry: &Registry) -> Option<Edit> {
        let Shared { key, what, common, off } = one;
        match what {
            What::Model => {
                let model = model(ui, common, session, registry)?;
                return Some(self.edit(Object::reflection_model.label(), |part| {
                    Edit::put(part, Object::reflection_model, model.clone())
                }));
            }
            What::Type => {
                let now = common.word().unwrap_or_default();
                let lights = registry.lights().iter().map(|l| l.declaration);
                let lights = lights.map(|d| [d.id, d.name, d.summary]);
                let shapes = registry.shapes().iter().map(|s| s.declaration);
                let shapes = shapes.map(|d| [d.id, d.name, d.summary]);
                let id = match self.parts.first() {
                    Some(Part::Light(_)) => type_knob(ui, lights, now, None),
                    _ => type_knob(ui, shapes, now, None),
                }?;
                return Some(self.edit("type", |part| Edit::set(part, *key, id.to_owned())));
            }
            What::Field(field) => {
                let new = field_knob(ui, field, common, self.limits(field, session, registry))?;
                Some((field.label(), new))
            }
            What::Parameter(p) => {
                parameter_knob(ui, (*key, *p, off.as_deref()), common, registry).map(|new| (p.label, new))
            }
        }
        .map(|(label, new)| {
            let scene = session.scene();
            self.edit(label, |part| {
                let own = own_value(scene, part, *key, registry);
                Edit::set(part, *key, own.map_or_else(|| new.clone(), |own| merged(&new, &own)))
            })
        })
    }

    fn edit(&self, label: &str, one: impl Fn(Part) -> Edit) -> Edit {
        let edits = self.parts.iter().map(|part| one(*part)).collect();
        Edit::Each { edits, step: format!("{} of {}", capitalised(label), self.name) }
    }

    /// The limits of the components of a field.
    fn limits(&self, field: &Field, session: &Session, registry: &Registry) -> [limits::Limits; 3] {
        let room = session.document.scene_size;
        match field.key {
            key if key == Object::position.key => [0, 1, 2].map(|axis| limits::position(room, axis)),
            key if key == Object::size.key => [0, 1, 2].map(|_| limits::object_size(room)),
            key if key == Light::intensity.key => {
                let first = self.parts.first().and_then(|part| light(session.scene(), *part));
                let entry = first.and_then(|light| registry.light(&light.light_type));
                [0, 1, 2]
                    .map(|_| entry.map_or_else(|| field.limits(), |of| limits::intensity(of.declaration)))
            }
            _ => [0, 1, 2].map(|_| field.limits()),
        }
    }
}

fn object(scene: &Scene, part: Part) -> Option<&Object> {
    if let Part::Object(i) = part { scene.objects.get(i) } else { None }
}

fn light(scene: &Scene, part: Part) -> Option<&Light> {
    if let Part::Light(i) = part { scene.lights.get(i) } else { None }
}

/// The value that a part has, its default if it is not set.
fn own_value(scene: &Scene, part: Part, key: Key, registry: &Registry) -> Option<Value> {
    if let (Key::Material(name), Some(object)) = (key, object(scene, part)) {
        return registry.material_parameter(name).map(|p| object.material.get(p));
    }
    let fields = scene.part(part)?;
    fields.value(key).or_else(|| {
        fields.parameters(registry).iter().find(|p| p.name == key.name()).map(Parameter::default_value)
    })
}

/// A field that all of these parts have.
fn field(field: Field, values: impl Iterator<Item = Option<Value>>) -> Option<Shared> {
    let all = values.collect::<Option<Vec<_>>>()?;
    let common = Common::of(all.into_iter())?;
    Some(Shared::new(field.into(), What::Field(field), common))
}

/// Parameters, with what these parts have of them. `off` tells why a part does not use one.
fn parameters<T: Copy>(
    all: impl Iterator<Item = &'static Parameter>,
    parts: &[T],
    key: fn(&'static str) -> Key,
    get: impl Fn(T, &Parameter) -> Value,
    off: impl Fn(T, &'static Parameter) -> Option<String>,
) -> Vec<Shared> {
    let off = |p: &'static Parameter| {
        // Only such a condition can be unmet, and there may be thousands of parts.
        p.used_when?;
        let mut reasons = parts.iter().map(|part| off(*part, p));
        let first = reasons.next()??;
        reasons.all(|reason| reason.is_some()).then_some(first)
    };
    let shared = |p: &'static Parameter| {
        let common = Common::of(parts.iter().map(|part| get(*part, p)))?;
        // Files are chosen one by one.
        let shown = !matches!(common.value, Value::File(_));
        shown.then(|| Shared { off: off(p), ..Shared::new(key(p.name), What::Parameter(p), common) })
    };
    all.filter_map(shared).collect()
}

fn of_objects(objects: &[&Object], scene: &Scene, registry: &Registry) -> Sections {
    let mut models: Vec<&str> = objects.iter().map(|object| scene.model_of(object)).collect();
    let common = Common::of(models.iter().map(|id| Value::from((*id).to_owned())));
    let model = common.map(|common| Shared::new(Object::reflection_model.into(), What::Model, common));
    models.sort_unstable();
    models.dedup();
    let models: Option<Vec<_>> = models.into_iter().map(|id| registry.model(id)).collect();
    let material = models.map(|models| of_material(&models, objects, scene));
    let object_type = Common::of(objects.iter().map(|o| Value::from(o.object_type.clone())));
    let shape = object_type.as_ref().and_then(|common| registry.shape(common.word()?));
    let shape = shape.map(|shape| {
        let off = |object: &Object, p: &'static Parameter| unused(shape.parameters, p, &object.shape);
        parameters(shape.parameters.iter(), objects, Key::Own, |object, p| object.shape.get(p), off)
    });
    let fields = [Object::visible, Object::size, Object::position, Object::rotation];
    let fields = fields.into_iter().filter_map(|of| field(of, objects.iter().map(|o| o.value(of.into()))));
    let place = object_type
        .map(|common| Shared::new(Object::object_type.into(), What::Type, common))
        .into_iter()
        .chain(shape.into_iter().flatten())
        .chain(fields);
    vec![
        ("Reflection", Group::none(model.into_iter().collect())),
        ("Material", material.unwrap_or_default()),
        ("Shape and position", Group::none(place.collect())),
    ]
}

/// The parameters that all of these models have, in the groups of the first.
fn of_material(models: &[&ModelEntry], objects: &[&Object], scene: &Scene) -> Vec<Group> {
    let Some((first, rest)) = models.split_first() else { return Vec::new() };
    let in_all = |p: &&'static Parameter| rest.iter().all(|model| model.parameter(p.name).is_some());
    let off = |object: &Object, p: &'static Parameter| {
        let id = scene.model_of(object);
        let model = models.iter().find(|model| model.declaration.id == id)?;
        unused(model.parameters, p, &object.material)
    };
    let values = |all: &mut dyn Iterator<Item = &'static Parameter>| {
        parameters(all.filter(in_all), objects, Key::Material, |object, p| object.material.get(p), off)
    };
    let all = first.parameters;
    let mut groups = Group::none(values(&mut ungrouped(first.groups, all)));
    let named =
        first.groups.iter().map(|group| Group { name: group.name, values: values(&mut group.of(all)) });
    groups.extend(named.filter(|group| !group.values.is_empty()));
    groups
}

fn of_lights(lights: &[&Light], registry: &Registry) -> Sections {
    let light_type = Common::of(lights.iter().map(|light| Value::from(light.light_type.clone())));
    let entry = light_type.as_ref().and_then(|common| registry.light(common.word()?));
    let of = |of: Field| field(of, lights.iter().map(|light| light.value(of.into())));
    let by_temperature = lights.iter().filter(|light| light.colour_temperature.is_some()).count();
    let colour = match by_temperature {
        0 => of(Light::colour),
        n if n == lights.len() => of(Light::colour_temperature),
        _ => None,
    };
    let by_flux = lights.iter().filter(|light| light.luminous_flux.is_some()).count();
    let strength = match by_flux {
        _ if entry.is_none() => None,
        0 => of(Light::intensity),
        n if n == lights.len() => of(Light::luminous_flux),
        _ => None,
    };
    let own = entry.map(|entry| {
        let off = |light: &Light, p: &'static Parameter| unused(entry.parameters, p, &light.parameters);
        parameters(entry.parameters.iter(), lights, Key::Own, |light, p| light.parameters.get(p), off)
    });
    let fields = [of(Light::enabled), strength, colour].into_iter().flatten();
    let first = light_type
        .map(|common| Shared::new(Light::light_type.into(), What::Type, common))
        .into_iter()
        .chain(fields)
        .chain(own.into_iter().flatten());
    let place = [of(Light::position), of(Light::direction)].into_iter().flatten();
    vec![("Light", Group::none(first.collect())), ("Position", Group::none(place.collect()))]
}

/// The choice of a reflection model for all, or of the scene's. Returns its id, or `None` for that of the scene.
fn model(ui: &mut Ui, common: &Common, session: &Session, registry: &Registry) -> Option<Option<String>> {
    let name = |id: &str| registry.model(id).map_or(id, |model| model.declaration.name).to_owned();
    let shown = common.word().map_or_else(|| "–".to_owned(), name);
    let first = format!("Scene default ({})", name(&session.scene().reflection_model));
    let chosen = knob::list_knob(ui, &Caption::of(&Object::reflection_model), &shown, |ui, list| {
        let height = 0.45 * ui.ctx().content_rect().height();
        let model = chooser::models(ui, list, height, session, registry, common.word(), Some(&first))?;
        Some(model.map(|model| model.declaration.id.to_owned()))
    })?;
    Some(chosen)
}

/// The knob of a field.
fn field_knob(ui: &mut Ui, field: &Field, common: &Common, limits: [limits::Limits; 3]) -> Option<Value> {
    let caption = Caption::of(field);
    if let Some(v) = common.vector() {
        return knob::vector_knob(ui, &caption, v, &limits).map(Value::from);
    }
    let number = |v: f32| if common.is_one() { f64::from(v) } else { f64::NAN };
    match &common.value {
        Value::Number(v) => knob::number_knob(ui, &caption, Amount::new(number(*v), None, &limits[0]))
            .map(|v| Value::Number(v as f32)),
        Value::Colour(rgb) if common.is_one() => {
            knob::colour_knob(ui, &caption, *rgb, None).map(Value::Colour)
        }
        Value::Colour(rgb) => colours(ui, &caption, *rgb),
        value => match value.truth() {
            Some(on) if common.is_one() => knob::flag_knob(ui, &caption, on).map(Value::flag),
            Some(_) => knob::choice_knob(ui, &caption, usize::MAX, &["no", "yes"])
                .map(|chosen| Value::flag(chosen == 1)),
            None => None,
        },
    }
}

/// The knob of a parameter, disabled for a reason.
fn parameter_knob(
    ui: &mut Ui,
    (key, p, off): (Key, &'static Parameter, Option<&str>),
    common: &Common,
    registry: &Registry,
) -> Option<Value> {
    let salt = match key {
        Key::Material(name) => name.to_owned(),
        Key::Own(name) => format!("shape {name}"),
    };
    if common.is_one() {
        return knob::parameter_knob(ui, &salt, p, &common.value, off);
    }
    let Parameter { symbol, label, unit, help, .. } = *p;
    let caption = Caption { salt: &salt, symbol, label, unit, help, disabled: off, ..Caption::default() };
    match &common.value {
        Value::Colour(rgb) => colours(ui, &caption, *rgb),
        Value::Choice(_) => {
            let words = Variable::of_material(p).words(registry);
            let names: Vec<_> = words.iter().map(|(_, name)| *name).collect();
            let chosen = knob::choice_knob(ui, &caption, usize::MAX, &names)?;
            words.get(chosen).map(|(id, _)| Value::Choice((*id).into()))
        }
        Value::Triple(_) => {
            let Value::Triple(default) = p.default_value() else { return None };
            let v = common.vector()?.to_array();
            knob::triple_knob(ui, &caption, v, default, &p.kind.limits()?).map(Value::Triple)
        }
        _ => {
            let limits = p.kind.limits()?;
            let default = p.kind.number_of(&p.default_value());
            let new = knob::number_knob(ui, &caption, Amount::new(f64::NAN, default, &limits))?;
            Some(p.kind.of_numbers([new; 3])).filter(|new| p.allows(new))
        }
    }
}

/// The knob of colours that differ: a list that opens the picker, which begins with the colour of the first.
fn colours(ui: &mut Ui, caption: &Caption, rgb: [u8; 3]) -> Option<Value> {
    let label = caption.label;
    knob::list_knob(ui, caption, "–", |ui, id| knob::picker(ui, id, label, rgb)).map(Value::Colour)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_the_same_in_all_is_common_and_the_rest_differs() {
        let common = |values: &[Value]| Common::of(values.iter().cloned()).expect("there are some");
        let same = common(&[Value::Number(0.5), Value::Number(0.5)]);
        assert!(same.is_one());
        let mixed = common(&[Value::Number(0.5), Value::Number(0.5), Value::Number(0.25)]);
        assert!(!mixed.is_one() && mixed.value == Value::Number(0.5));
        let places = common(&[Value::Triple([1.0, 2.0, 3.0]), Value::Triple([1.0, 5.0, 3.0])]);
        assert_eq!(places.differs, [false, true, false]);
        let v = places.vector().expect("they are vectors");
        assert!(v.x == 1.0 && v.y.is_nan() && v.z == 3.0, "{v}");
        assert_eq!(common(&[Value::from("a".to_owned()), Value::from("b".to_owned())]).word(), None);
        assert_eq!(Common::of(std::iter::empty()), None);
    }

    #[test]
    fn components_that_nobody_set_stay_those_of_each_part() {
        let new = Value::Triple([f32::NAN, 4.0, f32::NAN]);
        assert_eq!(merged(&new, &Value::Triple([1.0, 2.0, 3.0])), Value::Triple([1.0, 4.0, 3.0]));
        assert_eq!(merged(&Value::Number(1.0), &Value::Number(0.0)), Value::Number(1.0));
    }
}
