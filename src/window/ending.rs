//! Unexpected ends of the window: the display is lost, the renderer fails, or something panics. Unsaved changes are
//! kept, and the user learns where.
//!
//! When the X server goes away, Xlib ends the process with `exit(1)` from within the event loop, and offers no safe way
//! to prevent it. With glibc, however, `exit` first drops the thread-local values of the calling thread: ours then
//! exits with the intended status. Elsewhere the status is 1; the recovery copy exists in either case.

use std::{
    backtrace::Backtrace,
    cell::RefCell,
    panic::{self, AssertUnwindSafe, PanicHookInfo},
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering},
    },
    time::Duration,
};

use bevy::app::{App, AppExit};

use super::watching::complain;
use crate::{caught, failure::Failure, platform, recovery::Keeper};

/// Maximum time that ending waits for the disk.
pub(super) const PATIENCE: Duration = Duration::from_millis(1500);

thread_local! {
    static ALARM: Alarm = const { Alarm(RefCell::new(None)) };
}

/// Preserves unsaved changes and sets the exit status if the process exits while the alarm is set.
struct Alarm(RefCell<Option<Keeper>>);

impl Drop for Alarm {
    fn drop(&mut self) {
        let Some(keeper) = self.0.take() else { return };
        complain(&lost("the connection to the display was lost", keeper.settle(PATIENCE).sentence()));
        #[cfg(unix)]
        signal_hook::low_level::exit(Failure::NoRenderer(String::new()).status().into());
    }
}

/// Keeps the alarm set during its lifetime.
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

/// Runs the window until it is closed. The keeper, if any, preserves unsaved changes.
pub(super) fn run(app: &mut App, keeper: Option<&Keeper>) -> Result<(), Failure> {
    if !platform::OUTLIVES_WINDOW {
        // It runs on after this.
        app.run();
        return Ok(());
    }
    let sentence = || keeper.and_then(|keeper| keeper.settle(PATIENCE).sentence());
    static RUNNING: AtomicBool = AtomicBool::new(false);
    RUNNING.store(true, Ordering::SeqCst);
    // The first panic is the cause of all others, unless it was caught.
    static CULPRIT: Mutex<Option<(usize, String)>> = Mutex::new(None);
    let hook = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if RUNNING.load(Ordering::SeqCst)
            && let Ok(mut culprit) = CULPRIT.try_lock()
        {
            let caught = caught::count();
            let known = culprit.take().filter(|(before, _)| *before == caught);
            *culprit = Some(known.unwrap_or_else(|| (caught, described(info))));
        }
        // The windowing library reports a lost display in its own way; our message follows below.
        if !RUNNING.load(Ordering::SeqCst) || display_answers() {
            hook(info);
        }
    }));
    let ended = panic::catch_unwind(AssertUnwindSafe(|| app.run()));
    RUNNING.store(false, Ordering::SeqCst);
    match ended {
        Ok(AppExit::Success) => Ok(()),
        Ok(AppExit::Error(_)) if display_answers() => {
            Err(Failure::NoRenderer(lost("the renderer failed and the window was closed", sentence())))
        }
        Err(panic) if display_answers() => {
            let culprit = caught::lock(&CULPRIT).take();
            let why = culprit.map_or_else(|| "a system panicked".to_owned(), |(_, why)| why);
            complain(&lost(&format!("the window was closed: {why}"), sentence()));
            panic::resume_unwind(panic)
        }
        _ => Err(Failure::NoRenderer(lost("the connection to the display was lost", sentence()))),
    }
}

/// A panic in a system, described by function, if the program has debug symbols, and by location.
fn described(info: &PanicHookInfo<'_>) -> String {
    let why = caught::message(info.payload());
    let place = info.location().map_or_else(String::new, |at| format!(" at {}:{}", at.file(), at.line()));
    let trace = Backtrace::force_capture().to_string();
    let name = culprit(&trace).map_or_else(String::new, |name| format!(" {name}"));
    format!("the system{name} panicked{place}: {why}")
}

/// The innermost function in a backtrace that belongs neither to this crate nor to its foundations.
fn culprit(trace: &str) -> Option<&str> {
    const OTHERS: [&str; 7] =
        ["std", "core", "alloc", "backtrace", "__rustc", "bevy", "lights_camera_models"];
    let names = trace.lines().filter_map(|line| line.trim_start().split_once(": "));
    let names =
        names.filter(|(number, _)| number.bytes().all(|b| b.is_ascii_digit())).map(|(_, name)| name.trim());
    let is_foreign =
        |name: &&str| crate_of(name).is_some_and(|own| !OTHERS.contains(&own) && !own.starts_with("bevy_"));
    names.into_iter().find(is_foreign)
}

/// The crate at the beginning of a path, such as `velvet` of `<&mut velvet::Spin as Trait>::run`.
fn crate_of(path: &str) -> Option<&str> {
    let (before, _) = path.split_once("::")?;
    let (before, _) = before.split_once('[').unwrap_or((before, ""));
    before.rsplit(|c: char| !c.is_alphanumeric() && c != '_').next().filter(|name| !name.is_empty())
}

fn lost(what: &str, kept: Option<String>) -> String {
    format!("{what}; {}", kept.as_deref().unwrap_or("this window had no unsaved changes"))
}

/// False if the display named in the environment is gone.
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

/// Other systems do not lose their display.
#[cfg(not(target_os = "linux"))]
fn display_answers() -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_function_of_another_crate_is_named() {
        let trace = "   0: std::backtrace::Backtrace::force_capture\n             at /rustc/library/std/src/backtrace.rs:312:9
   1: lights_camera_models::window::ending::described
   2: std::panicking::panic_with_hook
   3: core::panicking::panic_fmt
   4: velvet::systems::spin
             at ./src/systems.rs:12:5
   5: <bevy_ecs::system::function_system::FunctionSystem<M> as System>::run_unsafe
   6: main";
        assert_eq!(culprit(trace), Some("velvet::systems::spin"));
        assert_eq!(culprit("   0: <unknown>\n   1: main\n"), None);
    }

    #[test]
    fn foundations_are_told_by_the_whole_names_of_crates() {
        let innermost = |name: &str| {
            let trace = format!("   0: std::panicking::panic\n   1: {name}\n   2: velvet::outer\n");
            culprit(&trace).map(str::to_owned)
        };
        for own in [
            "corelab::spin",
            "stdio_panel::show",
            "allocator::run",
            "bevyish::turn",
            "rust_lab::f",
            "lights_camera_models_extra::f",
            "<&mut corelab::Spin as bevy_ecs::system::System>::run",
        ] {
            assert_eq!(innermost(own).as_deref(), Some(own));
        }
        for foundation in [
            "core::ops::function::FnOnce::call_once",
            "core[1f2e3d]::ops::function::FnOnce::call_once",
            "alloc::boxed::Box<F>::call",
            "bevy::app::App::run",
            "<bevy_ecs::system::FunctionSystem<F> as System>::run",
            "<F as core::ops::FnOnce<A>>::call_once",
            "__rustc::rust_begin_unwind",
            "rust_begin_unwind",
            "<lights_camera_models::panel::Panels as Show>::show",
        ] {
            assert_eq!(innermost(foundation).as_deref(), Some("velvet::outer"), "{foundation}");
        }
    }
}
