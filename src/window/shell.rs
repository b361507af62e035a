//! The window on the desktop: its title, its size on the screen, its closing.

use bevy::{
    ecs::prelude::*,
    window::{MonitorSelection, PrimaryWindow, Window, WindowCloseRequested, WindowMode},
};

use crate::{
    panel::state::{Action, LabEffect, Session},
    registry::Registry,
};

pub(super) fn window_title(session: Res<Session>, mut window: Single<&mut Window, With<PrimaryWindow>>) {
    let mark = if session.is_dirty() { " •" } else { "" };
    let title = format!("{}{mark} – Lights, Camera, Models!", session.window_title());
    if window.title != title {
        window.title = title;
    }
}

/// The window fills the screen where the state says so.
pub(super) fn fullscreen(session: Res<Session>, mut window: Single<&mut Window, With<PrimaryWindow>>) {
    let mode = if session.view.fullscreen {
        WindowMode::BorderlessFullscreen(MonitorSelection::Current)
    } else {
        WindowMode::Windowed
    };
    if window.mode != mode {
        window.mode = mode;
    }
}

pub(super) fn close_requested(
    mut requests: MessageReader<WindowCloseRequested>,
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut effects: MessageWriter<LabEffect>,
) {
    if requests.read().count() > 0 {
        for effect in session.apply(Action::Quit, &registry) {
            effects.write(LabEffect(effect));
        }
    }
}
