//! The position, direction and size of a new lamp with extent.

use glam::Vec3;

use super::{PROBED, Stand, block::Block, round};
use crate::{
    light::{LightEntry, Size},
    parameter::{ParameterKind, Value, Values},
    scene::limits::significant,
};

/// Depth of a lamp, in distances of what it lights: in front of it, unless the camera then sees the dark side.
const DEPTH: f32 = 0.87;
/// Tangents of the angle at which the camera sees the side of a lamp that shines: wanted, and smallest.
const BRIGHT_SIDE: [f32; 2] = [0.15, 0.08];
/// Offset of a lamp from what it lights, in halves of the picture: above it, to either side.
const BESIDE: [[f32; 2]; 2] = [[0.55, 0.7], [-0.55, 0.7]];
/// Smallest and largest extent of a lamp, in distances from what it lights.
const SPAN: [f32; 2] = [0.2, 0.5];
/// Smallest rise of a lamp above what it lights, in distances from that.
const LEAST_RISE: f32 = 0.15;
/// The next smaller size of a lamp that covers something.
const SMALLER: f32 = 0.85;
/// Largest extent of a lamp, in distances from the nearest object.
const CLEAR: f32 = 1.6;

impl Stand<'_> {
    /// What a new lamp lights: the selected object if it is in view, otherwise the centre of the view.
    fn target(&self) -> Vec3 {
        self.aim.filter(|aim| self.sees(*aim, 0.0)).unwrap_or_else(|| self.middle())
    }

    /// Position of a new lamp: where the camera sees it beside all objects and lamps, preferably above what it lights;
    /// otherwise at least not over the centre of any.
    pub(super) fn lamp(&self, entry: &LightEntry) -> Vec3 {
        let wanted = self.above_target();
        let target = self.target();
        let up = self.turn * Vec3::Y;
        let is_above = |p: Vec3| (p - target).dot(up) > LEAST_RISE * p.distance(target);
        let step = self.light_step();
        let apart = |p: Vec3| self.is_apart(p, step, None);
        let in_view = |p: Vec3| self.shows_light(p) && apart(p);
        let has_dark_side = entry.declaration.has_direction && !is_tube(entry);
        let is_bright = |p: Vec3| !has_dark_side || self.sees_bright_side(p, target);
        let fits = |p: Vec3| in_view(p) && is_bright(p);
        // Where the picture is narrower than the usual distance between lights.
        let is_tight = |p: Vec3| self.shows_light(p) && self.is_outside_objects(p);
        let (span, others) = (entry.span(&Values::default()), self.in_sight());
        let covers = |p: Vec3, centre: bool| {
            let least = self.span_at(span, p).min(SPAN[0] * p.distance(target));
            self.covers(p, least, &others, centre)
        };
        // A narrow view shows few of the places that are farther from each other.
        let step = step.min(0.25 * self.opening[1] * wanted.distance(self.eye));
        let place = |fits: &dyn Fn(Vec3) -> bool| self.search(wanted, step, fits);
        place(&|p| is_above(p) && fits(p) && !covers(p, false))
            .or_else(|| place(&|p| fits(p) && !covers(p, false)))
            .or_else(|| place(&|p| is_tight(p) && is_bright(p) && !covers(p, false)))
            .or_else(|| place(&|p| is_above(p) && fits(p) && !covers(p, true)))
            .or_else(|| place(&|p| fits(p) && !covers(p, true)))
            .or_else(|| place(&|p| in_view(p) && !covers(p, true)))
            .or_else(|| place(&in_view))
            .or_else(|| place(&is_tight))
            .or_else(|| place(&apart))
            .unwrap_or_else(|| self.lattice(wanted))
    }

    /// True if the camera sees the side of a lamp that faces what it lights.
    fn sees_bright_side(&self, at: Vec3, target: Vec3) -> bool {
        let (way, back) = (target - at, self.eye - at);
        way.dot(back) > BRIGHT_SIDE[1] * way.cross(back).length()
    }

    /// True if a position is inside the room and outside objects, except those around the camera.
    fn is_outside_objects(&self, p: Vec3) -> bool {
        let is_outside = |object: &Block| object.gap(p) > 0.0 || object.gap(self.eye) <= 0.0;
        self.is_inside(p, self.margin()) && self.taken.iter().all(is_outside)
    }

    /// True if a lamp overlaps one of these in the picture, or with `centre`, if it covers the centre of one.
    fn covers(&self, at: Vec3, span: f32, others: &[Block], centre: bool) -> bool {
        let ball = Block::ball(at, 0.5 * span);
        others.iter().any(|other| self.hides(&ball, other, centre))
    }

    /// The space that lamps and the objects nearest to the camera take, without the floors and rooms that it stands in.
    fn in_sight(&self) -> Vec<Block> {
        let mut all: Vec<_> =
            self.taken.iter().filter(|other| !other.ball_holds(self.eye)).copied().collect();
        all.sort_by(|a, b| a.centre.distance(self.eye).total_cmp(&b.centre.distance(self.eye)));
        all.truncate(PROBED);
        let lamps = self.scene.lights.iter().filter_map(|light| {
            let span = self.registry.light(&light.light_type)?.span(&light.parameters);
            (span > 0.0).then_some(Block::ball(light.position?, 0.5 * span))
        });
        all.extend(lamps);
        all
    }

    /// False for a new light that would fill the background which other lights from all around leave free.
    pub(in crate::panel::state) fn may_fill_background(&self, entry: &LightEntry) -> bool {
        let is_around = |entry: &LightEntry| {
            let d = entry.declaration;
            d.extent && !d.has_position && !d.has_direction
        };
        let lights = self.scene.lights.iter().filter(|light| light.enabled);
        let others: Vec<_> = lights
            .filter_map(|light| Some((light, self.registry.light(&light.light_type)?)))
            .filter(|(_, other)| is_around(other))
            .collect();
        !is_around(entry)
            || entry.parameter("visible").is_none()
            || others.is_empty()
            || others.iter().any(|(light, other)| other.is_visible(&light.parameters))
    }

    /// The wished position of a new lamp: above what it lights, on the side with the least light of those with room.
    pub(super) fn above_target(&self) -> Vec3 {
        let target = self.target();
        let way = target - self.eye;
        let [across, up] = self.opening;
        let right = (self.turn * Vec3::X).reject_from(way).normalize_or(self.turn * Vec3::X);
        let above = right.cross(way.normalize_or(self.turn * Vec3::NEG_Z));
        let all = BESIDE.map(|[side, rise]| {
            let beside = side * across * right + rise * up * above;
            // By the law of sines, with the lamp at the given angle. The narrower the picture, the deeper it stands.
            let seen_from = (1.0 + BRIGHT_SIDE[0] * beside.length()) / (1.0 + beside.length_squared());
            self.eye + seen_from.max(DEPTH) * (way + way.length() * beside)
        });
        let has_room = |p: Vec3| self.free_for_light(p, 0.5 * SPAN[0] * p.distance(target), None);
        let shows = |p: Vec3| self.sees_light(p);
        let of = |good: &dyn Fn(Vec3) -> bool| self.darkest(all.into_iter().filter(|p| good(*p)));
        of(&|p| has_room(p) && shows(p))
            .or_else(|| of(&has_room))
            .or_else(|| of(&|_| true))
            .unwrap_or(self.eye)
    }

    /// The direction of a new light at a position: towards what it lights; for a tube, whose direction is its axis, across
    /// that and the line of sight, as its ends are dark.
    pub(in crate::panel::state) fn direction(&self, entry: &LightEntry, from: Vec3) -> Vec3 {
        if entry.declaration.sizes.is_empty() {
            return self.towards_middle(from);
        }
        let way = self.target() - from;
        let wanted = if is_tube(entry) { way.cross(self.turn * Vec3::Y) } else { way };
        wanted.try_normalize().map_or(Vec3::NEG_Y, |v| round(v, 100.0))
    }

    /// The extent of a lamp at a position: its own, unless that is far too large or too small for the distance from what it
    /// lights.
    fn span_at(&self, span: f32, at: Vec3) -> f32 {
        let distance = at.distance(self.target());
        let gaps = self.taken.iter().map(|object| object.gap(at));
        let [least, most] = SPAN.map(|share| share * distance);
        let most = gaps.map(|gap| CLEAR * gap).fold(most, f32::min);
        span.max(least).min(most)
    }

    /// Scales the sizes of a new lamp to its distance from what it lights, if they are far too large or too small for it, or
    /// if it would cover objects or other lamps, or reach out of the picture.
    pub(in crate::panel::state) fn fit_size(&self, entry: &LightEntry, at: Vec3, values: &mut Values) {
        let span = entry.span(values);
        let (mut wanted, others) = (self.span_at(span, at), self.in_sight());
        let least = SPAN[0] * at.distance(self.target());
        let is_out = |span: f32| self.sees(at, 0.0) && !self.sees(at, 0.5 * span);
        while wanted > least && (self.covers(at, wanted, &others, false) || is_out(wanted)) {
            wanted = (SMALLER * wanted).max(least);
        }
        if span <= 0.0 || wanted <= 0.0 || wanted == span {
            return;
        }
        let sizes = entry.declaration.sizes.iter().filter_map(|size| entry.parameter(size.parameter()));
        for parameter in sizes {
            let ParameterKind::Number(number) = &parameter.kind else { continue };
            let scaled = significant(f64::from(values.number(parameter) * wanted / span), 2) as f32;
            values.set(parameter.name, Value::Number(scaled.clamp(number.min, number.max)));
        }
    }
}

/// True for a tube, whose direction is its axis.
fn is_tube(entry: &LightEntry) -> bool {
    entry.declaration.sizes.iter().any(|size| matches!(size, Size::Length(_)))
}
