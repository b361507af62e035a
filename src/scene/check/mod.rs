//! Every constraint of a scene, once: for the reader, the window and the writer.
//!
//! A rule for one field is a function that returns `Err` with the rule as a clause, so that it can end a sentence: "k_d
//! is 0.2, but **the diffuse coefficient must be between 0.5 and 1**". [`scene`] applies them all to a whole scene;
//! [`light`], [`object`] and others to one part of it.

use std::{collections::HashMap, fmt};

use glam::Vec3;

use super::{
    MAX_DIMENSION, Observer, Scene, SceneSize, Variant,
    error::{Path, Problem},
    variant::LETTERS,
};
use crate::{
    light::LightEntry,
    parameter::Value,
    registry::Registry,
    text::{listed, quoted, with_article},
};

mod rule;
pub use rule::*;

/// A vector as written in scene files.
struct Written(Vec3);

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}, {}]", self.0.x, self.0.y, self.0.z)
    }
}

/// All problems of a scene, in order; empty if it is valid.
#[must_use]
pub fn scene(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    let count = |n: usize, what: &str| match n {
        0 => "empty".to_owned(),
        _ => format!("a list of {n} {what}"),
    };
    let (lights, objects) = (scene.lights.len(), scene.objects.len());
    found(scene, registry, |check| {
        check.dimensions();
        check.models();
        check.rule(light_count(lights), || (Path::root().key("lights"), count(lights, "lights")));
        (0..lights).for_each(|i| check.light(i));
        check.observer();
        check.rule(object_count(objects), || (Path::root().key("objects"), count(objects, "objects")));
        (0..objects).for_each(|i| check.object(i));
        check.display();
        check.variants();
    })
}

/// All problems of one light, including conflicts with other parts; empty if the light does not exist.
#[must_use]
pub fn light(scene: &Scene, index: usize, registry: &Registry) -> Vec<Problem> {
    Parts::of(scene, registry).light(index)
}

/// All problems of one object, including conflicts with other parts; empty if the object does not exist.
#[must_use]
pub fn object(scene: &Scene, index: usize, registry: &Registry) -> Vec<Problem> {
    Parts::of(scene, registry).object(index)
}

/// All problems of the observer, including conflicts with other parts.
#[must_use]
pub fn observer(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    Parts::of(scene, registry).observer()
}

/// Checks one part after another, as [`light`], [`object`] and [`observer`] do, without going through all
/// lights each time.
pub struct Parts<'a>(Check<'a>);

impl<'a> Parts<'a> {
    /// Starts checking the parts of a scene.
    #[must_use]
    pub fn of(scene: &'a Scene, registry: &'a Registry) -> Self {
        Self(Check::of(scene, registry))
    }

    /// All problems of one light.
    pub fn light(&mut self, index: usize) -> Vec<Problem> {
        let check = &mut self.0;
        check.light(index);
        if let Some(p) = check.scene.lights.get(index).and_then(|light| light.position) {
            check.meets(p, object_there(check.scene, p), "a light", "an object", || light_path(index));
        }
        std::mem::take(&mut check.problems)
    }

    /// All problems of one object.
    pub fn object(&mut self, index: usize) -> Vec<Problem> {
        self.0.object(index);
        std::mem::take(&mut self.0.problems)
    }

    /// All problems of the observer.
    pub fn observer(&mut self) -> Vec<Problem> {
        let check = &mut self.0;
        let p = check.scene.observer.position;
        check.observer();
        check.meets(p, check.light_there(p), "the observer", "a light", observer_path);
        check.meets(p, object_there(check.scene, p), "the observer", "an object", observer_path);
        std::mem::take(&mut check.problems)
    }
}

/// All problems of the room, including parts outside it.
#[must_use]
pub fn room(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    found(scene, registry, |check| {
        check.dimensions();
        for (i, p) in scene.lights.iter().enumerate().filter_map(|(i, light)| Some((i, light.position?))) {
            check.within(p, || light_path(i));
        }
        check.within(scene.observer.position, observer_path);
        for (i, object) in scene.objects.iter().enumerate() {
            check.within(object.position, || object_path(i));
        }
    })
}

/// All problems of the reflection model and the shading model of a scene. The scene's reflection model also
/// judges the materials of objects without an override: see [`object`].
#[must_use]
pub fn models(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    found(scene, registry, |check| check.models())
}

/// All problems of the variants and the comparison.
#[must_use]
pub fn variants(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    found(scene, registry, |check| check.variants())
}

/// All problems of the display.
#[must_use]
pub fn display(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    found(scene, registry, |check| check.display())
}

/// The room for checking positions: an invalid extent counts as the largest legal one, so that one error is not
/// repeated for everything in the room.
pub(super) fn plausible(mut room: SceneSize) -> SceneSize {
    for extent in [&mut room.height, &mut room.width, &mut room.depth] {
        if dimension("", *extent).is_err() {
            *extent = MAX_DIMENSION;
        }
    }
    room
}

/// The identity of a position: two parts have the same position if their coordinates are equal in 32 bits, as
/// in scene files. `None` for non-finite positions.
fn place(p: Vec3) -> Option<[u32; 3]> {
    // Adding 0 makes −0 and 0 the same bits.
    p.is_finite().then(|| (p + Vec3::ZERO).to_array().map(f32::to_bits))
}

/// True if lights, objects and the observer exclude each other here (CA AR4, AR10, AR15); two lights or two
/// objects may share a position.
#[must_use]
pub fn same_place(a: Vec3, b: Vec3) -> bool {
    place(a).is_some_and(|a| Some(a) == place(b))
}

/// The first object at a position, for messages.
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

/// The problems found so far, and the data for checking the parts of a scene.
struct Check<'a> {
    scene: &'a Scene,
    registry: &'a Registry,
    room: SceneSize,
    /// The first light at each position: with many objects, lookups replace pairwise comparison.
    lights: HashMap<[u32; 3], usize>,
    problems: Vec<Problem>,
}

/// The problems found by these checks.
fn found(scene: &Scene, registry: &Registry, checks: impl FnOnce(&mut Check)) -> Vec<Problem> {
    let mut check = Check::of(scene, registry);
    checks(&mut check);
    check.problems
}

impl<'a> Check<'a> {
    fn of(scene: &'a Scene, registry: &'a Registry) -> Self {
        let mut lights = HashMap::new();
        for (i, light) in scene.lights.iter().enumerate() {
            if let Some(key) = light.position.and_then(place) {
                lights.entry(key).or_insert(i);
            }
        }
        Self { scene, registry, room: plausible(scene.scene_size), lights, problems: Vec::new() }
    }
}

impl Check<'_> {
    /// Adds the broken rule, if any. The path is built only when needed, because most scenes are valid and
    /// some are large.
    fn rule<T: fmt::Display>(&mut self, rule: Rule, at: impl FnOnce() -> (Path, T)) {
        if let Err(rule) = rule {
            let (path, found) = at();
            self.problems.push(Problem::value(path, found, rule));
        }
    }

    fn about(&mut self, path: Path, predicate: String) {
        self.problems.push(Problem::about(path, predicate));
    }

    /// Checks that a position is in the room.
    fn within(&mut self, p: Vec3, path: impl Fn() -> Path) {
        self.rule(position(self.room, p), || (path().key("position"), Written(p)));
    }

    /// Checks that a part is not at the position of another that excludes it.
    fn meets(&mut self, p: Vec3, there: Option<String>, one: &str, other: &str, path: impl Fn() -> Path) {
        if let Some(there) = there {
            let rule = format!("{there} is there; {one} must not be where {other} is");
            self.problems.push(Problem::value(path().key("position"), Written(p), rule));
        }
    }

    /// The first light at a position, for messages.
    fn light_there(&self, p: Vec3) -> Option<String> {
        self.lights.get(&place(p)?).map(|i| format!("lights[{i}]"))
    }

    /// The observer, if at this position, for messages.
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

    fn light(&mut self, index: usize) {
        let Some(light) = self.scene.lights.get(index) else { return };
        let path = |key: &'static str| light_path(index).key(key);
        self.rule(light_type(self.registry, &light.light_type), || (path("type"), quoted(&light.light_type)));
        let entry = self.registry.light(&light.light_type);
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
                self.about(path("luminous_flux"), presence(&light.light_type, "luminous_flux", false));
            }
        }
        if let Some(kelvin) = light.colour_temperature {
            self.rule(colour_temperature(kelvin), || (path("colour_temperature"), kelvin));
        }
        for (name, value) in &light.parameters.0 {
            let path = || light_path(index).key(name.clone());
            match entry.map(|e| e.parameter(name)) {
                Some(Some(declared)) => self.rule(parameter(declared, value), || (path(), written(value))),
                Some(None) => self.about(path(), presence(&light.light_type, name, false)),
                // The type is unknown, which is already reported.
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

    fn object(&mut self, index: usize) {
        let Some(object) = self.scene.objects.get(index) else { return };
        let path = |key: &'static str| object_path(index).key(key);
        let registry = self.registry;
        self.rule(object_type(registry, &object.object_type), || (path("type"), quoted(&object.object_type)));
        self.within(object.position, || object_path(index));
        self.rule(size(object.size), || (path("size"), object.size));
        self.rule(rotation(object.rotation), || (path("rotation"), Written(object.rotation)));
        if let (Some(shape), Some(count)) = (registry.shape(&object.object_type), object.tessellation) {
            self.rule(tessellation(shape, count), || (path("tessellation"), count));
        }
        if let Some(shape) = registry.shape(&object.object_type) {
            for (name, value) in &object.shape.0 {
                let path = || object_path(index).key(name.clone());
                match shape.parameter(name) {
                    Some(declared) => self.rule(parameter(declared, value), || (path(), written(value))),
                    None => {
                        let what = with_article(&object.object_type);
                        self.about(path(), format!("is given, but {what} has no {name}"));
                    }
                }
            }
        }
        if let Some(id) = &object.reflection_model {
            self.rule(reflection_model(registry, id), || (path("reflection_model"), quoted(id)));
        }
        if let Some(id) = &object.shading_model {
            self.rule(shading_model(registry, id), || (path("shading_model"), quoted(id)));
        }
        for (name, value) in &object.material.0 {
            self.rule(material_parameter(registry, self.scene, object, name, value), || {
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

impl Check<'_> {
    fn variants(&mut self) {
        let (scene, registry) = (self.scene, self.registry);
        let all = &scene.variants;
        let list = || (Path::root().key("variants"), format!("a list of {} variants", all.len()));
        self.rule(variant_count(all.len()), list);
        for (i, variant) in all.iter().enumerate() {
            let path = |key: &'static str| Path::root().key("variants").index(i).key(key);
            if let Some(name) = &variant.name {
                let twin = all[..i].iter().position(|other| other.name.as_ref() == Some(name));
                if let Some(twin) = twin {
                    let rule =
                        format!("variants[{twin}] has this name already; variants need different names");
                    self.problems.push(Problem::value(path("name"), quoted(name), rule));
                }
            }
            if let Some(base) = &variant.based_on
                && let Err(rule) = basis(scene, variant, base)
            {
                self.problems.push(Problem::value(path("based_on"), quoted(base), rule));
            }
            if let Some(id) = &variant.reflection_model {
                self.rule(reflection_model(registry, id), || (path("reflection_model"), quoted(id)));
            }
            if let Some(id) = &variant.shading_model {
                self.rule(shading_model(registry, id), || (path("shading_model"), quoted(id)));
            }
            if let Some(ev) = variant.exposure {
                self.rule(exposure(ev), || (path("exposure"), ev));
            }
            if let Some(count) = variant.tessellation {
                self.rule(any_tessellation(count), || (path("tessellation"), count));
            }
            if !variant.material.0.is_empty() {
                self.variant_material(i, &path);
            }
        }
        let comparison = &scene.comparison;
        let path = |key: &'static str| Path::root().key("comparison").key(key);
        self.rule(split(comparison.split), || (path("split"), comparison.split));
        if let Some(factor) = comparison.amplification {
            self.rule(amplification(factor), || (path("amplification"), factor));
        }
        if comparison.with > all.len().max(1) {
            let letter = LETTERS.get(comparison.with).copied().unwrap_or("?");
            let rule = match all.len() {
                0 => "the scene has no variants".to_owned(),
                n => format!("the last view of the scene is {}", LETTERS[n]),
            };
            self.problems.push(Problem::value(path("with"), quoted(letter), rule));
        }
    }

    /// Checks the parameters of a variant, each against the objects of the scene as they are in the variant.
    fn variant_material(&mut self, index: usize, path: &dyn Fn(&'static str) -> Path) {
        let (scene, registry) = (self.scene, self.registry);
        let Some((seen, _)) = scene.seen(index + 1, registry) else { return };
        for (name, value) in &scene.variants[index].material.0 {
            let broken = seen
                .objects
                .iter()
                .find_map(|object| material_parameter(registry, &seen, object, name, value).err());
            if let Some(rule) = broken {
                let path = path("material").key(name.clone());
                self.problems.push(Problem::value(path, written(value), rule));
            }
        }
    }
}

/// Checks that a variant may be based on the one with this name.
fn basis(scene: &Scene, variant: &Variant, base: &str) -> Rule {
    if scene.variant(base).is_none() {
        let names =
            scene.variants.iter().filter(|v| !std::ptr::eq(*v, variant)).filter_map(|v| v.name.as_deref());
        let names: Vec<_> = names.map(quoted).collect();
        return Err(match names.as_slice() {
            [] => "there is no other variant with a name".to_owned(),
            names => format!("this must be the name of another variant: {}", listed(names, "or")),
        });
    }
    let mut chain = vec![variant.name.as_deref().unwrap_or("this variant")];
    let mut next = Some(base);
    while let Some(name) = next {
        let known = chain.contains(&name);
        chain.push(name);
        if known {
            // A cycle of other variants is reported for those.
            if chain[0] == name {
                return Err(format!("a variant must not be based on itself: {}", chain.join(" → ")));
            }
            return Ok(());
        }
        next = scene.variant(name).and_then(|v| v.based_on.as_deref());
    }
    Ok(())
}

/// The rule for a missing field that a light's type needs, or for a field that the type does not have.
fn presence(type_id: &str, field: &str, needed: bool) -> String {
    let light = with_article(type_id);
    if needed {
        format!("is missing; {light} light needs one")
    } else {
        format!("is given, but {light} light has no {field}")
    }
}

/// A parameter as written in scene files.
fn written(value: &Value) -> String {
    match value {
        Value::Number(v) => v.to_string(),
        Value::Integer(v) => v.to_string(),
        Value::Colour([r, g, b]) => format!("[{r}, {g}, {b}]"),
        Value::Triple([r, g, b]) => format!("[{r}, {g}, {b}]"),
        Value::Choice(v) => value.truth().map_or_else(|| quoted(v), |flag| flag.to_string()),
        Value::File(v) => quoted(v.name()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Light, Object};

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
        // Each part's check reports a conflict of two parts; the check of the whole scene reports it once.
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
                Light { light_type: "spot".into(), direction: None, ..Light::default() },
                Light { light_type: "ambient".into(), ..Light::default() },
                Light { light_type: "spott".into(), ..Light::default() },
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
                "lights[2].type is \"spott\", but the light type must be \"point\", \"spot\", \
                 \"photometric\", \"directional\", \"ambient\", \"rectangle\", \"disc\", \"sphere\", \"cylinder\", \
                 \"sun\" or \"environment\"; did you mean \"spot\"?",
            ]
        );
    }
}
