//! Permission to read files outside the folder of a scene: a scene may come from anybody, and cannot grant
//! it.

use std::{
    cell::Cell,
    collections::HashSet,
    path::{Path, PathBuf},
    sync::{
        LazyLock, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

/// The command-line option that grants it for all files.
pub const OPTION: &str = "--allow-outside";

static ALL: AtomicBool = AtomicBool::new(false);
static SOME: LazyLock<Mutex<HashSet<PathBuf>>> = LazyLock::new(Mutex::default);

thread_local! {
    static TRUSTED: Cell<bool> = const { Cell::new(false) };
}

/// Allows scenes to name any file, for the rest of this process.
pub fn allow_all() {
    ALL.store(true, Ordering::Relaxed);
}

/// Allows scenes to name this file, which the user chose, for the rest of this process.
pub(super) fn allow(path: &Path) {
    SOME.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
}

/// Allows a scene written by this program itself to name any file.
pub fn trusting<T>(read: impl FnOnce() -> T) -> T {
    /// Ends it, even after a panic.
    struct Before(bool);
    impl Drop for Before {
        fn drop(&mut self) {
            TRUSTED.set(self.0);
        }
    }
    let _before = Before(TRUSTED.replace(true));
    read()
}

/// True while named files count as chosen.
pub(super) fn is_trusted() -> bool {
    TRUSTED.get()
}

/// True if a file may be read from anywhere.
pub(super) fn is_allowed(path: &Path) -> bool {
    ALL.load(Ordering::Relaxed) || SOME.lock().unwrap_or_else(PoisonError::into_inner).contains(path)
}
