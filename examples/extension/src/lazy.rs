//! A shading model: Phong shading that brings interpolated normals back to length 1 in part only.

use lights_camera_models::{bevy::prelude::*, prelude::*, shading::*};

const WGSL: Source = Source::new("lazy.wgsl", include_str!("lazy.wgsl"));
const SHARE: Parameter = Parameter::number("share", 0.0..=1.0, 0.0).symbol("s").help("1 is Phong shading.");

parameters! {
    pub struct Lazy {
        share: number = SHARE,
    }
}

impl ShadingModel for Lazy {
    const DECLARATION: Declaration = Declaration::new("lazy", "Lazy", Stage::Pixel, 'L', WGSL)
        .summary("Normals interpolated and renormalised in part: polygons darken in their middle.");

    fn vertex(&self, _lighting: &dyn Lighting, corner: &Corner) -> Varying {
        let Corner { position, normal, tangent, .. } = *corner;
        Varying { position, normal, tangent, ..Varying::default() }
    }

    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, _face_normal: Vec3) -> Vec3 {
        let normal = varying.normal.lerp(varying.normal.normalize_or_zero(), self.share);
        lighting.colour(varying.position, normal, varying.tangent)
    }
}
