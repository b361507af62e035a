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
