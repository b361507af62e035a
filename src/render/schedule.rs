//! The order of everything that the lab does in a frame.

use bevy::{
    app::App,
    ecs::{
        prelude::*,
        schedule::{LogLevel, ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor},
    },
};

/// The schedule of everything that the lab does in a frame; runs after Bevy's `Update`.
///
/// Two systems in it that touch the same data and leave open which comes first are reported at the start by a warning
/// that names both. [`strict`] makes it an error; among the systems of the lab there are none, which a test checks.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct LabFrame;

/// The order of everything that the lab does in a frame, as sets of [`LabFrame`], each after the one before. Systems
/// from elsewhere are put in one of them, or ordered `before` and `after` them; systems in `Update` come before all.
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

/// Makes an open order of two systems in [`LabFrame`] an error when it runs first.
pub fn strict(app: &mut App) {
    detect(app, LogLevel::Error);
}

/// Runs the systems of every schedule one after the other on the calling thread. A frame has hundreds of systems of a
/// microsecond each, and handing one to another thread takes longer than that; those with much work spread it
/// themselves.
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

/// Sets how systems whose order is left open are reported.
pub(super) fn detect(app: &mut App, level: LogLevel) {
    app.edit_schedule(LabFrame, |schedule| {
        schedule.set_build_settings(ScheduleBuildSettings {
            ambiguity_detection: level,
            ..ScheduleBuildSettings::default()
        });
    });
}
