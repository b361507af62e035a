//! Systems that hang up a spotlight and swing it: `cargo run --release --example animate` opens the window with it.
//!
//! The spotlight is an entity like any other: spawning it adds a light to the scene, and turning its transform turns its
//! light. `Animated` keeps the motion out of the scene: it is shown, and neither stored nor undone.
#![allow(missing_docs)]

use lights_camera_models::{bevy::prelude::*, light::Spot, prelude::*};

/// Hangs up a spotlight.
fn hang(mut commands: Commands) {
    commands.spawn((
        Spot { cone_angle: 14.0, ..default() },
        SceneLight { power: LightPower::Intensity(60.0), ..default() },
        Transform::from_xyz(5.0, 9.0, 5.5),
        Animated,
    ));
}

/// Turns all spotlights a little further in every frame.
fn swing(mut lights: Query<&mut Transform, With<Spot>>, time: Res<Time>) {
    let angle = (3.0 * time.elapsed_secs()).sin();
    for mut place in &mut lights {
        place.look_to(Vec3::new(0.4 * angle, -1.0, -0.1), Vec3::Z);
    }
}

/// Both as a plugin.
pub fn swinging(app: &mut App) {
    app.add_systems(Startup, hang).add_systems(Update, swing);
}

pub fn main() -> AppExit {
    App::new().add_plugins((LabPlugins::default(), swinging)).run()
}
