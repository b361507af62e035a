//! The window with more than is built in: a reflection model, a panel, and a system that counts.
//!
//! `cargo run --release --example window` opens it. The model is that of `toon.rs`, the panel that of `panel.rs`.
#![allow(missing_docs)]

use lights_camera_models::{bevy::prelude::*, prelude::*};

#[path = "panel.rs"]
#[allow(dead_code)]
pub mod panel;
#[path = "toon.rs"]
#[allow(dead_code)]
pub mod toon;

pub fn main() -> AppExit {
    App::new()
        .add_plugins(LabPlugins::default().scene("scenes/shapes_and_lights.json"))
        .add_reflection_model::<toon::Toon>()
        .add_panel(panel::Dimmer::default())
        .add_systems(LabFrame, count.after(LabSystems::Spawn).before(LabSystems::Edit))
        .run()
}

/// Logs how many objects there are, whenever that changes.
fn count(objects: Query<(), With<SceneObject>>, mut known: Local<usize>) {
    if std::mem::replace(&mut *known, objects.count()) != *known {
        warn!("{} objects", *known);
    }
}
