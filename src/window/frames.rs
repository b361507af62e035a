//! What a frame costs: the time between frames that follow each other without a rest, so that the work of the GPU
//! counts, which goes on after the last system of a frame.

use std::time::{Duration, Instant};

use bevy::{
    app::AppExit,
    ecs::prelude::*,
    winit::{UpdateMode, WinitSettings},
};

use super::{Settling, watching::complain};
use crate::{panel::state::Session, render::view::Drawing};

/// As many frames of either kind are remembered.
const REMEMBERED: usize = 1000;

/// The clock of the frames.
#[derive(Default, Resource)]
pub(super) struct FrameClock {
    /// When the last frame began, and if it drew a picture, if another was to follow at once.
    last: Option<(Instant, bool)>,
    mean: f32,
    /// How long the last frames took, those that drew panels alone and those that drew a picture too.
    times: [Vec<Duration>; 2],
    /// How many frames there were of either kind.
    count: [u64; 2],
    /// The program says so when it ends.
    pub(super) tells: bool,
}

impl FrameClock {
    fn summary(&self) -> String {
        let kinds = ["panels alone", "panels and picture"];
        let told = kinds.iter().zip(&self.times).zip(self.count).map(|((kind, times), count)| {
            let mut times = times.clone();
            times.sort_unstable();
            let median =
                times.get(times.len() / 2).map(|t| format!(", median {:.1} ms", t.as_secs_f32() * 1e3));
            format!("{kind} {count}{}", median.unwrap_or_default())
        });
        format!("Frames: {}.", told.collect::<Vec<_>>().join("; "))
    }
}

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
        // Frames in which panels alone are drawn say nothing of the picture.
        if drew {
            let ms = time.as_secs_f32() * 1e3;
            clock.mean = if clock.mean == 0.0 { ms } else { 0.8 * clock.mean + 0.2 * ms };
            session.bypass_change_detection().status.frame_ms = clock.mean;
        }
    }
    let draws = views.iter().any(Drawing::draws);
    clock.count[usize::from(draws)] += 1;
    let follows = settling.frames > 0 || settings.focused_mode == UpdateMode::Continuous;
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
        let clock =
            FrameClock { times: [vec![ms(9), ms(3), ms(4)], vec![]], count: [5, 1], ..FrameClock::default() };
        assert_eq!(clock.summary(), "Frames: panels alone 5, median 4.0 ms; panels and picture 1.");
    }
}
