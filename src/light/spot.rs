use bevy::ecs::component::Component;
use glam::Vec3;

use super::{Declaration, Incident, LightRecord, LightType, MAX_LIGHT_PARAMETERS};
use crate::{
    optics::radiometry::{cone, cone_solid_angle, inverse_square},
    parameter::{ABOVE_ZERO, Parameter, ParameterKind},
    shader::wgsl,
};

/// Half the opening of the cone.
const CONE_ANGLE: Parameter = Parameter {
    name: "cone_angle",
    symbol: "θ",
    label: "cone angle",
    unit: "°",
    help: "Half the opening of the cone: the angle between its axis and its edge.",
    kind: ParameterKind::Number { min: ABOVE_ZERO, max: 90.0, default: 30.0 },
    used_when: None,
};

/// The softness of the edge.
const PENUMBRA: Parameter = Parameter {
    name: "penumbra",
    symbol: "p",
    label: "penumbra",
    unit: "",
    help: "The fraction of the cone taken by the soft edge: 0 is a hard edge, 1 fades from the axis outwards.",
    kind: ParameterKind::Number { min: 0.0, max: 1.0, default: 0.1 },
    used_when: None,
};

/// **Spotlight**: a point light within a cone; `I(p) = I · cone(θ) / |p − p₀|²`
/// ([`cone`]), I in candela, on the axis. Its luminous flux is `Φ = I ∫ cone dω` lumen
/// ([`cone_solid_angle`]).
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct Spot;

impl LightType for Spot {
    const DECLARATION: Declaration = Declaration {
        id: "spot",
        name: "Spot",
        summary: "A point light within a cone; falls off with the square of the distance and fades at the cone's edge.",
        glyph: "▼",
        has_position: true,
        has_direction: true,
        unit: "cd",
        default_intensity: 20.0,
        slider_max: 200.0,
        parameters: &[CONE_ANGLE, PENUMBRA],
        cone_parameter: Some(0),
        equation: "I(p) = I cone(θ) / d^2",
        wgsl: wgsl!("light/spot.wgsl"),
    };

    fn incident(light: &LightRecord, p: Vec3) -> Incident {
        let to_light = light.position - p;
        let l = to_light.normalize_or_zero();
        let [cone_angle, penumbra, ..] = light.parameters;
        let profile = cone(light.direction.dot(-l), cone_angle, penumbra);
        Incident::From { l, intensity: light.intensity * profile * inverse_square(to_light) }
    }

    fn solid_angle(&[cone_angle, penumbra, ..]: &[f32; MAX_LIGHT_PARAMETERS]) -> Option<f64> {
        Some(cone_solid_angle(cone_angle, penumbra))
    }
}
