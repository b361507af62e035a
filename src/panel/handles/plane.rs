//! The disc that moves the selection in the plane of the picture.

use bevy_egui::egui::{Pos2, Vec2, vec2};
use glam::Vec3;

use super::{
    Sort,
    grasp::{Dragged, snapped},
    paint,
    shape::{ARM, Body, DISC, GAP, HalfAxes, Placed},
};

/// Distance from the centre of the disc that moves in the picture plane, in points.
const ASIDE: f32 = 34.0;

pub(super) static SORT: Sort = Sort {
    id: "plane",
    name: |_, _, part| format!("move {part} in the plane of the picture"),
    value: |target, _| match &target.body {
        Body::Object(object, _) => Some(Dragged::Position(object.position)),
        Body::Light(light, _) => light.position.map(Dragged::Position),
        Body::Group(_) => Some(Dragged::Position(target.at)),
    },
    drag: |grasp, pull| {
        let to = grasp.at + pull.flat(pull.now)? - pull.flat(pull.start)?;
        let to = to.map(|v| snapped(v, pull.step));
        Some(Dragged::Position(pull.room.nearest(to)))
    },
    end: paint::eye,
    ..Sort::PLAIN
};

/// The disc among the arrows of the axes, which place it.
pub(super) fn disc(at: Vec3, origin: Pos2, arm: f32, clear: Option<HalfAxes>, arrows: &[Placed]) -> Placed {
    // In the widest gap between the arrows, preferably at the upper right.
    let ways: Vec<Vec2> = arrows.iter().map(|p| (p.end - origin).normalized()).collect();
    let corners = [vec2(1.0, -1.0), vec2(-1.0, -1.0), vec2(1.0, 1.0), vec2(-1.0, 1.0)].map(Vec2::normalized);
    let nearest = |corner: &Vec2| ways.iter().map(|way| way.dot(*corner)).fold(-1.0, f32::max);
    let free = corners.iter().find(|corner| nearest(corner) < 0.87);
    let corner = free.copied().unwrap_or(corners[0]);
    let aside = (ASIDE * arm / ARM).max(DISC + clear.map_or(GAP, |clear| clear.towards(corner)));
    Placed::new(SORT.handle(0), origin + corner * aside, DISC, at)
}
