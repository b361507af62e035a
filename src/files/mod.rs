//! All access to files: the program reads and writes files only through this module.
//!
//! Reading:
//! - [`read`]`(path, limit)`: the content of a regular file, links followed. It never waits: pipes, devices,
//!   sockets and folders are refused before they are opened, and so are files larger than the limit.
//! - [`read_start`]: the first bytes of a file; [`read_range`]: bytes from a position on.
//! - [`identity`]: identifies a file, whatever paths lead to it.
//! - [`listed`]: what lies in a folder under names with an extension.
//! - [`inside`]: checks that a path does not lead out of a folder.
//! - [`read_input`]: a path from the command line, which may also be a stream, such as a shell's `<(…)`.
//!
//! Writing:
//! - [`write()`]`(path, bytes)`: a document, all or nothing, on disk when it returns; [`create`]: a new
//!   document; [`write_all`]: several documents; [`Draft`]: a document in steps. They keep mode, owner,
//!   group, links and hard links, and refuse pipes, devices and sockets.
//! - [`FolderDraft`]: a folder of files, all or nothing.
//! - [`Output`]: the result of a command, such as a picture, which may go to a device or a pipe; [`may_overwrite`] and
//!   [`can_begin`] are called before it is calculated. Hard links to a replaced file keep its old content.
//! - [`spare`]: refuses a result that would replace an input; used by everything that writes results.
//! - [`Before`]: the state of a place when it was examined, so that anything written there meanwhile is kept.
//! - [`tidy`]: removes the leftovers of killed processes from a folder, and finishes their interrupted
//!   writes.
//! - [`give_up`]: removes the temporary files of this process when a signal ends it.
//!
//! Reporting:
//! - [`words()`]: an error of the operating system without its number.
//! - [`printable`]: a text without characters that a terminal would act on, and [`printable_json`], which
//!   keeps JSON valid; [`printable_line`]: on one line; [`Shown`]: a path on one line.
//!
//! # How a file is replaced
//!
//! The new content is first written to a file next to the old one, called `.lcm-XXXXXX.tmp` whatever the
//! other's name, so that names of any length work. It is locked while its process lives. Usually it is then
//! renamed, so a half-written file never exists.
//!
//! Renaming gives the name to another file. The content of the old one is overwritten instead if renaming would
//! separate hard links to a document, or would give the file an owner or group that this user may not restore, provided that this
//! user may write to the file. Because that can be interrupted, the complete copy beside it is first synced and renamed
//! to `.lcm-XXXXXX.INODE-TIME.whole`, with the inode and the modification time of the file to be overwritten. It is
//! removed only when everything is synced. [`tidy`] never treats such a copy as litter. If the file it belongs to is
//! equal to the copy, the overwriting was finished; if it is a prefix of the copy, the overwriting was interrupted, and
//! is repeated; otherwise both are kept and the user is informed.

use std::{
    env, fmt,
    io::{self, Read as _, Seek as _, SeekFrom},
    path::{Path, PathBuf},
};

use crate::{
    declared::texts,
    platform::{
        self,
        fs::{self, File, FileType, Metadata, OpenOptions},
    },
};

mod before;
mod draft;
mod folder;
mod input;
mod inside;
mod litter;
mod living;
mod output;
mod overwrite;
mod shown;
mod stamp;
mod typed;
mod words;

pub use before::Before;
pub use draft::{Draft, create, write, write_all};
pub use folder::{FolderDraft, clear, in_folder, take_back};
pub use input::{is_descriptor, is_stream, read_input};
pub use inside::inside;
pub use litter::{Unfinished, tidy};
pub use living::give_up;
pub use output::{
    EXR, HDR, Output, PICTURES, PNG, Refused, Signature, can_begin, may_overwrite, may_replace, spare,
};
pub use shown::{OnOneLine, Shown, printable, printable_json, printable_line};
pub use stamp::Stamp;
pub use typed::{meant, without_detours};
pub use words::words;

texts! {
    /// The kind of file or other item to which a path leads.
    Kind(
        /// The kind, with its article.
        name
    ) {
        /// A regular file.
        File = "a file",
        /// A folder.
        Folder = "a folder",
        /// A named pipe, or an anonymous one to another program.
        Pipe = "a named pipe",
        /// A socket.
        Socket = "a socket",
        /// A device: a terminal, a disk, `/dev/null`.
        Device = "a device",
        /// Something else.
        Unknown = "something unknown",
    }
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
        f.write_str(self.name())
    }
}

/// An error in reading or writing a file. The text follows the file name: "c.json could not be read: …".
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The path leads to something other than a regular file.
    #[error("it is {0}, but it must be a file")]
    Kind(Kind),
    /// The file exceeds the caller's limit.
    #[error("it is larger than {}", size(*.0))]
    TooLarge(u64),
    /// The file was only partly overwritten; the new content is complete in another file.
    #[error("{}; it is incomplete now; its complete new content is in {}", words(.error), .copy.shown())]
    Unfinished {
        /// The file with the complete content.
        copy: PathBuf,
        /// The error of the operating system.
        error: io::Error,
    },
    /// The place has changed since it was examined.
    #[error("another program wrote there in the meantime")]
    Taken,
    /// The path is not in the folder in which it must be.
    #[error("it is outside the folder {}", .0.shown())]
    Outside(PathBuf),
    /// An error of the operating system.
    #[error("{}", words(.0))]
    Io(#[from] io::Error),
}

impl From<FileError> for io::Error {
    fn from(error: FileError) -> Self {
        let kind = match error {
            FileError::Io(error) => return error,
            FileError::Kind(Kind::Folder) => io::ErrorKind::IsADirectory,
            FileError::Kind(_) => io::ErrorKind::InvalidInput,
            FileError::TooLarge(_) => io::ErrorKind::FileTooLarge,
            FileError::Taken => io::ErrorKind::AlreadyExists,
            FileError::Outside(_) => io::ErrorKind::PermissionDenied,
            FileError::Unfinished { ref error, .. } => error.kind(),
        };
        Self::new(kind, error.to_string())
    }
}

/// The message for a file without a byte, such as one whose writing failed.
pub const EMPTY: &str = "the file is empty";

/// A limit as displayed; that of a format of one length is its length.
fn size(bytes: u64) -> String {
    match bytes {
        _ if !bytes.is_multiple_of(1 << 10) => format!("{bytes} bytes"),
        _ if bytes >= 1 << 20 => format!("{} MiB", bytes >> 20),
        _ => format!("{} KiB", bytes >> 10),
    }
}

/// The kind of file to which a path leads, links followed.
///
/// # Errors
/// Returns an error if the path does not exist, or cannot be examined.
pub fn kind(path: &Path) -> io::Result<Kind> {
    Ok(Kind::of(fs::metadata(path)?.file_type()))
}

/// The content of a regular file, links followed.
///
/// # Errors
/// Returns an error if the path is not a regular file, or if the file is larger than `limit` bytes or cannot
/// be read.
pub fn read(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let (file, length) = open_to_read(path)?;
    if length > limit {
        return Err(FileError::TooLarge(limit));
    }
    let mut bytes = Vec::with_capacity(length as usize);
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    // It may have grown, and some files do not report their length.
    if bytes.len() as u64 > limit { Err(FileError::TooLarge(limit)) } else { Ok(bytes) }
}

/// The first bytes of a regular file, links followed: as many as requested, or all of a shorter file.
///
/// # Errors
/// Returns an error if the path is not a regular file, or cannot be read.
pub fn read_start(path: &Path, length: u64) -> Result<Vec<u8>, FileError> {
    read_range(path, 0, length)
}

/// Bytes of a regular file from a position on, links followed: as many as requested, or all that remain.
///
/// # Errors
/// Returns an error if the path is not a regular file, or cannot be read.
pub fn read_range(path: &Path, from: u64, length: u64) -> Result<Vec<u8>, FileError> {
    let (mut file, _) = open_to_read(path)?;
    file.seek(SeekFrom::Start(from))?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The file of the running program, for starting it again or copying it.
#[must_use]
pub fn program() -> Option<PathBuf> {
    // This name stays valid when the file is replaced or removed, for example by a new build.
    let own = PathBuf::from("/proc/self/exe");
    if cfg!(target_os = "linux") && fs::is_there(&own) { Some(own) } else { env::current_exe().ok() }
}

/// Opens a regular file, and returns its reported length.
fn open_to_read(path: &Path) -> Result<(File, u64), FileError> {
    // Opening alone can have effects: a pipe waits for a writer, a tape is rewound.
    regular(&fs::metadata(path)?)?;
    let file = options().read(true).open(path)?;
    // Something else may have taken its place meanwhile.
    let metadata = file.metadata()?;
    regular(&metadata)?;
    Ok((file, metadata.len()))
}

/// Options that prevent waiting on opening, and a terminal from becoming this process's controlling terminal.
#[cfg_attr(not(unix), allow(unused_mut))]
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
    platform::file_id(a).is_some_and(|a| platform::file_id(b) == Some(a))
}

/// Identifies a file, whatever paths lead to it.
pub type Identity = platform::FileId;

/// The identity of a regular file, links followed, and its length in bytes.
#[must_use]
pub fn identity(path: &Path) -> Option<(Identity, u64)> {
    let metadata = fs::metadata(path).ok()?;
    regular(&metadata).ok()?;
    Some((platform::file_id(path)?, metadata.len()))
}

/// What lies in a folder under names with an extension, by name, at most `most`, and true if there is more: hidden names are
/// left out; folders, pipes and dangling links are not. Nothing if the folder does not exist.
///
/// # Errors
/// Returns an error if the folder cannot be read.
pub fn listed(folder: &Path, extension: &str, most: usize) -> io::Result<(Vec<PathBuf>, bool)> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok((Vec::new(), false)),
        Err(error) => return Err(error),
    };
    let (mut names, mut more) = (Vec::new(), false);
    for entry in entries {
        let path = entry?.path();
        let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if path.extension().is_some_and(|of| of == extension) && !hidden {
            if names.len() == most {
                more = true;
                break;
            }
            names.push(path);
        }
    }
    names.sort();
    Ok((names, more))
}

/// What links in a circle are, whoever follows them.
const CIRCLE: &str = "too many links, each leading to the next";

/// The end of a path, links followed; it need not exist.
///
/// # Errors
/// Returns an error if links form a cycle.
pub fn follow(path: &Path) -> io::Result<PathBuf> {
    let mut at = path.to_owned();
    // The limit of Linux.
    for _ in 0..40 {
        match fs::read_link(&at) {
            Ok(target) => at = at.parent().unwrap_or(Path::new("")).join(target),
            // Not a link, or nonexistent.
            Err(_) => return Ok(at),
        }
    }
    Err(io::Error::other(CIRCLE))
}

/// The reason why nothing can be made in a folder, where the system says that it is not there.
fn missing(folder: &Path) -> io::Error {
    let is_gone = || env::current_dir().is_err_and(|error| error.kind() == io::ErrorKind::NotFound);
    let folder = if folder.is_relative() && is_gone() {
        "the working folder has been deleted".to_owned()
    } else if fs::is_dir(folder) {
        // As in /proc.
        format!("{} is a folder of the system in which no files can be created", folder.shown())
    } else {
        format!("there is no folder {}", folder.shown())
    };
    io::Error::new(io::ErrorKind::NotFound, folder)
}

/// The folder that contains a file.
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

/// True if two descriptions are of one file, or if that is unknown.
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    let [a, b] = [a, b].map(Node::of);
    (a.device, a.inode) == (b.device, b.inode)
}

/// The identity, owner and links of a file on Unix; on other systems, all files are alike.
pub(crate) struct Node {
    device: u64,
    pub(crate) inode: u64,
    owner: u32,
    /// The number of hard links.
    links: u64,
}

impl Node {
    #[cfg_attr(not(unix), allow(unused_variables))]
    pub(crate) fn of(metadata: &Metadata) -> Self {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt as _;
            let (device, inode) = (metadata.dev(), metadata.ino());
            Self { device, inode, owner: metadata.uid(), links: metadata.nlink() }
        }
        #[cfg(not(unix))]
        Self { device: 0, inode: 0, owner: 0, links: 1 }
    }
}
