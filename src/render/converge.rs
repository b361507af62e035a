//! The samples of light with extent, spread over frames: while nothing changes, a frame draws a few of them.
//!
//! All views draw the same samples in a frame, since those without overrides share the light buffer. A view
//! counts the samples that it has drawn since its last change. Once it has drawn the target number, each was
//! drawn once, wherever it began.

use std::time::Duration;

use bevy::ecs::resource::Resource;
use web_time::Instant;

use crate::{declared::with_defaults, reference::LightSamples};

/// Maximum number of samples in a frame.
const MOST: u32 = 8;
/// Duration above which the next frame draws fewer samples,
const SLOW: Duration = Duration::from_millis(50);
/// and below which it draws more.
const FAST: Duration = Duration::from_millis(20);

/// The samples of light with extent drawn in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Index of the first sample.
    pub first: u32,
    /// Number of samples: a power of two that divides `first`, since such parts of the sequence are evenly
    /// distributed.
    pub count: u32,
}

/// The progress of a view's samples of light with extent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Converged {
    /// Number of samples of which the picture is the mean.
    pub done: u32,
    /// Number of samples of which it will be the mean.
    pub total: u32,
}

impl Converged {
    /// True if no sample is missing.
    #[must_use]
    pub fn is_done(self) -> bool {
        self.done >= self.total
    }
}

with_defaults! {
    /// The convergence of pictures with light with extent.
    #[derive(Clone, Debug, Resource)]
    pub struct Convergence {
        /// The target number of samples, at least 1.
        pub target: u32 = LightSamples::DEFAULT,
        /// Number of samples in a frame, at least 1 and at most 8; `None` for as many as frames have time for.
        pub pace: Option<u32> = None,
        /// The first sample of the next frame.
        next: u32 = 0,
        /// Maximum number of samples in the next frame.
        most: u32 = 1,
        /// Start of the last frame of a converging picture.
        began: Option<Instant> = None,
    }
}

impl Convergence {
    /// The samples of a frame. `begins` is true if a picture begins in it, which waits for no more than one
    /// sample; `missing` is the minimum number of samples missing in other pictures, if any.
    pub(super) fn part(&mut self, begins: bool, missing: Option<u32>) -> Part {
        let target = self.target.max(1);
        if missing.is_none() || self.next >= target {
            // No picture continues, so that all begin alike.
            self.next = 0;
        }
        let now = Instant::now();
        match self.began.replace(now).map(|began| now - began) {
            Some(took) if took > SLOW => self.most = (self.most / 2).max(1),
            Some(took) if took < FAST => self.most = (self.most * 2).min(MOST),
            _ => {}
        }
        let aligned = if self.next == 0 { MOST } else { 1 << self.next.trailing_zeros().min(31) };
        let wanted = if begins { 1 } else { self.pace.unwrap_or(self.most).min(MOST) };
        let room = wanted.min(missing.unwrap_or(1)).min(target - self.next).max(1);
        let part = Part { first: self.next, count: aligned.min(1 << room.ilog2()) };
        self.next = (self.next + part.count) % target;
        part
    }

    /// Records that no picture converges.
    pub(super) fn rest(&mut self) {
        self.began = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_sample_is_drawn_once_in_stretches_that_are_evenly_spread_wherever_a_picture_begins() {
        for target in [1, 8, 100, 256] {
            for offset in [0, 1, 5, 37] {
                let mut convergence = Convergence { target, ..Convergence::default() };
                convergence.next = offset % target;
                let (mut drawn, mut done) = (vec![0; target as usize], 0);
                while done < target {
                    let Part { first, count } = convergence.part(false, Some(target - done));
                    assert!(
                        count.is_power_of_two() && count <= MOST && first % count == 0,
                        "{first} {count}"
                    );
                    for sample in &mut drawn[first as usize..][..count as usize] {
                        *sample += 1;
                    }
                    done += count;
                }
                assert_eq!((done, drawn), (target, vec![1; target as usize]), "{offset}");
            }
        }
    }

    #[test]
    fn a_picture_that_begins_waits_for_one_sample_and_begins_always_alike() {
        let mut convergence = Convergence { next: 24, most: 8, ..Convergence::default() };
        assert_eq!(convergence.part(true, Some(200)), Part { first: 24, count: 1 });
        assert_eq!(convergence.part(true, None), Part { first: 0, count: 1 });
        assert_eq!(convergence.part(true, None), Part { first: 0, count: 1 });
        assert_eq!(convergence.part(false, Some(255)), Part { first: 1, count: 1 });
    }
    #[test]
    fn a_pace_draws_as_many_samples_however_long_a_frame_takes() {
        let mut convergence = Convergence { pace: Some(4), most: 1, ..Convergence::default() };
        for first in [0, 4, 8] {
            assert_eq!(convergence.part(false, Some(200)), Part { first, count: 4 });
        }
        assert_eq!(convergence.part(true, Some(200)), Part { first: 12, count: 1 });
        convergence = Convergence { pace: Some(64), next: 64, ..convergence };
        assert_eq!(convergence.part(false, Some(190)), Part { first: 64, count: MOST });
    }
}
