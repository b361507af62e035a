//! Everything that can be added to the lab, from a crate of its own, with the lab's whole command line:
//! `cargo run --release -p lab-extension -- view examples/extension/scene.json` opens the window.

mod beacon;
mod blossom;
mod lazy;
mod meter;
mod sheen;

use lights_camera_models::{bevy::prelude::*, cli, light::Spot, prelude::*};

/// The types that scenes may name. The shaders are followed while they are edited.
pub fn types(to: &mut impl Register) {
    to.add_reflection_model::<sheen::Sheen>()
        .add_shading_model::<lazy::Lazy>()
        .add_light_type::<beacon::Beacon>()
        .add_object_type::<blossom::Blossom>()
        .add_shader_folder(concat!(env!("CARGO_MANIFEST_DIR"), "/src"));
}

/// The pace at which spotlights swing, rad/s.
#[derive(Resource)]
pub struct Pace(pub f32);

/// A spotlight that swings since this second.
#[derive(Component)]
pub struct Swinging(f32);

/// Swings every spotlight. `Animated` keeps the motion out of the scene: it is shown and not stored.
pub fn swing(
    mut spots: Query<(Entity, &mut Transform, Option<&Swinging>), With<Spot>>,
    (time, pace): (Res<Time>, Res<Pace>),
    mut commands: Commands,
) {
    let now = time.elapsed_secs();
    for (spot, mut place, swinging) in &mut spots {
        if let Some(Swinging(since)) = swinging {
            place.rotate_x(pace.0 * (now - since).cos() * time.delta_secs());
        } else {
            commands.entity(spot).insert((Animated, Swinging(now)));
        }
    }
}

/// More in the window.
pub fn window(app: &mut App) {
    app.add_panel(meter::Meter::default()).insert_resource(Pace(0.8)).add_systems(Update, swing);
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
    testing::assert_shading::<lazy::Lazy>();
}
