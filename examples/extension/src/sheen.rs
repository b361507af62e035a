//! A reflection model: cloth whose fibres shine at the rim.

use lights_camera_models::{bevy::prelude::*, parameter::BASE_COLOUR, prelude::*, reflection::Declaration};

const FALLOFF: Parameter =
    Parameter::number("falloff", 1.0..=8.0, 3.0).symbol("p").help("Thinness of the rim.");

parameters! {
    pub struct Sheen {
        base_colour: colour = BASE_COLOUR,
        falloff: number = FALLOFF,
    }
}

impl ReflectionModel for Sheen {
    const DECLARATION: Declaration =
        Declaration::new("sheen", "Sheen", Source::new("sheen.wgsl", include_str!("sheen.wgsl")))
            .summary("Cloth whose fibres shine at the rim.")
            .non_negative()
            .energy_conserving()
            .ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let rim = (1.0 - frame.n.dot(v).clamp(0.0, 1.0)).powf(self.falloff);
        Terms { diffuse: rim * frame.n.dot(l).max(0.0) * self.base_colour, ..Terms::default() }
    }
}
