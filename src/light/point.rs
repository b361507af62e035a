use glam::Vec3;

use super::{Declaration, Factor, Incident, LightRecord, LightType};
use crate::{
    optics::radiometry::{SPHERE, inverse_square},
    parameters,
    shader::wgsl,
};

parameters! {
    /// **Point light**: shines equally in every direction; `I(p) = I / |p − p₀|²` (CA DD7, intensity at a point), I in
    /// candela. The luminous flux is `Φ = 4π I` lumen.
    pub struct Point {}
}

impl LightType for Point {
    const DECLARATION: Declaration = Declaration::new("point", "Point", wgsl!("light/point.wgsl"))
        .summary(
            "Shines equally in every direction from one point; falls off with the square of the distance.",
        )
        .glyph("☀")
        .at_position()
        .candela(20.0, 200.0)
        .equation("I(p) = I / d^2");

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
