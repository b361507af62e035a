use glam::Vec3;

use super::{Corner, Declaration, Lighting, ShadingModel, Stage, Varying};
use crate::{parameters, shader::wgsl};

parameters! {
    /// **Flat shading**: one colour per polygon, calculated at its centre with its face normal (CA DD8, normals for flat shading).
    ///
    /// Source: J. Bouknight (1970), *A Procedure for Generation of Three-dimensional Half-toned Computer
    /// Graphics Presentations*. Shows the polygons themselves, and Mach bands between them.
    pub struct Flat {}
}

impl ShadingModel for Flat {
    const DECLARATION: Declaration = Declaration::new("flat", "Flat", Stage::Polygon, 'F', wgsl!("shading/flat.wgsl"))
        .published("J. Bouknight 1970", "J. Bouknight (1970), A Procedure for Generation of Three-dimensional Half-toned Computer Graphics Presentations, Communications of the ACM 13(9)")
        .summary("One colour per polygon, calculated at its centre with its own normal.");

    fn vertex(&self, lighting: &dyn Lighting, corner: &Corner) -> Varying {
        Varying {
            position: corner.position,
            normal: corner.face_normal,
            tangent: corner.face_tangent,
            colour: lighting.colour(corner.face_centre, corner.face_normal, corner.face_tangent),
        }
    }

    fn pixel(&self, _lighting: &dyn Lighting, varying: &Varying, _face_normal: Vec3) -> Vec3 {
        varying.colour
    }
}
