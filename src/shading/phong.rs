use glam::Vec3;

use super::{Declaration, Lighting, ShadingModel, Stage, Varying};
use crate::{parameters, shader::wgsl};

parameters! {
    /// **Phong shading**: normals interpolated and renormalised, colour calculated per pixel (CA DD10, normals for
    /// Phong shading).
    ///
    /// Source: B. T. Phong (1975), *Illumination for Computer Generated Pictures*. Not to be confused
    /// with the Phong reflection model of the same paper.
    pub struct PhongShading {}
}

impl ShadingModel for PhongShading {
    const DECLARATION: Declaration = Declaration::new("phong", "Phong", Stage::Pixel, 'P', wgsl!("shading/phong.wgsl"))
        .published("B. T. Phong 1975", "B. T. Phong (1975), Illumination for Computer Generated Pictures, Communications of the ACM 18(6), 311–317")
        .summary("Normals interpolated between the vertices and renormalised; colour calculated at every pixel.");

    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, _face_normal: Vec3) -> Vec3 {
        lighting.colour(varying.position, varying.normal.normalize_or_zero(), varying.tangent)
    }
}
