use bevy::ecs::component::Component;
use glam::Vec3;

use super::{Declaration, Incident, LightRecord, LightType};
use crate::shader::wgsl;

/// **Directional light**: infinitely far away, `I(p) = I`, the illuminance in lux on a surface that
/// faces it.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct Directional;

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
        parameters: &[],
        cone_parameter: None,
        equation: "I(p) = I",
        wgsl: wgsl!("light/directional.wgsl"),
    };

    fn incident(light: &LightRecord, _p: Vec3) -> Incident {
        Incident::From { l: -light.direction, intensity: light.intensity }
    }
}
