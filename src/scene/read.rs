//! From JSON to a [`Scene`]: types, unknown, missing and repeated keys are found here; ranges and
//! relations are [`check`]'s. Every problem gets the place of the value that it is about.

use std::{
    borrow::Cow,
    collections::{BTreeSet, HashSet},
};

use glam::Vec3;
use jsonc_parser::{
    CollectOptions, ParseOptions,
    ast::{Object as AstObject, ObjectProp, Value as Ast},
    common::Ranged,
    parse_to_ast,
};

use super::{
    DEFAULT_DIMENSION, DEFAULT_REFLECTION_MODEL, DEFAULT_SHADING_MODEL, Display, Light, MAX_DIMENSION,
    Object, Observer, Scene, SceneSize, check,
    error::{LoadError, Path, Problem, Segment},
    lacking_size,
    load::{Defaults, Lines, Missing},
};
use crate::{
    light::LightEntry,
    optics::{colour::Encoding, tone::ToneMapping},
    parameter::{Parameter, ParameterKind, Value, Values},
    registry::Registry,
    text::{quoted, shortened},
};

/// The keys of a scene. The order is that of messages.
pub(super) const SCENE_KEYS: &[&str] = &[
    "scene_size",
    "reflection_model",
    "shading_model",
    "lights",
    "observer",
    "objects",
    "display",
    "name",
    "description",
    "$schema",
];
/// The keys of `scene_size`.
pub(super) const SIZE_KEYS: &[&str] = &["height", "width", "depth"];
/// The keys that lights of every type may have.
pub(super) const LIGHT_KEYS: &[&str] = &[
    "type",
    "name",
    "enabled",
    "position",
    "direction",
    "colour",
    "colour_temperature",
    "intensity",
    "luminous_flux",
];
/// Keys of a light of which it has one or the other; the first counts where neither is given.
pub(super) const LIGHT_ALTERNATIVES: [[&str; 2]; 2] =
    [["intensity", "luminous_flux"], ["colour", "colour_temperature"]];
/// The keys of `observer`.
pub(super) const OBSERVER_KEYS: &[&str] = &["position", "direction", "field_of_view"];
/// The keys of an object.
pub(super) const OBJECT_KEYS: &[&str] = &[
    "type",
    "name",
    "visible",
    "position",
    "size",
    "rotation",
    "tessellation",
    "reflection_model",
    "shading_model",
    "material",
];
/// The keys of `display`.
pub(super) const DISPLAY_KEYS: &[&str] = &["tone_mapping", "exposure", "encoding"];

/// Other words for keys, for suggestions only: what other programs call them.
const OTHER_WORDS: &[(&str, &str)] = &[
    ("camera", "observer"),
    ("eye", "observer"),
    ("viewer", "observer"),
    ("fov", "field_of_view"),
    ("scale", "size"),
    ("radius", "size"),
    ("room", "scene_size"),
    ("lighting_model", "reflection_model"),
    ("shading", "shading_model"),
    ("reflection", "reflection_model"),
    ("shape", "type"),
    ("kind", "type"),
    ("location", "position"),
    ("orientation", "rotation"),
    ("look_at", "direction"),
    ("brightness", "intensity"),
    ("power", "intensity"),
    ("lumen", "luminous_flux"),
    ("lumens", "luminous_flux"),
    ("flux", "luminous_flux"),
    ("kelvin", "colour_temperature"),
    ("temperature", "colour_temperature"),
    ("segments", "tessellation"),
    ("subdivisions", "tessellation"),
    ("title", "name"),
    ("on", "enabled"),
    ("off", "enabled"),
    ("hidden", "visible"),
    ("visibility", "visible"),
    ("gamma", "encoding"),
    ("angle", "cone_angle"),
    ("shininess", "alpha"),
];

/// So many unknown keys get a suggestion; more would take long in a hostile file.
const MAX_SUGGESTIONS: usize = 200;

/// So many problems are listed. A scene within the limits of lights and objects that is wrong in every
/// field has fewer; a hostile file could have millions.
const MAX_PROBLEMS: usize = 200_000;

/// Reads a scene from JSON whose syntax is checked already.
pub(super) fn scene(
    text: &str,
    name: &str,
    registry: &Registry,
    defaults: Defaults,
) -> Result<(Scene, Vec<Missing>), LoadError> {
    let parsed = parse_to_ast(text, &CollectOptions::default(), &STRICT);
    let syntax = |at: usize, what: String| LoadError::Syntax {
        name: name.to_owned(),
        place: Lines::new(text).place(at),
        what,
    };
    // The two parsers agree but for half surrogate pairs, which only this one refuses.
    let root = parsed
        .map_err(|e| {
            let what = e.kind().to_string();
            syntax(e.range().start, what.to_lowercase())
        })?
        .value
        .ok_or_else(|| LoadError::Empty { name: name.to_owned() })?;

    let mut reader = Reader::new(text, registry);
    let scene = reader.scene(&root);
    reader.check(&scene, &root);
    let Reader { mut problems, missing, unlisted, lines, .. } = reader;
    if problems.is_empty() {
        return Ok((scene, missing));
    }
    if defaults == Defaults::Refuse {
        // A missing size may be told already.
        let told = |m: &&Missing| problems.iter().any(|(_, p)| p.path == m.path);
        let more: Vec<_> = missing.iter().filter(|m| !told(m)).map(|m| (0, m.problem())).collect();
        problems.extend(more);
    }
    problems.sort_by_key(|(at, _)| *at);
    if unlisted > 0 {
        let more = format!("has {unlisted} more problems, which are not listed");
        problems.push((text.len(), Problem::about(Path::root(), more)));
    }
    let problems = problems
        .into_iter()
        .map(|(at, problem)| Problem {
            place: Some(problem.place.unwrap_or_else(|| lines.place(at))),
            ..problem
        })
        .collect();
    Err(LoadError::Invalid { name: name.to_owned(), problems })
}

/// The reflection models that a scene names, from JSON whose syntax is checked already.
pub(super) fn models_named(text: &str, registry: &Registry) -> BTreeSet<String> {
    let parsed = parse_to_ast(text, &CollectOptions::default(), &STRICT);
    let root = parsed.ok().and_then(|parsed| parsed.value);
    let scene = root.map(|root| Reader::new(text, registry).scene(&root));
    scene.map_or_else(BTreeSet::new, |scene| scene.models().into_iter().map(str::to_owned).collect())
}

/// JSON and nothing else.
const STRICT: ParseOptions = ParseOptions {
    allow_comments: false,
    allow_loose_object_property_names: false,
    allow_trailing_commas: false,
    allow_missing_commas: false,
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

/// The keys that some type of light has.
fn light_keys(registry: &Registry) -> Vec<&'static str> {
    let declared = registry.lights().iter().flat_map(|l| l.declaration.parameters).map(|p| p.name);
    let mut keys = LIGHT_KEYS.to_vec();
    for name in declared {
        if !keys.contains(&name) {
            keys.push(name);
        }
    }
    keys
}

/// A key as the format spells it: `color` is read as `colour`, `base_color` as `base_colour`.
fn canonical(written: &str, known: &[&'static str]) -> Option<&'static str> {
    let find = |key: &str| known.iter().find(|k| **k == key).copied();
    find(written).or_else(|| written.contains("color").then(|| find(&written.replace("color", "colour")))?)
}

/// What is being read.
struct Reader<'a> {
    text: &'a str,
    registry: &'a Registry,
    /// Problems, each with the byte that it is about.
    problems: Vec<(usize, Problem)>,
    /// Paths whose values could not be read: what stands in for them is not checked.
    reported: HashSet<Path>,
    missing: Vec<Missing>,
    /// How many problems there are beyond [`MAX_PROBLEMS`].
    unlisted: usize,
    suggestions: usize,
    light_keys: Vec<&'static str>,
    material_keys: Vec<&'static str>,
    lines: Lines<'a>,
}

/// The known fields of an object, each key once.
struct Fields<'b, 'a> {
    path: Path,
    start: usize,
    fields: Vec<(&'static str, &'b ObjectProp<'a>)>,
}

impl<'b, 'a> Fields<'b, 'a> {
    fn get(&self, key: &str) -> Option<&'b Ast<'a>> {
        self.fields.iter().find(|(k, _)| *k == key).map(|(_, p)| &p.value)
    }
}

impl<'a> Reader<'a> {
    fn new(text: &'a str, registry: &'a Registry) -> Self {
        Self {
            text,
            registry,
            problems: Vec::new(),
            reported: HashSet::new(),
            missing: Vec::new(),
            unlisted: 0,
            suggestions: 0,
            light_keys: light_keys(registry),
            material_keys: registry.material_parameters().map(|p| p.name).collect(),
            lines: Lines::new(text),
        }
    }
}

impl Reader<'_> {
    fn scene(&mut self, root: &Ast) -> Scene {
        let mut scene = Scene { name: None, description: None, ..Scene::default() };
        let path = Path::root();
        let Some(fields) = self.fields(root, path.clone(), SCENE_KEYS, "a scene") else { return scene };

        scene.name = self.text_field(&fields, "name", "the name must be text");
        scene.description = self.text_field(&fields, "description", "the description must be text");
        self.text_field(&fields, "$schema", "the address of the schema must be text");
        scene.scene_size = self.scene_size(&fields);
        for (key, default, to) in [
            ("reflection_model", DEFAULT_REFLECTION_MODEL, &mut scene.reflection_model),
            ("shading_model", DEFAULT_SHADING_MODEL, &mut scene.shading_model),
        ] {
            match fields.get(key) {
                None => self.missing(path.key(key), fields.start, default.to_owned()),
                Some(value) => {
                    let rule = self.id_rule(key);
                    if let Some(id) = self.string(value, &path, key, &rule) {
                        *to = id;
                    }
                }
            }
        }
        scene.lights = self.list(&fields, "lights", check::light_count, Self::light);
        match fields.get("observer") {
            None => self.lacking(&fields, "observer", "a scene needs one observer"),
            Some(Ast::Array(list)) => {
                let predicate =
                    format!("is a list of {}, but a scene has exactly one observer", list.elements.len());
                self.report(list.start(), Problem::about(path.key("observer"), predicate));
            }
            Some(value) => scene.observer = self.observer(value),
        }
        scene.objects = self.list(&fields, "objects", check::object_count, Self::object);
        if let Some(value) = fields.get("display") {
            scene.display = self.display(value);
        }
        scene
    }

    fn scene_size(&mut self, scene: &Fields) -> SceneSize {
        let path = scene.path.key("scene_size");
        let mut size = SceneSize::default();
        let Some(value) = scene.get("scene_size") else {
            let d = DEFAULT_DIMENSION;
            self.missing(path, scene.start, format!("{d} × {d} × {d} m"));
            return size;
        };
        // While its own size is unknown, the room is as large as may be, so that positions do not seem
        // to be outside.
        let unknown = SceneSize { height: MAX_DIMENSION, width: MAX_DIMENSION, depth: MAX_DIMENSION };
        let Some(fields) = self.fields(value, path.clone(), SIZE_KEYS, "scene_size") else { return unknown };
        let extents = [("height", &mut size.height), ("width", &mut size.width), ("depth", &mut size.depth)];
        for (axis, to) in extents {
            match fields.get(axis) {
                None => self.missing(path.key(axis), fields.start, format!("{DEFAULT_DIMENSION} m")),
                Some(value) => {
                    let rule = rule_of(check::dimension(axis, f32::NAN));
                    *to = self.number(value, &path, axis, &rule).unwrap_or(MAX_DIMENSION);
                }
            }
        }
        size
    }

    fn light(&mut self, value: &Ast, path: Path) -> Light {
        let mut light = Light { position: None, ..Light::default() };
        let keys = self.light_keys.clone();
        let Some(fields) = self.fields(value, path.clone(), &keys, "a light") else { return light };
        let rule = self.id_rule("light type");
        match fields.get("type") {
            None => self.lacking(&fields, "type", &rule),
            Some(value) => light.kind = self.string(value, &path, "type", &rule).unwrap_or_default(),
        }
        let entry = self.registry.light(&light.kind);
        light.name = self.text_field(&fields, "name", "the name must be text");
        light.enabled = self.flag(&fields, "enabled");
        if let Some(value) = fields.get("position") {
            light.position = Some(self.vector(value, &path, "position", "a position"));
        }
        if let Some(value) = fields.get("direction") {
            light.direction = Some(self.vector(value, &path, "direction", "a direction"));
        }
        if let Some(value) = fields.get("colour") {
            light.colour = self.colour(value, &path, "colour", COLOUR_RULE).unwrap_or(light.colour);
        }
        light.intensity = entry.map_or(light.intensity, |e| e.declaration.default_intensity);
        if let Some(value) = fields.get("intensity") {
            let rule = rule_of(check::intensity(f32::NAN));
            light.intensity = self.number(value, &path, "intensity", &rule).unwrap_or(light.intensity);
        }
        if let Some(value) = fields.get("luminous_flux") {
            let rule = rule_of(check::luminous_flux(f32::NAN));
            light.luminous_flux = self.number(value, &path, "luminous_flux", &rule);
        }
        if let Some(value) = fields.get("colour_temperature") {
            let rule = rule_of(check::colour_temperature(f32::NAN));
            light.colour_temperature = self.number(value, &path, "colour_temperature", &rule);
        }
        for [one, other] in LIGHT_ALTERNATIVES {
            // That the type has no flux is said by the check, and says enough.
            let possible = other != "luminous_flux" || entry.is_none_or(LightEntry::has_flux);
            if let (Some(_), Some(value), true) = (fields.get(one), fields.get(other), possible) {
                let predicate = format!("is given, but so is {one}; a light has one of the two");
                self.report(value.start(), Problem::about(path.key(other), predicate));
            }
        }
        for (key, property) in &fields.fields {
            let own = entry.and_then(|e| e.declaration.parameters.iter().find(|p| p.name == *key));
            let of_any = || self.registry.lights().iter().flat_map(|l| l.declaration.parameters);
            if let Some(parameter) = own.or_else(|| of_any().find(|p| p.name == *key))
                && let Some(value) = self.parameter(&property.value, &path, parameter)
            {
                light.parameters.set(parameter.name, value);
            }
        }
        light
    }

    fn observer(&mut self, value: &Ast) -> Observer {
        let path = Path::root().key("observer");
        let mut observer = Observer { position: Vec3::NAN, ..Observer::default() };
        let Some(fields) = self.fields(value, path.clone(), OBSERVER_KEYS, "the observer") else {
            return observer;
        };
        match fields.get("position") {
            None => self.lacking(&fields, "position", "the observer needs one"),
            Some(value) => observer.position = self.vector(value, &path, "position", "a position"),
        }
        match fields.get("direction") {
            None => self.lacking(&fields, "direction", "the observer needs one"),
            Some(value) => observer.direction = self.vector(value, &path, "direction", "a direction"),
        }
        if let Some(value) = fields.get("field_of_view") {
            let rule = rule_of(check::field_of_view(f32::NAN));
            let degrees = self.number(value, &path, "field_of_view", &rule);
            observer.field_of_view = degrees.unwrap_or(observer.field_of_view);
        }
        observer
    }

    fn object(&mut self, value: &Ast, path: Path) -> Object {
        let mut object = Object { position: Vec3::NAN, ..Object::default() };
        let Some(fields) = self.fields(value, path.clone(), OBJECT_KEYS, "an object") else { return object };
        match fields.get("type") {
            None => {
                let rule = self.id_rule("object type");
                self.lacking(&fields, "type", &rule);
            }
            Some(Ast::StringLit(id)) => id.value.as_ref().clone_into(&mut object.kind),
            Some(value) => {
                let rule = self.id_rule("object type");
                self.wrong(value, &path, "type", &rule);
            }
        }
        object.name = self.text_field(&fields, "name", "the name must be text");
        object.visible = self.flag(&fields, "visible");
        match fields.get("position") {
            None => self.lacking(&fields, "position", "an object needs one"),
            Some(value) => object.position = self.vector(value, &path, "position", "a position"),
        }
        if let Some(value) = fields.get("size") {
            let size = self.number(value, &path, "size", "a size must be greater than 0");
            object.size = size.unwrap_or(object.size);
        }
        if let Some(value) = fields.get("rotation") {
            object.rotation = self.vector(value, &path, "rotation", "a rotation");
        }
        if let Some(value) = fields.get("tessellation") {
            let rule = match self.registry.shape(&object.kind) {
                Some(shape) => check::tessellation_rule(shape),
                None => "the tessellation must be a whole number".to_owned(),
            };
            object.tessellation = self.integer(value, &path, "tessellation", &rule).and_then(|count| {
                u32::try_from(count).map_err(|_| self.wrong(value, &path, "tessellation", &rule)).ok()
            });
        }
        for (key, to) in
            [("reflection_model", &mut object.reflection_model), ("shading_model", &mut object.shading_model)]
        {
            match fields.get(key) {
                None => {}
                Some(Ast::StringLit(id)) => *to = Some(id.value.clone().into_owned()),
                Some(value) => {
                    let rule = self.id_rule(key);
                    self.wrong(value, &path, key, &rule);
                }
            }
        }
        if let Some(value) = fields.get("material") {
            object.material = self.material(value, path.key("material"));
        }
        object
    }

    fn material(&mut self, value: &Ast, path: Path) -> Values {
        let mut values = Values::default();
        let keys = std::mem::take(&mut self.material_keys);
        let fields = self.fields(value, path.clone(), &keys, "a material");
        self.material_keys = keys;
        for (key, property) in fields.map(|f| f.fields).unwrap_or_default() {
            if let Some(parameter) = self.registry.material_parameter(key)
                && let Some(value) = self.parameter(&property.value, &path, parameter)
            {
                values.set(parameter.name, value);
            }
        }
        values
    }

    fn display(&mut self, value: &Ast) -> Display {
        let path = Path::root().key("display");
        let mut display = Display::default();
        let Some(fields) = self.fields(value, path.clone(), DISPLAY_KEYS, "display") else { return display };
        if let Some(id) = self.choice(&fields, "tone_mapping", check::tone_mapping) {
            display.tone_mapping = ToneMapping::from_id(&id).unwrap_or_default();
        }
        if let Some(id) = self.choice(&fields, "encoding", check::encoding) {
            display.encoding = Encoding::ALL.into_iter().find(|e| e.id() == id).unwrap_or_default();
        }
        if let Some(value) = fields.get("exposure") {
            let rule = rule_of(check::exposure(f32::NAN));
            display.exposure = self.number(value, &path, "exposure", &rule).unwrap_or_default();
        }
        display
    }

    /// A parameter as it is declared, if the value has its type. Its range is checked later.
    fn parameter(&mut self, value: &Ast, path: &Path, parameter: &'static Parameter) -> Option<Value> {
        let rule = || check::parameter_rule(parameter);
        let key = parameter.name;
        match parameter.kind {
            ParameterKind::Number { .. } => self.number(value, path, key, &rule()).map(Value::Number),
            ParameterKind::Integer { .. } => self.integer(value, path, key, &rule()).map(Value::Integer),
            ParameterKind::Colour { .. } => self.colour(value, path, key, &rule()).map(Value::Colour),
            ParameterKind::Triple { .. } => self.triple(value, path, key, &rule()).map(Value::Triple),
            ParameterKind::Choice { options, .. } => {
                let id = self.string(value, path, key, &rule())?;
                let known = options.iter().map(|(id, _)| *id).find(|known| *known == id);
                Some(Value::Choice(known.map_or(Cow::Owned(id), Cow::Borrowed)))
            }
        }
    }

    /// The entries of a list of lights or objects. Of a list that is too long, only the length is
    /// reported: it may be very long.
    fn list<T>(
        &mut self,
        scene: &Fields,
        key: &'static str,
        count: fn(usize) -> check::Rule,
        mut read: impl FnMut(&mut Self, &Ast, Path) -> T,
    ) -> Vec<T> {
        let path = scene.path.key(key);
        match scene.get(key) {
            None => self.lacking(scene, key, &format!("a scene must have a list of {key}")),
            Some(value @ Ast::Array(list)) => match count(list.elements.len()) {
                Err(rule) => self.wrong(value, &scene.path, key, &rule),
                Ok(()) => {
                    return list
                        .elements
                        .iter()
                        .enumerate()
                        .map(|(i, e)| read(self, e, path.index(i)))
                        .collect();
                }
            },
            Some(value) => self.wrong(value, &scene.path, key, &format!("a scene must have a list of {key}")),
        }
        Vec::new()
    }

    /// The fields of an object by canonical key. Reports what is not an object, unknown keys, and keys
    /// given twice.
    fn fields<'b, 'a>(
        &mut self,
        value: &'b Ast<'a>,
        path: Path,
        known: &[&'static str],
        what: &str,
    ) -> Option<Fields<'b, 'a>> {
        let Ast::Object(object) = value else {
            let rule =
                format!("{what} must be an object, with the keys {}", crate::text::listed(known, "and"));
            self.report(value.start(), Problem::value(path, self.describe(value), rule));
            return None;
        };
        let mut fields: Vec<(&'static str, &'b ObjectProp<'a>)> =
            Vec::with_capacity(object.properties.len().min(16));
        for property in &object.properties {
            let written = property.name.as_str();
            match canonical(written, known) {
                None => self.unknown(property, &path, known, what),
                Some(key) => match fields.iter().find(|(k, _)| *k == key) {
                    None => fields.push((key, property)),
                    Some((_, first)) => {
                        let at = self.lines.place(first.start());
                        let again = if first.name.as_str() == written {
                            String::new()
                        } else {
                            format!(" as {written}")
                        };
                        let predicate = format!("is given twice{again}; it is given first at {at}");
                        self.report(property.start(), Problem::about(path.key(key), predicate));
                    }
                },
            }
        }
        Some(Fields { path, start: object.start(), fields })
    }

    /// Reports an unknown key, with the nearest known one or where else it belongs.
    fn unknown(&mut self, property: &ObjectProp, path: &Path, known: &[&'static str], what: &str) {
        let written = property.name.as_str();
        self.suggestions += 1;
        let hint = if self.suggestions > MAX_SUGGESTIONS {
            String::new()
        } else if what == "an object" && canonical(written, &self.material_keys).is_some() {
            "; it is a parameter of the material: write it in \"material\"".to_owned()
        } else {
            let others = OTHER_WORDS.iter().copied().filter(|(_, key)| known.contains(key));
            let labels =
                self.registry.material_parameters().flat_map(|p| [(p.label, p.name), (p.symbol, p.name)]);
            let labels = labels.filter(|_| what == "a material");
            let spelling = written.replace("color", "colour");
            match crate::text::nearest(&spelling, known.iter().map(|k| (*k, *k)).chain(others).chain(labels))
            {
                Some(nearest) => format!("; did you mean {}?", quoted(nearest)),
                None => format!("; {what} has the keys {}", crate::text::listed(known, "and")),
            }
        };
        let key = shortened(written);
        self.report_only(
            property.start(),
            Problem::about(path.key(key), format!("is not a key of {what}{hint}")),
        );
    }

    fn text_field(&mut self, fields: &Fields, key: &'static str, rule: &str) -> Option<String> {
        fields.get(key).and_then(|value| self.string(value, &fields.path, key, rule))
    }

    /// Yes or no; yes where it is not given.
    fn flag(&mut self, fields: &Fields, key: &'static str) -> bool {
        match fields.get(key) {
            None => true,
            Some(Ast::BooleanLit(flag)) => flag.value,
            Some(value) => {
                self.wrong(value, &fields.path, key, &format!("{key} must be true or false"));
                true
            }
        }
    }

    fn choice(
        &mut self,
        fields: &Fields,
        key: &'static str,
        check: fn(&str) -> check::Rule,
    ) -> Option<String> {
        let value = fields.get(key)?;
        let id = self.string(value, &fields.path, key, &rule_of(check("")))?;
        if let Err(rule) = check(&id) {
            self.wrong(value, &fields.path, key, &rule);
            return None;
        }
        Some(id)
    }

    fn string(&mut self, value: &Ast, path: &Path, key: &'static str, rule: &str) -> Option<String> {
        if let Ast::StringLit(text) = value {
            return Some(text.value.clone().into_owned());
        }
        self.wrong(value, path, key, rule);
        None
    }

    /// A number in 32 bits; too large a one is infinite, so that its rule refuses it.
    fn number(&mut self, value: &Ast, path: &Path, key: &'static str, rule: &str) -> Option<f32> {
        let number = number_of(value);
        if number.is_none() {
            self.wrong(value, path, key, &needs("a number", value, rule));
        }
        number
    }

    /// A whole number. `32.0` and `3.2e1` are whole: JSON does not tell them from `32`.
    fn integer(&mut self, value: &Ast, path: &Path, key: &'static str, rule: &str) -> Option<i64> {
        let integer = integer_of(value);
        if integer.is_none() {
            let rule = match value {
                Ast::NumberLit(_) => rule.to_owned(),
                _ => needs("a whole number", value, rule),
            };
            self.wrong(value, path, key, &rule);
        }
        integer
    }

    /// Three numbers; not-a-number where they could not be read.
    fn vector(&mut self, value: &Ast, path: &Path, key: &'static str, what: &str) -> Vec3 {
        let rule = format!("{what} must be three numbers: [x, y, z]");
        let Ast::Array(list) = value else {
            self.wrong(value, path, key, &rule);
            return Vec3::NAN;
        };
        let [x, y, z] = list.elements.as_slice() else {
            self.wrong(value, path, key, &rule);
            return Vec3::NAN;
        };
        let mut vector = Vec3::NAN;
        for (i, element) in [x, y, z].into_iter().enumerate() {
            match number_of(element) {
                Some(number) => vector[i] = number,
                None => {
                    let found = self.describe(element);
                    self.report_only(
                        element.start(),
                        Problem::value(path.key(key).index(i), found, rule.clone()),
                    );
                    self.reported.insert(path.key(key));
                }
            }
        }
        if self.reported.contains(&path.key(key)) { Vec3::NAN } else { vector }
    }

    /// Three whole numbers from 0 to 255.
    /// Three numbers, or one for all three.
    fn triple(&mut self, value: &Ast, path: &Path, key: &'static str, rule: &str) -> Option<[f32; 3]> {
        match value {
            Ast::NumberLit(_) => self.number(value, path, key, rule).map(|v| [v; 3]),
            Ast::Array(list) if list.elements.len() == 3 => {
                let mut triple = [0.0; 3];
                let mut good = true;
                for (to, element) in triple.iter_mut().zip(&list.elements) {
                    match self.number(element, path, key, rule) {
                        Some(v) => *to = v,
                        None => good = false,
                    }
                }
                good.then_some(triple)
            }
            _ => {
                self.wrong(value, path, key, rule);
                None
            }
        }
    }

    fn colour(&mut self, value: &Ast, path: &Path, key: &'static str, rule: &str) -> Option<[u8; 3]> {
        let Ast::Array(list) = value else {
            let hint = match value {
                Ast::StringLit(text) => hexadecimal(&text.value)
                    .map_or_else(String::new, |[r, g, b]| format!("; write [{r}, {g}, {b}]")),
                _ => String::new(),
            };
            self.wrong(value, path, key, &format!("{rule}{hint}"));
            return None;
        };
        let [_, _, _] = list.elements.as_slice() else {
            self.wrong(value, path, key, rule);
            return None;
        };
        let mut colour = [0; 3];
        let mut whole = true;
        for (i, element) in list.elements.iter().enumerate() {
            match integer_of(element).and_then(|v| u8::try_from(v).ok()) {
                Some(v) => colour[i] = v,
                None => {
                    whole = false;
                    let found = self.describe(element);
                    self.report(element.start(), Problem::value(path.key(key).index(i), found, rule));
                }
            }
        }
        whole.then_some(colour)
    }

    /// What the rule for an id is, for values that are no text.
    fn id_rule(&self, key: &str) -> String {
        rule_of(match key {
            "reflection_model" => check::reflection_model(self.registry, ""),
            "shading_model" => check::shading_model(self.registry, ""),
            "light type" => check::light_type(self.registry, ""),
            _ => check::object_type(self.registry, ""),
        })
    }

    /// Reports a value of a wrong type.
    fn wrong(&mut self, value: &Ast, path: &Path, key: &'static str, rule: &str) {
        let found = self.describe(value);
        self.report(value.start(), Problem::value(path.key(key), found, rule));
    }

    /// Reports that a required key is missing.
    fn lacking(&mut self, fields: &Fields, key: &'static str, why: &str) {
        self.report(fields.start, Problem::about(fields.path.key(key), format!("is missing; {why}")));
    }

    /// Notes that a part is missing which has a default.
    fn missing(&mut self, path: Path, at: usize, default: String) {
        self.missing.push(Missing { path, default, place: Some(self.lines.place(at)) });
    }

    /// Adds a problem and remembers that its path is not to be checked.
    fn report(&mut self, at: usize, problem: Problem) {
        if self.problems.len() < MAX_PROBLEMS {
            self.reported.insert(problem.path.clone());
        }
        self.report_only(at, problem);
    }

    fn report_only(&mut self, at: usize, problem: Problem) {
        if self.problems.len() < MAX_PROBLEMS {
            self.problems.push((at, problem));
        } else {
            self.unlisted += 1;
        }
    }

    /// A value as it is written, if it is short, and what it is otherwise.
    fn describe(&self, value: &Ast) -> String {
        describe(value, self.text)
    }

    /// Applies [`check`] and finds the places of what it finds.
    fn check(&mut self, scene: &Scene, root: &Ast) {
        let mut problems = check::scene(scene, self.registry);
        if !self.reported.is_empty() {
            problems.retain(|problem| !problem.path.ancestors().any(|p| self.reported.contains(&p)));
        }
        for mut problem in lacking_size::explain(problems, scene, &self.missing) {
            let (at, value) = locate(root, &problem.path);
            if let (Some(value), Some(found)) = (value, &mut problem.found) {
                *found = self.describe(value);
            }
            self.report_only(at, problem);
        }
    }
}

/// What every colour must be.
const COLOUR_RULE: &str = "a colour must be three whole numbers from 0 to 255: [red, green, blue]";

/// The rule that a check broke.
fn rule_of(rule: check::Rule) -> String {
    rule.err().unwrap_or_default()
}

/// What is needed instead of a value of another type.
fn needs(what: &str, value: &Ast, rule: &str) -> String {
    match value {
        Ast::StringLit(text) if text.value.trim().parse::<f64>().is_ok() => {
            format!("it must be {what}, without quotes: {rule}")
        }
        _ => format!("it must be {what}: {rule}"),
    }
}

/// The number in 32 bits, rounded once; infinite if it is too large.
fn number_of(value: &Ast) -> Option<f32> {
    match value {
        Ast::NumberLit(number) => number.value.parse().ok(),
        _ => None,
    }
}

/// The whole number.
fn integer_of(value: &Ast) -> Option<i64> {
    let Ast::NumberLit(number) = value else { return None };
    if let Ok(integer) = number.value.parse() {
        return Some(integer);
    }
    // Beyond this, neighbouring whole numbers are the same in 64 bits.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let v: f64 = number.value.parse().ok()?;
    (v.fract() == 0.0 && v.abs() <= EXACT).then_some(v as i64)
}

/// `#ff8000` as three numbers.
fn hexadecimal(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.is_ascii())?;
    let channel = |i: usize| u8::from_str_radix(&digits[i..i + 2], 16).ok();
    Some([channel(0)?, channel(2)?, channel(4)?])
}

/// A value as it is written, if it is short, and what it is otherwise.
fn describe(value: &Ast, text: &str) -> String {
    let written = value.text(text);
    match value {
        Ast::Array(list) => {
            let short = list.elements.len() <= 4;
            let scalar = |e: &Ast| !matches!(e, Ast::Array(_) | Ast::Object(_));
            if short && list.elements.iter().all(scalar) {
                let elements: Vec<_> = list.elements.iter().map(|e| shortened(e.text(text))).collect();
                return format!("[{}]", elements.join(", "));
            }
            format!("a list of {}", list.elements.len())
        }
        Ast::Object(AstObject { properties, .. }) if properties.is_empty() => "{}".to_owned(),
        Ast::Object(_) => "an object".to_owned(),
        _ => shortened(written),
    }
}

/// The byte and the value of a path; if the value is missing, the byte of what lacks it.
fn locate<'b, 'a>(root: &'b Ast<'a>, path: &Path) -> (usize, Option<&'b Ast<'a>>) {
    let mut value = root;
    for segment in path.segments() {
        let next = match (segment, value) {
            (Segment::Index(i), Ast::Array(list)) => list.elements.get(*i),
            (Segment::Key(key), Ast::Object(object)) => {
                let same = |p: &&ObjectProp| {
                    let written = p.name.as_str();
                    written == key
                        || (written.contains("color") && written.replace("color", "colour") == *key)
                };
                object.properties.iter().find(same).map(|p| &p.value)
            }
            _ => None,
        };
        match next {
            Some(next) => value = next,
            None => return (value.start(), None),
        }
    }
    (value.start(), Some(value))
}
