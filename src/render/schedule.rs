//! The order of the lab's systems in a frame.

use bevy::{
    ecs::schedule::{LogLevel, ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor},
    prelude::*,
};

/// The schedule of the lab's systems in a frame; runs after Bevy's `Update`.
///
/// A warning at the start names any two of its systems that access the same data in an undefined order.
/// [`strict`] turns this into an error; the systems of the lab have no such pairs, which a test checks.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct LabFrame;

/// The order of the lab's systems in a frame, as sets of [`LabFrame`], each after the one before. Systems
/// from elsewhere are added to one of them, or ordered `before` and `after` them; systems in `Update` run
/// before all.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LabSystems {
    /// Files are read, actions are carried out, and the document becomes the scene that is shown.
    Load,
    /// The scene becomes entities: after it, every part has its components.
    Spawn,
    /// Changes to entities become edits of the document: what is changed after it counts in the next frame.
    Edit,
    /// Objects get the meshes and materials of their models and shading models.
    Swap,
    /// Lights and display settings go to the renderer.
    Upload,
    /// Gizmos are drawn and pictures are taken: the scene does not change any more.
    Capture,
}

/// Turns an undefined order of two systems in [`LabFrame`] into an error on its first run.
pub fn strict(app: &mut App) {
    detect(app, LogLevel::Error);
}

/// Runs the systems of every schedule one after the other on the calling thread. A frame has hundreds of
/// systems of a microsecond each, and passing one to another thread takes longer than that; those with much
/// work distribute it themselves.
pub fn run_on_one_thread(app: &mut App) {
    let worlds = app.sub_apps_mut();
    for app in worlds.iter_mut() {
        if let Some(mut schedules) = app.world_mut().get_resource_mut::<Schedules>() {
            for (_, schedule) in schedules.iter_mut() {
                schedule.set_executor(SingleThreadedExecutor::new());
            }
        }
    }
}

/// Sets how systems with an undefined order are reported.
pub(super) fn detect(app: &mut App, level: LogLevel) {
    app.edit_schedule(LabFrame, |schedule| {
        schedule.set_build_settings(ScheduleBuildSettings { ambiguity_detection: level, ..default() });
    });
}
