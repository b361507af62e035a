use glam::Vec3;

use super::{Declaration, Incident, LightRecord, LightType};
use crate::{parameters, shader::wgsl};

parameters! {
    /// **Ambient light**: the same from every direction, `I(p) = I` in lux. Models answer with their `ambient_response`.
    pub struct Ambient {}
}

impl LightType for Ambient {
    const DECLARATION: Declaration = Declaration::new("ambient", "Ambient", wgsl!("light/ambient.wgsl"))
        .summary("The same light from every direction: illuminates every point equally, whatever its normal.")
        .glyph("◌")
        .lux(1.0, 10.0)
        .equation("I(p) = I");

    fn incident(&self, light: &LightRecord, _p: Vec3) -> Incident {
        Incident::Uniform { intensity: Vec3::splat(light.intensity) }
    }
}
