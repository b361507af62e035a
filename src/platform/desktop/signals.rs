//! Signals of the operating system.

#[cfg(unix)]
mod system {
    use std::{fs, io, thread};

    use signal_hook::{
        consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM},
        iterator::Signals,
        low_level::{emulate_default_handler, signal_name},
    };

    /// Calls a function on a thread of its own for each signal that ends the process, with its name and whether it is
    /// Ctrl+C; if it returns false, the process ends by the signal.
    ///
    /// # Errors
    /// Returns an error if the operating system refuses.
    pub fn listen(goes_on: impl Fn(&str, bool) -> bool + Send + 'static) -> io::Result<()> {
        let status = fs::read("/proc/self/status").unwrap_or_default();
        let ignored = ignored(&String::from_utf8_lossy(&status));
        let wanted = [SIGINT, SIGTERM, SIGHUP, SIGQUIT].into_iter().filter(|s| ignored & (1 << (s - 1)) == 0);
        let mut signals = Signals::new(wanted)?;
        thread::Builder::new().name("signals".to_owned()).spawn(move || {
            for signal in signals.forever() {
                if !goes_on(signal_name(signal).unwrap_or("a signal"), signal == SIGINT) {
                    let _ = emulate_default_handler(signal);
                }
            }
        })?;
        Ok(())
    }

    /// The signals that the parent process wants ignored, as `nohup` does with `SIGHUP`, one bit each. Only Linux
    /// reports them.
    fn ignored(status: &str) -> u64 {
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
    }

    /// Ends the process as Ctrl+C does.
    pub fn end_by_interrupt() {
        let _ = emulate_default_handler(SIGINT);
    }

    #[cfg(test)]
    mod tests {
        #[test]
        fn signals_that_are_ignored_stay_so() {
            let status = "Name:\tlcm\nSigBlk:\t0000000000000000\nSigIgn:\t0000000000001001\nSigCgt:\t0000000000000440\n";
            assert_eq!(super::ignored(status), 1 << 12 | 1);
            assert_eq!(super::ignored(""), 0);
        }
    }
}

#[cfg(not(unix))]
mod system {
    use std::{io, process};

    /// Exit status that shells report for a program ended by Ctrl+C.
    const INTERRUPTED: i32 = 130;

    /// Calls a function on a thread of its own for each Ctrl+C, with its name and true; if it returns false, the process
    /// ends.
    ///
    /// # Errors
    /// Returns an error if the operating system refuses.
    pub fn listen(goes_on: impl Fn(&str, bool) -> bool + Send + 'static) -> io::Result<()> {
        let heard = move || {
            if !goes_on("Ctrl+C", true) {
                end_by_interrupt();
            }
        };
        ctrlc::set_handler(heard).map_err(io::Error::other)
    }

    /// Ends the process as Ctrl+C does.
    pub fn end_by_interrupt() {
        process::exit(INTERRUPTED);
    }
}

pub use system::{end_by_interrupt, listen};
