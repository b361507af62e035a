//! Non-finite light: finds the light or reflection model of a scene that produces it, and where.
//!
//! Renderers draw NaN as black and infinity as white. This module finds the source, by trying positions and
//! directions, or from pixels known to be affected. It also finds models that cannot be tried because a
//! function runs too long.

use std::collections::{HashMap, HashSet};

use glam::{Vec2, Vec3};

use super::{
    Part, Seen as Explained,
    edited_lights::{EditedLamp, EditedLights},
    numbers::{number, triple},
    pixel,
};
use crate::files::Shown as _;
use crate::{
    channel::colours::{INFINITE, NAN},
    light::{
        Emitter, Incident, LightEntry, LightRecord,
        extent::{Sample, Seen},
    },
    optics::{Frame, TermSelection, Terms},
    parameter::words,
    reference::Settings,
    reflection::{ModelEntry, Surface, ends::check_that_it_ends},
    registry::Registry,
    scene::{Light, Object, Scene, emitter, error::Path},
    shader::definitions::definition,
    text::{place::Lines, quoted},
};

/// Angles between light and normal to try, in degrees; a model must be finite behind the surface too.
const LIGHTS: [f32; 10] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0, 89.9, 100.0, 180.0];
/// Angles between viewer and normal to try, in degrees.
const VIEWS: [f32; 6] = [0.0, 30.0, 45.0, 60.0, 85.0, 89.9];
/// Angles between their planes to try, in degrees.
const PLANES: [f32; 5] = [0.0, 60.0, 120.0, 180.0, 270.0];
/// The functions of models in WGSL: for light from a direction, and from everywhere.
const RESPONSE: &str = "response";
const AMBIENT: &str = "ambient_response";
/// Maximum number of objects at which lights are tried.
const MOST_OBJECTS: usize = 64;
/// Maximum number of places at which the WGSL of lights is interpreted.
const MOST_INTERPRETED: usize = 16;
/// Maximum number of different surfaces to try.
const MOST_SURFACES: usize = 512;
/// Maximum number of pixels traced to their source.
const MOST_PIXELS: usize = 16;

/// A light, or an object with its reflection model, whose light is not finite or cannot be calculated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path} {}{what}", named(.name.as_deref()))]
pub struct NotFinite {
    /// Path in the scene.
    pub path: Path,
    /// Its name, if it has one of its own.
    pub name: Option<String>,
    /// The rest of the sentence: type or model, value, and position.
    pub what: String,
}

impl NotFinite {
    /// What the path does not say: the name, and the rest of the sentence.
    #[must_use]
    pub fn rest(&self) -> String {
        named(self.name.as_deref()) + &self.what
    }
}

/// Selects the lights and models of a scene to try.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// All.
    All,
    /// Models without tests in this crate: custom models, and types of other crates.
    Untested,
}

impl Scope {
    fn has(self, source: &str, registry: &Registry) -> bool {
        let edited = || registry.sources().edited().any(|path| path == source);
        self == Self::All || registry.is_foreign(source) || edited()
    }
}

/// Results for surfaces, by model, version and parameters: each is tried once. Edited light types are prepared once.
#[derive(Debug, Default)]
pub struct Tried {
    surfaces: HashMap<(&'static str, u64, Vec<u32>), Option<String>>,
    lights: EditedLights,
    too_long: Vec<NotFinite>,
}

impl Tried {
    /// Objects of the last scene whose models ran a function for too long, one for each model: neither
    /// renderer runs these models.
    #[must_use]
    pub fn too_long(&self) -> &[NotFinite] {
        &self.too_long
    }
}

/// Tries the lights of a scene at its objects and in its room, also those of types whose WGSL was edited, and its models
/// for directions of light and viewer. Skips what the CPU cannot run.
#[must_use]
pub fn probe(scene: &Scene, registry: &Registry, scope: Scope, tried: &mut Tried) -> Vec<NotFinite> {
    let mut found = lights(scene, registry, scope, &mut tried.lights);
    tried.too_long.clear();
    if tried.surfaces.len() > 8 * MOST_SURFACES {
        tried.surfaces.clear();
    }
    let mut met = HashSet::new();
    for (i, object) in scene.objects.iter().enumerate().filter(|(_, object)| object.visible) {
        let Some(model) = registry.model(scene.model_of(object)) else { continue };
        if !scope.has(model.declaration.wgsl.path, registry) || model.not_on_cpu().is_some() {
            continue;
        }
        let words = words(model.parameters, &object.material, scene.display.encoding);
        let key = (model.declaration.id, model.version(), words);
        if met.len() >= MOST_SURFACES || !met.insert(key.clone()) {
            continue;
        }
        let what = tried.surfaces.entry(key).or_insert_with(|| surface(scene, object, model, registry));
        let of = |what| NotFinite { path: part("objects", i), name: object.name.clone(), what };
        found.extend(what.clone().map(of));
        // It did not run too long before, so this object triggers it.
        if model.runs_too_long() {
            tried.too_long.push(of(too_long(model, registry)));
        }
    }
    found
}

fn part(list: &str, index: usize) -> Path {
    Path::root().key(list.to_owned()).index(index)
}

fn named(name: Option<&str>) -> String {
    name.map_or_else(String::new, |name| format!("({}) ", quoted(name)))
}

/// The active lights that are not finite somewhere, each with the first such position.
fn lights(scene: &Scene, registry: &Registry, scope: Scope, edited: &mut EditedLights) -> Vec<NotFinite> {
    let places = places(scene);
    let few = places.len().div_ceil(MOST_INTERPRETED).max(1);
    let mut found = Vec::new();
    for (i, light) in scene.lights.iter().enumerate().filter(|(_, light)| light.enabled) {
        let Some((entry, emitter, record)) = emitter(light, registry, scene.display.encoding) else {
            continue;
        };
        let wanted = scope.has(entry.declaration.wgsl.path, registry);
        let mut tried = places.iter().filter(|_| wanted);
        let odd = tried.find_map(|p| Some((*p, given(entry, &*emitter, &record, *p)?)));
        let odd = odd.map(|(p, odd)| of_light(i, light.name.as_deref(), &light.light_type, p, &odd));
        let tried = places.iter().copied().step_by(few);
        found.extend(odd.or_else(|| of_edited(scene, i, registry, edited, tried)));
    }
    found
}

/// A light that is not finite at one of these places by the edited WGSL of its type.
fn of_edited(
    scene: &Scene,
    index: usize,
    registry: &Registry,
    edited: &mut EditedLights,
    mut places: impl Iterator<Item = Vec3>,
) -> Option<NotFinite> {
    let light = scene.lights.get(index)?;
    let lamp = edited.lamp(light, registry, scene.display.encoding)?;
    let (p, odd) = places.find_map(|p| Some((p, interpreted(&lamp, p)?)))?;
    Some(of_light(index, light.name.as_deref(), &light.light_type, p, &odd))
}

fn of_light(index: usize, name: Option<&str>, id: &str, p: Vec3, odd: &Odd) -> NotFinite {
    let (p, Odd { of, value, must_be }) = (triple(p), odd);
    let what = format!("is of the type {id}, whose {of} at {p} m is {value}; it must be {must_be}");
    NotFinite { path: part("lights", index), name: name.map(str::to_owned), what }
}

/// A quantity of a light that has no legal value.
struct Odd {
    of: &'static str,
    value: String,
    must_be: &'static str,
}

impl Odd {
    /// A quantity whose value is not finite.
    fn infinite(of: &'static str, value: String) -> Option<Self> {
        Some(Self { of, value, must_be: "finite" })
    }

    /// A density, unless it is finite and not negative.
    fn density(of: &'static str, pdf: f32) -> Option<Self> {
        match pdf {
            _ if !pdf.is_finite() => Self::infinite(of, number(pdf)),
            _ if pdf < 0.0 => Some(Self { of, value: number(pdf), must_be: "0 or more" }),
            _ => None,
        }
    }
}

/// The first quantity without a legal value of a light at a point, by its functions in Rust.
fn given(entry: &LightEntry, emitter: &dyn Emitter, record: &LightRecord, p: Vec3) -> Option<Odd> {
    match entry.declaration.extent {
        true => with_extent(|u| emitter.sample(record, p, u), |l| emitter.seen(record, p, l)),
        false => of_direction(emitter.incident(record, p)),
    }
}

/// The same by its functions in WGSL.
fn interpreted(lamp: &EditedLamp, p: Vec3) -> Option<Odd> {
    match lamp.has_extent() {
        true => with_extent(|u| lamp.sample(p, u), |l| lamp.seen(p, l)),
        false => of_direction(lamp.incident(p)),
    }
}

/// The first quantity that is not finite of light from one direction.
fn of_direction(incident: Incident) -> Option<Odd> {
    let (value, l) = match incident {
        Incident::From { l, intensity } => (intensity, l),
        Incident::Uniform { intensity } => (intensity, Vec3::Z),
    };
    if !value.is_finite() {
        return Odd::infinite("intensity", triple(value));
    }
    if value != Vec3::ZERO && !l.is_finite() { Odd::infinite("direction", triple(l)) } else { None }
}

/// The first quantity without a legal value of a light with extent: in samples, or seen in their directions and in some
/// others.
fn with_extent(sample: impl Fn(Vec2) -> Sample, seen: impl Fn(Vec3) -> Seen) -> Option<Odd> {
    let mut directions = directions();
    for u in grid() {
        let Sample { l, radiance, pdf } = sample(u);
        if !radiance.is_finite() {
            return Odd::infinite("radiance in sample", triple(radiance));
        }
        if let Some(odd) = Odd::density("density in sample", pdf) {
            return Some(odd);
        }
        if radiance != Vec3::ZERO && pdf > 0.0 {
            if !l.is_finite() {
                return Odd::infinite("direction in sample", triple(l));
            }
            directions.push(l);
        }
    }
    directions.into_iter().find_map(|l| {
        let Seen { radiance, pdf, distance } = seen(l);
        match () {
            () if !radiance.is_finite() => Odd::infinite("radiance in seen", triple(radiance)),
            // Infinite is far away.
            () if distance.is_nan() => Odd::infinite("distance in seen", number(distance)),
            () => Odd::density("density in seen", pdf),
        }
    })
}

/// Points of the unit square: a grid with its edges.
fn grid() -> impl Iterator<Item = Vec2> {
    /// Points per side. Samples are below 1.
    const SIDE: usize = 5;
    let at = |i: usize| (i as f32 / (SIDE - 1) as f32).min(1.0f32.next_down());
    (0..SIDE * SIDE).map(move |i| Vec2::new(at(i % SIDE), at(i / SIDE)))
}

/// Directions over the whole sphere.
fn directions() -> Vec<Vec3> {
    let polar = [0.0, 45.0, 90.0, 135.0, 180.0];
    polar.into_iter().flat_map(|theta| PLANES.map(|phi| direction(theta, phi))).collect()
}

/// Positions at objects, and a grid in the room.
fn places(scene: &Scene) -> Vec<Vec3> {
    let room = scene.scene_size.corner();
    let grid = (0..27).map(|i| Vec3::new((i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32));
    let around = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let at = |object: &Object| around.map(|side| object.position + 0.5 * object.size * side);
    let objects = scene.shown().take(MOST_OBJECTS).flat_map(at);
    objects.chain(grid.map(|cell| (0.1 + 0.4 * cell) * room)).collect()
}

/// The direction with these angles, in degrees.
fn direction(theta: f32, phi: f32) -> Vec3 {
    let (sin, cos) = theta.to_radians().sin_cos();
    let (y, x) = phi.to_radians().sin_cos();
    Vec3::new(sin * x, sin * y, cos)
}

/// A description of the first of these directions for which an object's surface is not finite.
fn surface(scene: &Scene, object: &Object, model: &ModelEntry, registry: &Registry) -> Option<String> {
    // As before a GPU runs the model.
    check_that_it_ends(model, &object.material, scene.display.encoding).ok()?;
    let surface = model.instantiate(&object.material, scene.display.encoding);
    let by = |function| move |(value, where_): (Vec3, String)| (value, where_, function);
    let found = directed(&*surface, model).map(by(RESPONSE));
    let (value, where_, function) = found.or_else(|| everywhere(&*surface, scene).map(by(AMBIENT)))?;
    Some(of_model(model.declaration.id, value, &where_, &place_of(model, function, registry)))
}

/// True for light from everywhere.
fn is_ambient(light: &Light) -> bool {
    light.position.is_none() && light.direction.is_none()
}

/// The function of a custom model in its file, after a colon, if its text defines the function: by default, ambient light
/// is that of the response.
fn place_of(model: &ModelEntry, function: &str, registry: &Registry) -> String {
    let Some(file) = registry.custom_file(model.declaration.id) else { return String::new() };
    let text = registry.sources().text(&model.declaration.wgsl);
    let defined = [function, RESPONSE].into_iter().find_map(|name| Some((name, definition(text, name)?)));
    defined.map_or_else(
        || format!(": {}", file.shown()),
        |(name, at)| format!(": {name} at {}:{}", file.shown(), Lines::new(text).place(at)),
    )
}

fn too_long(model: &ModelEntry, registry: &Registry) -> String {
    let id = model.declaration.id;
    let file = registry.custom_file(id).map_or_else(String::new, |file| format!(" of {}", file.shown()));
    let why = model.not_on_cpu().unwrap_or_default();
    format!("has the reflection model {id}{file}, which cannot be run: {why}")
}

fn of_model(model: &str, value: Vec3, where_: &str, place: &str) -> String {
    let value = triple(value);
    format!("has the reflection model {model}, which gives {value} for {where_}; it must be finite{place}")
}

/// The sum of the terms, if any of them is not finite.
fn odd(terms: &Terms) -> Option<Vec3> {
    let sum = terms.select(TermSelection::All);
    (!sum.is_finite()).then_some(sum)
}

fn directed(surface: &dyn Surface, model: &ModelEntry) -> Option<(Vec3, String)> {
    for light in LIGHTS {
        for view in VIEWS {
            for plane in PLANES {
                let (l, v) = (direction(light, plane), direction(view, 0.0));
                if let Some(value) = odd(&surface.response(l, v, &Frame::LOCAL)) {
                    let where_ = format!(
                        "light at {light}° and a viewer at {view}° to the normal, {plane}° between their planes"
                    );
                    return Some((value, where_));
                }
            }
        }
        if model.runs_too_long() {
            return None;
        }
    }
    None
}

fn everywhere(surface: &dyn Surface, scene: &Scene) -> Option<(Vec3, String)> {
    // Calculated only where needed: it takes long for some models.
    if !scene.shining().any(is_ambient) {
        return None;
    }
    VIEWS.into_iter().find_map(|view| {
        let value = surface.ambient_response(direction(view, 0.0), &Frame::LOCAL);
        let where_ = format!("light from everywhere and a viewer at {view}° to the normal");
        (!value.is_finite()).then_some((value, where_))
    })
}

/// The pixels marked as not finite in a picture of that debug channel, row by row.
#[must_use]
pub fn marked(rgb8: &[u8], width: u32) -> Vec<[u32; 2]> {
    let pixels = rgb8.as_chunks::<3>().0.iter().zip(0u32..);
    let odd = pixels.filter(|(code, _)| **code == NAN || **code == INFINITE);
    odd.map(|(_, i)| [i % width, i / width]).collect()
}

/// The lights and objects that make some of these pixels of a picture non-finite.
#[must_use]
pub fn traced(
    scene: &Scene,
    registry: &Registry,
    settings: &Settings,
    pixels: &[[u32; 2]],
) -> Vec<NotFinite> {
    let mut found: Vec<NotFinite> = Vec::new();
    let mut edited = EditedLights::default();
    for at in pixels.iter().step_by(pixels.len().div_ceil(MOST_PIXELS).max(1)) {
        let explained = pixel(scene, registry, settings, *at).ok();
        let Some(seen) = explained.and_then(|explained| explained.seen) else { continue };
        for odd in of_pixel(scene, registry, &seen, *at, &mut edited) {
            if !found.iter().any(|known| known.path == odd.path) {
                found.push(odd);
            }
        }
    }
    found
}

fn of_pixel(
    scene: &Scene,
    registry: &Registry,
    seen: &Explained,
    [x, y]: [u32; 2],
    edited: &mut EditedLights,
) -> Vec<NotFinite> {
    let mut found = Vec::new();
    let of =
        |what| NotFinite { path: part("objects", seen.object.index), name: seen.object.name.clone(), what };
    for spot in &seen.spots {
        for lit in spot.lights.iter().filter(|lit| !lit.is_finite()) {
            let light = scene.lights.get(lit.light.index).filter(|_| lit.integral.is_some());
            let of_extent = light.and_then(|light| {
                let (entry, emitter, record) = emitter(light, registry, scene.display.encoding)?;
                given(entry, &*emitter, &record, spot.position)
            });
            let any = || Odd::infinite("light", triple(lit.arriving)).filter(|_| !lit.arriving.is_finite());
            let Part { index, name, id, .. } = &lit.light;
            found.push(match of_extent.or_else(any) {
                Some(wrong) => of_light(*index, name.as_deref(), id, spot.position, &wrong),
                None => {
                    let value = odd(&lit.response).unwrap_or(lit.contribution);
                    let where_ = format!("{} at pixel {x},{y}", part("lights", *index));
                    let ambient = scene.lights.get(lit.light.index).is_some_and(is_ambient);
                    let function = if ambient { AMBIENT } else { RESPONSE };
                    let place =
                        registry.model(seen.model.id).map(|model| place_of(model, function, registry));
                    of(of_model(seen.model.id, value, &where_, &place.unwrap_or_default()))
                }
            });
        }
    }
    if found.is_empty() {
        // Only the GPU runs an edited light type.
        let active = scene.lights.iter().enumerate().filter(|(_, light)| light.enabled);
        let places = || seen.spots.iter().map(|spot| spot.position).chain([seen.position]);
        found.extend(active.filter_map(|(i, _)| of_edited(scene, i, registry, edited, places())));
    }
    if found.is_empty() {
        // Only the GPU produces it, or the CPU cannot run the model.
        found.push(of(format!("has the reflection model {}: pixel {x},{y}", seen.model.id)));
    }
    found
}
