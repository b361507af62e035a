//! The folder that graphics drivers expect the environment to name.
//!
//! Where `XDG_RUNTIME_DIR` is not set, as after `su` or on a bare server, Mesa looks for a Wayland display all the same,
//! and the library that it asks prints a line of its own for each attempt. Nothing that can be set within a process
//! keeps it quiet, so the program becomes itself once more (the same process, with the same streams), with the folder
//! named that belongs to this user. It need not exist.

use std::{
    env,
    ffi::OsStr,
    os::unix::{ffi::OsStrExt as _, fs::MetadataExt as _, process::CommandExt as _},
    process::Command,
};

/// The variable that names the folder.
const VARIABLE: &str = "XDG_RUNTIME_DIR";

/// Starts the program anew with the folder in its environment, unless it is there. Returns where that is so, and where
/// starting fails, which costs no more than a few lines on the terminal.
pub(super) fn provide() {
    // What does not begin at the root is taken for nothing.
    let usable = |folder: &OsStr| folder.as_bytes().starts_with(b"/");
    if env::var_os(VARIABLE).is_some_and(|folder| usable(&folder)) {
        return;
    }
    let Some((program, user)) = super::trial::program().zip(std::fs::metadata("/proc/self").ok()) else {
        return;
    };
    let mut arguments = env::args_os();
    let mut again = Command::new(program);
    if let Some(name) = arguments.next() {
        again.arg0(name);
    }
    let _ = again.args(arguments).env(VARIABLE, format!("/run/user/{}", user.uid())).exec();
}
