//! The frames around what is selected, as the camera sees it: their corners, so that nothing of it is covered.

use std::{collections::HashMap, f32::consts::PI, sync::Arc};

use bevy_egui::egui::{Context, Id, Rect, Ui, Vec2, pos2, vec2};
use glam::Vec3;

use super::{SELECTED, ink::Ink};
use crate::{
    panel::{kept, state::Session, together::together},
    registry::Registry,
    scene::{Object, Part, rotation::rotation},
    shape::{MeshKey, ShapeEntry},
};

/// Distance of a frame from what it frames, points.
const FRAME: f32 = 7.0;
/// Maximum number of objects that have frames of their own beside the first one.
const MOST_FRAMES: usize = 64;
/// Number of directions in which the points of a shape are sought that reach farthest.
const DIRECTIONS: usize = 512;

/// The outermost points of the shapes of the objects that are selected besides the first.
#[derive(Clone, Default)]
struct Shapes(HashMap<MeshKey, Arc<[Vec3]>>);

/// The tessellation of the mesh whose points are framed. Finer ones have the same outline.
fn tessellation(shape: &ShapeEntry, object: &Object) -> u32 {
    shape.tessellation(object.tessellation).min(shape.declaration.default_tessellation)
}

/// A frame around the selected object.
pub(super) fn frame(ui: &Ui, ink: &mut Ink, object: &Object, registry: &Registry) {
    let Some(shape) = registry.shape(&object.object_type) else { return };
    let count = tessellation(shape, object);
    // Only the last one is kept: a drag of a knob makes hundreds.
    let (id, key) = (Id::new("mesh of what is selected"), shape.key(&object.shape, Some(count)));
    let make = || shape.mesh(&object.shape, count).positions.into();
    let mesh: Arc<[Vec3]> = kept::of_key(ui.ctx(), id, key, make);
    around(ink, object, &mesh);
}

/// Frames around the objects that are selected besides the first: one around each, or, if they are many, one around all.
pub(super) fn frames(ui: &Ui, ink: &mut Ink, session: &Session, registry: &Registry) {
    let Some(all) = together(ui.ctx(), session, registry) else { return };
    let lens = ink.lens;
    let others = || {
        let first = Part::from(session.selection);
        let is_other = move |part: Part| matches!(part, Part::Object(_)) && part != first;
        all.places().filter(move |(part, ..)| is_other(*part))
    };
    if others().nth(MOST_FRAMES).is_none() {
        let object = |part| if let Part::Object(i) = part { session.document.objects.get(i) } else { None };
        return each(ui.ctx(), ink, others().filter_map(|(part, ..)| object(part)), registry);
    }
    let seen = others().filter_map(|(_, at, half)| {
        let points = half.max_element() / lens.metres(at, 1.0);
        Some(Rect::from_center_size(lens.project(at)?, Vec2::splat(2.0 * points)))
    });
    if let Some(around) = seen.reduce(Rect::union) {
        corners(ink, around.expand(FRAME));
    }
}

/// A frame around each object, as tight as that of one alone.
fn each<'o>(ctx: &Context, ink: &mut Ink, objects: impl Iterator<Item = &'o Object>, registry: &Registry) {
    let Shapes(known) = kept::get(ctx);
    let mut used = HashMap::new();
    for object in objects {
        let Some(shape) = registry.shape(&object.object_type) else { continue };
        let count = tessellation(shape, object);
        let points = used.entry(shape.key(&object.shape, Some(count))).or_insert_with_key(|key| {
            let make = || outermost(shape.mesh(&object.shape, count).positions);
            known.get(key).cloned().unwrap_or_else(make)
        });
        around(ink, object, points);
    }
    kept::set(ctx, Shapes(used));
}

/// The points that reach farthest in some direction, which decide where a shape ends in the picture; all of a few.
fn outermost(points: Vec<Vec3>) -> Arc<[Vec3]> {
    if points.len() <= DIRECTIONS {
        return points.into();
    }
    // Directions along a spiral, in equal parts of the sphere.
    let direction = |k: usize| {
        let z = 1.0 - (2 * k + 1) as f32 / DIRECTIONS as f32;
        let (sin, cos) = (k as f32 * PI * (3.0 - 5f32.sqrt())).sin_cos();
        ((1.0 - z * z).sqrt() * Vec3::new(cos, sin, 0.0)).with_z(z)
    };
    let farthest = |k: usize| {
        let way = direction(k);
        points.iter().copied().max_by(|a, b| a.dot(way).total_cmp(&b.dot(way)))
    };
    (0..DIRECTIONS).filter_map(farthest).collect()
}

/// A frame around points of an object.
fn around(ink: &mut Ink, object: &Object, points: &[Vec3]) {
    let (lens, turn) = (ink.lens, rotation(object.rotation));
    let seen = points.iter().map(|p| lens.project(object.position + turn * (object.size * *p)));
    // A part that reaches behind the camera is all around it.
    let around = match seen.collect::<Option<Vec<_>>>() {
        Some(points) => Rect::from_points(&points).expand(FRAME),
        None => lens.rect.shrink(FRAME),
    };
    corners(ink, around);
}

/// The corners of a frame, as far as it is seen.
fn corners(ink: &mut Ink, around: Rect) {
    let view = ink.lens.rect.shrink(FRAME);
    if !around.intersects(view) {
        return;
    }
    let around = around.intersect(view);
    let arm = (0.25 * around.size().min_elem()).clamp(6.0, 18.0);
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
        let corner = around.lerp_inside(vec2(x, y));
        let inward = vec2(1.0 - 2.0 * x, 1.0 - 2.0 * y) * arm;
        let ends = [pos2(corner.x + inward.x, corner.y), pos2(corner.x, corner.y + inward.y)];
        ink.line(vec![ends[0], corner, ends[1]], SELECTED);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::Values;

    #[test]
    fn the_outermost_points_of_a_shape_end_where_the_shape_does() {
        let registry = Registry::builtin();
        for shape in registry.shapes() {
            let finest = *shape.declaration.tessellation.end();
            let all = shape.mesh(&Values::default(), finest.min(64)).positions;
            let few = outermost(all.clone());
            assert!(few.len() <= all.len().max(DIRECTIONS), "{}", shape.declaration.id);
            for way in [Vec3::X, Vec3::Y, Vec3::new(0.6, -0.3, 0.7).normalize(), Vec3::new(-0.2, -0.9, 0.1)] {
                let end = |points: &[Vec3]| points.iter().map(|p| p.dot(way)).fold(0.0, f32::max);
                let (end_of_all, end_of_few) = (end(&all), end(&few));
                assert!(end_of_few <= end_of_all);
                assert!(end_of_few >= 0.97 * end_of_all, "{}: {end_of_few}", shape.declaration.id);
            }
        }
    }
}
