//! The order of everything that the lab does in a frame.

use bevy::ecs::{prelude::*, schedule::ScheduleLabel};

/// The schedule of everything that the lab does in a frame; runs after Bevy's `Update`. A schedule of
/// its own, so that two of our systems whose order is left open are an error at start, whatever
/// Bevy's own systems do.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct LabFrame;

/// The order of everything that the lab does in a frame. Its systems are ordered through these sets.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LabSystems {
    /// Files are read; the scene is replaced.
    Load,
    /// The scene becomes entities.
    Spawn,
    /// Changes to entities go back into the scene.
    Edit,
    /// Objects get the meshes and materials of their models and shading models.
    Swap,
    /// Lights and display settings go to the renderer.
    Upload,
    /// Pictures are taken.
    Capture,
}
