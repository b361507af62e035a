//! Every constraint of a scene, once (R5, R6): the reader, the window and the writer all ask here.
//!
//! A rule for one field is a function that returns `Err` with the rule as a clause, so that it can end
//! a sentence: "k_d is 0.2, but **the diffuse coefficient must be between 0.5 and 1**". [`scene`]
//! applies them all to a whole scene, [`light`], [`object`] and their like to one part of it.

use super::{
    Light, MAX_DIMENSION, MAX_OBJECTS, Object, Observer, Scene, SceneSize,
    error::{Path, Problem},
};
use crate::{
    custom,
    light::{LightEntry, MAX_LIGHTS},
    optics::{
        colour::Encoding,
        temperature::{MAX_TEMPERATURE, MIN_TEMPERATURE},
        tone::ToneMapping,
    },
    parameter::{Parameter, ParameterKind, Value, Values},
    registry::Registry,
    shape::ShapeEntry,
    text::{self, did_you_mean, quoted},
};
use std::{collections::HashMap, fmt};

use glam::Vec3;

/// The narrowest legal field of view, degrees.
pub const MIN_FIELD_OF_VIEW: f32 = 1.0;
/// The widest legal field of view, degrees.
pub const MAX_FIELD_OF_VIEW: f32 = 170.0;
/// The legal exposures reach from minus this to plus this, EV.
pub const MAX_EXPOSURE: f32 = 16.0;

/// The largest legal size of an object, metres: a million kilometres. Far beyond, the squares of distances and of their
/// derivatives are no numbers any more on graphics cards, and there is no picture that both renderers could agree on.
pub const MAX_SIZE: f32 = 1e9;

/// `Ok`, or the rule that is broken.
pub type Rule = Result<(), String>;

/// `Ok` where a rule is kept.
fn must(kept: bool, rule: impl FnOnce() -> String) -> Rule {
    if kept { Ok(()) } else { Err(rule()) }
}

/// One extent of the room, in metres; `axis` is `height`, `width` or `depth`.
pub fn dimension(axis: &str, metres: f32) -> Rule {
    must(metres > 0.0 && metres <= MAX_DIMENSION, || {
        format!("the {axis} of the room must be greater than 0 and at most {MAX_DIMENSION} m")
    })
}

/// A position of a light, an object or the observer.
pub fn position(room: SceneSize, position: Vec3) -> Rule {
    must(room.contains(position), || {
        let SceneSize { width, height, depth } = room;
        format!(
            "a position must be inside the room: 0 < x ≤ {width} (width), 0 < y ≤ {height} (height), \
             0 < z ≤ {depth} (depth)"
        )
    })
}

/// A direction of a light or the observer. It need not have length 1.
pub fn direction(direction: Vec3) -> Rule {
    must(direction != Vec3::ZERO, || "a direction must not be zero".to_owned())?;
    must(direction.is_finite() && direction.try_normalize().is_some(), || {
        "this is too long or too short to be a direction; write it with a length near 1".to_owned()
    })
}

/// The intensity of a light.
pub fn intensity(value: f32) -> Rule {
    brightness("an intensity", value)
}

/// The luminous flux of a light, in lumen.
pub fn luminous_flux(value: f32) -> Rule {
    brightness("a luminous flux", value)
}

fn brightness(what: &str, value: f32) -> Rule {
    must(value >= 0.0 && value.is_finite(), || {
        if value == f32::INFINITY {
            format!("{what} must be at most 3.4e38")
        } else {
            format!("{what} must be at least 0")
        }
    })
}

/// The colour temperature of a light, in kelvin.
pub fn colour_temperature(kelvin: f32) -> Rule {
    must((MIN_TEMPERATURE..=MAX_TEMPERATURE).contains(&kelvin), || {
        format!("a colour temperature must be between {MIN_TEMPERATURE} and {MAX_TEMPERATURE} K")
    })
}

/// The vertical field of view of the observer, in degrees.
pub fn field_of_view(degrees: f32) -> Rule {
    must((MIN_FIELD_OF_VIEW..=MAX_FIELD_OF_VIEW).contains(&degrees), || {
        format!("the field of view must be between {MIN_FIELD_OF_VIEW} and {MAX_FIELD_OF_VIEW} degrees")
    })
}

/// The largest extent of an object, in metres.
pub fn size(metres: f32) -> Rule {
    must(metres > 0.0 && metres <= MAX_SIZE, || {
        if metres > MAX_SIZE {
            format!("a size must be at most {MAX_SIZE:e} m")
        } else {
            "a size must be greater than 0".to_owned()
        }
    })
}

/// Euler angles in degrees.
pub fn rotation(degrees: Vec3) -> Rule {
    must(degrees.is_finite(), || "a rotation must be three finite numbers of degrees".to_owned())
}

/// How finely an object of a type is cut.
pub fn tessellation(shape: &ShapeEntry, count: u32) -> Rule {
    let range = &shape.declaration.tessellation;
    must(range.contains(&count), || tessellation_rule(shape))
}

/// The rule of [`tessellation`].
pub(super) fn tessellation_rule(shape: &ShapeEntry) -> String {
    let range = &shape.declaration.tessellation;
    format!(
        "the tessellation of a {} must be a whole number between {} and {}",
        shape.declaration.id,
        range.start(),
        range.end()
    )
}

/// The exposure of the display, in EV.
pub fn exposure(ev: f32) -> Rule {
    must((-MAX_EXPOSURE..=MAX_EXPOSURE).contains(&ev), || {
        format!("the exposure must be between -{MAX_EXPOSURE} and {MAX_EXPOSURE} EV")
    })
}

/// The value of a declared parameter of a model or a light.
pub fn parameter(parameter: &Parameter, value: &Value) -> Rule {
    must(parameter.allows(value), || {
        let hint = match (&parameter.kind, value) {
            (ParameterKind::Choice { options, .. }, Value::Choice(id)) => did_you_mean(
                id,
                options.iter().map(|(id, name)| (*name, *id)).chain(options.iter().map(|(id, _)| (*id, *id))),
            ),
            _ => String::new(),
        };
        parameter_rule(parameter) + &hint
    })
}

/// The rule of [`parameter`].
pub(crate) fn parameter_rule(parameter: &Parameter) -> String {
    format!("the {} must be {}{}", parameter.label, parameter.rule(), unit(parameter))
}

/// The unit of a parameter after its range.
fn unit(parameter: &Parameter) -> String {
    match (parameter.unit, &parameter.kind) {
        ("", _) | (_, ParameterKind::Colour { .. } | ParameterKind::Choice { .. }) => String::new(),
        ("°", _) => " degrees".to_owned(),
        (unit, _) => format!(" {unit}"),
    }
}

/// A parameter in the material of an object: if the object's own model declares it, in its range there,
/// and otherwise in the range of some model that does.
pub fn material_parameter(registry: &Registry, model: &str, name: &str, value: &Value) -> Rule {
    if let Some(own) = registry.model(model).and_then(|m| m.parameter(name)) {
        return parameter(own, value);
    }
    let mut rule = None;
    for declared in registry.models().iter().filter_map(|m| m.parameter(name)) {
        match parameter(declared, value) {
            Ok(()) => return Ok(()),
            Err(broken) => rule = rule.or(Some(broken)),
        }
    }
    Err(rule.unwrap_or_else(|| unknown_material_parameter(registry, name)))
}

/// That no model declares a material parameter, and which one it might be.
pub(super) fn unknown_material_parameter(registry: &Registry, name: &str) -> String {
    let declared: Vec<_> = registry.material_parameters().collect();
    let also = declared.iter().flat_map(|p| [(p.label, p.name), (p.symbol, p.name)]);
    let known = declared.iter().map(|p| (p.name, p.name)).chain(also);
    format!("no reflection model has a parameter of that name{}", did_you_mean(name, known))
}

/// The id of a reflection model.
pub fn reflection_model(registry: &Registry, id: &str) -> Rule {
    let known = registry.models().iter().map(|m| (m.declaration.id, m.declaration.name));
    one_of("the reflection model", id, known).map_err(|rule| match registry.broken_model(id) {
        Some(why) => format!("the file of that custom model has a mistake: {why}"),
        None => rule + &own_model_missing(registry, id),
    })
}

/// That there is no file for an id, where own models are kept: it may have been left behind.
fn own_model_missing(registry: &Registry, id: &str) -> String {
    match registry.custom_folder() {
        Some(folder) if folder.is_dir() && custom::is_id(id) => {
            format!(
                "; among the custom models there is no {}",
                folder.join(id).with_extension(custom::EXTENSION).display()
            )
        }
        _ => String::new(),
    }
}

/// The id of a shading mode.
pub fn shading_model(registry: &Registry, id: &str) -> Rule {
    let known = registry.modes().iter().map(|m| (m.declaration.id, m.declaration.name));
    one_of("the shading model", id, known)
}

/// The id of a light type.
pub fn light_type(registry: &Registry, id: &str) -> Rule {
    one_of("the light type", id, registry.lights().iter().map(|l| (l.declaration.id, l.declaration.name)))
}

/// The id of an object type.
pub fn object_type(registry: &Registry, id: &str) -> Rule {
    one_of("the object type", id, registry.shapes().iter().map(|s| (s.declaration.id, s.declaration.name)))
}

/// The id of a tone mapping.
pub fn tone_mapping(id: &str) -> Rule {
    one_of("the tone mapping", id, ToneMapping::ALL.into_iter().map(|t| (t.id(), t.name())))
}

/// The id of an encoding.
pub fn encoding(id: &str) -> Rule {
    one_of("the encoding", id, Encoding::ALL.into_iter().map(|e| (e.id(), e.id())))
}

/// How many lights a scene has.
pub fn light_count(count: usize) -> Rule {
    must((1..=MAX_LIGHTS).contains(&count), || format!("a scene must have between 1 and {MAX_LIGHTS} lights"))
}

/// How many objects a scene has.
pub fn object_count(count: usize) -> Rule {
    must((1..=MAX_OBJECTS).contains(&count), || {
        format!("a scene must have between 1 and {MAX_OBJECTS} objects")
    })
}

/// One of several ids: the rule lists them and names the nearest.
fn one_of<'a>(what: &str, id: &str, known: impl Iterator<Item = (&'a str, &'a str)> + Clone) -> Rule {
    must(known.clone().any(|(k, _)| k == id), || {
        let names = known.clone().map(|(k, name)| (name, k));
        let candidates = known.clone().map(|(k, _)| (k, k)).chain(names);
        text::one_of(what, known.clone().map(|(k, _)| k)) + &did_you_mean(id, candidates)
    })
}

/// A vector as scene files write it.
struct Written(Vec3);

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}, {}]", self.0.x, self.0.y, self.0.z)
    }
}

/// Everything that is wrong with a scene; empty if it is valid. The order is that of the scene.
#[must_use]
pub fn scene(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    let mut check = Check::new(scene, registry);
    check.dimensions();
    check.models();
    let count = |n: usize, what: &str| match n {
        0 => "empty".to_owned(),
        _ => format!("a list of {n} {what}"),
    };
    let lights = scene.lights.len();
    check.rule(light_count(lights), || (Path::root().key("lights"), count(lights, "lights")));
    for (i, light) in scene.lights.iter().enumerate() {
        check.light(light, i);
    }
    check.observer();
    let objects = scene.objects.len();
    check.rule(object_count(objects), || (Path::root().key("objects"), count(objects, "objects")));
    for (i, object) in scene.objects.iter().enumerate() {
        check.object(object, i);
    }
    check.display();
    check.problems
}

/// Everything that is wrong with one light, also where it meets other parts. Nothing where there is no such light.
#[must_use]
pub fn light(scene: &Scene, index: usize, registry: &Registry) -> Vec<Problem> {
    let mut check = Check::new(scene, registry);
    if let Some(light) = scene.lights.get(index) {
        check.light(light, index);
        if let Some(p) = light.position {
            check.meets(p, object_there(scene, p), "a light", "an object", || light_path(index));
        }
    }
    check.problems
}

/// Everything that is wrong with one object, also where it meets other parts. Nothing where there is no such object.
#[must_use]
pub fn object(scene: &Scene, index: usize, registry: &Registry) -> Vec<Problem> {
    let mut check = Check::new(scene, registry);
    if let Some(object) = scene.objects.get(index) {
        check.object(object, index);
    }
    check.problems
}

/// Everything that is wrong with the observer, also where it meets other parts.
#[must_use]
pub fn observer(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    let mut check = Check::new(scene, registry);
    let p = scene.observer.position;
    check.observer();
    check.meets(p, check.light_there(p), "the observer", "a light", observer_path);
    check.meets(p, object_there(scene, p), "the observer", "an object", observer_path);
    check.problems
}

/// Everything that is wrong with the room, and everything that stands outside it.
#[must_use]
pub fn room(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    let mut check = Check::new(scene, registry);
    check.dimensions();
    for (i, light) in scene.lights.iter().enumerate() {
        if let Some(p) = light.position {
            check.within(p, || light_path(i));
        }
    }
    check.within(scene.observer.position, observer_path);
    for (i, object) in scene.objects.iter().enumerate() {
        check.within(object.position, || object_path(i));
    }
    check.problems
}

/// Everything that is wrong with the reflection model and the shading model of a scene. The materials of objects that
/// have no reflection model themselves are judged by the scene's: [`object`] tells.
#[must_use]
pub fn models(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    let mut check = Check::new(scene, registry);
    check.models();
    check.problems
}

/// Everything that is wrong with the display.
#[must_use]
pub fn display(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    let mut check = Check::new(scene, registry);
    check.display();
    check.problems
}

/// The room to judge positions by: an extent that is itself wrong is as large as may be, so that one
/// mistake is not reported once more for everything in the room.
pub(super) fn plausible(mut room: SceneSize) -> SceneSize {
    for extent in [&mut room.height, &mut room.width, &mut room.depth] {
        if dimension("", *extent).is_err() {
            *extent = MAX_DIMENSION;
        }
    }
    room
}

/// The identity of a place: two parts are in the same place if their coordinates are the same numbers in 32 bits, as
/// scene files hold them. What is not finite is nowhere.
fn place(p: Vec3) -> Option<[u32; 3]> {
    // Adding 0 makes −0 and 0 the same bits.
    p.is_finite().then(|| (p + Vec3::ZERO).to_array().map(f32::to_bits))
}

/// True if lights, objects and the observer exclude each other here (CA AR4, AR10, AR15); two lights or two objects
/// may share a place.
#[must_use]
pub fn same_place(a: Vec3, b: Vec3) -> bool {
    place(a).is_some_and(|a| Some(a) == place(b))
}

/// The first object in a place, for messages.
fn object_there(scene: &Scene, p: Vec3) -> Option<String> {
    scene.objects.iter().position(|o| same_place(o.position, p)).map(|i| format!("objects[{i}]"))
}

fn light_path(index: usize) -> Path {
    Path::root().key("lights").index(index)
}

fn object_path(index: usize) -> Path {
    Path::root().key("objects").index(index)
}

fn observer_path() -> Path {
    Path::root().key("observer")
}

/// The problems found so far, and what the parts of a scene are judged by.
struct Check<'a> {
    scene: &'a Scene,
    registry: &'a Registry,
    room: SceneSize,
    /// The first light in each place: with many objects, places are looked up and not compared pairwise.
    lights: HashMap<[u32; 3], usize>,
    problems: Vec<Problem>,
}

impl<'a> Check<'a> {
    fn new(scene: &'a Scene, registry: &'a Registry) -> Self {
        let mut lights = HashMap::new();
        for (i, light) in scene.lights.iter().enumerate() {
            if let Some(key) = light.position.and_then(place) {
                lights.entry(key).or_insert(i);
            }
        }
        Self { scene, registry, room: plausible(scene.scene_size), lights, problems: Vec::new() }
    }

    /// Adds the broken rule; the path is made only then, since valid scenes are the rule and large.
    fn rule<T: fmt::Display>(&mut self, rule: Rule, at: impl FnOnce() -> (Path, T)) {
        if let Err(rule) = rule {
            let (path, found) = at();
            self.problems.push(Problem::value(path, found, rule));
        }
    }

    fn about(&mut self, path: Path, predicate: String) {
        self.problems.push(Problem::about(path, predicate));
    }

    /// A position in the room.
    fn within(&mut self, p: Vec3, path: impl Fn() -> Path) {
        self.rule(position(self.room, p), || (path().key("position"), Written(p)));
    }

    /// A part in a place where another is that it excludes.
    fn meets(&mut self, p: Vec3, there: Option<String>, one: &str, other: &str, path: impl Fn() -> Path) {
        if let Some(there) = there {
            let rule = format!("{there} is there; {one} must not be where {other} is");
            self.problems.push(Problem::value(path().key("position"), Written(p), rule));
        }
    }

    /// The first light in a place, for messages.
    fn light_there(&self, p: Vec3) -> Option<String> {
        self.lights.get(&place(p)?).map(|i| format!("lights[{i}]"))
    }

    /// The observer, if it is in a place, for messages.
    fn observer_there(&self, p: Vec3) -> Option<String> {
        same_place(p, self.scene.observer.position).then(|| "the observer".to_owned())
    }

    fn dimensions(&mut self) {
        let SceneSize { height, width, depth } = self.scene.scene_size;
        for (axis, metres) in [("height", height), ("width", width), ("depth", depth)] {
            self.rule(dimension(axis, metres), || (Path::root().key("scene_size").key(axis), metres));
        }
    }

    fn models(&mut self) {
        let Scene { reflection_model: reflection, shading_model: shading, .. } = self.scene;
        let at = |key: &'static str, id: &str| (Path::root().key(key), quoted(id));
        self.rule(reflection_model(self.registry, reflection), || at("reflection_model", reflection));
        self.rule(shading_model(self.registry, shading), || at("shading_model", shading));
    }

    fn light(&mut self, light: &Light, index: usize) {
        let path = |key: &'static str| light_path(index).key(key);
        self.rule(light_type(self.registry, &light.kind), || (path("type"), quoted(&light.kind)));
        let entry = self.registry.light(&light.kind);
        if let Some(LightEntry { declaration, .. }) = entry {
            let fields = [
                ("position", light.position.is_some(), declaration.has_position),
                ("direction", light.direction.is_some(), declaration.has_direction),
            ];
            for (key, is, should) in fields {
                if is != should {
                    self.about(path(key), presence(declaration.id, key, should));
                }
            }
        }
        if let Some(p) = light.position {
            self.within(p, || light_path(index));
        }
        if let Some(d) = light.direction {
            self.rule(direction(d), || (path("direction"), Written(d)));
        }
        self.rule(intensity(light.intensity), || (path("intensity"), light.intensity));
        if let Some(flux) = light.luminous_flux {
            if entry.is_none_or(LightEntry::has_flux) {
                self.rule(luminous_flux(flux), || (path("luminous_flux"), flux));
            } else {
                self.about(path("luminous_flux"), presence(&light.kind, "luminous_flux", false));
            }
        }
        if let Some(kelvin) = light.colour_temperature {
            self.rule(colour_temperature(kelvin), || (path("colour_temperature"), kelvin));
        }
        for (name, value) in &light.parameters.0 {
            let path = || light_path(index).key(name.clone());
            match entry.map(|e| e.declaration.parameters.iter().find(|p| p.name == name.as_ref())) {
                Some(Some(declared)) => self.rule(parameter(declared, value), || (path(), written(value))),
                Some(None) => self.about(path(), presence(&light.kind, name, false)),
                // The type is unknown, and that is reported already.
                None => {}
            }
        }
        if let Some(p) = light.position {
            self.meets(p, self.observer_there(p), "a light", "the observer", || light_path(index));
        }
    }

    fn observer(&mut self) {
        let Observer { position, direction: d, field_of_view: degrees } = self.scene.observer;
        self.within(position, observer_path);
        self.rule(direction(d), || (observer_path().key("direction"), Written(d)));
        self.rule(field_of_view(degrees), || (observer_path().key("field_of_view"), degrees));
    }

    fn object(&mut self, object: &Object, index: usize) {
        let path = |key: &'static str| object_path(index).key(key);
        let registry = self.registry;
        self.rule(object_type(registry, &object.kind), || (path("type"), quoted(&object.kind)));
        self.within(object.position, || object_path(index));
        self.rule(size(object.size), || (path("size"), object.size));
        self.rule(rotation(object.rotation), || (path("rotation"), Written(object.rotation)));
        if let (Some(shape), Some(count)) = (registry.shape(&object.kind), object.tessellation) {
            self.rule(tessellation(shape, count), || (path("tessellation"), count));
        }
        if let Some(id) = &object.reflection_model {
            self.rule(reflection_model(registry, id), || (path("reflection_model"), quoted(id)));
        }
        if let Some(id) = &object.shading_model {
            self.rule(shading_model(registry, id), || (path("shading_model"), quoted(id)));
        }
        let model = self.scene.model_of(object);
        for (name, value) in &object.material.0 {
            self.rule(material_parameter(registry, model, name, value), || {
                (path("material").key(name.clone()), written(value))
            });
        }
        let p = object.position;
        match self.light_there(p) {
            Some(light) => self.meets(p, Some(light), "an object", "a light", || object_path(index)),
            None => {
                let observer = self.observer_there(p);
                self.meets(p, observer, "an object", "the observer", || object_path(index));
            }
        }
    }

    fn display(&mut self) {
        let ev = self.scene.display.exposure;
        self.rule(exposure(ev), || (Path::root().key("display").key("exposure"), ev));
    }
}

/// That a light of a type needs, or has not, a field.
fn presence(kind: &str, field: &str, needed: bool) -> String {
    let article = if kind.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    if needed {
        format!("is missing; {article} {kind} light needs one")
    } else {
        format!("is given, but {article} {kind} light has no {field}")
    }
}

/// A parameter as scene files write it.
fn written(value: &Value) -> String {
    match value {
        Value::Number(v) => v.to_string(),
        Value::Integer(v) => v.to_string(),
        Value::Colour([r, g, b]) => format!("[{r}, {g}, {b}]"),
        Value::Triple([r, g, b]) => format!("[{r}, {g}, {b}]"),
        Value::Choice(v) => quoted(v),
    }
}

impl Light {
    /// Makes it a light of another type: gains and loses position, direction and parameters as that
    /// type has them. Intensity or luminous flux is kept, unless the new type measures in another unit.
    pub fn set_type(&mut self, to: &LightEntry, registry: &Registry, room: SceneSize) {
        let new = to.declaration;
        let flux = self.luminous_flux.filter(|_| to.has_flux());
        self.intensity = match registry.light(&self.kind) {
            Some(old) if flux.is_none() && old.declaration.unit == new.unit => self.intensity_as(old),
            // 20 cd and 20 lx are worlds apart: another unit starts from its own default.
            _ => new.default_intensity,
        };
        self.luminous_flux = flux;
        let centre = Vec3::new(room.width / 2.0, room.height * 0.8, room.depth / 2.0);
        self.position = new.has_position.then(|| self.position.unwrap_or(centre));
        self.direction = new.has_direction.then(|| self.direction.unwrap_or(Vec3::NEG_Y));
        let mut parameters = Values::default();
        for p in new.parameters {
            if let Some(value) = self.parameters.0.get(p.name).filter(|v| p.allows(v)) {
                parameters.set(p.name, value.clone());
            }
        }
        self.parameters = parameters;
        new.id.clone_into(&mut self.kind);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(s: &Scene) -> Vec<String> {
        scene(s, &Registry::builtin()).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn the_default_scene_is_valid() {
        assert_eq!(messages(&Scene::default()), [""; 0]);
    }

    #[test]
    fn every_problem_is_found_at_once() {
        let mut s = Scene::default();
        s.scene_size.height = 0.0;
        s.scene_size.width = 101.0;
        s.observer.field_of_view = 180.0;
        s.observer.direction = Vec3::ZERO;
        s.objects[0].size = -1.0;
        s.objects[0].material.set("k_d", Value::Number(0.2));
        s.objects[0].tessellation = Some(0);
        s.lights[0].intensity = f32::NAN;
        s.display.exposure = 17.0;
        let found = messages(&s).join("\n");
        for expected in [
            "scene_size.height is 0, but the height of the room must be greater than 0 and at most 100 m",
            "scene_size.width is 101, but the width of the room",
            "observer.field_of_view is 180, but the field of view must be between 1 and 170 degrees",
            "observer.direction is [0, 0, 0], but a direction must not be zero",
            "objects[0].size is -1, but a size must be greater than 0",
            "objects[0].material.k_d is 0.2, but the diffuse coefficient must be between 0.5 and 1",
            "objects[0].tessellation is 0, but the tessellation of a sphere must be a whole number between",
            "lights[0].intensity is NaN, but an intensity must be at least 0",
            "display.exposure is 17, but the exposure must be between -16 and 16 EV",
        ] {
            assert!(found.contains(expected), "{expected}\nis not in\n{found}");
        }
    }

    #[test]
    fn positions_are_in_the_room_with_its_far_faces_but_not_its_near_ones() {
        let room = SceneSize { height: 1.0, width: 2.0, depth: 3.0 };
        assert_eq!(position(room, Vec3::new(2.0, 1.0, 3.0)), Ok(()));
        for outside in [
            Vec3::new(0.0, 0.5, 1.0),
            Vec3::new(2.1, 0.5, 1.0),
            Vec3::new(1.0, 1.5, 1.0),
            Vec3::new(1.0, 0.5, f32::INFINITY),
            Vec3::NAN,
        ] {
            assert!(position(room, outside).is_err(), "{outside}");
        }
    }

    #[test]
    fn nothing_may_be_where_another_kind_of_thing_is() {
        let mut s = Scene::default();
        s.objects.push(Object { position: s.observer.position, ..Object::default() });
        s.objects.push(Object { position: Vec3::new(7.5, 8.0, 9.0), ..Object::default() });
        s.lights.push(Light { position: Some(s.observer.position), ..Light::default() });
        let found = messages(&s);
        assert_eq!(
            found,
            [
                "lights[1].position is [5, 5, 9.5], but the observer is there; a light must not be where the observer is",
                "objects[1].position is [5, 5, 9.5], but lights[1] is there; an object must not be where a light is",
                "objects[2].position is [7.5, 8, 9], but lights[0] is there; an object must not be where a light is",
            ]
        );
        // Two objects may share a place, and so may two lights: the CA does not forbid it.
        let s = Scene {
            objects: vec![Object::default(); 2],
            lights: vec![Light::default(); 2],
            ..Scene::default()
        };
        assert_eq!(messages(&s), [""; 0]);
    }

    #[test]
    fn one_part_is_checked_like_the_whole() {
        let registry = Registry::builtin();
        let mut s = Scene::default();
        s.lights.push(Light { intensity: -1.0, position: Some(Vec3::splat(11.0)), ..Light::default() });
        s.lights.push(Light { position: Some(s.observer.position), ..Light::default() });
        s.objects.push(Object { size: 0.0, position: Vec3::new(7.5, 8.0, 9.0), ..Object::default() });
        s.objects.push(Object { reflection_model: Some("lambret".into()), ..Object::default() });
        s.observer.field_of_view = 0.0;
        s.display.exposure = 99.0;
        let whole = scene(&s, &registry);
        let mut parts = [room(&s, &registry), models(&s, &registry)].concat();
        parts.retain(|p| whole.contains(p) && p.path.segments().len() == 2);
        parts.extend((0..s.lights.len()).flat_map(|i| light(&s, i, &registry)));
        parts.extend(observer(&s, &registry));
        parts.extend((0..s.objects.len()).flat_map(|i| object(&s, i, &registry)));
        parts.extend(display(&s, &registry));
        // Where two parts meet, each tells of it; the whole scene tells of it once.
        let both: Vec<_> = parts.iter().filter(|p| !whole.contains(p)).map(ToString::to_string).collect();
        assert_eq!(
            both,
            [
                "lights[0].position is [7.5, 8, 9], but objects[1] is there; a light must not be where an object is",
                "observer.position is [5, 5, 9.5], but lights[2] is there; the observer must not be where a light is",
            ]
        );
        parts.retain(|p| whole.contains(p));
        assert_eq!(parts, whole);
        assert_eq!(light(&s, 9, &registry), []);
        assert_eq!(object(&s, 9, &registry), []);
    }

    #[test]
    fn a_room_is_too_small_for_what_stands_outside_it() {
        let mut s = Scene::default();
        s.scene_size.depth = 9.25;
        let found: Vec<_> = room(&s, &Registry::builtin()).iter().map(|p| p.path.to_string()).collect();
        assert_eq!(found, ["observer.position"]);
        s.scene_size.depth = 101.0;
        let found: Vec<_> = room(&s, &Registry::builtin()).iter().map(|p| p.path.to_string()).collect();
        assert_eq!(found, ["scene_size.depth"]);
    }

    #[test]
    fn the_same_place_is_the_same_three_numbers() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        assert!(same_place(p, p) && same_place(Vec3::ZERO, -Vec3::ZERO));
        assert!(!same_place(p, p.with_x(1.0f32.next_up())));
        assert!(!same_place(Vec3::NAN, Vec3::NAN) && !same_place(Vec3::INFINITY, Vec3::INFINITY));
    }

    #[test]
    fn lights_have_what_their_type_has() {
        let mut s = Scene {
            lights: vec![
                Light { kind: "spot".into(), direction: None, ..Light::default() },
                Light { kind: "ambient".into(), ..Light::default() },
                Light { kind: "spott".into(), ..Light::default() },
            ],
            ..Scene::default()
        };
        s.lights[1].parameters.set("cone_angle", Value::Number(20.0));
        assert_eq!(
            messages(&s),
            [
                "lights[0].direction is missing; a spot light needs one",
                "lights[1].position is given, but an ambient light has no position",
                "lights[1].cone_angle is given, but an ambient light has no cone_angle",
                "lights[2].type is \"spott\", but the light type must be \"point\", \"spot\", \"directional\" or \
                 \"ambient\"; did you mean \"spot\"?",
            ]
        );
    }

    #[test]
    fn changing_the_type_of_a_light_keeps_the_scene_valid() {
        let registry = Registry::builtin();
        let mut s = Scene::default();
        for from in registry.lights() {
            for to in registry.lights() {
                s.lights[0].set_type(from, &registry, s.scene_size);
                for p in from.declaration.parameters {
                    s.lights[0].parameters.set(p.name, p.default_value());
                }
                s.lights[0].set_type(to, &registry, s.scene_size);
                assert_eq!(messages(&s), [""; 0]);
            }
        }
    }

    #[test]
    fn extreme_directions_are_refused_because_they_cannot_be_normalised() {
        assert_eq!(direction(Vec3::new(0.0, -3.0, 0.0)), Ok(()));
        for d in [Vec3::splat(1e-30), Vec3::splat(1e30), Vec3::splat(f32::INFINITY), Vec3::NAN] {
            assert!(direction(d).is_err_and(|rule| rule.contains("too long or too short")), "{d}");
        }
    }
}
