//! Requests another frame while something changes, and none otherwise.

use std::time::Duration;

use bevy::{
    prelude::*,
    window::RequestRedraw,
    winit::{UpdateMode, WinitSettings},
};

use bevy_egui::EguiRenderOutput;

use super::WindowView;
use crate::{
    panel::state::{PictureArea, Session},
    render::{
        entities::CurrentScene, illumination::ShownTerms, live::LiveShaders, trial::Bench, view::Drawing,
    },
};

/// Maximum sleep of an idle window, which input wakes at once.
const SLEEP: Duration = Duration::from_secs(3600);
/// Number of frames drawn after the last change: the panels change their layout in the first and settle in the second.
pub(super) const SETTLING_FRAMES: u32 = 3;

/// Lets the window sleep when nothing happens.
pub(super) fn sleepy() -> WinitSettings {
    WinitSettings {
        focused_mode: UpdateMode::reactive(SLEEP),
        unfocused_mode: UpdateMode::reactive_low_power(SLEEP),
    }
}

/// Number of frames still to be drawn because something changed.
#[derive(Resource)]
pub(super) struct Settling(u32);

impl Default for Settling {
    fn default() -> Self {
        Self(10)
    }
}

impl Settling {
    /// Requests at least this number of frames, because something changed.
    pub(super) fn draw(&mut self, frames: u32) {
        self.0 = self.0.max(frames);
    }

    /// True if another frame follows at once.
    pub(super) fn goes_on(&self) -> bool {
        self.0 > 0
    }
}

/// Requests another frame while something changes.
pub(super) fn redraw(
    session: Res<Session>,
    area: Option<Res<PictureArea>>,
    scene: Res<CurrentScene>,
    terms: Res<ShownTerms>,
    live: Res<LiveShaders>,
    bench: Res<Bench>,
    cameras: Query<&Transform, With<WindowView>>,
    drawings: Query<&Drawing>,
    painted: Query<&EguiRenderOutput>,
    mut seen_from: Local<Option<Transform>>,
    mut settling: ResMut<Settling>,
    mut requests: MessageWriter<RequestRedraw>,
) {
    // New glyphs reach the GPU one frame after they are requested.
    let letters = painted.iter().any(|output| !output.textures_delta.set.is_empty());
    let camera = cameras.iter().next().copied();
    let moved = std::mem::replace(&mut *seen_from, camera) != camera;
    // An edit in the panels reaches the scene in the next frame.
    let area = area.is_some_and(|area| area.is_changed());
    let changed = session.is_changed() || area || scene.is_changed() || terms.is_changed();
    // Problems are reported after a delay, and shaders outside the picture are tested one per frame.
    let busy = live.is_busy() && !bench.is_waiting() && !live.is_reading() || bench.is_drawing_first();
    if letters || moved || changed || busy {
        settling.draw(SETTLING_FRAMES);
    }
    if drawings.iter().any(|drawing| drawing.draws() && !drawing.is_done()) {
        settling.draw(1);
    }
    if settling.goes_on() {
        settling.0 -= 1;
        requests.write(RequestRedraw);
    }
}
