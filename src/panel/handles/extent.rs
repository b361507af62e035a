//! The handles at the ends of the sizes that a light type declares.

use bevy_egui::egui::Pos2;
use glam::Vec3;

use super::{
    Handle, Sort,
    grasp::{Dragged, snapped},
    paint,
    shape::{Body, DISC, Placed, Target},
};
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

/// An end of a size of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// The end in the direction of the size's axis.
    First,
    /// The opposite end.
    Second,
}

/// The size that a handle changes, by its place among those that the type declares, and at which of its ends.
fn parts(which: usize) -> (usize, End) {
    (which / 2, if which.is_multiple_of(2) { End::First } else { End::Second })
}

pub(super) static SORT: Sort = Sort {
    id: "extent",
    name: |target, which, part| {
        let label = target.parameter(SORT.handle(which)).map_or("size", |p| p.label);
        match parts(which).1 {
            End::First => format!("{label} of {part}"),
            End::Second => format!("{label} of {part}, at the other end"),
        }
    },
    placed: |around| match (&around.target.body, around.mode) {
        (Body::Light(light, entry), HandleMode::Size) => {
            sizes(around.target, light, entry, around.middle, around.lens)
        }
        _ => Vec::new(),
    },
    parameter: |entry, which| entry.parameter(entry.declaration.sizes.get(parts(which).0)?.parameter()),
    hold: |grasp, target, lens| {
        let (i, end) = parts(grasp.handle.which);
        if let Body::Light(light, entry) = target.body
            && let Some(size) = entry.declaration.sizes.get(i)
        {
            grasp.end = Some((way(light, entry, *size, end, target.at, lens), size.part()));
        }
    },
    drag: |grasp, pull| {
        let ((_, before), (way, part)) = grasp.parameter.zip(grasp.end)?;
        let by = grasp.moved_along(pull.lens, pull.pointer, grasp.point, way)?;
        grasp.nearest(snapped(before + by / part, pull.step).max(pull.step))
    },
    words: |grasp, dragged, metres| match dragged {
        Dragged::Parameter(value) => format!("{} {} m", grasp.label(), metres(value)),
        other => super::grasp::words(grasp, other, metres),
    },
    end: paint::square,
    ..Sort::OF_PARAMETER
};

/// The direction from the centre of a light to the handle of a size.
fn way(light: &Light, entry: &LightEntry, size: Size, end: End, at: Vec3, lens: &Lens) -> Vec3 {
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
        (_, None) => (right + up).reject_from(at - lens.eye).normalize_or(right),
    };
    if end == End::First { way } else { -way }
}

fn sizes(target: &Target, light: &Light, entry: &LightEntry, middle: Pos2, lens: &Lens) -> Vec<Placed> {
    let mut all = Vec::new();
    for (i, size) in entry.declaration.sizes.iter().enumerate() {
        let ends: &[End] = if size.needs_direction() { &[End::First, End::Second] } else { &[End::First] };
        for end in ends {
            let handle = SORT.handle(2 * i + usize::from(*end == End::Second));
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
    let view = lens.rect.shrink(INSET);
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
    Some(Placed { lines: stem.into_iter().collect(), ..Placed::new(handle, end, DISC + 2.0, point) })
}
