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
        system::listen(interrupt.clone(), wake, last_act)?;
        Ok(interrupt)
    }

    /// Makes every signal that ends this process remove its temporary files first. For commands without a
    /// window, in which nobody waits for a request.
    ///
    /// # Errors
    /// Returns an error if the operating system refuses.
    pub fn end_tidily() -> io::Result<()> {
        // As if the first request had not been answered.
        system::listen(Self(Arc::new(AtomicU8::new(HEARD))), || (), |_| ())
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
            system::end_by_interrupt();
        }
    }

    /// True if this Ctrl+C is the first.
    fn is_first(&self) -> bool {
        self.0.swap(HEARD, Ordering::SeqCst) == NONE
    }
}

#[cfg(unix)]
mod system {
    use std::{io, path::Path, thread};

    use signal_hook::{
        consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM},
        iterator::Signals,
        low_level::{emulate_default_handler, signal_name},
    };

    use super::Interrupt;
    use crate::files;

    pub(super) fn listen(
        interrupt: Interrupt,
        wake: impl Fn() + Send + 'static,
        last_act: impl Fn(&str) + Send + 'static,
    ) -> io::Result<()> {
        let status = files::read(Path::new("/proc/self/status"), 1 << 16).unwrap_or_default();
        let ignored = ignored(&String::from_utf8_lossy(&status));
        let wanted = [SIGINT, SIGTERM, SIGHUP, SIGQUIT].into_iter().filter(|s| ignored & (1 << (s - 1)) == 0);
        let mut signals = Signals::new(wanted)?;
        thread::Builder::new().name("signals".to_owned()).spawn(move || {
            for signal in signals.forever() {
                if signal == SIGINT && interrupt.is_first() {
                    wake();
                    continue;
                }
                last_act(signal_name(signal).unwrap_or("a signal"));
                files::give_up();
                let _ = emulate_default_handler(signal);
            }
        })?;
        Ok(())
    }

    /// The signals that the parent process wants ignored, as `nohup` does with `SIGHUP`, one bit each. Only Linux
    /// reports them.
    pub(super) fn ignored(status: &str) -> u64 {
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
    }

    pub(super) fn end_by_interrupt() {
        files::give_up();
        let _ = emulate_default_handler(SIGINT);
    }
}

#[cfg(not(unix))]
mod system {
    use std::{io, process};

    use super::Interrupt;

    /// Exit status that shells report for a program ended by Ctrl+C.
    const INTERRUPTED: i32 = 130;

    pub(super) fn listen(
        interrupt: Interrupt,
        wake: impl Fn() + Send + 'static,
        last_act: impl Fn(&str) + Send + 'static,
    ) -> io::Result<()> {
        let heard = move || {
            if interrupt.is_first() {
                wake();
            } else {
                last_act("Ctrl+C");
                end_by_interrupt();
            }
        };
        ctrlc::set_handler(heard).map_err(io::Error::other)
    }

    pub(super) fn end_by_interrupt() {
        crate::files::give_up();
        process::exit(INTERRUPTED);
    }
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

    #[cfg(unix)]
    #[test]
    fn signals_that_are_ignored_stay_so() {
        let status =
            "Name:\tlcm\nSigBlk:\t0000000000000000\nSigIgn:\t0000000000001001\nSigCgt:\t0000000000000440\n";
        assert_eq!(system::ignored(status), 1 << 12 | 1);
        assert_eq!(system::ignored(""), 0);
    }
}
