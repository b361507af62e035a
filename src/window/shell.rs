//! The window on the desktop: title, full screen, closing, sleep.

use bevy::{
    prelude::*,
    window::{PrimaryWindow, WindowCloseRequested, WindowMode},
};

use bevy_egui::{EguiPostUpdateSet, EguiPreUpdateSet};

use super::{Acting, frames, input, redraw, watching::waker};
use crate::{
    panel::state::{Action, Session, Severity},
    platform::{self, Notice},
    program,
};

/// The window on the desktop. It sleeps while nothing changes.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShellPlugin {
    /// True to report the time per frame at the end.
    pub verbose: bool,
}

impl Plugin for ShellPlugin {
    fn build(&self, app: &mut App) {
        platform::listen_for_files(waker(app.world()));
        app.insert_resource(redraw::sleepy())
            .init_resource::<redraw::Settling>()
            .insert_resource(frames::FrameClock::new(self.verbose))
            .add_systems(Startup, frames::adapter_facts)
            .add_systems(
                PreUpdate,
                (
                    (close_requested, file_dropped).chain(),
                    notices,
                    (input::mend_input, input::report_leaving)
                        .chain()
                        .after(EguiPreUpdateSet::ProcessInput)
                        .before(EguiPreUpdateSet::BeginPass),
                ),
            )
            .add_systems(
                PostUpdate,
                (
                    (window_title, fullscreen).run_if(resource_changed::<Session>),
                    // After the panels' last changes, which must be drawn.
                    redraw::redraw
                        .after(EguiPostUpdateSet::ProcessOutput)
                        .before(EguiPostUpdateSet::PostProcessOutput),
                ),
            )
            .add_systems(Last, (frames::measure, input::rescale_pointer, shown.run_if(run_once)));
    }
}

/// The first frame is drawn.
fn shown() {
    platform::shown();
}

fn window_title(session: Res<Session>, mut window: Single<&mut Window, With<PrimaryWindow>>) {
    let mark = if session.shows_unsaved() { " •" } else { "" };
    let title = format!("{}{mark} – {}", session.window_title(), program::title());
    if window.title != title {
        platform::titled(&title, session.shows_unsaved());
        window.title = title;
    }
}

/// Makes the window fill the screen if the session says so.
fn fullscreen(session: Res<Session>, mut window: Single<&mut Window, With<PrimaryWindow>>) {
    let mode = if session.view.fullscreen {
        WindowMode::BorderlessFullscreen(MonitorSelection::Current)
    } else {
        WindowMode::Windowed
    };
    if window.mode != mode {
        window.mode = mode;
    }
}

/// Opens files dropped on the window, or adds them to the scene.
fn file_dropped(mut drops: MessageReader<FileDragAndDrop>, mut acting: Acting) {
    let file = |drop: &FileDragAndDrop| match drop {
        FileDragAndDrop::DroppedFile { path_buf, .. } => Some(path_buf.clone()),
        FileDragAndDrop::HoveredFile { .. } | FileDragAndDrop::HoveredFileCanceled { .. } => None,
    };
    let dropped: Vec<_> = drops.read().filter_map(file).chain(platform::brought()).collect();
    if !dropped.is_empty() {
        acting.apply(Action::Drop(dropped));
    }
}

/// Shows what has happened around the window.
fn notices(mut session: ResMut<Session>) {
    for notice in platform::notices() {
        match notice {
            Notice::Info(text) => session.say(Severity::Info, text),
            Notice::Warning(text) => session.say(Severity::Warning, text),
            Notice::Unkept(path, why) => session.not_kept(&path, &why),
            Notice::Copied(text) => session.copied(&text),
            Notice::Uncopied(text, why) => session.not_copied(&text, &why),
        }
    }
}

fn close_requested(mut requests: MessageReader<WindowCloseRequested>, mut acting: Acting) {
    if requests.read().count() > 0 {
        acting.apply(Action::Quit);
    }
}
