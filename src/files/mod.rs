//! The one guard between the program and files: everything that is read or written goes through here, and nothing
//! else in the program opens a file.
//!
//! To read:
//! - [`read`]`(path, limit)`: the content of a regular file, links followed. It never waits: pipes, devices,
//!   sockets and folders are refused before they are opened, and so is what is larger than the limit.
//! - [`read_start`]: its first bytes.
//! - [`read_input`]: for what a command line names, which may also be a stream, such as `<(…)` of a shell.
//!
//! To write:
//! - [`write()`]`(path, bytes)`: a document, all or nothing, on disk when it returns; [`create`]: the same where
//!   there must be none yet; [`Draft`]: the same in steps. They keep mode, owner, group, links and hard links, and
//!   refuse pipes, devices and sockets.
//! - [`Output`]: the result of a command, which may go to a device or a pipe; [`may_overwrite`] is asked before it
//!   is calculated.
//! - [`tidy`]: removes what killed processes left in a folder, and finishes what they could not.
//!
//! To tell of it:
//! - [`printable`]: a text without what a terminal would obey.
//!
//! # How a file is replaced
//!
//! The new content is first written to a file beside it, called `.lcm-XXXXXX.tmp` whatever the name of the other is,
//! so that names of any length can be written. It is locked as long as its process lives. Usually it is then
//! renamed, so that there is never half a file.
//!
//! Renaming gives the name to another file. Where that would part hard links, or give the file to another owner or
//! group than this user may restore, and where this user may write to the file, its content is overwritten instead.
//! Because that can be interrupted, the complete copy beside it is first synced and renamed to
//! `.lcm-XXXXXX.INODE-TIME.whole`, with the inode of the file that is overwritten and when that last changed. It is
//! only removed when all is synced.
//! [`tidy`] never takes such a copy for litter. If the file it belongs to is as long as the copy and equal to it, all
//! was done; if it is a beginning of the copy, the overwriting was interrupted, and is done again; otherwise both are
//! left alone and the user is told.

use std::{
    fmt,
    fs::{self, File, FileType, Metadata, OpenOptions},
    io::{self, Read as _},
    path::{Path, PathBuf},
};

mod draft;
mod input;
mod litter;
mod output;
mod shown;

pub use draft::{Draft, create, write};
pub use input::{is_descriptor, is_stream, read_input};
pub use litter::{Unfinished, tidy};
pub use output::{Output, PNG, Refused, Signature, may_overwrite};
pub use shown::printable;

/// The kind of thing that a path leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A regular file.
    File,
    /// A folder.
    Folder,
    /// A named pipe, or one that another program writes to.
    Pipe,
    /// A socket.
    Socket,
    /// A device: a terminal, a disk, `/dev/null`.
    Device,
    /// Something else.
    Unknown,
}

impl Kind {
    /// The kind of a file type.
    #[must_use]
    pub fn of(kind: FileType) -> Self {
        #[cfg(unix)]
        {
            use std::os::unix::fs::FileTypeExt as _;
            if kind.is_fifo() {
                return Self::Pipe;
            }
            if kind.is_socket() {
                return Self::Socket;
            }
            if kind.is_char_device() || kind.is_block_device() {
                return Self::Device;
            }
        }
        if kind.is_file() {
            Self::File
        } else if kind.is_dir() {
            Self::Folder
        } else {
            Self::Unknown
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::File => "a file",
            Self::Folder => "a folder",
            Self::Pipe => "a named pipe",
            Self::Socket => "a socket",
            Self::Device => "a device",
            Self::Unknown => "something unknown",
        })
    }
}

/// A failure to read or write a file. Its text follows the name of the file: "c.json could not be read: …".
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The path leads to something that is no regular file.
    #[error("it is {0}, but it must be a file")]
    Kind(Kind),
    /// It is larger than what was asked for can be.
    #[error("it is larger than {}", size(*.0))]
    TooLarge(u64),
    /// It was overwritten in part only; the new content is whole in another file.
    #[error("{error}; it is incomplete now, and its whole new content is in {}", .copy.display())]
    Unfinished {
        /// The file that holds the whole content.
        copy: PathBuf,
        /// The failure of the operating system.
        error: io::Error,
    },
    /// A failure of the operating system.
    #[error("{0}")]
    Io(#[from] io::Error),
}

impl From<FileError> for io::Error {
    fn from(error: FileError) -> Self {
        let kind = match &error {
            FileError::Kind(Kind::Folder) => io::ErrorKind::IsADirectory,
            FileError::Kind(_) => io::ErrorKind::InvalidInput,
            FileError::TooLarge(_) => io::ErrorKind::FileTooLarge,
            FileError::Unfinished { error, .. } => error.kind(),
            FileError::Io(_) => io::ErrorKind::Other,
        };
        match error {
            FileError::Io(error) => error,
            error => Self::new(kind, error.to_string()),
        }
    }
}

/// A limit as people read it.
fn size(bytes: u64) -> String {
    if bytes >= 1 << 20 { format!("{} MiB", bytes >> 20) } else { format!("{} KiB", bytes >> 10) }
}

/// The kind of thing that a path leads to, links followed.
///
/// # Errors
/// When there is nothing, or it cannot be looked at.
pub fn kind(path: &Path) -> io::Result<Kind> {
    Ok(Kind::of(fs::metadata(path)?.file_type()))
}

/// The content of a regular file, links followed.
///
/// # Errors
/// When it is no regular file, is larger than `limit` bytes, or cannot be read.
pub fn read(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let (file, length) = open_to_read(path)?;
    if length > limit {
        return Err(FileError::TooLarge(limit));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    // It may have grown, and some files do not say how long they are.
    if bytes.len() as u64 > limit { Err(FileError::TooLarge(limit)) } else { Ok(bytes) }
}

/// The first bytes of a regular file, links followed: as many as asked for, or all there are.
///
/// # Errors
/// When it is no regular file or cannot be read.
pub fn read_start(path: &Path, length: u64) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    open_to_read(path)?.0.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Opens a regular file, and says how long it claims to be.
fn open_to_read(path: &Path) -> Result<(File, u64), FileError> {
    // Opening alone can have effects: a pipe waits for a writer, a tape is wound back.
    regular(&fs::metadata(path)?)?;
    let file = options().read(true).open(path)?;
    // Something else may have taken its place meanwhile.
    let metadata = file.metadata()?;
    regular(&metadata)?;
    Ok((file, metadata.len()))
}

/// Options that never make opening wait, nor a terminal the one of this process.
fn options() -> OpenOptions {
    let mut options = OpenOptions::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt as _;
        options.custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY);
    }
    options
}

/// True if both paths lead to one file, by links or hard links.
#[must_use]
pub fn same(a: &Path, b: &Path) -> bool {
    matches!((file_id::get_file_id(a), file_id::get_file_id(b)), (Ok(a), Ok(b)) if a == b)
}

/// The end of a path, links followed; nothing need be there.
///
/// # Errors
/// When links lead in a circle.
pub fn follow(path: &Path) -> io::Result<PathBuf> {
    let mut at = path.to_owned();
    // As many as Linux follows.
    for _ in 0..40 {
        match fs::read_link(&at) {
            Ok(target) => at = at.parent().unwrap_or(Path::new("")).join(target),
            // Not a link, or nothing there.
            Err(_) => return Ok(at),
        }
    }
    Err(io::Error::other("too many links, each leading to the next"))
}

/// The folder of a file.
#[must_use]
pub fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn regular(metadata: &Metadata) -> Result<(), FileError> {
    match Kind::of(metadata.file_type()) {
        Kind::File => Ok(()),
        kind => Err(FileError::Kind(kind)),
    }
}

/// True if two descriptions are of one file; where that cannot be told, true.
#[cfg_attr(not(unix), allow(unused_variables))]
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt as _;
        (a.dev(), a.ino()) == (b.dev(), b.ino())
    }
    #[cfg(not(unix))]
    true
}
