//! Values of a scene by path, as typed by users: `objects[0].material.roughness`, `lights[0].position[1]`.
//!
//! A [`Place`] is a path with its declaration: it reads values from text, puts them into scenes, and says them in words.
//! Paths are those of messages, of lessons and of tables.

use super::{
    Field, Key, Object, Part, Scene, check,
    error::{Path, Problem, Segment},
    field::Kind,
    load::MAX_DEPTH,
    part::Fields,
    read::keys::OTHER_WORDS,
    used::{idle, other_types},
};
pub use super::{declaration::Declared, used::Idle};
use crate::{
    parameter::{
        Value,
        kind::{
            Kind as _,
            colour::{Colour, hexadecimal},
        },
    },
    registry::Registry,
    text::{
        did_you_mean,
        json::{TOO_LARGE, canonical},
        numbers, plural, quoted, shortened,
    },
};

/// A value of a scene: where it is, and how it is declared.
#[derive(Clone, Debug)]
pub struct Place {
    /// The path.
    pub path: Path,
    /// The part that holds the value.
    pub part: Part,
    /// The declaration.
    pub declared: Declared,
    key: Key,
    /// The index of a component of a vector or a colour.
    component: Option<usize>,
}

impl Place {
    /// The value at a path of a scene, whether the scene gives it or has its default.
    ///
    /// # Errors
    /// Returns the reason why there is none, with the nearest known key.
    pub fn find(text: &str, scene: &Scene, registry: &Registry) -> Result<Self, String> {
        let path =
            path(text).map_err(|(at, what)| format!("{} (character {}): {what}", quoted(text), at + 1))?;
        let (part, rest) = part_of(&path, scene)?;
        let fields = scene.part(part).ok_or_else(|| format!("there is no {}", part.path()))?;
        let (key, declared, tail) = declared(part, fields, rest, registry)?;
        let whole = Self { path: key.within(part), part, declared, key, component: None };
        match tail {
            [] => Ok(whole),
            [Segment::Index(i)] if *i < declared.components() => {
                Ok(Self { path: whole.path.index(*i), component: Some(*i), ..whole })
            }
            [Segment::Index(_)] if declared.components() > 1 => {
                Err(format!("{} has the components [0], [1] and [2]", whole.path))
            }
            _ => Err(format!("{} is a single value; the path ends there", whole.path)),
        }
    }

    /// True for values that are whole numbers.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.declared.is_whole()
    }

    /// True if other values depend on this one: models judge materials, and types have parameters.
    fn comes_first(&self) -> bool {
        matches!(self.declared, Declared::Field(Field { kind: Kind::Id(_), .. }))
    }

    /// The value in a text: a number, a word, three numbers such as `[1, 2, 3]`, a colour such as `#ff8800`. The range
    /// is checked [in a scene](Scene::with).
    ///
    /// # Errors
    /// Returns the path, the text and the rule that it breaks.
    pub fn read(&self, text: &str, registry: &Registry) -> Result<Value, String> {
        let text = text.trim();
        let broken = |rule: &str| {
            Problem {
                place: None,
                path: self.path.clone(),
                found: Some(shortened(text)),
                rule: rule.to_owned(),
            }
            .to_string()
        };
        if self.component.is_some() {
            let value = text.parse().ok().filter(|v: &f32| v.is_finite()).map(Value::Number);
            let code = |value: &Value| {
                (0.0..=255.0).contains(&value.numbers()[0]) && value.numbers()[0].fract() == 0.0
            };
            return match value {
                Some(value) if !self.declared.is_colour() || code(&value) => Ok(value),
                _ if self.declared.is_colour() => Err(broken("it must be a whole number from 0 to 255")),
                _ if text.parse().is_ok_and(f32::is_infinite) => Err(broken(TOO_LARGE)),
                _ => Err(broken("it must be a number")),
            };
        }
        if let Some(rgb) = hexadecimal(text).filter(|_| self.declared.is_colour()) {
            return Ok(Value::Colour(rgb));
        }
        match self.declared {
            Declared::Parameter(parameter) => match parameter.kind.parse(text) {
                Some(Value::File(_)) => Err(broken("a file cannot be given here")),
                Some(value) => Ok(value),
                None => Err(broken(&self.with_hexadecimal(parameter.clause()))),
            },
            Declared::Field(field) => {
                let value = of_field(field, text)
                    .ok_or_else(|| broken(&self.with_hexadecimal(field.rule(registry))))?;
                field.check_text(text).map_err(|rule| broken(&rule))?;
                field.check(&value, registry).map(|()| value).map_err(|rule| broken(&rule))
            }
        }
    }

    /// A rule with the other form in which colours can be typed.
    fn with_hexadecimal(&self, rule: String) -> String {
        if self.declared.is_colour() { format!("{rule}, or hexadecimal: #ff8000") } else { rule }
    }

    /// The value that a scene has here, given or by default.
    #[must_use]
    pub fn value(&self, scene: &Scene) -> Option<Value> {
        self.declared.held(scene.part(self.part)?, self.key)
    }

    /// Puts a value into a scene, unless the type of the part has no such parameter. False if the scene has no such part,
    /// or the value another type.
    fn put(&self, scene: &mut Scene, value: &Value, registry: &Registry) -> bool {
        if !self.is_in_type(scene, registry) {
            return true;
        }
        let value = match self.component {
            None => value.clone(),
            Some(i) => {
                let v = value.numbers()[0];
                match self.value(scene) {
                    Some(Value::Triple(mut all)) => {
                        all[i] = v as f32;
                        Value::Triple(all)
                    }
                    Some(Value::Colour(mut all)) => {
                        all[i] = v as u8;
                        Value::Colour(all)
                    }
                    _ => return false,
                }
            }
        };
        let (key, room) = (self.key, scene.scene_size);
        match self.part {
            Part::Light(i) => {
                let light = scene.lights.get_mut(i);
                light.is_some_and(|light| light.set(key, Some(value), registry, room))
            }
            Part::Object(i) => {
                scene.objects.get_mut(i).is_some_and(|object| object.set(key, Some(value), registry))
            }
            part => scene.part_mut(part).is_some_and(|part| part.put(key, Some(value))),
        }
    }

    /// True unless it is a parameter that the type of the part does not have.
    fn is_in_type(&self, scene: &Scene, registry: &Registry) -> bool {
        let (Declared::Parameter(parameter), Key::Own(_)) = (self.declared, self.key) else { return true };
        let part = scene.part(self.part);
        part.is_none_or(|part| part.parameters(registry).iter().any(|p| p.name == parameter.name))
    }

    /// The reason why a scene makes no use of the value; `None` if it does. Models and types need not have each parameter,
    /// and some use one only with some choices.
    #[must_use]
    pub fn idle(&self, scene: &Scene, registry: &Registry) -> Option<Idle> {
        match self.declared {
            Declared::Parameter(parameter) => idle((self.part, self.key), parameter, scene, registry),
            Declared::Field(_) => None,
        }
    }

    /// A value in words, with its unit.
    #[must_use]
    pub fn shown(&self, value: &Value, registry: &Registry) -> String {
        self.declared.shown(value, registry)
    }

    /// The symbol of the value; empty if it has none.
    #[must_use]
    pub fn symbol(&self) -> &'static str {
        if self.component.is_some() { "" } else { self.declared.symbol() }
    }

    /// The name of the value: "roughness", "position, x".
    #[must_use]
    pub fn label(&self) -> String {
        let label = self.declared.label();
        let names = if self.declared.is_colour() { ["red", "green", "blue"] } else { ["x", "y", "z"] };
        match self.component.and_then(|i| names.get(i)) {
            Some(component) => format!("{label}, {component}"),
            None => label.to_owned(),
        }
    }
}

/// The part of a path, and the rest of the path.
fn part_of<'p>(path: &'p Path, scene: &Scene) -> Result<(Part, &'p [Segment]), String> {
    let [Segment::Key(first), rest @ ..] = path.segments() else {
        return Err("a path begins with a key".to_owned());
    };
    let (count, part): (usize, fn(usize) -> Part) = match first.as_ref() {
        "lights" => (scene.lights.len(), Part::Light),
        "objects" => (scene.objects.len(), Part::Object),
        "variants" => (scene.variants.len(), Part::Variant),
        _ => {
            let parts = [Part::Size, Part::Observer, Part::Display, Part::Comparison];
            let named = parts.into_iter().find(|part| part.path().segments() == &path.segments()[..1]);
            return Ok(named.map_or((Part::Scene, path.segments()), |part| (part, rest)));
        }
    };
    match rest {
        [Segment::Index(i), rest @ ..] if *i < count => Ok((part(*i), rest)),
        [Segment::Index(i), ..] => Err(format!(
            "there is no {first}[{i}]: the scene has {}, counted from 0",
            plural(count, first.trim_end_matches('s'))
        )),
        _ => Err(format!("{first} is a list; continue with an index, as in {first}[0]")),
    }
}

/// The key and the declaration at the beginning of a path within a part, and the rest of the path.
fn declared<'p>(
    part: Part,
    fields: &dyn Fields,
    rest: &'p [Segment],
    registry: &Registry,
) -> Result<(Key, Declared, &'p [Segment]), String> {
    let (at, mut known, mut has_material) = (part.path(), Vec::new(), false);
    fields.each(&mut |field, _, _| {
        known.extend((!field.key.is_empty()).then_some(field.key));
        has_material |= matches!(field.kind, Kind::Material);
    });
    known.extend(fields.parameters(registry).iter().map(|parameter| parameter.name));
    let materials: Vec<_> = registry.material_parameters().collect();
    let names: Vec<_> = materials.iter().map(|parameter| parameter.name).collect();
    match rest {
        [Segment::Key(material), rest @ ..] if has_material && material == "material" => {
            let [Segment::Key(name), tail @ ..] = rest else {
                return Err(format!(
                    "{} is not a single value; continue with one of its keys",
                    at.key("material")
                ));
            };
            let found = canonical(name, &names).and_then(|name| materials.iter().find(|p| p.name == name));
            let found = found.ok_or_else(|| {
                let labels =
                    materials.iter().flat_map(|p| [(p.name, p.name), (p.label, p.name), (p.symbol, p.name)]);
                let hint = did_you_mean(name, labels);
                format!(
                    "there is no {}: no model has such a parameter{hint}",
                    at.key("material").key(name.clone())
                )
            })?;
            Ok((Key::Material(found.name), Declared::Parameter(found), tail))
        }
        [Segment::Key(name), tail @ ..] => {
            let key = canonical(name, &known);
            let field = key.and_then(|key| fields.field(key));
            if key == Some(Object::repeat.key) {
                return Err(format!(
                    "{} makes a row of copies, which are single objects here; vary a value of each of them, or write \
                     scenes with other rows",
                    at.key(name.clone())
                ));
            }
            if let Some(Field {
                kind: Kind::Part | Kind::Parts | Kind::Parameters | Kind::Material, ..
            }) = field
            {
                return Err(format!(
                    "{} is not a single value; continue with one of its keys",
                    at.key(name.clone())
                ));
            }
            if let Some(field) = field {
                return Ok((Key::Own(field.key), Declared::Field(field), tail));
            }
            let parameter = key.and_then(|key| fields.parameters(registry).iter().find(|p| p.name == key));
            if let Some(parameter) = parameter {
                return Ok((Key::Own(parameter.name), Declared::Parameter(parameter), tail));
            }
            let hint = match canonical(name, &names) {
                Some(name) if has_material => {
                    format!(
                        "; it is a parameter of the material: {}",
                        at.key("material").key(name.to_owned())
                    )
                }
                Some(name) => {
                    format!("; parameters of materials belong to objects: objects[0].material.{name}")
                }
                None => other_types(part, fields, name, registry).unwrap_or_else(|| {
                    let others = OTHER_WORDS.iter().copied().filter(|(_, key)| known.contains(key));
                    did_you_mean(name, known.iter().map(|k| (*k, *k)).chain(others))
                }),
            };
            Err(format!("there is no {}{hint}", at.key(name.clone())))
        }
        [] => Err(format!("{at} is not a single value; continue with one of its keys")),
        [Segment::Index(i), ..] => Err(format!("{at} is not a list, so it has no [{i}]")),
    }
}

/// The value of a field in a text, if it has the type.
fn of_field(field: &Field, text: &str) -> Option<Value> {
    match field.kind {
        Kind::Number { .. } => text.parse().ok().map(Value::Number),
        Kind::Count(_) => text.parse::<u32>().ok().map(Value::from),
        Kind::Flag(_) => text.parse::<bool>().ok().map(Value::from),
        Kind::Text(_) | Kind::Id(_) | Kind::Choice(_) => Some(text.into()),
        Kind::Position | Kind::Direction | Kind::Step | Kind::Rotation => {
            <[f32; 3]>::try_from(numbers(text)?).ok().map(Value::Triple)
        }
        Kind::Colour => Colour { default: [0; 3] }.parse(text),
        Kind::Material | Kind::Parameters | Kind::List | Kind::Part | Kind::Parts => None,
    }
}

impl Scene {
    /// The scene with other values. Models and types come first, and numbers of materials that another model does not
    /// allow become the nearest that it allows, as in [views](super::Variant::applied), unless they are among the values.
    ///
    /// # Errors
    /// Returns the problems of the scene with these values.
    pub fn with<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a Place, &'a Value)>,
        registry: &Registry,
    ) -> Result<Self, Vec<Problem>> {
        let mut values = values.into_iter().peekable();
        if values.peek().is_none() {
            return Ok(self.clone());
        }
        let (scene, mut problems) = self.with_unchecked(values, registry);
        problems.extend(check::scene(&scene, registry));
        if problems.is_empty() { Ok(scene) } else { Err(problems) }
    }

    /// As [`with`](Self::with), but without checking the rules of scenes: returns the problems of values that have no
    /// place in the scene.
    pub(crate) fn with_unchecked<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a Place, &'a Value)>,
        registry: &Registry,
    ) -> (Self, Vec<Problem>) {
        let (mut scene, mut problems) = (self.clone(), Vec::new());
        let (first, others): (Vec<_>, Vec<_>) =
            values.into_iter().partition(|(place, _)| place.comes_first());
        let mut put = |scene: &mut Self, (place, value): &(&Place, &Value)| {
            if !place.put(scene, value, registry) {
                let rule = "this cannot be set here";
                problems.push(Problem::value(place.path.clone(), value.written(), rule));
            }
        };
        first.iter().for_each(|one| put(&mut scene, one));
        if !first.is_empty() {
            scene.bring_into_range(registry);
        }
        others.iter().for_each(|one| put(&mut scene, one));
        (scene, problems)
    }
}

/// Reads a path such as `objects[0].material.alpha`.
///
/// # Errors
/// Returns the byte of the first mistake, and the mistake.
pub fn path(text: &str) -> Result<Path, (usize, String)> {
    let mut path = Path::root();
    let mut at = 0;
    while at < text.len() {
        if path.segments().len() == MAX_DEPTH {
            let what = format!("a path has at most {MAX_DEPTH} steps; no path in a scene has more than five");
            return Err((at, what));
        }
        let rest = &text[at..];
        if let Some(inside) = rest.strip_prefix('[') {
            let end = inside.find(']').ok_or((at, "this bracket is never closed".to_owned()))?;
            let written = &inside[..end];
            let rule = "is not an index; an index is a whole number, 0 or more";
            let index =
                written.trim().parse().map_err(|_| (at + 1, format!("{} {rule}", quoted(written))))?;
            path = path.then(Segment::Index(index));
            at += end + 2;
            continue;
        }
        let dot = usize::from(rest.starts_with('.') && at > 0);
        let word = &rest[dot..];
        let length = word.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(word.len());
        if length == 0 || dot == 0 && at > 0 {
            let what =
                "a path consists of keys with dots between them, and of [indices] in lists: objects[0].size";
            return Err((at, what.to_owned()));
        }
        path = path.then(Segment::Key(word[..length].to_owned().into()));
        at += dot + length;
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(text: &str) -> Result<Place, String> {
        Place::find(text, &Scene::default(), &Registry::builtin())
    }

    fn set(path: &str, text: &str) -> Result<Scene, String> {
        let registry = Registry::builtin();
        let place = find(path)?;
        let value = place.read(text, &registry)?;
        let said =
            |problems: Vec<Problem>| problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
        Scene::default().with([(&place, &value)], &registry).map_err(said)
    }

    #[test]
    fn every_kind_of_value_can_be_set_by_its_path() {
        let of = |path: &str, text: &str| set(path, text).unwrap_or_else(|e| panic!("{path}: {e}"));
        assert_eq!(of("reflection_model", "phong").reflection_model, "phong");
        assert_eq!(of("observer.field_of_view", "30").observer.field_of_view, 30.0);
        assert_eq!(of("observer.position[2]", "8").observer.position.z, 8.0);
        assert_eq!(of("lights[0].colour", "#ff8000").lights[0].colour, [255, 128, 0]);
        assert_eq!(of("lights[0].color[1]", "7").lights[0].colour, [255, 7, 255]);
        assert_eq!(of("lights[0].luminous_flux", "400").lights[0].luminous_flux, Some(400.0));
        assert_eq!(of("lights[0].enabled", "false").shining().count(), 0);
        assert_eq!(of("objects[0].position", "[1, 2, 3]").objects[0].position.to_array(), [1.0, 2.0, 3.0]);
        assert_eq!(of("objects[0].tessellation", "9").objects[0].tessellation, Some(9));
        assert_eq!(of("display.tone_mapping", "aces").display.tone_mapping.id(), "aces");
        let material = &of("objects[0].material.roughness", "0.25").objects[0].material;
        assert_eq!(material.0["roughness"], Value::Number(0.25));
        let colour = &of("objects[0].material.base_colour[0]", "10").objects[0].material;
        assert_eq!(colour.0["base_colour"], Value::Colour([10, 255, 255]));
    }

    #[test]
    fn what_is_wrong_is_said_with_the_nearest() {
        for (path, text, expected) in [
            ("objects[0].material.roughnes", "1", "did you mean \"roughness\"?"),
            ("objects[0].roughness", "1", "it is a parameter of the material: objects[0].material.roughness"),
            ("roughness", "1", "objects[0].material.roughness"),
            ("objects[0].scale", "1", "did you mean \"size\"?"),
            ("objects[7].size", "1", "there is no objects[7]: the scene has 1 object, counted from 0"),
            ("objects.size", "1", "objects is a list; continue with an index, as in objects[0]"),
            ("observer", "1", "observer is not a single value"),
            ("objects[0].size[1]", "1", "objects[0].size is a single value; the path ends there"),
            ("objects[0].position[3]", "1", "has the components [0], [1] and [2]"),
            ("objects[0]..size", "1", "a path consists of keys"),
            ("objects[0].size", "big", "objects[0].size is big, but a size must be greater than 0"),
            (
                "objects[0].material.k_d",
                "2",
                "objects[0].material.k_d is 2, but the diffuse coefficient must be between",
            ),
            ("reflection_model", "lambrt", "did you mean"),
            ("display.tone_mapping", "acess", "did you mean"),
            ("lights[0].colour[0]", "300", "a whole number from 0 to 255"),
            ("lights[0].position", "[1, 2]", "three numbers"),
            ("lights[0].position[1]", "1e39", "is 1e39, but numbers must be between -3.4e38 and 3.4e38"),
            ("lights[0].position[1]", "high", "it must be a number"),
            ("lights[0].position", "[1, 2, 99]", "must be inside the room"),
        ] {
            let said = set(path, text).expect_err(path);
            assert!(said.contains(expected), "{path}: {said}");
        }
    }

    #[test]
    fn another_model_brings_other_values_into_its_range_unless_they_are_given() {
        let registry = Registry::builtin();
        let places = ["reflection_model", "objects[0].material.k_d"].map(|path| find(path).expect(path));
        let model = Value::from("phong");
        let mut scene = Scene::default();
        scene.objects[0].material.set("k_d", Value::Number(0.2));
        let phong = scene.with([(&places[0], &model)], &registry).expect("brought into range");
        assert_eq!(phong.objects[0].material.0["k_d"], Value::Number(0.5));
        let given = Value::Number(0.2);
        let both = [(&places[1], &given), (&places[0], &model)];
        let said = scene.with(both, &registry).expect_err("out of range")[0].to_string();
        assert!(
            said.starts_with("objects[0].material.k_d is 0.2, but the diffuse coefficient must be"),
            "{said}"
        );
    }
}
