//! The rings about the axes of the room, which turn an object, or several parts about their common middle.

use std::f32::consts::TAU;

use bevy_egui::egui::{Pos2, vec2};
use glam::Vec3;

use super::{
    Sort,
    grasp::{DEGREES, Dragged, snapped, twist, wrapped},
    paint,
    shape::{Around, Body, CLEAR, HalfAxes, LETTER, LETTER_RADIUS, LETTERS, Placed},
};
use crate::{
    panel::{marks::Lens, state::HandleMode},
    scene::rotation::turned,
};

/// Radius of a ring, in points.
pub(super) const RING: f32 = 78.0;
/// Number of segments of a ring.
const SIDES: usize = 72;

pub(super) static SORT: Sort = Sort {
    id: "ring",
    name: |_, axis, part| format!("turn {part} about {}", LETTERS[axis]),
    placed: |around| {
        let Around { target, lens, middle, part, extent, .. } = around;
        let turns = matches!(target.body, Body::Object(..) | Body::Group(_));
        if !turns || around.mode != HandleMode::Turn {
            return Vec::new();
        }
        let most = 0.5 * lens.rect.size().max_elem() - LETTER;
        let around = |extent: HalfAxes| (extent.most() + CLEAR).min(most).max(part * RING);
        let radius = extent.map_or(part * RING, around);
        (0..3).map(|axis| ring(target.at, axis, radius, lens).beyond(*middle, *extent)).collect()
    },
    value: |target, _| {
        let rotation = match target.body {
            Body::Group(_) => Vec3::ZERO,
            _ => target.object()?.rotation,
        };
        Some(Dragged::Rotation(rotation, 0.0))
    },
    drag: |grasp, pull| {
        let axis = Vec3::AXES[grasp.handle.which];
        let by = grasp.turned_about(pull.lens, pull.pointer, axis)?;
        let before = twist(grasp.rotation, axis);
        let after = snapped(wrapped(before + by), if pull.snap { DEGREES } else { 1.0 });
        let degrees = turned(grasp.rotation, axis, after.to_radians() - before);
        Some(Dragged::Rotation(degrees, after + 0.0))
    },
    words: |grasp, dragged, metres| match dragged {
        Dragged::Rotation(_, angle) => format!("{} {angle:.0}°", LETTERS[grasp.handle.which]),
        other => super::grasp::words(grasp, other, metres),
    },
    has_axis: true,
    end: paint::letter,
    guide: |ui, lens, _, at, ends, _| paint::angle(ui, lens, at, ends),
    ..Sort::PLAIN
};

/// The lines of a circle spanned by two directions, on the near side and on the far side.
pub(super) fn circle(at: Vec3, [first, second]: [Vec3; 2], length: f32, lens: &Lens) -> [Vec<Vec<Pos2>>; 2] {
    let around = |k: usize| {
        let (y, x) = (k as f32 / SIDES as f32 * TAU).sin_cos();
        at + length * (x * first + y * second)
    };
    let to_eye = (lens.eye - at).normalize_or_zero();
    let is_near = |p: Vec3| (p - at).dot(to_eye) >= -0.06 * length;
    let (mut lines, mut far) = (Vec::new(), Vec::new());
    for k in 0..SIDES {
        let pair = [around(k), around(k + 1)];
        let near = is_near(0.5 * (pair[0] + pair[1]));
        let to: &mut Vec<Vec<Pos2>> = if near { &mut lines } else { &mut far };
        for run in lens.path(&pair) {
            match to.last_mut().filter(|line| line.last().is_some_and(|p| p.distance(run[0]) < 0.01)) {
                Some(line) => line.extend(&run[1..]),
                None => to.push(run),
            }
        }
    }
    [lines, far]
}

/// A ring about a world axis.
fn ring(at: Vec3, axis: usize, radius: f32, lens: &Lens) -> Placed {
    let sides = [Vec3::AXES[(axis + 1) % 3], Vec3::AXES[(axis + 2) % 3]];
    let length = lens.metres(at, radius);
    let [lines, far] = circle(at, sides, length, lens);
    // The letters are spread for legibility: at the top, at the right, and between them.
    let wanted = [vec2(0.0, -1.0), vec2(1.0, 0.0), vec2(0.7, 0.7)][axis];
    let middle = lens.project(at).unwrap_or_default();
    let inside = lens.rect.shrink(LETTER + LETTER_RADIUS);
    let best = |within: bool| {
        let points = lines.iter().flatten().copied().filter(|p| !within || inside.contains(*p));
        points.max_by(|a, b| (*a - middle).dot(wanted).total_cmp(&(*b - middle).dot(wanted)))
    };
    let best = best(true).or_else(|| best(false)).unwrap_or(middle);
    let end = best + (best - middle).normalized() * LETTER;
    let point = at + length * sides[0];
    Placed { lines, far, ..Placed::new(SORT.handle(axis), end, LETTER_RADIUS, point) }
}
