//! Every constraint of a scene, once: for the reader, the writer and each edit.
//!
//! A [rule](Rule) is a clause that can end a sentence: "k_d is 0.2, but **the diffuse coefficient must be between 0.5
//! and 1**". The rule for a value by itself follows from its [declaration](super::Field::check). [`scene`] applies all
//! rules to a whole scene; [`Parts`] and [`change`] to one part and what it can meet.

use std::{
    borrow::Cow,
    collections::{BTreeMap, HashMap},
    fmt, mem,
    ops::Range,
};

use glam::Vec3;

use super::{
    Light, MAX_DIMENSION, Object, Observer, Part, Scene, SceneSize, Variant,
    error::{Path, Problem},
    field::Kind,
    part::{Fields, Structure},
    variant::LETTERS,
};
use crate::{
    parameter::Value,
    registry::Registry,
    text::{listed, quoted, with_article},
};

mod rule;
pub use super::clause::{Rule, direction};
pub use rule::*;

/// All problems of a scene, in order, with their paths in a file; empty if it is valid.
#[must_use]
pub fn scene(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    let count = |n: usize, what: &str| match n {
        0 => "empty".to_owned(),
        _ => format!("a list of {n} {what}"),
    };
    let (lights, objects) = (scene.lights.len(), scene.objects.len());
    let mut check = Check::of(scene, registry);
    check.fields(&scene.scene_size, Part::Size);
    check.fields(scene, Part::Scene);
    check.rule(light_count(lights), || (Path::root().key("lights"), count(lights, "lights")));
    scene.lights.iter().enumerate().for_each(|(i, light)| check.light(i, light));
    check.fields(&scene.observer, Part::Observer);
    check.rule(object_count(objects), || (Path::root().key("objects"), count(objects, "objects")));
    scene.objects.iter().enumerate().for_each(|(i, object)| check.object(i, object));
    check.fields(&scene.display, Part::Display);
    check.variants();
    scene.as_in_file(check.problems, registry)
}

/// Checks one part after another, without going through all lights each time. Each part's check reports its conflicts
/// with others; a missing part has none.
pub struct Parts<'a>(Check<'a>);

impl<'a> Parts<'a> {
    /// Starts checking the parts of a scene.
    #[must_use]
    pub fn of(scene: &'a Scene, registry: &'a Registry) -> Self {
        Self(Check::of(scene, registry))
    }

    /// All problems of a part. Those of the scene itself are about its models, which also judge the materials of objects;
    /// those of the room include parts outside it; those of a variant are those of all variants and of the comparison.
    pub fn problems(&mut self, part: Part) -> Vec<Problem> {
        let check = &mut self.0;
        let (scene, lights, objects) = (check.scene, check.lights, check.objects);
        match part {
            Part::Light(i) => lights.get(i).into_iter().for_each(|light| check.light_alone(i, light)),
            Part::Object(i) => objects.get(i).into_iter().for_each(|object| check.object(i, object)),
            Part::Observer => {
                let p = scene.observer.position;
                check.fields(&scene.observer, part);
                check.meets(part, p, check.light_there(p));
                check.meets(part, p, check.object_there(p));
            }
            Part::Size => {
                check.fields(&scene.scene_size, part);
                places(lights, objects, scene).for_each(|(part, p)| check.within(part, p));
            }
            Part::Scene => check.fields(scene, part),
            Part::Display => check.fields(&scene.display, part),
            Part::Variant(_) | Part::Comparison => check.variants(),
        }
        mem::take(&mut check.problems)
    }
}

/// A light, an object, or everything but the lists of them, as it would be.
#[derive(Clone, Debug)]
pub enum Change {
    /// A light, with its index.
    Light(usize, Light),
    /// An object, with its index.
    Object(usize, Object),
    /// Objects in the places of a row, or of the object that becomes one.
    Row(Range<usize>, Vec<Object>),
    /// A scene whose own lights and objects do not count.
    Rest(Box<Scene>),
}

/// The problems of a part after a change. Of views only those that are new: a model that changed on disk must not prevent
/// edits of others. Costs what changes, and what it can meet.
#[must_use]
pub fn change(scene: &Scene, part: Part, change: &Change, registry: &Registry) -> Vec<Problem> {
    let mut after = Parts::of(scene, registry);
    let mut problems = match change {
        Change::Light(i, light) => {
            after.0.light_alone(*i, light);
            after.0.problems
        }
        Change::Object(i, object) => {
            after.0.object(*i, object);
            after.0.problems
        }
        Change::Row(places, objects) => {
            (places.start..).zip(objects).for_each(|(i, object)| after.0.object(i, object));
            after.0.problems
        }
        Change::Rest(rest) => {
            (after.0.scene, after.0.room) = (rest, plausible(rest.scene_size));
            after.problems(part)
        }
    };
    if matches!(part, Part::Variant(_) | Part::Comparison) && !problems.is_empty() {
        let before = Parts::of(scene, registry).problems(part);
        problems.retain(|problem| !before.contains(problem));
    }
    problems
}

/// The problems of these lights and objects, by their indices, once all of them are as given: they meet each other as they
/// would be. Of materials only if they are among what changes: checking them takes the most time.
#[must_use]
pub fn each(
    scene: &Scene,
    lights: &BTreeMap<usize, Light>,
    objects: &BTreeMap<usize, Object>,
    materials: bool,
    registry: &Registry,
) -> Vec<Problem> {
    let all_lights = with_changed(&scene.lights, lights);
    // Only lights look for objects.
    let no_objects = BTreeMap::new();
    let all_objects = with_changed(&scene.objects, if lights.is_empty() { &no_objects } else { objects });
    let mut check = Check { materials, ..Check::with(scene, &all_lights, &all_objects, registry) };
    lights.iter().for_each(|(i, light)| check.light_alone(*i, light));
    objects.iter().for_each(|(i, object)| check.object(*i, object));
    check.problems
}

/// A list in which these parts are replaced.
fn with_changed<'a, T: Clone>(all: &'a [T], changed: &BTreeMap<usize, T>) -> Cow<'a, [T]> {
    let mut all = Cow::Borrowed(all);
    for (i, part) in changed {
        if let Some(place) = all.to_mut().get_mut(*i) {
            place.clone_from(part);
        }
    }
    all
}

/// The room for checking positions: an invalid extent counts as the largest legal one, so that one error is not
/// repeated for everything in the room.
pub(super) fn plausible(mut room: SceneSize) -> SceneSize {
    for extent in [&mut room.height, &mut room.width, &mut room.depth] {
        if SceneSize::width.check_number(*extent).is_err() {
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

/// The positions of all parts that have one.
pub(super) fn places<'a>(
    lights: &'a [Light],
    objects: &'a [Object],
    rest: &Scene,
) -> impl Iterator<Item = (Part, Vec3)> + 'a {
    let lights = lights.iter().enumerate().filter_map(|(i, l)| Some((Part::Light(i), l.position?)));
    let objects = objects.iter().enumerate().map(|(i, o)| (Part::Object(i), o.position));
    lights.chain(objects).chain([(Part::Observer, rest.observer.position)])
}

/// The part that a part would meet at a position, if they exclude each other.
#[must_use]
pub fn met(scene: &Scene, part: Part, p: Vec3) -> Option<Part> {
    let differs = |other: &Part| mem::discriminant(other) != mem::discriminant(&part);
    places(&scene.lights, &scene.objects, scene)
        .find_map(|(other, at)| (differs(&other) && same_place(at, p)).then_some(other))
}

/// A kind of part in messages.
fn what(part: Part) -> &'static str {
    match part {
        Part::Light(_) => Light::WHAT,
        Part::Object(_) => Object::WHAT,
        _ => Observer::WHAT,
    }
}

/// The problems found so far, and the data for checking the parts of a scene.
struct Check<'a> {
    /// Everything but lights and objects.
    scene: &'a Scene,
    lights: &'a [Light],
    objects: &'a [Object],
    registry: &'a Registry,
    room: SceneSize,
    /// The first light at each position: with many objects, lookups replace pairwise comparison.
    light_at: HashMap<[u32; 3], usize>,
    /// True if the values of materials are checked.
    materials: bool,
    problems: Vec<Problem>,
}

impl<'a> Check<'a> {
    fn of(scene: &'a Scene, registry: &'a Registry) -> Self {
        Self::with(scene, &scene.lights, &scene.objects, registry)
    }

    /// A check of a scene with these lights and objects in place of its own.
    fn with(scene: &'a Scene, lights: &'a [Light], objects: &'a [Object], registry: &'a Registry) -> Self {
        let mut light_at = HashMap::new();
        for (i, light) in lights.iter().enumerate() {
            if let Some(key) = light.position.and_then(place) {
                light_at.entry(key).or_insert(i);
            }
        }
        Self {
            scene,
            lights,
            objects,
            registry,
            room: plausible(scene.scene_size),
            light_at,
            materials: true,
            problems: Vec::new(),
        }
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

    /// Checks each field of a part by itself, and that its position is in the room.
    fn fields(&mut self, fields: &dyn Fields, part: Part) {
        let registry = self.registry;
        fields.each(&mut |field, held, _| match (field.kind, held.value()) {
            (Kind::Position, Some(Value::Triple(p))) => self.within(part, p.into()),
            (_, Some(value)) => {
                self.rule(field.check(&value, registry), || (part.path().key(field.key), value.written()));
            }
            _ => {}
        });
    }

    /// Checks that a position is in the room.
    fn within(&mut self, part: Part, p: Vec3) {
        self.rule(position(self.room, p), || (part.path().key("position"), Value::from(p).written()));
    }

    /// Checks that a part is not at the position of another that excludes it.
    fn meets(&mut self, part: Part, p: Vec3, there: Option<Part>) {
        if let Some(there) = there {
            let other =
                if there == Part::Observer { Observer::WHAT.to_owned() } else { there.path().to_string() };
            let rule = format!("{other} is there; {} must not be where {} is", what(part), what(there));
            self.problems.push(Problem::value(part.path().key("position"), Value::from(p).written(), rule));
        }
    }

    /// The first light at a position.
    fn light_there(&self, p: Vec3) -> Option<Part> {
        self.light_at.get(&place(p)?).copied().map(Part::Light)
    }

    /// The first object at a position.
    fn object_there(&self, p: Vec3) -> Option<Part> {
        self.objects.iter().position(|o| same_place(o.position, p)).map(Part::Object)
    }

    /// The observer, if at this position.
    fn observer_there(&self, p: Vec3) -> Option<Part> {
        same_place(p, self.scene.observer.position).then_some(Part::Observer)
    }

    fn light(&mut self, index: usize, light: &Light) {
        let part = Part::Light(index);
        let path = |key: &'static str| part.path().key(key);
        let id = &light.light_type;
        let entry = self.registry.light(id);
        if let Some(entry) = entry {
            let d = entry.declaration;
            for (key, is, should) in [
                ("position", light.position.is_some(), d.has_position),
                ("direction", light.direction.is_some(), d.has_direction),
                (
                    "luminous_flux",
                    light.luminous_flux.is_some(),
                    light.luminous_flux.is_some() && entry.has_flux(),
                ),
            ] {
                if is != should {
                    self.about(path(key), presence(id, key, should));
                }
            }
        }
        if light.luminous_flux.is_some() && entry.is_some_and(|entry| !entry.has_flux()) {
            self.fields(&Light { luminous_flux: None, ..light.clone() }, part);
        } else {
            self.fields(light, part);
        }
        for (name, value) in &light.parameters.0 {
            let path = || part.path().key(name.clone());
            match entry.map(|e| e.parameter(name)) {
                Some(Some(declared)) => self.rule(declared.check(value), || (path(), value.written())),
                Some(None) => self.about(path(), presence(id, name, false)),
                // The type is unknown, which is already reported.
                None => {}
            }
        }
        if let Some(p) = light.position {
            self.meets(part, p, self.observer_there(p));
        }
    }

    /// Checks a light, and that no object is where it is.
    fn light_alone(&mut self, index: usize, light: &Light) {
        self.light(index, light);
        if let Some(p) = light.position {
            self.meets(Part::Light(index), p, self.object_there(p));
        }
    }

    fn object(&mut self, index: usize, object: &Object) {
        let part = Part::Object(index);
        let registry = self.registry;
        self.fields(object, part);
        if let Some(shape) = registry.shape(&object.object_type) {
            if let Some(count) = object.tessellation {
                self.rule(tessellation(shape, count), || (part.path().key("tessellation"), count));
            }
            for (name, value) in &object.shape.0 {
                let path = || part.path().key(name.clone());
                match shape.parameter(name) {
                    Some(declared) => self.rule(declared.check(value), || (path(), value.written())),
                    None => {
                        let what = with_article(&object.object_type);
                        self.about(path(), format!("is given, but {what} has no {name}"));
                    }
                }
            }
        }
        let models = [self.scene.model_of(object), self.scene.shading_model_of(object)];
        let materials = self.materials;
        for (name, value) in object.material.0.iter().filter(|_| materials) {
            self.rule(material_parameter(registry, models, name, value), || {
                (part.path().key("material").key(name.clone()), value.written())
            });
        }
        let p = object.position;
        self.meets(part, p, self.light_there(p).or_else(|| self.observer_there(p)));
    }

    fn variants(&mut self) {
        let scene = self.scene;
        let all = &scene.variants;
        let list = || (Path::root().key("variants"), format!("a list of {} variants", all.len()));
        self.rule(variant_count(all.len()), list);
        for (i, variant) in all.iter().enumerate() {
            let part = Part::Variant(i);
            if let Some(name) = &variant.name {
                let twin = all[..i].iter().position(|other| other.name.as_ref() == Some(name));
                if let Some(twin) = twin {
                    let rule =
                        format!("variants[{twin}] has this name already; variants need different names");
                    self.problems.push(Problem::value(part.path().key("name"), quoted(name), rule));
                }
            }
            if let Some(base) = &variant.based_on {
                self.rule(basis(scene, variant, base), || (part.path().key("based_on"), quoted(base)));
            }
            self.fields(variant, part);
            if !variant.material.0.is_empty() {
                self.variant_material(i);
            }
        }
        let comparison = &scene.comparison;
        self.fields(comparison, Part::Comparison);
        if comparison.with > all.len().max(1) {
            let letter = LETTERS.get(comparison.with).copied().unwrap_or("?");
            let rule = match all.len() {
                0 => "the scene has no variants".to_owned(),
                n => format!("the last view of the scene is {}", LETTERS[n]),
            };
            let path = Part::Comparison.path().key("with");
            self.problems.push(Problem::value(path, quoted(letter), rule));
        }
    }

    /// Checks the parameters of a variant, each with the models that objects have in it.
    fn variant_material(&mut self, index: usize) {
        let (scene, registry) = (self.scene, self.registry);
        let Some(variant) = scene.overrides(index + 1) else { return };
        let mut models: Vec<[&str; 2]> = Vec::new();
        for object in self.objects {
            let model = variant.reflection_model.as_deref().unwrap_or_else(|| scene.model_of(object));
            let shading = variant.shading_model.as_deref().unwrap_or_else(|| scene.shading_model_of(object));
            if !models.contains(&[model, shading]) {
                models.push([model, shading]);
            }
        }
        for (name, value) in &scene.variants[index].material.0 {
            let rule =
                models.iter().try_for_each(|models| material_parameter(registry, *models, name, value));
            self.rule(rule, || {
                (Part::Variant(index).path().key("material").key(name.clone()), value.written())
            });
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
            "display.exposure is 17, but it must be between -16 and 16 EV",
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
        let mut check = Parts::of(&s, &registry);
        let mut parts = [check.problems(Part::Size), check.problems(Part::Scene)].concat();
        parts.retain(|p| whole.contains(p) && p.path.segments().len() == 2);
        parts.extend((0..s.lights.len()).flat_map(|i| check.problems(Part::Light(i))));
        parts.extend(check.problems(Part::Observer));
        parts.extend((0..s.objects.len()).flat_map(|i| check.problems(Part::Object(i))));
        parts.extend(check.problems(Part::Display));
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
        assert_eq!(check.problems(Part::Light(9)), []);
        assert_eq!(check.problems(Part::Object(9)), []);
    }

    #[test]
    fn a_room_is_too_small_for_what_stands_outside_it() {
        let room = |s: &Scene| -> Vec<_> {
            let registry = Registry::builtin();
            Parts::of(s, &registry).problems(Part::Size).iter().map(|p| p.path.to_string()).collect()
        };
        let mut s = Scene::default();
        s.scene_size.depth = 9.25;
        let found = room(&s);
        assert_eq!(found, ["observer.position"]);
        s.scene_size.depth = 101.0;
        let found = room(&s);
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
