//! A browser: one thread that must never wait, and no files but those that the page brings along.

use std::{
    ffi::OsString,
    io,
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

mod address;
pub mod fs;
mod page;
mod tabs;
pub mod temporary;
#[cfg(feature = "window")]
mod window;
mod work;

pub use page::report_panics;
#[cfg(feature = "window")]
pub use window::*;
pub use work::{Worker, beside, later, on_stack, once, receive};

/// True if other programs than this one change files, too.
pub const SHARES_FILES: bool = false;
/// True if the program can start others, itself included.
pub const HAS_PROGRAMS: bool = false;
/// True if the program goes on after a panic, and after its window is closed.
pub const OUTLIVES_WINDOW: bool = false;
/// True if what is copied is on the clipboard at once. Otherwise, the notices tell.
pub const COPIES_AT_ONCE: bool = false;
/// True if a call can wait for the GPU.
pub const WAITS_FOR_GPU: bool = false;

/// What identifies a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(u64);

/// What identifies a file, whatever paths lead to it.
#[must_use]
pub fn file_id(path: &Path) -> Option<FileId> {
    fs::metadata(path).ok().map(|there| FileId(there.id()))
}

/// The present time.
#[must_use]
pub fn now() -> SystemTime {
    let since = web_time::SystemTime::now().duration_since(web_time::UNIX_EPOCH);
    SystemTime::UNIX_EPOCH + since.unwrap_or(Duration::ZERO)
}

/// The number of this tab.
#[must_use]
pub fn process() -> u32 {
    page::process()
}

/// The folder for temporary files.
#[must_use]
pub fn temporary_folder() -> PathBuf {
    PathBuf::from("/tmp")
}

/// The folder of a program for what it keeps for its user.
#[must_use]
pub fn data_folder(_name: &str) -> Option<PathBuf> {
    Some(PathBuf::from(fs::DATA))
}

/// The folder of a program for its settings.
#[must_use]
pub fn settings_folder(_name: &str) -> Option<PathBuf> {
    Some(PathBuf::from(fs::DATA))
}

/// Calls a function after this tab or another one has changed files.
pub fn tell_of_changes(wake: impl Fn() + Send + Sync + 'static) {
    fs::tell_of_changes(wake);
}

/// The files that this tab or another one has changed since the last call.
#[must_use]
pub fn own_changes() -> Vec<PathBuf> {
    fs::own_changes()
}

/// Counts a file as changed.
pub fn note_change(path: &Path) {
    fs::note_change(path);
}

/// The folder for results, if it is not that of the scene.
#[must_use]
pub fn results_folder() -> Option<PathBuf> {
    Some(PathBuf::from(fs::DOWNLOADS))
}

/// The command line that the address of the page means: `?scene=NAME` opens an example or a scene of the site, `#scene=1.…`
/// the scene that it holds, `?lesson=NAME&step=2` a lesson.
pub fn arguments() -> impl Iterator<Item = OsString> {
    address::arguments(&page::query(), &page::fragment()).into_iter().map(OsString::from)
}

/// The address of the page, without what may follow in it.
#[must_use]
pub fn page_address() -> Option<String> {
    Some(page::place())
}

/// What the page has loaded of its site because its address gives this name: the content, or why there is none.
#[must_use]
pub fn loaded(name: &str) -> Option<Result<Vec<u8>, String>> {
    page::loaded_bytes(name).map(Ok).or_else(|| page::load_problem(name).map(Err))
}

/// Tells whoever watches the program a line.
pub fn tell(line: &str) {
    page::tell(line);
}

/// There are no signals in a browser.
///
/// # Errors
/// Returns none.
pub fn listen(_goes_on: impl Fn(&str, bool) -> bool + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// There are no signals in a browser.
pub fn end_by_interrupt() {}
