use glam::Vec3;

use super::{Declaration, Incident, LightRecord, LightType};
use crate::{parameters, shader::wgsl};

parameters! {
    /// **Directional light**: infinitely far away, `I(p) = I`, the illuminance in lux on a surface that
    /// faces it.
    pub struct Directional {}
}

impl LightType for Directional {
    const DECLARATION: Declaration = Declaration {
        id: "directional",
        name: "Directional",
        summary: "Light from infinitely far away, as from the sun: one direction and one strength everywhere.",
        glyph: "↓",
        has_position: false,
        has_direction: true,
        unit: "lx",
        default_intensity: 1.0,
        slider_max: 10.0,
        cone_parameter: None,
        sizes: &[],
        roll_parameter: None,
        equation: "I(p) = I",
        extent: false,
        wgsl: wgsl!("light/directional.wgsl"),
    };

    fn incident(&self, light: &LightRecord, _p: Vec3) -> Incident {
        Incident::From { l: -light.direction, intensity: Vec3::splat(light.intensity) }
    }
}
