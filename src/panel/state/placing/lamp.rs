//! The position, direction and size of a new lamp with extent.

use glam::Vec3;

use super::{Stand, round};
use crate::{
    light::{LightEntry, Size},
    parameter::{ParameterKind, Value, Values},
    scene::limits::significant,
};

/// Depth of a lamp, in distances of what it lights: so little in front of it that the camera sees the side that shines.
const DEPTH: f32 = 0.87;
/// Offset of a lamp from what it lights, in halves of the picture: above it, to either side.
const BESIDE: [[f32; 2]; 2] = [[0.55, 0.7], [-0.55, 0.7]];
/// Smallest and largest extent of a lamp, in distances from what it lights.
const SPAN: [f32; 2] = [0.2, 0.5];
/// Largest extent of a lamp, in distances from the nearest object.
const CLEAR: f32 = 1.6;

impl Stand<'_> {
    /// What a new lamp lights: the selected object if it is in view, otherwise the centre of the view.
    fn target(&self) -> Vec3 {
        self.aim.filter(|aim| self.sees(*aim, 0.0)).unwrap_or_else(|| self.middle())
    }

    /// The wished position of a new lamp: above what it lights, on the side with the least light of those with room.
    pub(super) fn above_target(&self) -> Vec3 {
        let target = self.target();
        let way = target - self.eye;
        let [across, up] = self.opening();
        let right = (self.turn * Vec3::X).reject_from(way).normalize_or(self.turn * Vec3::X);
        let above = right.cross(way.normalize_or(self.turn * Vec3::NEG_Z));
        let all = BESIDE.map(|[side, rise]| {
            self.eye + DEPTH * (way + way.length() * (side * across * right + rise * up * above))
        });
        let has_room = |p: Vec3| self.free_for_light(p, 0.5 * SPAN[0] * p.distance(target), None);
        let shows = |p: Vec3| self.sees(p, 0.08 * p.distance(self.eye));
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
        let is_tube = entry.declaration.sizes.iter().any(|size| matches!(size, Size::Length(_)));
        let wanted = if is_tube { way.cross(self.turn * Vec3::Y) } else { way };
        wanted.try_normalize().map_or(Vec3::NEG_Y, |v| round(v, 100.0))
    }

    /// Scales the sizes of a new lamp to its distance from what it lights, if they are far too large or too small for it.
    pub(in crate::panel::state) fn fit_size(&self, entry: &LightEntry, at: Vec3, values: &mut Values) {
        let span = entry.span(values);
        let distance = at.distance(self.target());
        let gaps = self.taken.iter().map(|object| object.gap(at));
        let [least, most] = SPAN.map(|share| share * distance);
        let most = gaps.map(|gap| CLEAR * gap).fold(most, f32::min);
        let wanted = span.max(least).min(most);
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
