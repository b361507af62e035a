//! The samples of light with extent, spread over frames: while nothing changes, a frame draws a few of them.
//!
//! All views draw the same samples in a frame, as those without overrides share the buffer of lights. A view counts those
//! that it has drawn since its last change. After as many as are wanted it has drawn each once, wherever it began.

use std::time::{Duration, Instant};

use bevy::ecs::resource::Resource;

use crate::reference::LightSamples;

/// The most samples in a frame.
const MOST: u32 = 8;
/// A frame that takes longer draws fewer samples the next time,
const SLOW: Duration = Duration::from_millis(50);
/// and one that takes less draws more.
const FAST: Duration = Duration::from_millis(20);

/// The samples of light with extent that a frame draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// The number of the first.
    pub first: u32,
    /// How many: a power of two that divides `first`, as such stretches of the sequence are evenly spread.
    pub count: u32,
}

/// A view's samples of light with extent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Converged {
    /// Those that the picture is the mean of.
    pub done: u32,
    /// Those that it will be the mean of.
    pub total: u32,
}

impl Converged {
    /// True if none is missing.
    #[must_use]
    pub fn is_done(self) -> bool {
        self.done >= self.total
    }
}

/// How pictures of light with extent converge.
#[derive(Clone, Debug, Resource)]
pub struct Convergence {
    /// The samples that a picture is the mean of, at least 1.
    pub target: u32,
    /// The first sample of the next frame.
    next: u32,
    /// The most samples of the next frame.
    most: u32,
    /// When the last frame of a picture that converges began.
    began: Option<Instant>,
}

impl Default for Convergence {
    fn default() -> Self {
        Self { target: LightSamples::DEFAULT, next: 0, most: 1, began: None }
    }
}

impl Convergence {
    /// The samples of a frame. `begins` if a picture begins in it, which waits for no more than one sample; `missing` are
    /// the samples that the others lack, at least, if there are others.
    pub(super) fn part(&mut self, begins: bool, missing: Option<u32>) -> Part {
        let target = self.target.max(1);
        if missing.is_none() || self.next >= target {
            // Nothing goes on, so that all pictures begin alike.
            self.next = 0;
        }
        let now = Instant::now();
        match self.began.replace(now).map(|began| now - began) {
            Some(took) if took > SLOW => self.most = (self.most / 2).max(1),
            Some(took) if took < FAST => self.most = (self.most * 2).min(MOST),
            _ => {}
        }
        let aligned = if self.next == 0 { MOST } else { 1 << self.next.trailing_zeros().min(31) };
        let wanted = if begins { 1 } else { self.most };
        let room = wanted.min(missing.unwrap_or(1)).min(target - self.next).max(1);
        let part = Part { first: self.next, count: aligned.min(1 << room.ilog2()) };
        self.next = (self.next + part.count) % target;
        part
    }

    /// No picture converges.
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
}
