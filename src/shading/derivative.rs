use glam::Vec3;

use super::{Declaration, Lighting, ShadingModel, Stage, Varying};
use crate::{parameters, shader::wgsl};

parameters! {
    /// **Derivative shading**: the normal of the triangle from screen-space derivatives of the position,
    /// colour calculated per pixel (LC3).
    ///
    /// On the GPU the normal is `normalize(dpdy(P) × dpdx(P))`; within a plane triangle that is the exact triangle normal,
    /// which the CPU renderer uses. Needs no normals in the mesh; tangents are interpolated. Looks faceted like flat
    /// shading, but the light varies within each facet.
    pub struct Derivative {}
}

impl ShadingModel for Derivative {
    const DECLARATION: Declaration = Declaration {
        id: "derivative",
        name: "Derivative",
        author: "screen-space derivatives",
        source: "CA LC3: normals from partial derivatives; dFdx and dFdy, OpenGL Shading Language 1.10 (2004)",
        summary: "Facet normals from the derivatives of position on the screen; colour calculated at every pixel.",
        stage: Stage::Pixel,
        faceted: true,
        key: 'D',
        wgsl: wgsl!("shading/derivative.wgsl"),
    };

    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, face_normal: Vec3) -> Vec3 {
        lighting.colour(varying.position, face_normal, varying.tangent)
    }
}
