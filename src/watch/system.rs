//! Interprets the operating system's events and errors.

use std::io;

use notify::{
    ErrorKind, EventKind,
    event::{AccessKind, AccessMode},
};

/// True if an event only reports reading.
pub(super) fn is_reading(kind: EventKind) -> bool {
    matches!(kind, EventKind::Access(access) if access != AccessKind::Close(AccessMode::Write))
}

/// The reason why the system does not watch, and the remedy.
pub(super) fn reason(error: &notify::Error) -> String {
    /// "Too many open files", Linux's error at its limit of inotify instances.
    const EMFILE: i32 = 24;
    match &error.kind {
        ErrorKind::MaxFilesWatch => {
            "its limit of watched folders is reached (fs.inotify.max_user_watches)".to_owned()
        }
        ErrorKind::Io(e) if cfg!(target_os = "linux") && e.raw_os_error() == Some(EMFILE) => {
            "its limit of watchers is reached (fs.inotify.max_user_instances)".to_owned()
        }
        ErrorKind::Io(e) => e.to_string(),
        _ => error.to_string(),
    }
}

/// True if a folder could not be watched because it no longer exists.
pub(super) fn is_absent(error: &notify::Error) -> bool {
    match &error.kind {
        ErrorKind::PathNotFound => true,
        ErrorKind::Io(e) => matches!(e.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory),
        _ => false,
    }
}
