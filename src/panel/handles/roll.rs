//! The ring that turns a light about its direction.

use glam::Vec3;

use super::{
    Sort,
    grasp::{DEGREES, Dragged, snapped, wrapped},
    paint,
    ring::{RING, circle},
    shape::{Body, DISC, Placed, Target, part_of},
};
use crate::{
    light::LightEntry,
    panel::{marks::Lens, state::HandleMode},
    scene::Light,
};

pub(super) static SORT: Sort = Sort {
    id: "roll",
    name: |target, _, part| {
        let label = target.parameter(SORT.handle(0)).map_or("size", |p| p.label);
        format!("{label} of {part}")
    },
    placed: |around| match (&around.target.body, around.mode) {
        (Body::Light(light, entry), HandleMode::Turn) => {
            roll(around.target, light, entry, around.lens).into_iter().collect()
        }
        _ => Vec::new(),
    },
    parameter: |entry, _| LightEntry::roll_parameter(entry),
    drag: |grasp, pull| {
        let (which, before) = grasp.parameter?;
        let by = grasp.turned_about(pull.lens, pull.pointer, grasp.direction)?;
        let after = snapped(wrapped(before.to_radians() + by), if pull.snap { DEGREES } else { 1.0 });
        Dragged::parameter(which.nearest_angle(after + 0.0))
    },
    words: |grasp, dragged, metres| match dragged {
        Dragged::Parameter(value) => format!("{} {value:.0}°", grasp.label()),
        other => super::grasp::words(grasp, other, metres),
    },
    guide: |ui, lens, _, at, ends, _| paint::angle(ui, lens, at, ends),
    ..Sort::OF_PARAMETER
};

/// The ring that turns a light about its direction, with a knob at the top of the light.
fn roll(target: &Target, light: &Light, entry: &LightEntry, lens: &Lens) -> Option<Placed> {
    entry.roll_parameter()?;
    let direction = light.direction.and_then(Vec3::try_normalize)?;
    let [x, y] = entry.sides(&light.parameters, direction);
    let length = lens.metres(target.at, part_of(lens) * RING);
    let point = target.at + length * y;
    let [lines, far] = circle(target.at, [x, y], length, lens);
    Some(Placed { handle: SORT.handle(0), lines, far, end: lens.project(point)?, radius: DISC, point })
}
