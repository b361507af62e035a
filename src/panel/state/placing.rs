//! The position of a new part of the scene: free, and in view of the camera; and the intensity of a new light, which
//! has a visible effect without overexposing the picture.

use glam::{Quat, Vec2, Vec3};

use super::Clipping;
use crate::{
    light::LightEntry,
    optics::{
        colour::{srgb_decode, srgb_encode},
        tone::exposure_factor,
    },
    parameter::{Value, Values},
    reference,
    registry::Registry,
    scene::limits::significant,
    scene::{Light, Object, Observer, Scene},
};
use block::Block;

mod block;
mod copy;
mod lamp;
mod several;

/// Free space around a light, and between an object and the camera, in metres.
const AIR: f32 = 0.3;
/// Size of the test pictures that determine the brightness of a light: small ones are enough.
const PROBE: [u32; 2] = [128, 72];
/// Maximum number of objects in a test picture: those nearest to the camera.
const PROBED: usize = 200;
/// Fraction of the remaining range of the display that a new light uses.
const SHARE: f32 = 0.75;
/// Minimum brightening by a new light, in display values from 0 to 1, even if some pixels then clip.
const VISIBLE: f32 = 0.07;
/// Fraction of the lit pixels that may clip for that.
const HIGHLIGHTS: f32 = 0.006;
/// Fraction of the lit pixels that are brightened at least that much.
const VISIBLE_PART: f32 = 0.05;

/// Distances of copies of lights and of several parts from the originals, in widths or heights of a copy; farther away
/// they would no longer be beside them.
const APART: [f32; 8] = [1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0];
/// Width or height of a copy that leaves a small gap, in multiples of the copy's reach.
const GAP: f32 = 2.2;
/// Factor of the size of objects, so that what they stand on does not count as touched.
const SLACK: f32 = 0.999;
/// Factor from bounding boxes and spheres to the slightly smaller outlines.
const OUTLINE: f32 = 0.95;
/// Minimum distance between the markers of two lights, in halves of the height of the picture.
const MARKER: f32 = 0.12;

/// A scene, and the camera in front of which something is placed.
pub(super) struct Stand<'a> {
    scene: &'a Scene,
    registry: &'a Registry,
    eye: Vec3,
    turn: Quat,
    /// Tangents of half the field of view, across and up. Each view in the window shows at least this.
    opening: [f32; 2],
    /// The space that the objects take.
    taken: Vec<Block>,
    /// The position of the selected object.
    aim: Option<Vec3>,
}

impl<'a> Stand<'a> {
    pub(super) fn new(scene: &'a Scene, registry: &'a Registry, eye: Vec3, turn: Quat) -> Self {
        let taken = scene.objects.iter().map(|o| Block::of(o, registry)).collect();
        let angle = scene.view_angle();
        let up = (0.5 * angle.degrees.to_radians()).tan();
        Self { scene, registry, eye, turn, opening: [angle.keeps * up, up], taken, aim: None }
    }

    /// New lamps light this place if it is in view.
    pub(super) fn aiming(self, aim: Option<Vec3>) -> Self {
        Self { aim, ..self }
    }

    /// Position and size of a new object.
    pub(super) fn object(&self, id: &str) -> (Vec3, f32) {
        let size = Object::default().size.min(0.5 * self.scene.scene_size.corner().min_element());
        let unit = self.registry.shape(id).map_or(0.5, |shape| shape.bounds(&Values::default()).radius);
        let wanted = self.middle();
        // If there is no room for it, the object becomes smaller.
        let smaller = [4.0, 8.0, 16.0].map(|divisor| (divisor, true));
        for (divisor, hides) in
            [(1.0, false), (2.0, false), (1.0, true), (2.0, true)].into_iter().chain(smaller)
        {
            let step = 0.55 * (size / divisor).max(0.3 * size);
            let size = size / divisor;
            let radius = unit * size;
            let fits = |p: Vec3| {
                self.free(p, radius) && self.sees(p, radius) && (hides || self.is_beside_all(p, radius))
            };
            if let Some(place) = self.search(wanted, step, fits) {
                return (place, size);
            }
        }
        let radius = unit * size;
        let anywhere = self.search(wanted, 0.55 * size, |p| self.free(p, radius));
        (anywhere.unwrap_or_else(|| self.lattice(wanted)), size)
    }

    /// The nearest valid position beside another as seen by the camera, at the same depth: to the right, to the left,
    /// above or below, at the given numbers of steps. Sideways and upward steps may differ.
    fn beside(
        &self,
        of: Vec3,
        [side, up]: [f32; 2],
        counts: &[f32],
        fits: impl Fn(Vec3) -> bool,
    ) -> Option<Vec3> {
        let ways = [side * Vec3::X, side * Vec3::NEG_X, up * Vec3::Y, up * Vec3::NEG_Y];
        // Fine enough to preserve the depth.
        let steps = 10.0 * self.steps();
        let place = |way: Vec3| round(of + self.turn * way, steps);
        let mut places = counts.iter().flat_map(|count| ways.map(|way| place(*count * way)));
        places.find(|p| fits(*p))
    }

    /// True if a block is completely in the picture.
    fn shows(&self, block: &Block) -> bool {
        let seen = self.turn.inverse() * (block.centre - self.eye);
        let [side, rise, deep] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| block.reach(self.turn * axis));
        let [across, up] = self.opening;
        let near = -seen.z - deep;
        let boxed = seen.x.abs() + side <= across * near && seen.y.abs() + rise <= up * near;
        near > 0.1 && (boxed || self.sees(block.centre, block.radius))
    }

    /// True if two blocks overlap in the picture, or with `centre`, if the first one covers the centre of the other. A
    /// block around the camera or behind it covers nothing.
    fn hides(&self, one: &Block, other: &Block, centre: bool) -> bool {
        let ((at, depth), (there, far)) = (self.flat(one.centre), self.flat(other.centre));
        if depth <= one.radius.max(0.1) || far <= 0.1 {
            return centre && depth > -one.radius;
        }
        let between = there - at;
        let reach = |way: Vec2| {
            let way = self.turn * way.extend(0.0);
            let own = one.reach(way) / depth;
            if centre { own } else { OUTLINE * (own + other.reach(way) / far) }
        };
        // If the centres coincide, they define no separating direction.
        let ways = [Some(Vec2::X), Some(Vec2::Y), between.try_normalize()];
        ways.into_iter().flatten().all(|way| between.dot(way).abs() < reach(way))
    }

    /// Position of a new light of a type.
    pub(super) fn new_light(&self, entry: &LightEntry) -> Vec3 {
        if entry.declaration.sizes.is_empty() { self.light(None) } else { self.lamp(entry) }
    }

    /// Position of a copy of the light at a position.
    pub(super) fn copy_of_light(&self, at: Vec3) -> Vec3 {
        self.light(Some(at))
    }

    /// The position of these that is farthest from all lights, as seen from the centre of the view.
    fn darkest(&self, all: impl IntoIterator<Item = Vec3>) -> Option<Vec3> {
        let dark = |a: &Vec3, b: &Vec3| self.nearest_light(*a).total_cmp(&self.nearest_light(*b));
        all.into_iter().min_by(dark)
    }

    /// Distance between lights, and between the places tried for one, in metres.
    fn light_step(&self) -> f32 {
        let distance = (self.middle() - self.eye).length();
        0.1 * distance.min(self.scene.scene_size.corner().min_element()).max(AIR)
    }

    /// True if a light is inside the room, outside objects, and farther than a step away from other lights. See
    /// [`Self::free_for_light`].
    fn is_apart(&self, p: Vec3, step: f32, copied: Option<Vec3>) -> bool {
        let lights = self.scene.lights.iter().filter_map(|l| l.position);
        self.free_for_light(p, 0.0, copied) && lights.into_iter().all(|q| p.distance(q) > step)
    }

    /// True if a light is in the picture, away from its edges.
    fn sees_light(&self, p: Vec3) -> bool {
        // A narrow view is not all edge.
        let margin = (0.2 * self.opening[1]).min(0.08);
        self.sees(p, margin * p.distance(self.eye))
    }

    /// True if a light is in the picture, and its marker covers none of another light.
    fn shows_light(&self, p: Vec3) -> bool {
        self.sees_light(p) && self.is_beside_markers(p)
    }

    /// Position of a light without size: beside `copied` if it is a copy, otherwise where it is noticed most.
    fn light(&self, copied: Option<Vec3>) -> Vec3 {
        let distance = (self.middle() - self.eye).length();
        let [across, up] = self.opening;
        // Over the shoulder or from below, on the side with the least light, where the new light is most noticeable.
        let depth = 0.7 * distance;
        let beside = |[side, rise]: [f32; 2]| {
            self.eye + self.turn * (depth * Vec3::new(side * across, rise * up, -1.0))
        };
        let wanted = copied.unwrap_or_else(|| {
            let sides = [[0.4, 0.6], [-0.4, 0.6], [0.4, -0.5], [-0.4, -0.5]];
            self.darkest(sides.map(beside)).unwrap_or(self.eye)
        });
        let step = self.light_step();
        let apart = |p: Vec3| self.is_apart(p, step, copied);
        // A copy of a light outside the view is still placed near it.
        let hidden = copied.is_some_and(|near| !self.sees(near, 0.0));
        let fits = |p: Vec3| apart(p) && (hidden || self.shows_light(p));
        copied
            .and_then(|near| self.beside(near, [1.1 * step; 2], &APART, fits))
            .or_else(|| self.search(wanted, step, fits))
            .or_else(|| self.search(wanted, step, apart))
            .unwrap_or_else(|| self.lattice(wanted))
    }

    /// Cosine of the angle, seen from the centre of the view, between a position and the nearest light.
    fn nearest_light(&self, place: Vec3) -> f32 {
        let middle = self.middle();
        let way = (place - middle).normalize_or_zero();
        let lights = self.scene.lights.iter();
        let ways = lights.filter_map(|l| l.position.map(|p| p - middle).or(l.direction.map(|d| -d)));
        ways.map(|w| w.normalize_or_zero().dot(way)).fold(-1.0, f32::max)
    }

    /// The direction from a position to the centre of the view.
    pub(super) fn towards_middle(&self, from: Vec3) -> Vec3 {
        (self.middle() - from).try_normalize().map_or(Vec3::NEG_Y, |v| round(v, 100.0))
    }

    /// The scene of test pictures, as seen by the camera. Lights are judged by the objects, not by lamps in sight and what is
    /// behind them.
    fn probe(&self) -> Scene {
        let mut scene = self.scene.clone();
        scene.observer =
            Observer { position: self.eye, direction: self.turn * Vec3::NEG_Z, ..scene.observer };
        scene.objects.sort_by(|a, b| a.position.distance(self.eye).total_cmp(&b.position.distance(self.eye)));
        scene.objects.truncate(PROBED);
        for object in &mut scene.objects {
            if let Some(shape) = self.registry.shape(&object.object_type) {
                let range = &shape.declaration.tessellation;
                let count = shape.tessellation(object.tessellation).min(32);
                object.tessellation = Some(count.clamp(*range.start(), *range.end()));
            }
        }
        scene.lights.iter_mut().for_each(|light| self.conceal(light));
        scene
    }

    /// Makes a light with extent invisible itself.
    fn conceal(&self, light: &mut Light) {
        if self.registry.light(&light.light_type).is_some_and(|e| e.parameter("visible").is_some()) {
            light.parameters.set("visible", Value::flag(false));
        }
    }

    /// An intensity at which a new light is visible while the brightest parts stay within the range of the display,
    /// determined by rendering with and without the light. Also returns true if more pixels clip than are tolerated.
    pub(super) fn intensity(&self, light: &Light, entry: &LightEntry) -> (f32, bool) {
        let default = entry.declaration.default_intensity;
        let mut scene = self.probe();
        let [width, height] = PROBE;
        let settings = reference::Settings { width, height, samples: 1, ..reference::Settings::default() };
        let before = reference::render(&scene, self.registry, &settings);
        scene.lights = vec![Light { intensity: default, luminous_flux: None, ..light.clone() }];
        scene.lights.iter_mut().for_each(|light| self.conceal(light));
        let added = reference::render(&scene, self.registry, &settings);
        let limit = self.brightest();
        let (mut factors, mut floors, mut clipped) = (Vec::new(), Vec::new(), 0);
        for (before, added) in before.pixels.iter().zip(&added.pixels) {
            let (before, added) = (before.truncate().max_element(), added.truncate().max_element());
            if before >= limit {
                // A pixel that clips already uses up the tolerance.
                clipped += 1;
            } else if added > 1e-9 {
                let brighter = srgb_decode((srgb_encode(before / limit) + VISIBLE).min(1.0)) * limit;
                floors.push((brighter - before) / added);
                factors.push((limit - before) / added);
            }
        }
        if factors.is_empty() {
            return (default, false);
        }
        factors.sort_by(f32::total_cmp);
        floors.sort_by(f32::total_cmp);
        // Number of pixels that may clip without a warning.
        let spared = (Clipping::TOLERATED * f64::from(width * height)) as usize;
        let most = factors[spared.saturating_sub(clipped).min(factors.len() - 1)];
        let least = floors[(VISIBLE_PART * floors.len() as f32) as usize];
        // Highlights, but nothing else, may clip to make the light visible.
        let clipping = factors[(HIGHLIGHTS * factors.len() as f32) as usize];
        let factor = (SHARE * most).max(least.min(clipping.max(most)));
        let intensity = f64::from(default) * f64::from(factor).clamp(1e-6, 1e3);
        (significant(intensity, 2) as f32, factor > most)
    }

    /// The largest light that the display distinguishes from larger values.
    fn brightest(&self) -> f32 {
        let display = &self.scene.display;
        let curve = |x: f32| display.tone_mapping.map(Vec3::splat(x)).max_element();
        let top = [8.0, 4.0, 2.0].into_iter().find(|x| curve(*x) < 0.97).unwrap_or(1.0);
        top / exposure_factor(display.exposure)
    }

    /// Centre of the objects if it is in view, otherwise the nearest point on the line of sight.
    fn middle(&self) -> Vec3 {
        let objects = &self.scene.objects;
        let middle = match objects.len() {
            0 => 0.5 * self.scene.scene_size.corner(),
            n => objects.iter().map(|o| o.position).sum::<Vec3>() / n as f32,
        };
        if self.sees(middle, 0.0) {
            return middle;
        }
        let ahead = self.turn * Vec3::NEG_Z;
        let near = 0.2 * self.scene.scene_size.corner().min_element();
        self.eye + ahead * (middle - self.eye).dot(ahead).max(near)
    }

    /// True if a sphere is completely in view.
    fn sees(&self, p: Vec3, radius: f32) -> bool {
        let seen = self.turn.inverse() * (p - self.eye);
        let [across, up] = self.opening;
        let within = |side: f32, opening: f32| {
            (opening * -seen.z - side.abs()) / (1.0 + opening * opening).sqrt() >= radius
        };
        -seen.z > radius + 0.1 && within(seen.x, across) && within(seen.y, up)
    }

    /// True if a sphere neither hides an object nor is hidden by one.
    fn is_beside_all(&self, p: Vec3, radius: f32) -> bool {
        let (at, depth) = self.flat(p);
        let mut others = self.taken.iter().filter(|other| !other.ball_holds(self.eye));
        others.all(|other| {
            let (there, far) = self.flat(other.centre);
            far < 0.1 || at.distance(there) >= 0.9 * (radius / depth + other.radius / far)
        })
    }

    /// True if the marker of a light at a position covers none of another light.
    fn is_beside_markers(&self, p: Vec3) -> bool {
        let least = MARKER * self.opening[1];
        let (at, _) = self.flat(p);
        let mut lights = self.scene.lights.iter().filter_map(|l| l.position).map(|q| self.flat(q));
        lights.all(|(there, far)| far < 0.1 || at.distance(there) >= least)
    }

    /// A position in the picture, as tangents across and up, and its depth.
    fn flat(&self, p: Vec3) -> (Vec2, f32) {
        let seen = self.turn.inverse() * (p - self.eye);
        (seen.truncate() / -seen.z, -seen.z)
    }

    /// True if a sphere is inside the room and touches no sphere around an object. The sphere around a floor contains
    /// the camera and most of the scene: there the box counts.
    fn free(&self, p: Vec3, radius: f32) -> bool {
        let gap = |other: &Block| {
            if other.ball_holds(self.eye) { other.gap(p) } else { p.distance(other.centre) - other.radius }
        };
        self.has_air(p, radius) && self.taken.iter().all(|other| gap(other) > clearance(radius))
    }

    /// True if a light of a radius is inside the room and outside objects. What already contains the camera or the
    /// light `copied` is a room, not an obstacle.
    fn free_for_light(&self, p: Vec3, radius: f32, copied: Option<Vec3>) -> bool {
        let is_room = |other: &Block| {
            other.gap(self.eye) <= 0.0 || copied.is_some_and(|copied| other.gap(copied) <= 0.0)
        };
        self.has_air(p, radius)
            && self.taken.iter().all(|other| other.gap(p) > clearance(radius) || is_room(other))
    }

    /// True if a sphere is inside the room, and away from lights and cameras.
    fn has_air(&self, p: Vec3, radius: f32) -> bool {
        self.is_inside(p, Vec3::splat(radius).max(self.margin())) && self.is_in_air(p, radius)
    }

    /// Minimum distance from the walls.
    fn margin(&self) -> Vec3 {
        Vec3::splat(0.01 * self.scene.scene_size.corner().min_element())
    }

    /// True if a box with half sides `reach` around a position is inside the room.
    fn is_inside(&self, p: Vec3, reach: Vec3) -> bool {
        (p - reach).min_element() >= 0.0 && (p + reach).cmple(self.scene.scene_size.corner()).all()
    }

    /// True if a sphere is away from lights and cameras.
    fn is_in_air(&self, p: Vec3, radius: f32) -> bool {
        let corner = self.scene.scene_size.corner();
        let air = |q: Vec3| p.distance(q) > radius + AIR.min(0.1 * corner.min_element());
        air(self.eye)
            && air(self.scene.observer.position)
            && self.scene.lights.iter().filter_map(|l| l.position).all(air)
    }

    /// The valid position nearest to a wanted one: preferably beside it, then behind, then above.
    fn search(&self, wanted: Vec3, step: f32, fits: impl Fn(Vec3) -> bool) -> Option<Vec3> {
        let level = |v: Vec3| v.with_y(0.0).try_normalize();
        let right = level(self.turn * Vec3::X).unwrap_or(Vec3::X);
        let ahead = right.cross(Vec3::NEG_Y).normalize_or(Vec3::NEG_Z);
        let mut offsets = Vec::new();
        for i in -8..=8i32 {
            for j in -5..=5i32 {
                for k in -8..=8i32 {
                    let lean = |n: i32, cost: f32| cost * n.abs() as f32 + if n < 0 { 0.1 } else { 0.0 };
                    let cost = lean(i, 1.0) + lean(j, 2.0) + lean(k, 1.3);
                    let way = i as f32 * right + j as f32 * Vec3::Y + k as f32 * ahead;
                    offsets.push((cost, way));
                }
            }
        }
        offsets.sort_by(|a, b| a.0.total_cmp(&b.0));
        // The places stay apart when they are rounded.
        let steps = self.steps().max(10f32.powf((1.0 / step).log10().ceil()));
        offsets.into_iter().map(|(_, way)| round(wanted + step * way, steps)).find(|p| fits(*p))
    }

    /// Steps per metre that give readable numbers: 10, or more in a small room.
    fn steps(&self) -> f32 {
        let room = self.scene.scene_size.corner().min_element();
        10f32.powf((20.0 / room).log10().ceil().max(1.0))
    }

    /// A lattice point that is not the position of anything, for a crowded room.
    fn lattice(&self, wanted: Vec3) -> Vec3 {
        let corner = self.scene.scene_size.corner();
        let step = 0.1 * corner;
        let lights = self.scene.lights.iter().filter_map(|l| l.position);
        let others: Vec<_> = (lights.chain(self.scene.objects.iter().map(|o| o.position)))
            .chain([self.scene.observer.position])
            .collect();
        let taken = |p: Vec3| others.iter().any(|q| (p - *q).length() < 0.5 * step.min_element());
        let inside = |p: Vec3| round(p.clamp(0.02 * corner, 0.99 * corner), 10.0 * self.steps());
        let wrapped = |start: f32, k: i32, step: f32, end: f32| {
            let q = start + k as f32 * step;
            if q > end { q - end } else { q }
        };
        let start = inside(wanted);
        (0..1000)
            // x varies fastest, then z, then y: a row on the floor before a tower.
            .map(|n| {
                inside(Vec3::new(
                    wrapped(start.x, n % 10, step.x, corner.x),
                    wrapped(start.y, n / 100, step.y, corner.y),
                    wrapped(start.z, (n / 10) % 10, step.z, corner.z),
                ))
            })
            .find(|p| !taken(*p))
            .unwrap_or_else(|| inside(start + 0.01 * step))
    }
}

/// Minimum distance of a new sphere of a radius from objects.
fn clearance(radius: f32) -> f32 {
    1.05 * radius.max(0.05)
}

/// Rounds to the given number of steps per metre.
fn round(v: Vec3, steps: f32) -> Vec3 {
    (v * steps).round() / steps
}
