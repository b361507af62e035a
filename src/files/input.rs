//! The inputs of commands: files and streams.

use std::{
    io::{self, Read},
    path::Path,
    thread,
    time::Duration,
};

use web_time::Instant;

use super::{FileError, Kind, options, read};
use crate::platform::fs;

/// Maximum wait for a writer of a named pipe.
const PATIENCE: Duration = Duration::from_secs(2);
/// The time between two attempts to read.
const PAUSE: Duration = Duration::from_millis(5);

/// True if a path leads to something that can be read only once, or without end: a pipe, a device.
#[must_use]
pub fn is_stream(path: &Path) -> bool {
    super::kind(path).is_ok_and(|kind| matches!(kind, Kind::Pipe | Kind::Device))
}

/// The content of a path from the command line: as [`read`], but streams such as `/dev/stdin` or a shell's
/// `<(…)` are allowed too. It waits for processes that write to the stream, but not for one that might start
/// to.
///
/// # Errors
/// Returns an error if the path is neither a file nor a stream, if the stream has no writer, if there are
/// more than `limit` bytes, or if it cannot be read.
pub fn read_input(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let kind = Kind::of(fs::metadata(path)?.file_type());
    match kind {
        Kind::Pipe | Kind::Device => {}
        _ => return read(path, limit),
    }
    if descriptor(path) == Some("0") {
        return read_all(io::stdin().lock(), limit, Duration::ZERO);
    }
    let stream = options().read(true).open(path)?;
    if Kind::of(stream.metadata()?.file_type()) != kind {
        return Err(io::Error::other("it changed while it was opened").into());
    }
    // A pipe inherited by this process has its writers from the start.
    let patience = if kind == Kind::Pipe && descriptor(path).is_none() { PATIENCE } else { Duration::ZERO };
    match read_all(stream, limit, patience)? {
        bytes if bytes.is_empty() && !patience.is_zero() => Err(FileError::Kind(kind)),
        bytes => Ok(bytes),
    }
}

/// True if a path stands for a file that this process has open, such as `/dev/stdout`.
#[must_use]
pub fn is_descriptor(path: &Path) -> bool {
    descriptor(path).is_some()
}

/// The descriptor for which a path stands.
pub(super) fn descriptor(path: &Path) -> Option<&str> {
    let path = path.to_str()?;
    match path {
        "/dev/stdin" => Some("0"),
        "/dev/stdout" => Some("1"),
        "/dev/stderr" => Some("2"),
        _ => path.strip_prefix("/dev/fd/").or_else(|| path.strip_prefix("/proc/self/fd/")),
    }
}

/// Reads to the end; an end before the first byte counts only after some patience.
fn read_all(mut from: impl Read, limit: u64, patience: Duration) -> Result<Vec<u8>, FileError> {
    let begin = Instant::now();
    let mut bytes = Vec::new();
    let mut piece = vec![0; 1 << 16];
    loop {
        match from.read(&mut piece) {
            Ok(0) if bytes.is_empty() && begin.elapsed() < patience => thread::sleep(PAUSE),
            Ok(0) => return Ok(bytes),
            Ok(n) => bytes.extend_from_slice(&piece[..n]),
            // A writer exists, but has not written anything yet.
            Err(e) if e.kind() == io::ErrorKind::WouldBlock => thread::sleep(PAUSE),
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e.into()),
        }
        if bytes.len() as u64 > limit {
            return Err(FileError::TooLarge(limit));
        }
    }
}
