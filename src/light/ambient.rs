use bevy::ecs::component::Component;
use glam::Vec3;

use super::{Declaration, Incident, LightRecord, LightType};
use crate::shader::wgsl;

/// **Ambient light**: the same from every direction, `I(p) = I` in lux. Models answer with their `ambient_response`.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct Ambient;

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
        parameters: &[],
        cone_parameter: None,
        equation: "I(p) = I",
        wgsl: wgsl!("light/ambient.wgsl"),
    };

    fn incident(light: &LightRecord, _p: Vec3) -> Incident {
        Incident::Uniform { intensity: light.intensity }
    }
}
