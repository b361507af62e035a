//! The handle that makes an object larger and smaller.

use bevy_egui::egui::{Pos2, vec2};
use glam::Vec3;

use super::{
    Sort,
    grasp::{Dragged, snapped},
    paint,
    shape::{Around, Body, DISC, GAP, HalfAxes, Placed},
};
use crate::panel::{
    marks::{Lens, Ray},
    state::HandleMode,
};

/// Distance of the size handle from the centre, as a multiple of the largest half extent.
const OUTWARD: f32 = 1.2;
/// Minimum distance of the size handle from the centre, in points.
const NEAREST: f32 = 44.0;

pub(super) static SORT: Sort = Sort {
    id: "size",
    name: |_, _, part| format!("size of {part}"),
    placed: |around| {
        let Around { target, lens, middle, extent, .. } = around;
        let (Body::Object(object, half), HandleMode::Size) = (&target.body, around.mode) else {
            return Vec::new();
        };
        let radius = OUTWARD * object.size * half.max_element();
        size(target.at, *middle, radius, *extent, lens).into_iter().collect()
    },
    value: |target, _| Some(Dragged::Size(target.object()?.size)),
    drag: |grasp, pull| {
        let [right, up, _] = pull.lens.axes();
        // Distances from the centre, so that the grabbed point does not matter.
        let radius = |ray: Ray| {
            let arm = pull.flat(ray)? - grasp.at;
            Some(arm.dot(right).hypot(arm.dot(up)))
        };
        let part = radius(pull.now)? / radius(pull.start)?.max(1e-6);
        Some(Dragged::Size(snapped(grasp.size * part, pull.step).max(pull.step.max(0.01))))
    },
    end: paint::square,
    ..Sort::PLAIN
};

/// The size handle, to the upper right of the centre.
fn size(at: Vec3, middle: Pos2, radius: f32, clear: Option<HalfAxes>, lens: &Lens) -> Option<Placed> {
    let way = vec2(1.0, -1.0).normalized();
    let clear = clear.map_or(GAP, |clear| clear.towards(way));
    let edge =
        [lens.rect.right() - middle.x, middle.y - lens.rect.top()].map(|room| (room - 20.0) / way.x.abs());
    let most = edge[0].min(edge[1]).max(GAP + DISC);
    let points = (radius / lens.metres(at, 1.0)).max(NEAREST).min(most);
    let end = middle + points * way;
    let lines = vec![vec![middle + clear.min(points) * way, end]];
    Some(Placed { lines, ..Placed::new(SORT.handle(0), end, DISC + 2.0, at) })
}
