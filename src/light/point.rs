use glam::Vec3;

use super::{Declaration, Factor, Incident, LightRecord, LightType};
use crate::{
    optics::radiometry::{SPHERE, inverse_square},
    parameters,
    shader::wgsl,
};

parameters! {
    /// **Point light**: shines equally in every direction; `I(p) = I / |p − p₀|²` (CA DD7, intensity at a point), I in
    /// candela. Its luminous flux
    /// is `Φ = 4π I` lumen.
    pub struct Point {}
}

impl LightType for Point {
    const DECLARATION: Declaration = Declaration {
        id: "point",
        name: "Point",
        summary: "Shines equally in every direction from one point; falls off with the square of the distance.",
        glyph: "☀",
        has_position: true,
        has_direction: false,
        unit: "cd",
        default_intensity: 20.0,
        slider_max: 200.0,
        cone_parameter: None,
        sizes: &[],
        roll_parameter: None,
        equation: "I(p) = I / d^2",
        extent: false,
        wgsl: wgsl!("light/point.wgsl"),
    };

    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        let to_light = light.position - p;
        Incident::From {
            l: to_light.normalize_or_zero(),
            intensity: Vec3::splat(light.intensity * inverse_square(to_light)),
        }
    }

    fn factors(&self, light: &LightRecord, p: Vec3) -> Vec<Factor> {
        let to_light = light.position - p;
        vec![
            Factor::intensity(light, Self::DECLARATION.unit),
            Factor::inverse_square(inverse_square(to_light), to_light.length()),
        ]
    }

    fn solid_angle(&self) -> Option<f64> {
        Some(SPHERE)
    }
}
