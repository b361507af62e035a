//! Everything that can be added to the lab, from a crate of its own, with the lab's whole command line:
//! `cargo run --release -p lab-extension -- view examples/extension/scene.json` opens the window.

mod beacon;
mod blossom;
mod lazy;
mod meter;
mod sheen;

use std::process::ExitCode;

use lights_camera_models::{bevy::prelude::*, cli, light::Spot, prelude::*};

/// What scenes may name. The shaders are followed while they are edited.
fn types(registry: &mut Registry) {
    registry
        .add_reflection_model::<sheen::Sheen>()
        .add_shading_model::<lazy::Lazy>()
        .add_light_type::<beacon::Beacon>()
        .add_object_type::<blossom::Blossom>()
        .add_shader_folder(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders"));
}

/// Swings every spotlight. `Animated` keeps the motion out of the scene: it is shown and not stored.
fn swing(
    mut spots: Query<(Entity, &mut Transform, Has<Animated>), With<Spot>>,
    time: Res<Time>,
    mut commands: Commands,
) {
    for (spot, mut place, animated) in &mut spots {
        if animated {
            place.rotate_x(0.8 * time.elapsed_secs().cos() * time.delta_secs());
        } else {
            commands.entity(spot).insert(Animated);
        }
    }
}

fn main() -> ExitCode {
    cli::main_with(types, |app| {
        app.add_panel(meter::Meter::default()).add_systems(Update, swing);
    })
}
