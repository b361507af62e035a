//! The extent of the room.

use glam::Vec3;

use super::{Field, part::part};
use crate::parameter::ABOVE_ZERO;

/// The largest legal extent of a scene in any direction, metres (CA `MAX_HEIGHT`, `MAX_WIDTH`, `MAX_DEPTH`).
pub const MAX_DIMENSION: f32 = 100.0;

/// One extent of the room (CA `DEF_HEIGHT`, `DEF_WIDTH`, `DEF_DEPTH`).
const fn extent(subject: &'static str) -> Field {
    Field::number(subject, ABOVE_ZERO..=MAX_DIMENSION).unit("m").asked()
}

part! {
    /// Extent of the room in metres.
    #[derive(Copy)]
    pub struct SceneSize("scene_size") {
        /// Limit of y, metres.
        height: f32 = extent("the height of the room"), 10.0;
        /// Limit of x, metres.
        width: f32 = extent("the width of the room"), 10.0;
        /// Limit of z, metres.
        depth: f32 = extent("the depth of the room"), 10.0;
    }
}

impl SceneSize {
    /// The corner opposite the origin.
    #[must_use]
    pub fn corner(self) -> Vec3 {
        Vec3::new(self.width, self.height, self.depth)
    }

    /// True if a point is in the room: 0 < coordinate ≤ size in each direction.
    #[must_use]
    pub fn contains(self, p: Vec3) -> bool {
        p.cmpgt(Vec3::ZERO).all() && p.cmple(self.corner()).all()
    }

    /// The point of the room nearest to this one, at least a centimetre from the walls at 0, which are not
    /// part of the room.
    #[must_use]
    pub fn nearest(self, p: Vec3) -> Vec3 {
        let corner = self.corner();
        p.max(corner.min(Vec3::splat(0.01))).min(corner)
    }
}
