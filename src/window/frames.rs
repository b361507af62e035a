//! Frame times: measured between frames without a pause, in order to include the work of the GPU, which continues after
//! the last system of a frame.

use std::time::Duration;

use bevy::{
    prelude::*,
    render::renderer::RenderAdapterInfo,
    winit::{UpdateMode, WinitSettings},
};
use web_time::Instant;

use super::{redraw::Settling, watching::complain};
use crate::{
    panel::state::Session,
    render::{
        meshes::{SOFTWARE_TRIANGLES, ShapeMeshes},
        view::Drawing,
    },
};

/// Maximum number of remembered frames of each kind.
const REMEMBERED: usize = 1000;

/// The frame clock.
#[derive(Default, Resource)]
pub(super) struct FrameClock {
    /// Start of the previous frame and whether it drew a picture; `None` if no frame was to follow at once.
    last: Option<(Instant, bool)>,
    mean: f32,
    /// Durations of recent frames, of those with panels only and of those with a picture.
    times: [Vec<Duration>; 2],
    /// Number of frames of each kind.
    count: [u64; 2],
    /// Number of frames in which the session changed.
    changes: u64,
    /// True if the program prints a summary at the end.
    tells: bool,
}

impl FrameClock {
    pub(super) fn new(tells: bool) -> Self {
        Self { tells, ..Self::default() }
    }

    fn summary(&self) -> String {
        let kinds = ["panels alone", "panels and picture"];
        let told = kinds.iter().zip(&self.times).zip(self.count).map(|((kind, times), count)| {
            let mut times = times.clone();
            times.sort_unstable();
            let median =
                times.get(times.len() / 2).map(|t| format!(", median {:.1} ms", t.as_secs_f32() * 1e3));
            format!("{kind} {count}{}", median.unwrap_or_default())
        });
        let told = told.collect::<Vec<_>>().join("; ");
        format!("Frames: {told}; session changed in {}.", self.changes)
    }
}

/// Reports the GPU to the panels, and limits what is drawn without one.
pub(super) fn adapter_facts(
    adapter: Option<Res<RenderAdapterInfo>>,
    mut session: ResMut<Session>,
    mut meshes: ResMut<ShapeMeshes>,
) {
    if let Some(adapter) = adapter {
        if adapter.device_type == wgpu::DeviceType::Cpu {
            meshes.limit_triangles(SOFTWARE_TRIANGLES);
        }
        let facts = &mut session.bypass_change_detection().facts;
        facts.backend = format!("{:?}", adapter.backend);
        facts.adapter.clone_from(&adapter.name);
    }
}

/// Measures the frame, and reports to the panels.
pub(super) fn measure(
    mut clock: ResMut<FrameClock>,
    settling: Res<Settling>,
    settings: Res<WinitSettings>,
    views: Query<&Drawing>,
    mut exit: MessageReader<AppExit>,
    mut session: ResMut<Session>,
) {
    let now = Instant::now();
    let clock = &mut *clock;
    if let Some((last, drew)) = clock.last.take() {
        let time = now - last;
        let times = &mut clock.times[usize::from(drew)];
        if times.len() == REMEMBERED {
            times.remove(0);
        }
        times.push(time);
        // Frames with panels only say nothing about the picture.
        if drew {
            let ms = time.as_secs_f32() * 1e3;
            clock.mean = if clock.mean == 0.0 { ms } else { 0.8 * clock.mean + 0.2 * ms };
            session.bypass_change_detection().facts.frame_ms = clock.mean;
        }
    }
    let draws = views.iter().any(Drawing::draws);
    clock.count[usize::from(draws)] += 1;
    clock.changes += u64::from(session.is_changed());
    let follows = settling.goes_on() || settings.focused_mode == UpdateMode::Continuous;
    clock.last = follows.then_some((now, draws));
    if exit.read().count() > 0 && clock.tells {
        complain(&clock.summary());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_frames_of_both_kinds_and_gives_their_medians() {
        let ms = Duration::from_millis;
        let clock = FrameClock {
            times: [vec![ms(9), ms(3), ms(4)], vec![]],
            count: [5, 1],
            changes: 2,
            ..FrameClock::default()
        };
        assert_eq!(
            clock.summary(),
            "Frames: panels alone 5, median 4.0 ms; panels and picture 1; session changed in 2."
        );
    }
}
