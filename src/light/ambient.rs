use glam::Vec3;

use super::{Declaration, Incident, LightRecord, LightType};
use crate::{parameters, shader::wgsl};

parameters! {
    /// **Ambient light**: the same from every direction, `I(p) = I` in lux. Models answer with their `ambient_response`.
    pub struct Ambient {}
}

impl LightType for Ambient {
    const DECLARATION: Declaration = Declaration {
        id: "ambient",
        name: "Ambient",
        summary: "The same light from every direction: illuminates every point equally, whatever its normal.",
        glyph: "◌",
        has_position: false,
        has_direction: false,
        unit: "lx",
        default_intensity: 1.0,
        slider_max: 10.0,
        cone_parameter: None,
        sizes: &[],
        roll_parameter: None,
        equation: "I(p) = I",
        extent: false,
        wgsl: wgsl!("light/ambient.wgsl"),
    };

    fn incident(&self, light: &LightRecord, _p: Vec3) -> Incident {
        Incident::Uniform { intensity: Vec3::splat(light.intensity) }
    }
}
