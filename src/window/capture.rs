//! `view --exit-after N --capture FILE`: the whole window as a PNG file.

use std::{
    path::PathBuf,
    sync::{Arc, Mutex},
    time::{Duration, Instant},
};

use bevy::{
    app::{App, AppExit, Plugin},
    ecs::prelude::*,
    render::view::screenshot::{Screenshot, ScreenshotCaptured},
};

use crate::{
    failure::Failure,
    render::{
        capture::png,
        live::LiveShaders,
        schedule::{LabFrame, LabSystems},
    },
};

/// The longest that shaders are waited for before frames are counted.
const PATIENCE: Duration = Duration::from_secs(30);

/// Exits after so many frames; before, writes the window to a file, if one is given.
pub(super) struct ExitAfter {
    pub(super) frames: u32,
    pub(super) file: Option<PathBuf>,
    pub(super) failure: Arc<Mutex<Option<Failure>>>,
}

#[derive(Resource)]
struct Countdown {
    left: u32,
    file: Option<PathBuf>,
    failure: Arc<Mutex<Option<Failure>>>,
    since: Instant,
}

impl Plugin for ExitAfter {
    fn build(&self, app: &mut App) {
        app.insert_resource(Countdown {
            left: self.frames,
            file: self.file.clone(),
            failure: self.failure.clone(),
            since: Instant::now(),
        })
        .add_systems(LabFrame, count.in_set(LabSystems::Capture));
    }
}

fn count(
    mut countdown: ResMut<Countdown>,
    live: Res<LiveShaders>,
    mut commands: Commands,
    mut exit: MessageWriter<AppExit>,
) {
    // An object whose shader is still being tried is not on the picture yet.
    if live.is_trying() && countdown.since.elapsed() < PATIENCE {
        return;
    }
    // After the capture was asked for, frames go on until it arrives.
    let Some(left) = countdown.left.checked_sub(1) else { return };
    countdown.left = left;
    if left > 0 {
        return;
    }
    if countdown.file.is_some() {
        commands.spawn(Screenshot::primary_window()).observe(write);
    } else {
        exit.write(AppExit::Success);
    }
}

fn write(captured: On<ScreenshotCaptured>, countdown: Res<Countdown>, mut exit: MessageWriter<AppExit>) {
    exit.write(AppExit::Success);
    let Some(file) = &countdown.file else { return };
    let failed = |what: String| {
        if let Ok(mut failure) = countdown.failure.lock() {
            *failure = Some(Failure::Write(format!("{} could not be written: {what}", file.display())));
        }
    };
    match captured.image.clone().try_into_dynamic() {
        Ok(image) => {
            let image = image.to_rgb8();
            let facts = [("Software", concat!("Lights, Camera, Models! ", env!("CARGO_PKG_VERSION")))];
            if let Err(e) = png::write(file, image.width(), image.height(), image.as_raw(), &facts) {
                failed(e.to_string());
            }
        }
        Err(e) => failed(e.to_string()),
    }
}
