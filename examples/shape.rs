//! An object type from outside the crate, complete: a pear with a parameter.
//!
//! `cargo run --release --example shape` opens the window with three of them. The struct has the parameters, which are
//! keys of the object in scene files, beside its `type`; `mesh` makes the polygons from them.
#![allow(missing_docs)]

use std::f32::consts::{PI, TAU};

use lights_camera_models::{bevy::prelude::*, prelude::*};

const BELLY: Parameter = Parameter::number("belly", 0.0..=1.0, 0.6)
    .symbol("b")
    .help("How much wider the lower half is: 0 is an egg, and 1 has a neck.");

parameters! {
    /// A pear, standing.
    pub struct Pear {
        /// Extra width of the lower half.
        belly: number = BELLY,
    }
}

impl ObjectType for Pear {
    const DECLARATION: shape::Declaration = shape::Declaration::new("pear", "Pear")
        .summary("Curves outward at its belly and inward at its neck.")
        .glyph("●")
        .tessellation(4..=128, 32, "Bands from pole to pole; twice as many segments go around.");

    fn mesh(&self, tessellation: u32) -> PolygonMesh {
        let segments = 2 * tessellation;
        let around: Vec<_> =
            (0..segments).map(|i| Vec2::from_angle(TAU * i as f32 / segments as f32)).collect();
        let outline = (1..tessellation).map(|i| {
            let (sin, cos) = (PI * i as f32 / tessellation as f32).sin_cos();
            Vec2::new(0.35 * sin * (1.0 - 0.8 * self.belly * cos), 0.5 * cos)
        });
        let mut mesh = PolygonMesh::between_poles(outline, &around);
        // Whatever the parameters are, the largest extent is 1: the scene sets the size.
        mesh.normalise();
        mesh
    }
}

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/shape.json");

pub fn main() -> AppExit {
    App::new().add_plugins(LabPlugins::default().scene(SCENE)).add_object_type::<Pear>().run()
}
