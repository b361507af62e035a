//! The handle at the edge of a light's cone, which opens it.

use super::{
    Sort,
    direction::Aim,
    grasp::{DEGREES, snapped},
    shape::Placed,
};
use crate::light::LightEntry;

pub(super) static SORT: Sort = Sort {
    id: "cone",
    name: |_, _, part| format!("cone of {part}"),
    placed: |around| {
        let Some(Aim { direction, reach, cone: Some(angle) }) = Aim::of(around) else { return Vec::new() };
        let (at, lens) = (around.target.at, around.lens);
        let (sin, cos) = angle.to_radians().sin_cos();
        let edge = direction * cos + lens.across(at, direction) * sin;
        Placed::disc(SORT.handle(0), at + reach * edge, lens).into_iter().collect()
    },
    parameter: |entry, _| LightEntry::cone_parameter(entry),
    drag: |grasp, pull| {
        let angle = grasp.opened(pull.lens, pull.pointer)?.to_degrees();
        grasp.nearest(snapped(angle, if pull.snap { DEGREES } else { 0.5 }))
    },
    ..Sort::OF_PARAMETER
};
