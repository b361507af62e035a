//! The places of the marks of lights: beside the objects, and not under what is written over the picture.

use bevy_egui::egui::{Pos2, Rect, Vec2};
use glam::Vec3;

use super::lens::Lens;
use crate::{
    registry::Registry,
    scene::{Light, Object, Scene, rotation::rotation},
};

/// More lights than this get small marks, wherever they are.
pub(super) const CROWD: usize = 24;
/// Length of arrows and cones, points.
pub(super) const SHORT: f32 = 28.0;
/// Free space around a mark, points.
const AIR: f32 = 7.0;
/// Places along a way that are tried.
const STEPS: usize = 32;
/// An object that fills a larger part of the picture is the floor on which the others stand.
const FLOOR: f32 = 0.4;
/// The most objects that are kept clear of: more would fill the picture.
const OBJECTS: usize = 256;

/// The place of a light's mark: that of the light; for light from a direction, where it enters the room. None for
/// uniform light.
#[must_use]
pub fn anchor(light: &Light, scene: &Scene) -> Option<Vec3> {
    let direction = light.direction.and_then(Vec3::try_normalize);
    light.position.or_else(|| {
        let half = 0.5 * scene.scene_size.corner();
        let room = 0.92 * (half / direction?.abs().max(Vec3::splat(1e-6))).min_element();
        Some(half - direction? * room)
    })
}

/// The position of the mark of each light: for light from a direction, beside the objects and as far from them as
/// it can be seen, and not where something is written over the picture.
#[must_use]
pub fn places(scene: &Scene, registry: &Registry, lens: &Lens, overlays: &[Rect]) -> Vec<Option<Vec3>> {
    let crowd = scene.lights.len() > CROWD;
    let (mut taken, mut objects) = (overlays.to_vec(), Vec::new());
    if !crowd && scene.lights.iter().any(|light| light.position.is_none() && light.direction.is_some()) {
        let lamps = scene.lights.iter().filter_map(|light| lens.project(light.position?));
        taken.extend(lamps.map(|at| Rect::from_center_size(at, Vec2::splat(4.0 * AIR))));
        objects = outlines(scene, registry, lens);
    }
    let place = |light: &Light| {
        let (at, room) = place(light, scene, lens, &taken, &objects)?;
        taken.extend(room.filter(|_| !crowd));
        Some(at)
    };
    scene.lights.iter().map(place).collect()
}

/// The rectangles of the picture in which the objects are.
fn outlines(scene: &Scene, registry: &Registry, lens: &Lens) -> Vec<Rect> {
    let outline = |object: &Object| {
        let turn = rotation(object.rotation);
        let half = object.size * registry.shape(&object.object_type)?.bounds(&object.shape).half;
        let corner = |k: u32| {
            let sign = |bit: u32| if k & bit == 0 { -1.0 } else { 1.0 };
            lens.project(object.position + turn * (half * Vec3::new(sign(1), sign(2), sign(4))))
        };
        let corners: Vec<Pos2> = (0..8).map(corner).collect::<Option<_>>()?;
        let seen = Rect::from_points(&corners).intersect(lens.rect);
        // Beside a floor there is no place.
        Some(seen).filter(|r| r.is_positive() && r.area() < FLOOR * lens.rect.area())
    };
    scene.shown().filter_map(outline).take(OBJECTS).collect()
}

/// The part of the picture that the mark of light from a direction takes.
fn room(from: Vec3, direction: Vec3, lens: &Lens) -> Option<Rect> {
    let to = from + direction * lens.metres(from, SHORT);
    let ends = [lens.project(from)?, lens.project(to)?];
    Some(Rect::from_points(&ends).expand(0.4 * SHORT + AIR))
}

/// The place of a light's mark, and the part of the picture that it takes if it could be elsewhere.
fn place(
    light: &Light,
    scene: &Scene,
    lens: &Lens,
    taken: &[Rect],
    objects: &[Rect],
) -> Option<(Vec3, Option<Rect>)> {
    let far = anchor(light, scene)?;
    if light.position.is_some() {
        return Some((far, None));
    }
    let direction = light.direction.and_then(Vec3::try_normalize)?;
    let count = scene.objects.len().max(1) as f32;
    let middle = scene.objects.iter().map(|o| o.position).sum::<Vec3>() / count;
    let depth = lens.seen(middle).length();
    let ahead = lens.at(lens.rect.center(), depth);
    let free = |p: Vec3, beside: bool| {
        // Not so near to the camera that the mark is out of its depth.
        let room = room(p, direction, lens).filter(|_| -lens.seen(p).z > 0.3 * depth)?;
        let hidden = |by: &[Rect]| by.iter().any(|r| r.intersects(room));
        let free = lens.rect.contains_rect(room) && !hidden(taken) && !(beside && hidden(objects));
        free.then_some((p, Some(room)))
    };
    // First along the way that the light takes to the objects, then along the edge of the picture.
    let along = |from: Vec3| {
        let steps = (0..=STEPS).rev().map(move |k| from - direction * (depth * k as f32 / STEPS as f32));
        steps.filter(|p| scene.scene_size.contains(*p))
    };
    let edge = || border(lens.rect, lens.towards(ahead - direction * depth)).map(|at| lens.at(at, depth));
    let all = || [far].into_iter().chain(along(middle)).chain(along(ahead)).chain(edge());
    let find = |beside: bool| all().find_map(|p| free(p, beside));
    find(true).or_else(|| find(false)).or(Some((far, None)))
}

/// Places around the edge of the picture, those nearest to a direction first.
fn border(rect: Rect, way: Vec2) -> impl Iterator<Item = Pos2> {
    let turns = (0..STEPS).map(|k| {
        let turn = k.div_ceil(2) as f32 / STEPS as f32 * std::f32::consts::TAU;
        if k % 2 == 0 { turn } else { -turn }
    });
    turns.flat_map(move |turn| {
        let way = Vec2::angled(way.angle() + turn);
        [0.86, 0.7].map(|part| at_edge(rect.scale_from_center(part), way))
    })
}

/// The point at which the way from the middle meets the frame.
pub(super) fn at_edge(frame: Rect, way: Vec2) -> Pos2 {
    let half = 0.5 * frame.size();
    let reach = |half: f32, way: f32| if way.abs() > 1e-6 { half / way.abs() } else { f32::INFINITY };
    frame.center() + way * reach(half.x, way.x).min(reach(half.y, way.y))
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{pos2, vec2};

    use super::*;

    #[test]
    fn the_way_to_the_edge_ends_there() {
        let frame = Rect::from_min_max(pos2(0.0, 0.0), pos2(200.0, 100.0));
        assert_eq!(at_edge(frame, vec2(1.0, 0.0)), pos2(200.0, 50.0));
        assert_eq!(at_edge(frame, vec2(0.0, -1.0)), pos2(100.0, 0.0));
    }

    #[test]
    fn light_from_a_direction_has_its_mark_where_it_enters_the_room() {
        let mut scene = Scene::default();
        let down = Light { position: None, direction: Some(Vec3::NEG_Y), ..Light::default() };
        assert!(anchor(&down, &scene).is_some_and(|p| p.distance(Vec3::new(5.0, 9.6, 5.0)) < 1e-4));
        scene.scene_size.width = 40.0;
        let flat = Light { direction: Some(Vec3::new(-3.0, 0.0, 0.0)), ..down.clone() };
        assert!(anchor(&flat, &scene).is_some_and(|p| scene.scene_size.contains(p) && p.x > 38.0));
        assert_eq!(anchor(&Light { direction: None, ..down }, &scene), None, "uniform light");
    }
}
