//! A light type from outside the crate, complete: the sun through a blind, with a number and a colour.
//!
//! `cargo run --release --example light` opens the window with it. `incident` is the light that arrives at a point, and
//! `light.wgsl` the same for the GPU, where the parameters have the same names.
#![allow(missing_docs)]

use lights_camera_models::{bevy::prelude::*, prelude::*};

const SLATS: Parameter = Parameter::number("slats", 0.5..=10.0, 2.0)
    .symbol("n")
    .unit("1/m")
    .help("The number of slats in a metre.");
const TINT: Parameter =
    Parameter::colour("tint", [40, 30, 20]).symbol("T").help("The light that a slat lets through.");

parameters! {
    /// Sunlight through a blind.
    pub struct Blind {
        /// Slats per metre.
        slats: number = SLATS,
        /// Light that a slat lets through, linear.
        tint: colour = TINT,
    }
}

impl LightType for Blind {
    const DECLARATION: light::Declaration =
        light::Declaration::new("blind", "Blind", Source::new("light.wgsl", include_str!("light.wgsl")))
            .summary("The sun through a blind: every other stripe lies behind a slat.")
            .equation("I(p) = I if fract(n p·a) < 1/2, else T I; a ⊥ D, upwards")
            .glyph("≡")
            .with_direction()
            .lux(1.0, 10.0);

    fn incident(&self, light: &LightRecord, p: Vec3) -> Incident {
        let across = (Vec3::Y - light.direction.y * light.direction).normalize_or_zero();
        let stripe = self.slats * p.dot(across);
        let passed = if stripe - stripe.floor() < 0.5 { Vec3::ONE } else { self.tint };
        Incident::From { l: -light.direction, intensity: light.intensity * passed }
    }
}

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/light.json");

pub fn main() -> AppExit {
    App::new().add_plugins(LabPlugins::default().scene(SCENE)).add_light_type::<Blind>().run()
}
