//! Handles that a light type declares: at the ends of its sizes, and one for its roll.

use bevy_egui::egui::Pos2;
use glam::Vec3;

use super::shape::{Body, DISC, End, Handle, Placed, RING, Target, circle, part_of};
use crate::{
    light::{LightEntry, Size},
    panel::{marks::Lens, state::HandleMode},
    scene::Light,
};

/// Minimum distance of a size handle from the centre, in points.
const NEAREST: f32 = 26.0;
/// Minimum distance of a handle from the edge of the view, in points.
const INSET: f32 = 14.0;
/// Projected length of an axis, relative to its full length, below which it has no handles at its ends: it could not be
/// dragged along.
const FLAT: f32 = 0.2;

/// The direction from the centre of a light to the handle of a size.
pub(super) fn way(light: &Light, entry: &LightEntry, size: Size, end: End, at: Vec3, lens: &Lens) -> Vec3 {
    let [right, up, _] = lens.axes();
    let direction = light.direction.and_then(Vec3::try_normalize);
    let [x, y] = entry.sides(&light.parameters, direction.unwrap_or(Vec3::NEG_Y));
    let way = match (size, direction) {
        (Size::Width(_), _) => x,
        (Size::Height(_), _) => y,
        (Size::Length(_), Some(direction)) => direction,
        // The point of a circle that is farthest to the right.
        (_, Some(direction)) => {
            let across = lens.across(at, direction);
            if across.dot(right) < 0.0 { -across } else { across }
        }
        (_, None) => (right + up).reject_from(at - lens.eye()).normalize_or(right),
    };
    if end == End::First { way } else { -way }
}

/// The handles for the sizes and the roll of a light.
pub(super) fn placed(target: &Target, mode: HandleMode, lens: &Lens) -> Vec<Placed> {
    let Some(middle) = lens.project(target.at).filter(|p| lens.rect().contains(*p)) else {
        return Vec::new();
    };
    match (&target.body, mode) {
        (Body::Light(light, entry), HandleMode::Size) => sizes(target, light, entry, middle, lens),
        (Body::Light(light, entry), HandleMode::Turn) => {
            roll(target, light, entry, lens).into_iter().collect()
        }
        _ => Vec::new(),
    }
}

fn sizes(target: &Target, light: &Light, entry: &LightEntry, middle: Pos2, lens: &Lens) -> Vec<Placed> {
    let mut all = Vec::new();
    for (i, size) in entry.declaration.sizes.iter().enumerate() {
        let ends: &[End] = if size.needs_direction() { &[End::First, End::Second] } else { &[End::First] };
        for end in ends {
            let handle = Handle::Extent(i, *end);
            let metres = target.parameter(handle).map(|p| size.part() * light.parameters.number(p));
            let way = way(light, entry, *size, *end, target.at, lens);
            all.extend(metres.and_then(|metres| at_end(handle, target.at, middle, metres * way, way, lens)));
        }
    }
    all
}

/// The handle at an end of a size, kept inside the view and away from the centre.
fn at_end(handle: Handle, at: Vec3, middle: Pos2, arm: Vec3, way: Vec3, lens: &Lens) -> Option<Placed> {
    let step = lens.project(at + lens.metres(at, 10.0) * way)? - middle;
    let (length, seen) = (step.length(), step.normalized());
    if length < 10.0 * FLAT {
        return None;
    }
    let view = lens.rect().shrink(INSET);
    let room = |from: f32, way: f32, [least, most]: [f32; 2]| {
        (if way > 0.0 { most - from } else { from - least }) / way.abs().max(1e-6)
    };
    let across = room(middle.x, seen.x, [view.left(), view.right()]);
    let most = across.min(room(middle.y, seen.y, [view.top(), view.bottom()]));
    let ahead = lens.project(at + arm).map(|end| (end - middle).dot(seen)).filter(|points| *points <= most);
    // Outside the view, the handle sits where the axis leaves it.
    let (points, point) = match ahead {
        Some(points) => (points, at + arm),
        None => (most, at + lens.ray(middle + most * seen).along(at, way)? * way),
    };
    let apart = points.max(NEAREST.min(most));
    let end = middle + apart * seen;
    let stem = (apart > points + DISC).then(|| vec![middle + points * seen, end]);
    let lines = stem.into_iter().collect();
    Some(Placed { handle, lines, far: Vec::new(), end, radius: DISC + 2.0, point })
}

/// The ring that turns a light about its direction, with a knob at the top of the light.
fn roll(target: &Target, light: &Light, entry: &LightEntry, lens: &Lens) -> Option<Placed> {
    entry.roll_parameter()?;
    let direction = light.direction.and_then(Vec3::try_normalize)?;
    let [x, y] = entry.sides(&light.parameters, direction);
    let length = lens.metres(target.at, part_of(lens) * RING);
    let point = target.at + length * y;
    let [lines, far] = circle(target.at, [x, y], length, lens);
    Some(Placed { handle: Handle::Roll, lines, far, end: lens.project(point)?, radius: DISC, point })
}
