//! Progress of work that takes a while, and the wish to stop it.

/// The user no longer wants the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// Tells the state of some work, and whether it should go on.
pub struct Progress<'a> {
    /// Receives the fraction that is done, and the current step.
    pub tell: &'a dyn Fn(f32, &str),
    /// True if the user no longer wants it.
    pub cancelled: &'a dyn Fn() -> bool,
}

impl Progress<'_> {
    /// Nobody watches.
    pub const NONE: Progress<'static> = Progress { tell: &|_, _| (), cancelled: &|| false };

    /// Does one of several equal parts of the work, which tells how far it is by itself; `name` makes its steps those of the whole.
    pub fn part<T>(
        &self,
        (number, count): (usize, usize),
        name: impl Fn(&str) -> String,
        work: impl FnOnce(&Progress) -> T,
    ) -> T {
        let tell = |done: f32, step: &str| (self.tell)((number as f32 + done) / count as f32, &name(step));
        work(&Progress { tell: &tell, cancelled: self.cancelled })
    }

    /// Begins a step, after this fraction of the work.
    ///
    /// # Errors
    /// [`Cancelled`] if the user no longer wants it.
    pub fn step(&self, done: f32, what: &str) -> Result<(), Cancelled> {
        if (self.cancelled)() {
            return Err(Cancelled);
        }
        (self.tell)(done, what);
        Ok(())
    }
}
