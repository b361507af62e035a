//! The folder that graphics drivers expect in the environment.
//!
//! Without `XDG_RUNTIME_DIR`, as after `su` or on a bare server, Mesa still looks for a Wayland display, and
//! the library that it calls prints a line for each attempt. Nothing that can be set within a process
//! silences it, so the program restarts itself (the same process, with the same streams) with this user's
//! folder in the variable. The folder need not exist.

use std::{
    env,
    ffi::OsStr,
    os::unix::{ffi::OsStrExt as _, fs::MetadataExt as _, process::CommandExt as _},
    process::Command,
};

/// Variable with the folder.
const VARIABLE: &str = "XDG_RUNTIME_DIR";

/// Restarts the program with the folder in its environment, unless it is already there. Returns if it is, or
/// if restarting fails, which costs only a few lines on the terminal.
pub(super) fn provide() {
    // Relative paths count as unset.
    let usable = |folder: &OsStr| folder.as_bytes().starts_with(b"/");
    if env::var_os(VARIABLE).is_some_and(|folder| usable(&folder)) {
        return;
    }
    let Some((program, user)) = crate::files::program().zip(std::fs::metadata("/proc/self").ok()) else {
        return;
    };
    let mut arguments = env::args_os();
    let mut again = Command::new(program);
    if let Some(name) = arguments.next() {
        again.arg0(name);
    }
    let _ = again.args(arguments).env(VARIABLE, format!("/run/user/{}", user.uid())).exec();
}
