//! A light type with a colour and a number: a lamp that shines in another colour downwards.

use lights_camera_models::{bevy::prelude::*, light::Declaration, prelude::*};

const BELOW: Parameter = Parameter::colour("below", [255, 120, 40]).symbol("B").help("Its light downwards.");
const BLEND: Parameter = Parameter::number("blend", 0.5..=8.0, 1.0).symbol("b").help("Edge sharpness.");

parameters! {
    pub struct Beacon {
        below: colour = BELOW,
        blend: number = BLEND,
    }
}

impl LightType for Beacon {
    const DECLARATION: Declaration =
        Declaration::new("beacon", "Beacon", Source::new("beacon.wgsl", include_str!("beacon.wgsl")))
            .summary("A point light that shines in another colour downwards.")
            .at_position()
            .candela(20.0, 200.0);

    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        let to_light = light.position - p;
        let l = to_light.normalize_or_zero();
        let colour = Vec3::ONE.lerp(self.below, (0.5 + 0.5 * self.blend * l.y).clamp(0.0, 1.0));
        Incident::From { l, intensity: light.intensity / to_light.length_squared().max(1e-6) * colour }
    }
}
