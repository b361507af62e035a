//! `view --exit-after N --capture FILE`: the whole window as a PNG file.

use std::{
    path::PathBuf,
    sync::{Arc, Mutex},
    time::Duration,
};

use bevy::{
    camera::RenderTarget,
    prelude::*,
    render::view::screenshot::{Screenshot, ScreenshotCaptured},
    window::PrimaryWindow,
    winit::WinitSettings,
};
use web_time::Instant;

use super::{ViewOptions, WindowView, watching::complain};
use crate::files::{Shown as _, words};
use crate::{
    caught::lock,
    failure::Failure,
    panel::state::Session,
    picture::png::{self, About},
    registry::Registry,
    render::{
        live::LiveShaders,
        schedule::{LabFrame, LabSystems},
        view::{Drawing, texture_of},
    },
};

/// Maximum time to wait for shaders before frames are counted.
const PATIENCE: Duration = Duration::from_secs(30);

/// Exits after a number of frames, if given. Before that, captures the window to a file, if given; without a window,
/// the picture.
#[derive(Clone, Debug, Default)]
pub struct CapturePlugin {
    /// Number of frames.
    pub frames: Option<u32>,
    /// PNG file of the capture.
    pub file: Option<PathBuf>,
    /// True to leave the scene out of the file.
    pub no_scene: bool,
}

impl CapturePlugin {
    pub(super) fn of(options: &ViewOptions) -> Self {
        Self { frames: options.exit_after, file: options.capture.clone(), no_scene: options.no_scene }
    }
}

impl Plugin for CapturePlugin {
    fn build(&self, app: &mut App) {
        let Some(remaining) = self.frames else { return };
        app.insert_resource(WinitSettings::continuous())
            .insert_resource(Countdown { of: self.clone(), remaining, reported: None, since: Instant::now() })
            .add_systems(LabFrame, count.in_set(LabSystems::Capture));
    }
}

/// Receives the reason if a capture fails.
pub(super) type Report = Arc<Mutex<Option<Failure>>>;

#[derive(Resource)]
pub(super) struct Countdown {
    of: CapturePlugin,
    remaining: u32,
    /// Receiver of a failure; `None` to report it here.
    pub(super) reported: Option<Report>,
    since: Instant,
}

fn count(
    mut countdown: ResMut<Countdown>,
    live: Res<LiveShaders>,
    windows: Query<(), With<PrimaryWindow>>,
    mut views: Query<(&RenderTarget, &mut Drawing), With<WindowView>>,
    mut commands: Commands,
    mut exit: MessageWriter<AppExit>,
) {
    // An object whose shader is still being tested is missing from the picture.
    if live.is_trying() && countdown.since.elapsed() < PATIENCE {
        return;
    }
    // After the capture is requested, frames continue until it arrives.
    let Some(remaining) = countdown.remaining.checked_sub(1) else { return };
    countdown.remaining = remaining;
    if remaining > 0 {
        return;
    }
    if countdown.of.file.is_some() {
        let mut shot = Screenshot::primary_window();
        for (target, mut drawing) in views.iter_mut().filter(|_| windows.is_empty()) {
            // An idle view would be missing from the screenshot.
            drawing.redraw();
            shot = texture_of(target).map_or(shot, |picture| Screenshot::image(picture.clone()));
        }
        commands.spawn(shot).observe(write);
    } else {
        exit.write(AppExit::Success);
    }
}

fn write(
    captured: On<ScreenshotCaptured>,
    countdown: Res<Countdown>,
    scene: Option<(Res<Session>, Res<Registry>)>,
    mut exit: MessageWriter<AppExit>,
) {
    let Some(file) = &countdown.of.file else { return };
    let written = captured.image.clone().try_into_dynamic().map_err(|e| e.to_string()).and_then(|image| {
        let image = image.to_rgb8();
        let about = match &scene {
            Some((session, registry)) if !countdown.of.no_scene => {
                About::scene(&session.document.named(registry), registry)
            }
            _ => About::program(),
        };
        png::write(file, image.width(), image.height(), image.as_raw(), &about).map_err(|e| words(&e))
    });
    let Err(what) = written else {
        exit.write(AppExit::Success);
        return;
    };
    let failure = Failure::Write(format!("{} could not be written: {what}", file.shown()));
    exit.write(AppExit::from_code(failure.status()));
    match &countdown.reported {
        Some(report) => *lock(report) = Some(failure),
        None => complain(&failure.to_string()),
    }
}
