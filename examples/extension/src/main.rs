//! Everything that can be added to the lab, from a crate of its own, with the lab's whole command line:
//! `cargo run --release -p lab-extension -- view examples/extension/scene.json` opens the window.

mod beacon;
mod blossom;
mod lazy;
mod meter;
mod sheen;

use lights_camera_models::{bevy::prelude::*, cli, light::Spot, prelude::*};

/// What scenes may name. The shaders are followed while they are edited.
pub fn types(to: &mut impl Register) {
    to.add_reflection_model::<sheen::Sheen>()
        .add_shading_model::<lazy::Lazy>()
        .add_light_type::<beacon::Beacon>()
        .add_object_type::<blossom::Blossom>()
        .add_shader_folder(concat!(env!("CARGO_MANIFEST_DIR"), "/src"));
}

/// Swings every spotlight. `Animated` keeps the motion out of the scene: it is shown and not stored.
pub fn swing(
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

/// More in the window.
pub fn window(app: &mut App) {
    app.add_panel(meter::Meter::default()).add_systems(Update, swing);
}

fn main() -> std::process::ExitCode {
    cli::main_with(types, window)
}

#[test]
fn all_of_it_is_right() {
    use lights_camera_models::testing;
    testing::assert_laws::<sheen::Sheen>();
    testing::assert_parity::<sheen::Sheen>();
    testing::assert_light::<beacon::Beacon>();
    testing::assert_mesh::<blossom::Blossom>();
}
