use glam::Vec3;

use super::{Corner, Declaration, Lighting, ShadingModel, Stage, Varying};
use crate::{parameters, shader::wgsl};

parameters! {
    /// **Gouraud shading**: colour calculated at the vertices, interpolated between them (CA DD9, normals for Gouraud
    /// shading).
    ///
    /// Source: H. Gouraud (1971), *Continuous Shading of Curved Surfaces*. Smooth and cheap; misses highlights that fall
    /// between the vertices.
    pub struct Gouraud {}
}

impl ShadingModel for Gouraud {
    const DECLARATION: Declaration = Declaration::new("gouraud", "Gouraud", Stage::Vertex, 'G', wgsl!("shading/gouraud.wgsl"))
        .published("H. Gouraud 1971", "H. Gouraud (1971), Continuous Shading of Curved Surfaces, IEEE Transactions on Computers C-20(6)")
        .summary("Colour calculated at the vertices, interpolated between them. Misses highlights that fall between vertices.");

    fn vertex(&self, lighting: &dyn Lighting, corner: &Corner) -> Varying {
        corner.varying(lighting.colour(corner.position, corner.normal, corner.tangent))
    }

    fn pixel(&self, _lighting: &dyn Lighting, varying: &Varying, _face_normal: Vec3) -> Vec3 {
        varying.colour
    }
}
