//! Progress of long work, and its cancellation.

use std::time::Duration;

/// The user cancelled the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// The words for a step of some work; a step without words of its own adds none.
#[must_use]
pub fn named(work: &str, step: &str) -> String {
    if step.is_empty() { work.to_owned() } else { format!("{work}, {step}") }
}

/// The time that is left, by that of all of the work so far: the speed of the last moments is that of one step. `None` at
/// the beginning, most of which goes into reading and compiling.
#[must_use]
pub fn time_left(done: f32, elapsed: Duration) -> Option<Duration> {
    const ENOUGH: f32 = 0.05;
    const FIRST: Duration = Duration::from_secs(3);
    (done >= ENOUGH && elapsed >= FIRST).then(|| elapsed.mul_f32((1.0 - done).max(0.0) / done))
}

/// Reports the progress of some work, and asks whether it should continue.
pub struct Progress<'a> {
    /// Receives the completed fraction, and the current step.
    pub tell: &'a dyn Fn(f32, &str),
    /// True if the user has cancelled the work.
    pub cancelled: &'a dyn Fn() -> bool,
}

impl Progress<'_> {
    /// Reports nothing, and never cancels.
    pub const NONE: Progress<'static> = Progress { tell: &|_, _| (), cancelled: &|| false };

    /// Does one of several equal parts of the work, which reports its own progress; `name` makes its steps
    /// those of the whole.
    pub fn part<T>(
        &self,
        (number, count): (usize, usize),
        name: impl Fn(&str) -> String,
        work: impl FnOnce(&Progress) -> T,
    ) -> T {
        let at = |number: usize| number as f32 / count as f32;
        self.stretch([at(number), at(number + 1)], name, work)
    }

    /// Does the work between two fractions of the whole, as [`part`](Self::part) does.
    pub fn stretch<T>(
        &self,
        [from, to]: [f32; 2],
        name: impl Fn(&str) -> String,
        work: impl FnOnce(&Progress) -> T,
    ) -> T {
        let tell = |done: f32, step: &str| (self.tell)(from + done * (to - from), &name(step));
        work(&Progress { tell: &tell, cancelled: self.cancelled })
    }

    /// Begins a step, after this fraction of the work.
    ///
    /// # Errors
    /// Returns [`Cancelled`] if the user has cancelled.
    pub fn step(&self, done: f32, what: &str) -> Result<(), Cancelled> {
        if (self.cancelled)() {
            return Err(Cancelled);
        }
        (self.tell)(done, what);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_without_words_leaves_no_gap() {
        assert_eq!(named("drawing room.json", "16 of 40 samples"), "drawing room.json, 16 of 40 samples");
        assert_eq!(named("drawing room.json", ""), "drawing room.json");
    }

    #[test]
    fn the_time_left_is_known_once_enough_is_done() {
        let seconds = Duration::from_secs_f32;
        for (done, elapsed) in [(0.0, 60.0), (0.01, 60.0), (0.5, 1.0)] {
            assert_eq!(time_left(done, seconds(elapsed)), None, "{done} after {elapsed} s");
        }
        assert_eq!(time_left(0.25, seconds(10.0)), Some(seconds(30.0)));
        assert_eq!(time_left(1.0, seconds(10.0)), Some(Duration::ZERO));
    }
}
