//! Pictures whose light does not come from the light loop: the same points on the same objects, with another
//! calculation.

use std::sync::Arc;

use glam::Vec3;

use super::object::Draw;
use crate::shading::{Corner, Lighting, PhongShading, Shading, Stage, Varying};

/// The light that leaves a point towards the observer, from its position, unit normal and tangent as in
/// [`Lighting::colour`].
pub(crate) type Leaving = dyn Fn(Vec3, Vec3, Vec3) -> Vec3 + Send + Sync;

/// Phong shading that uses this light.
#[derive(Clone)]
pub(super) struct Instead(pub(super) Arc<Leaving>);

impl Instead {
    /// The object with this light.
    pub(super) fn on<'a>(&self, draw: Draw<'a>) -> Draw<'a> {
        Draw { stage: Stage::Pixel, shading: Box::new(self.clone()), ..draw }
    }
}

impl Lighting for Instead {
    fn colour(&self, position: Vec3, normal: Vec3, tangent: Vec3) -> Vec3 {
        (self.0)(position, normal, tangent)
    }
}

impl Shading for Instead {
    fn vertex(&self, _: &dyn Lighting, corner: &Corner) -> Varying {
        Shading::vertex(&PhongShading::default(), self, corner)
    }

    fn pixel(&self, _: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3 {
        Shading::pixel(&PhongShading::default(), self, varying, face_normal)
    }
}
