//! The desktop: threads, files, processes.

use std::{
    env,
    ffi::OsString,
    io::{self, Write as _},
    path::{Path, PathBuf},
    process,
    time::SystemTime,
};

pub mod fs;
mod identity;
mod signals;
pub mod temporary;
#[cfg(feature = "window")]
mod window;
mod work;

pub use identity::{FileId, file_id};
pub use signals::{end_by_interrupt, listen};
#[cfg(feature = "window")]
pub use window::*;
pub use work::{Worker, beside, later, on_stack, once, receive};

/// True if other programs than this one change files, too.
pub const SHARES_FILES: bool = true;
/// True if the program can start others, itself included.
pub const HAS_PROGRAMS: bool = true;
/// True if the program goes on after a panic, and after its window is closed.
pub const OUTLIVES_WINDOW: bool = true;
/// True if what is copied is on the clipboard at once. Otherwise, the notices tell.
pub const COPIES_AT_ONCE: bool = true;
/// True if a call can wait for the GPU.
pub const WAITS_FOR_GPU: bool = true;

/// The present time.
#[must_use]
pub fn now() -> SystemTime {
    SystemTime::now()
}

/// The number of this process.
#[must_use]
pub fn process() -> u32 {
    process::id()
}

/// The folder for temporary files.
#[must_use]
pub fn temporary_folder() -> PathBuf {
    env::temp_dir()
}

/// The folder of a program for what it keeps for its user.
#[must_use]
pub fn data_folder(name: &str) -> Option<PathBuf> {
    Some(directories::ProjectDirs::from("", "", name)?.data_dir().to_owned())
}

/// The folder of a program for its settings.
#[must_use]
pub fn settings_folder(name: &str) -> Option<PathBuf> {
    Some(directories::ProjectDirs::from("", "", name)?.config_dir().to_owned())
}

/// The operating system tells of changed files.
pub fn tell_of_changes(_wake: impl Fn() + Send + Sync + 'static) {}

/// The operating system tells of changed files.
#[must_use]
pub fn own_changes() -> Vec<PathBuf> {
    Vec::new()
}

/// The operating system tells of changed files.
pub fn note_change(_path: &Path) {}

/// The folder for results, if it is not that of the scene.
#[must_use]
pub fn results_folder() -> Option<PathBuf> {
    None
}

/// The command line, of which the first is the name of the program.
pub fn arguments() -> impl Iterator<Item = OsString> {
    env::args_os()
}

/// There is no page.
#[must_use]
pub fn page_address() -> Option<String> {
    None
}

/// There is no page that has loaded anything.
#[must_use]
pub fn loaded(_name: &str) -> Option<Result<Vec<u8>, String>> {
    None
}

/// Prepares to report panics, which the standard library does.
pub fn report_panics() {}

/// Tells whoever watches the program a line. A missing reader must not cause a panic.
pub fn tell(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}
