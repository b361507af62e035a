//! An object type: a ball with petals.

use std::f32::consts::{PI, TAU};

use lights_camera_models::{bevy::prelude::*, prelude::*, shape::Declaration};

const PETALS: Parameter = Parameter::integer("petals", 2..=12, 5).symbol("n").help("The number of petals.");
const DEPTH: Parameter =
    Parameter::number("depth", 0.0..=0.6, 0.3).symbol("d").help("How deep they are cut.");

parameters! {
    pub struct Blossom {
        petals: number = PETALS,
        depth: number = DEPTH,
    }
}

impl ObjectType for Blossom {
    const DECLARATION: Declaration = Declaration::new("blossom", "Blossom")
        .summary("A ball with petals.")
        .tessellation(4..=32, 12, "Bands from pole to pole, and segments around each petal.");

    fn mesh(&self, tessellation: u32) -> PolygonMesh {
        let segments = self.petals as u32 * tessellation;
        let petal = |turn: f32| {
            let cut = self.depth * (0.5 - 0.5 * (self.petals * turn).cos());
            (1.0 - cut) * Vec2::from_angle(turn)
        };
        let around: Vec<_> = (0..segments).map(|i| petal(TAU * i as f32 / segments as f32)).collect();
        let outline = (1..tessellation).map(|i| {
            let (sin, cos) = (PI * i as f32 / tessellation as f32).sin_cos();
            Vec2::new(0.5 * sin, 0.5 * cos)
        });
        let mut mesh = PolygonMesh::between_poles(outline, &around);
        mesh.normalise();
        mesh
    }
}
