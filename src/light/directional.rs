use glam::Vec3;

use super::{Declaration, Incident, LightRecord, LightType};
use crate::{parameters, shader::wgsl};

parameters! {
    /// **Directional light**: infinitely far away, `I(p) = I`, the illuminance in lux on a surface that
    /// faces it.
    pub struct Directional {}
}

impl LightType for Directional {
    const DECLARATION: Declaration =
        Declaration::new("directional", "Directional", wgsl!("light/directional.wgsl"))
            .summary(
                "Light from infinitely far away, as from the sun: one direction and one strength everywhere.",
            )
            .glyph("↓")
            .with_direction()
            .lux(1.0, 10.0)
            .equation("I(p) = I");

    fn incident(&self, light: &LightRecord, _p: Vec3) -> Incident {
        Incident::From { l: -light.direction, intensity: Vec3::splat(light.intensity) }
    }
}
