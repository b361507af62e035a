//! The handle at the tip of the arrow of a light, which turns its direction.

use glam::Vec3;

use super::{
    Sort,
    grasp::{DEGREES, Dragged, angles, snapped},
    shape::{Around, Body, DISC, Placed},
};
use crate::panel::{marks, state::HandleMode};

pub(super) static SORT: Sort = Sort {
    id: "direction",
    name: |_, _, part| format!("direction of {part}"),
    placed: |around| {
        let Some(Aim { direction, reach, cone }) = Aim::of(around) else { return Vec::new() };
        let (at, lens) = (around.target.at, around.lens);
        let length = if cone.is_some() { marks::AXIS * reach } else { reach };
        let tip = at + direction * (length + lens.metres(at, DISC + 4.0));
        Placed::disc(SORT.handle(0), tip, lens).into_iter().collect()
    },
    value: |target, _| target.light()?.direction.map(Dragged::Direction),
    drag: |grasp, pull| {
        let p = grasp.pulled(pull.lens, pull.pointer)?;
        if !pull.snap {
            return Some(Dragged::Direction((p * 1000.0).round() / 1000.0 + Vec3::ZERO));
        }
        let [azimuth, elevation] = angles(p).map(|v| snapped(v, DEGREES).to_radians());
        let level = elevation.cos();
        let p = Vec3::new(level * azimuth.sin(), elevation.sin(), level * azimuth.cos());
        Some(Dragged::Direction((p * 10_000.0).round() / 10_000.0 + Vec3::ZERO))
    },
    is_on_sphere: true,
    ..Sort::PLAIN
};

/// The direction of a light, the length of its mark, metres, and the half angle of its cone, degrees.
pub(super) struct Aim {
    pub(super) direction: Vec3,
    pub(super) reach: f32,
    pub(super) cone: Option<f32>,
}

impl Aim {
    pub(super) fn of(around: &Around) -> Option<Self> {
        let Body::Light(light, entry) = around.target.body else { return None };
        // Sizes may end where the handle is.
        if around.mode == HandleMode::Size && !entry.declaration.sizes.is_empty() {
            return None;
        }
        let direction = light.direction.and_then(Vec3::try_normalize)?;
        let reach = marks::reach(around.lens, around.target.at, &around.session.document);
        Some(Self { direction, reach, cone: entry.cone_angle(&light.parameters) })
    }
}
