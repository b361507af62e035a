//! Requests from outside to end the program: Ctrl+C in the terminal, and the signals of the operating system.
//!
//! A separate thread handles them, so they work while the window sleeps or hangs. The first Ctrl+C (`SIGINT`)
//! is a request: the window closes as with Ctrl+Q, asking for confirmation if there are unsaved changes. The
//! second one, `SIGTERM`, `SIGHUP` and `SIGQUIT` end the program regardless of the window, after a last
//! action given by the caller; then the process dies of the signal, as its parent expects. It leaves no
//! temporary files; this also applies to commands without a window.

use std::{
    io,
    sync::{
        Arc,
        atomic::{AtomicU8, Ordering},
    },
};

use crate::{files, platform};

/// The state of a request by Ctrl+C.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicU8>);

/// No request.
const NONE: u8 = 0;
/// The window has not received it yet.
const HEARD: u8 = 1;
/// The window is closing, or asks for confirmation.
const TAKEN: u8 = 2;

impl Interrupt {
    /// Starts listening. `wake` is called at the first Ctrl+C, `last_act` with the name of the signal that ends the
    /// program, both on the listening thread.
    ///
    /// # Errors
    /// Returns an error if the operating system refuses.
    pub fn listen(
        wake: impl Fn() + Send + 'static,
        last_act: impl Fn(&str) + Send + 'static,
    ) -> io::Result<Self> {
        let interrupt = Self::default();
        hear(interrupt.clone(), wake, last_act)?;
        Ok(interrupt)
    }

    /// Makes every signal that ends this process remove its temporary files first. For commands without a
    /// window, in which nobody waits for a request.
    ///
    /// # Errors
    /// Returns an error if the operating system refuses.
    pub fn end_tidily() -> io::Result<()> {
        // As if the first request had not been answered.
        hear(Self(Arc::new(AtomicU8::new(HEARD))), || (), |_| ())
    }

    /// True once for each Ctrl+C that the window should answer.
    #[must_use]
    pub fn take(&self) -> bool {
        self.0.compare_exchange(HEARD, TAKEN, Ordering::SeqCst, Ordering::SeqCst).is_ok()
    }

    /// True after a Ctrl+C.
    #[must_use]
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::SeqCst) != NONE
    }

    /// Records that the user decided to stay: the next Ctrl+C is a request again.
    pub fn stay(&self) {
        let _ = self.0.compare_exchange(TAKEN, NONE, Ordering::SeqCst, Ordering::SeqCst);
    }

    /// Ends the process as Ctrl+C does, after a Ctrl+C.
    pub fn end_if_asked(&self) {
        if self.is_asked() {
            files::give_up();
            platform::end_by_interrupt();
        }
    }

    /// True if this Ctrl+C is the first.
    fn is_first(&self) -> bool {
        self.0.swap(HEARD, Ordering::SeqCst) == NONE
    }
}

/// Hears of signals until the end of the process.
fn hear(
    interrupt: Interrupt,
    wake: impl Fn() + Send + 'static,
    last_act: impl Fn(&str) + Send + 'static,
) -> io::Result<()> {
    platform::listen(move |signal, is_interrupt| {
        if is_interrupt && interrupt.is_first() {
            wake();
            return true;
        }
        last_act(signal);
        files::give_up();
        false
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_is_a_wish_until_the_user_stays() {
        let interrupt = Interrupt::default();
        assert!(!interrupt.take());
        for _ in 0..2 {
            assert!(interrupt.is_first());
            assert!(interrupt.take() && !interrupt.take());
            interrupt.stay();
        }
        assert!(interrupt.is_first() && !interrupt.is_first(), "the window did not answer");
        assert!(interrupt.take() && !interrupt.is_first(), "the window asks");
    }
}
