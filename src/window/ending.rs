//! The end of the window when nobody in it asked for it: the display is lost, the renderer fails, something panics.
//! The unsaved changes are kept, and the user is told where.
//!
//! When the X server goes, Xlib ends the process with `exit(1)`, from within the event loop, and offers no safe way to
//! object. But `exit` drops the thread-local values of its thread first, where the C library is glibc: ours then
//! goes on to the status that is meant. Elsewhere the status is 1, and the copy is there as it always is.

use std::{
    cell::RefCell,
    panic::{self, AssertUnwindSafe},
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use bevy::app::{App, AppExit};

use super::watching::complain;
use crate::{failure::Failure, recovery::Keeper};

/// Ending waits for the disk no longer than this.
pub(super) const PATIENCE: Duration = Duration::from_millis(1500);

thread_local! {
    static ALARM: Alarm = const { Alarm(RefCell::new(None)) };
}

/// Goes off when the process exits while it is set.
struct Alarm(RefCell<Option<Keeper>>);

impl Drop for Alarm {
    fn drop(&mut self) {
        let Some(keeper) = self.0.take() else { return };
        complain(&lost("the connection to the display was lost", keeper.settle(PATIENCE).sentence()));
        #[cfg(unix)]
        signal_hook::low_level::exit(Failure::NoRenderer(String::new()).status().into());
    }
}

/// The alarm is set while this exists.
pub(super) struct Guard(());

impl Guard {
    pub(super) fn set(keeper: &Keeper) -> Self {
        ALARM.with(|alarm| alarm.0.replace(Some(keeper.clone())));
        Self(())
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        ALARM.with(|alarm| alarm.0.take());
    }
}

/// Runs the window until it is closed; the keeper keeps what is unsaved, if there is one.
pub(super) fn run(app: &mut App, keeper: Option<&Keeper>) -> Result<(), Failure> {
    let sentence = || keeper.and_then(|keeper| keeper.settle(PATIENCE).sentence());
    static RUNNING: AtomicBool = AtomicBool::new(false);
    RUNNING.store(true, Ordering::SeqCst);
    let hook = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        // Of a lost display the windowing library complains in its own way; ours is below.
        if !RUNNING.load(Ordering::SeqCst) || display_answers() {
            hook(info);
        }
    }));
    let ended = panic::catch_unwind(AssertUnwindSafe(|| app.run()));
    RUNNING.store(false, Ordering::SeqCst);
    match ended {
        Ok(AppExit::Success) => Ok(()),
        Ok(AppExit::Error(_)) => {
            let what = if display_answers() {
                "the renderer failed and the window was closed"
            } else {
                "the connection to the display was lost"
            };
            Err(Failure::NoRenderer(lost(what, sentence())))
        }
        Err(_) if !display_answers() => {
            Err(Failure::NoRenderer(lost("the connection to the display was lost", sentence())))
        }
        Err(panic) => {
            if let Some(sentence) = sentence() {
                complain(&sentence);
            }
            panic::resume_unwind(panic)
        }
    }
}

fn lost(what: &str, kept: Option<String>) -> String {
    match kept {
        Some(sentence) => format!("{what}; {sentence}"),
        None => format!("{what}; this window had no unsaved changes"),
    }
}

/// True unless the display that the environment names is gone.
#[cfg(target_os = "linux")]
fn display_answers() -> bool {
    use std::{env, os::unix::net::UnixStream, path::PathBuf};

    let named = |name| env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
    match named("WAYLAND_DISPLAY") {
        // An absolute path replaces the folder.
        Some(name) => UnixStream::connect(named("XDG_RUNTIME_DIR").unwrap_or_default().join(name)).is_ok(),
        None => x11rb::connect(None).is_ok(),
    }
}

/// Other systems do not part with their display.
#[cfg(not(target_os = "linux"))]
fn display_answers() -> bool {
    true
}
