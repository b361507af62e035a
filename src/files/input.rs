//! The inputs of commands: files and streams.

use std::{
    fs,
    io::{self, Read},
    path::Path,
    thread,
    time::{Duration, Instant},
};

use super::{FileError, Kind, options, read};

/// The longest wait for somebody who writes to a named pipe.
const PATIENCE: Duration = Duration::from_secs(2);
/// The time between two attempts to read.
const PAUSE: Duration = Duration::from_millis(5);

/// True if a path leads to something that can be read only once, or without end: a pipe, a device.
#[must_use]
pub fn is_stream(path: &Path) -> bool {
    super::kind(path).is_ok_and(|kind| matches!(kind, Kind::Pipe | Kind::Device))
}

/// The content of what a command line names: as [`read`], but it may be a stream too, such as `/dev/stdin` or the
/// `<(…)` of a shell. Those who write to it are waited for, but not for somebody who might begin to.
///
/// # Errors
/// When it is neither file nor stream, nobody writes to it, more than `limit` bytes come from it, or it cannot be
/// read.
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
    // Whoever writes to a pipe that this process was given is there from the beginning.
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

/// The number of the open file of this process that a path stands for.
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
            // Somebody holds the other end, and says nothing for now.
            Err(e) if e.kind() == io::ErrorKind::WouldBlock => thread::sleep(PAUSE),
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e.into()),
        }
        if bytes.len() as u64 > limit {
            return Err(FileError::TooLarge(limit));
        }
    }
}
