//! A shading model from outside the crate, complete: the colour of each pixel, in steps.
//!
//! `cargo run --release --example shading_model` opens the window with it; key B chooses it. `vertex` runs at the corners
//! of polygons and `pixel` between them; `shading_model.wgsl` says the same for the GPU. Its parameter stands in the
//! material of objects.
#![allow(missing_docs)]

use lights_camera_models::{
    bevy::prelude::*,
    prelude::*,
    shading::{Corner, Lighting, Stage, Varying},
};

const STEPS: Parameter = Parameter::integer("steps", 2..=16, 5)
    .symbol("n")
    .help("The number of steps between black and full light.");

parameters! {
    /// Phong shading in bands of equal light.
    pub struct Banded {
        /// The number of steps.
        steps: number = STEPS,
    }
}

impl ShadingModel for Banded {
    const DECLARATION: shading::Declaration = shading::Declaration::new(
        "banded",
        "Banded",
        Stage::Pixel,
        'B',
        Source::new("shading_model.wgsl", include_str!("shading_model.wgsl")),
    )
    .published("an example", "examples/shading_model.rs")
    .summary("Phong shading in steps: the edges of the bands are lines of equal light.");

    fn vertex(&self, _lighting: &dyn Lighting, corner: &Corner) -> Varying {
        let Corner { position, normal, tangent, .. } = *corner;
        Varying { position, normal, tangent, ..Varying::default() }
    }

    fn pixel(&self, lighting: &dyn Lighting, varying: &Varying, _face_normal: Vec3) -> Vec3 {
        let normal = varying.normal.normalize_or_zero();
        let colour = lighting.colour(varying.position, normal, varying.tangent);
        // The hue stays: the brightest channel is put on a step, and the others follow.
        let brightest = colour.max_element().max(1e-6);
        colour * ((self.steps * brightest).ceil() / (self.steps * brightest))
    }
}

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/shading_model.json");

pub fn main() -> AppExit {
    App::new().add_plugins(LabPlugins::default().scene(SCENE)).add_shading_model::<Banded>().run()
}
