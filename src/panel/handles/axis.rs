//! The arrows along the axes of the room, which move the selection.

use std::f32::consts::TAU;

use bevy_egui::egui::{Pos2, Vec2};
use glam::Vec3;

use super::{
    Handle, Sort,
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

/// Cosine of the angle in the picture below which two arrows are taken for each other.
const ALIKE: f32 = 0.94;
/// Minimum projected length of an arrow, in points: an axis seen end on cannot be dragged along.
const SHORTEST: f32 = 30.0;
/// Number of directions from an object, and of distances from it, in which arrows beside it are tried.
const WAYS: u8 = 16;
const STEPS: u8 = 8;
/// Lengths of arrows beside an object that are tried, relative to the usual one there.
const SHORTER: [f32; 3] = [1.0, 0.8, 0.64];
/// Maximum number of other objects that arrows beside an object keep clear of, and the radius in points from which
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
        let Around { target, session, lens, middle, part, extent, held, .. } = around;
        let clear = extent.filter(|extent| extent.leaves_room(*part, lens));
        match (&target.body, around.mode) {
            (Body::Object(..), HandleMode::Move) => {
                let around =
                    clear.map(|_| arrows(target.at, [*middle; 2], part * ARM, clear, (*lens, *held)));
                // Where the view ends beside the object, an arrow would lie on it.
                let is_clear = |all: &Vec<Placed>| {
                    let mut arrows = all.iter().filter(|placed| !placed.lines.is_empty());
                    arrows.all(|arrow| gap(arrow, *middle, *extent) > -1.0)
                };
                around.filter(is_clear).unwrap_or_else(|| {
                    let others = others(session, target.at, lens);
                    arrows_beside(
                        target.at,
                        *middle,
                        STUB * part * ARM,
                        (*extent, &others[..]),
                        (*lens, *held),
                    )
                })
            }
            (Body::Light(light, _), HandleMode::Move) if light.position.is_some() => {
                arrows(target.at, [*middle; 2], part * ARM, None, (*lens, *held))
            }
            (Body::Group(_), HandleMode::Move) => {
                arrows(target.at, [*middle; 2], part * ARM, None, (*lens, *held))
            }
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

/// Places for the middle of arrows beside an object, the nearest first. Those below come before others at the same
/// distance: badges and captions tend to be at the top.
fn origins(middle: Pos2, arm: f32, extent: HalfAxes, lens: &Lens) -> impl Iterator<Item = Pos2> {
    let step = (LONGEST * arm + LETTER + LETTER_RADIUS) / f32::from(STEPS);
    let way = |k: u8| {
        // Downwards, then to either side in turn.
        let turned = f32::from(k.div_ceil(2)) * if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        Vec2::angled(0.25 * TAU + turned / f32::from(WAYS) * TAU)
    };
    let all = (0..=STEPS).flat_map(move |n| (0..WAYS).map(move |k| (n, way(k))));
    let all = all.map(move |(n, way)| middle + way * (extent.towards(way) + f32::from(n) * step));
    let rect = lens.rect;
    all.filter(move |at| rect.contains(*at))
}

/// Places for the middle of arrows at the edges of the view, the bottom corners first.
fn edges(arm: f32, lens: &Lens) -> [Pos2; 8] {
    let inset = (LONGEST * arm + LETTER + LETTER_RADIUS).min(0.5 * lens.rect.size().min_elem());
    let inside = lens.rect.shrink(inset);
    [
        inside.left_bottom(),
        inside.right_bottom(),
        inside.right_top(),
        inside.left_top(),
        inside.center_bottom(),
        inside.center_top(),
        inside.left_center(),
        inside.right_center(),
    ]
}

/// Arrows for an object that leaves no room around it: in the view, as near to the object as they cover neither it nor
/// the discs over others, and shorter where that takes less room; at an edge of the view for an object that fills it.
/// Where they cover something everywhere, they are where they cover least. They are dragged like any others: only the
/// motion of the pointer counts.
fn arrows_beside(
    at: Vec3,
    middle: Pos2,
    arm: f32,
    (extent, others): (Option<HalfAxes>, &[(Pos2, f32)]),
    (lens, held): (&Lens, Option<Handle>),
) -> Vec<Placed> {
    let inside = lens.rect.shrink(LETTER_RADIUS);
    let mut best: Option<(f32, Vec<Placed>)> = None;
    let lengths = SHORTER.map(|part| part * arm);
    let near = lengths.into_iter().flat_map(|arm| {
        let origins = extent.into_iter().flat_map(move |extent| origins(middle, arm, extent, lens));
        origins.map(move |origin| (true, arm, origin))
    });
    let edges = edges(arm, lens).map(|origin| (false, arm, origin));
    for (is_near, arm, origin) in near.chain(edges) {
        // Near the object is better than far away from everything.
        if !is_near && best.as_ref().is_some_and(|(most, _)| *most > -FIRST) {
            break;
        }
        let all = arrows(at, [origin, middle], arm, None, (lens, held));
        let is_inside = all.iter().flat_map(Placed::points).all(|p| inside.contains(p));
        let own = all.iter().map(|handle| gap(handle, middle, extent)).fold(f32::INFINITY, f32::min);
        let beside = |p: Pos2| others.iter().map(move |(other, radius)| p.distance(*other) - radius);
        // Others count where the object itself is not covered.
        let free = match own < 0.0 || !is_inside {
            true => own.min(0.0) - if is_inside { FIRST } else { 2.0 * FIRST },
            false => all.iter().flat_map(Placed::points).flat_map(beside).fold(0.0, f32::min),
        };
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
    (lens, held): (&Lens, Option<Handle>),
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
    let mut all = told_apart(&all, origin, (at - lens.eye).normalize_or_zero(), held);
    all.push(plane::disc(at, origin, arm, clear, &all));
    all
}

/// The arrows that are not taken for another: of two that point the same way in the picture, the one gives way whose axis
/// is seen more nearly end on along the line of sight. The one that is held stays.
fn told_apart(all: &[Placed], origin: Pos2, sight: Vec3, held: Option<Handle>) -> Vec<Placed> {
    let along = |arrow: &Placed| sight[arrow.handle.which].abs();
    let way = |arrow: &Placed| (arrow.end - origin).normalized();
    let is_held = |arrow: &Placed| held == Some(arrow.handle);
    let goes_first = |one: &Placed, other: &Placed| is_held(one) || along(one) < along(other);
    let gives_way = |arrow: &Placed| {
        let is_alike = |other: &&Placed| way(other).dot(way(arrow)) > ALIKE;
        !is_held(arrow) && all.iter().filter(is_alike).any(|other| goes_first(other, arrow))
    };
    all.iter().filter(|arrow| !gives_way(arrow)).cloned().collect()
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{Rect, pos2, vec2};

    use super::*;
    use crate::{
        panel::handles::shape::{Target, placed},
        registry::Registry,
        scene::Scene,
    };

    /// The handles that move a sphere at a position, in a picture of a size, with the picture, and the place and the
    /// extent of the sphere in it.
    fn handles(position: Vec3, [width, height]: [f32; 2]) -> (Vec<Placed>, Rect, Pos2, HalfAxes) {
        let object = Object { position, size: 2.1, ..Object::default() };
        let session = Session::new(Scene { objects: vec![object], ..Scene::default() });
        let registry = Registry::builtin();
        let rect = Rect::from_min_size(pos2(300.0, 40.0), vec2(width, height));
        let lens = Lens::of(&session, rect);
        let target = Target::of(&session, &registry, None, Vec::new).expect("selected");
        let all = placed(&target, HandleMode::Move, &session, (&lens, None));
        let middle = lens.project(position).expect("in view");
        let extent = HalfAxes::of(&target, middle, &lens).expect("in front of the camera");
        (all, rect, middle, extent)
    }

    #[test]
    fn an_arrow_that_is_held_stays_beside_another_that_looks_like_it() {
        let arrow =
            |axis: usize, end: Pos2| Placed::new(SORT.handle(axis), end, LETTER_RADIUS, Vec3::AXES[axis]);
        let all = [arrow(0, pos2(76.0, 0.0)), arrow(2, pos2(75.0, 8.0))];
        let left = |held: Option<Handle>| -> Vec<_> {
            let sight = Vec3::new(0.3, 0.0, 0.9);
            told_apart(&all, Pos2::ZERO, sight, held).iter().map(|arrow| arrow.handle.which).collect()
        };
        assert_eq!(left(None), [0]);
        assert_eq!(left(Some(SORT.handle(2))), [2]);
        assert_eq!(left(Some(SORT.handle(0))), [0]);
    }

    #[test]
    fn beside_the_middle_the_arrow_to_the_right_is_x() {
        for position in [[7.2, 5.0, 3.9], [7.25, 5.0, 5.0], [8.5, 5.0, 3.0]].map(Vec3::from) {
            for size in [[730.0, 655.0], [1040.0, 740.0]] {
                let all = handles(position, size).0;
                let axes: Vec<_> =
                    all.iter().filter(|p| p.handle.sort.has_axis).map(|p| p.handle.which).collect();
                assert_eq!(axes, [0, 1], "{position} in {size:?}");
            }
        }
    }

    #[test]
    fn arrows_stay_near_an_object_among_others() {
        let session = || {
            let object = |x: f32| Object { position: Vec3::new(x, 5.0, 5.0), size: 2.1, ..Object::default() };
            Session::new(Scene { objects: [2.75, 5.0, 7.25].map(object).into(), ..Scene::default() })
        };
        for size in [vec2(900.0, 500.0), vec2(360.0, 210.0)] {
            let (session, registry) = (session(), Registry::builtin());
            let rect = Rect::from_min_size(pos2(300.0, 40.0), size);
            let lens = Lens::of(&session, rect);
            let target = Target::of(&session, &registry, None, Vec::new).expect("selected");
            let middle = lens.project(target.at).expect("in view");
            let extent = HalfAxes::of(&target, middle, &lens);
            let all = placed(&target, HandleMode::Move, &session, (&lens, None));
            let nearest = all.iter().map(|handle| gap(handle, middle, extent)).fold(f32::INFINITY, f32::min);
            assert!(!all.is_empty() && nearest < 24.0, "{size:?}: {nearest} points from the object");
        }
    }

    #[test]
    fn arrows_stay_near_an_object_at_the_edge_of_the_view() {
        for position in [[2.75, 5.0, 5.0], [7.25, 5.0, 5.0], [5.0, 6.6, 5.0], [2.0, 3.6, 5.0]].map(Vec3::from)
        {
            for size in [[900.0, 620.0], [560.0, 420.0], [420.0, 260.0]] {
                let (all, rect, middle, extent) = handles(position, size);
                let here = format!("{position} in {size:?}");
                let points: Vec<_> = all.iter().flat_map(Placed::points).collect();
                let apart: Vec<_> =
                    points.iter().map(|p| p.distance(middle) - extent.towards(*p - middle)).collect();
                let nearest = apart.iter().copied().fold(f32::INFINITY, f32::min);
                assert!((-1.0..24.0).contains(&nearest), "{here}: {nearest} points from the object");
                let farthest = apart.into_iter().fold(0.0, f32::max);
                assert!(farthest < 2.5 * ARM, "{here}: {farthest} points from the object");
                assert!(points.iter().all(|p| rect.contains(*p)), "{here}: {points:?} outside {rect:?}");
            }
        }
    }
}
