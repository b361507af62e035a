//! Progress of long work, and its cancellation.

/// The user cancelled the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// The words for a step of some work; a step without words of its own adds none.
#[must_use]
pub fn named(work: &str, step: &str) -> String {
    if step.is_empty() { work.to_owned() } else { format!("{work}, {step}") }
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
}
