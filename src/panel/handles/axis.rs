//! The arrows along the axes of the room, which move the selection.

use bevy_egui::egui::Pos2;
use glam::Vec3;

use super::{
    Sort,
    grasp::{Dragged, snapped},
    paint, plane,
    shape::{ARM, Around, Body, GAP, HalfAxes, LETTER, LETTER_RADIUS, LETTERS, Placed, STUB},
};
use crate::{
    panel::{
        marks::Lens,
        state::{HandleMode, Session},
    },
    scene::Object,
};

/// Minimum projected length of an arrow, in points: an axis seen end on cannot be dragged along.
const SHORTEST: f32 = 30.0;
/// Maximum number of other objects that arrows at an edge of the view keep clear of, and the radius in points from which
/// they are floors and rooms.
const MOST_OTHERS: usize = 256;
const WIDEST: f32 = 600.0;
/// Larger than every distance in a view, in points.
const FIRST: f32 = 1e5;
/// Maximum length of an arrow, relative to [`ARM`].
const LONGEST: f32 = 1.2;

pub(super) static SORT: Sort = Sort {
    id: "axis",
    name: |_, axis, part| format!("move {part} along {}", LETTERS[axis]),
    placed: |around| {
        let Around { target, session, lens, middle, part, extent, .. } = around;
        let clear = extent.filter(|extent| extent.leaves_room(*part, lens));
        match (&target.body, around.mode) {
            (Body::Object(..), HandleMode::Move) => {
                let around = clear.map(|_| arrows(target.at, [*middle; 2], part * ARM, clear, lens));
                // Where the view ends beside the object, an arrow would lie on it.
                let is_clear = |all: &Vec<Placed>| {
                    let mut arrows = all.iter().filter(|placed| !placed.lines.is_empty());
                    arrows.all(|arrow| gap(arrow, *middle, *extent) > -1.0)
                };
                around.filter(is_clear).unwrap_or_else(|| {
                    let others = others(session, target.at, lens);
                    arrows_at_edge(target.at, *middle, STUB * part * ARM, (*extent, &others[..]), lens)
                })
            }
            (Body::Light(light, _), HandleMode::Move) if light.position.is_some() => {
                arrows(target.at, [*middle; 2], part * ARM, None, lens)
            }
            (Body::Group(_), HandleMode::Move) => arrows(target.at, [*middle; 2], part * ARM, None, lens),
            _ => Vec::new(),
        }
    },
    value: plane::SORT.value,
    drag: |grasp, pull| {
        let axis = grasp.handle.which;
        let by = grasp.moved_along(pull.lens, pull.pointer, grasp.at, Vec3::AXES[axis])?;
        let to = snapped(grasp.at[axis] + by, pull.step);
        let mut place = grasp.at;
        place[axis] = pull.room.nearest(Vec3::splat(to))[axis];
        Some(Dragged::Position(place))
    },
    words: |grasp, dragged, metres| match dragged {
        Dragged::Position(p) => {
            let axis = grasp.handle.which;
            format!("{} {} m", LETTERS[axis], metres(p[axis]))
        }
        other => super::grasp::words(grasp, other, metres),
    },
    has_axis: true,
    end: paint::arrow,
    guide: |ui, lens, axis, at, _, room| paint::guide(ui, lens, at, axis, room),
    ..Sort::PLAIN
};

/// Distance of a handle from an object with that extent around `middle`, in points; negative if the handle covers it.
fn gap(handle: &Placed, middle: Pos2, extent: Option<HalfAxes>) -> f32 {
    let of = |p: Pos2| extent.map_or(0.0, |extent| p.distance(middle) - extent.towards(p - middle));
    handle.points().map(of).fold(f32::INFINITY, f32::min)
}

/// Discs in the view over the visible objects, except the one at a position.
fn others(session: &Session, at: Vec3, lens: &Lens) -> Vec<(Pos2, f32)> {
    let right = session.facts.camera * Vec3::X;
    let disc = |object: &Object| {
        let middle = lens.project(object.position)?;
        let side = lens.project(object.position + 0.5 * object.size * right)?;
        Some((middle, side.distance(middle)))
    };
    let objects = session.document.shown().filter(|object| object.position != at);
    objects.take(MOST_OTHERS).filter_map(disc).filter(|(_, radius)| *radius < WIDEST).collect()
}

/// Arrows for an object that leaves no room around it, at an edge of the view where they cover it and the discs over
/// others least. They are dragged like any others: only the motion of the pointer counts.
fn arrows_at_edge(
    at: Vec3,
    middle: Pos2,
    arm: f32,
    (extent, others): (Option<HalfAxes>, &[(Pos2, f32)]),
    lens: &Lens,
) -> Vec<Placed> {
    let inset = (LONGEST * arm + LETTER + LETTER_RADIUS).min(0.5 * lens.rect.size().min_elem());
    let inside = lens.rect.shrink(inset);
    // Bottom corners first: badges and captions tend to be at the top.
    let places = [
        inside.left_bottom(),
        inside.right_bottom(),
        inside.right_top(),
        inside.left_top(),
        inside.center_bottom(),
        inside.center_top(),
        inside.left_center(),
        inside.right_center(),
    ];
    let mut best: Option<(f32, Vec<Placed>)> = None;
    for origin in places {
        let all = arrows(at, [origin, middle], arm, None, lens);
        let beside = |p: Pos2| others.iter().map(move |(other, radius)| p.distance(*other) - radius);
        let beside = all.iter().flat_map(Placed::points).flat_map(beside).fold(f32::INFINITY, f32::min);
        let own = all.iter().map(|handle| gap(handle, middle, extent)).fold(f32::INFINITY, f32::min);
        // Others count where the object itself is not covered.
        let free = if own < 0.0 { own - FIRST } else { own.min(beside) };
        if free >= 0.0 {
            return all;
        }
        if best.as_ref().is_none_or(|(most, _)| free > *most) {
            best = Some((free, all));
        }
    }
    best.map(|(_, all)| all).unwrap_or_default()
}

/// Arrows along the world axes, and the disc that moves in the picture plane, around `origin`; `middle` is the centre
/// of the moved part.
fn arrows(
    at: Vec3,
    [origin, middle]: [Pos2; 2],
    arm: f32,
    clear: Option<HalfAxes>,
    lens: &Lens,
) -> Vec<Placed> {
    let length = lens.metres(at, arm);
    let mut all = Vec::new();
    for (axis, way) in Vec3::AXES.into_iter().enumerate() {
        let point = at + length * way;
        let Some(tip) = lens.project(point) else { continue };
        let along = tip - middle;
        if along.length() < SHORTEST.min(0.5 * arm) {
            continue;
        }
        let way = along.normalized();
        let arrow = |clear: Option<f32>| {
            let from = GAP.min(0.3 * arm).max(clear.unwrap_or_default());
            // An arrow that points at the camera would grow without bound.
            let to = along.length().min(LONGEST * arm).max(clear.map_or(0.0, |clear| clear + STUB * arm));
            (vec![origin + from * way, origin + to * way], origin + (to + LETTER) * way)
        };
        // A letter outside the view could not be grabbed.
        let inside = lens.rect.shrink(LETTER);
        let beyond =
            Some(arrow(clear.map(|clear| clear.towards(way)))).filter(|(_, end)| inside.contains(*end));
        let (line, end) = beyond.unwrap_or_else(|| arrow(None));
        let placed = Placed::new(SORT.handle(axis), end, LETTER_RADIUS, point);
        all.push(Placed { lines: vec![line], ..placed });
    }
    all.push(plane::disc(at, origin, arm, clear, &all));
    all
}
