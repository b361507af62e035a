//! The results of commands: destinations, and how to write them.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    thread,
    time::Duration,
};

use web_time::Instant;

use super::shown::Shown as _;
use super::{
    Draft, FileError, Kind, folder::missing_folders, folder_of, in_folder, input::descriptor, kind, options,
    read_start, same,
};
use crate::platform::fs::{self, File};

/// Maximum wait for a reader of a named pipe.
#[cfg(unix)]
const PATIENCE: Duration = Duration::from_secs(10);
/// The time between two attempts to write.
const PAUSE: Duration = Duration::from_millis(1);

/// The first bytes of files of a format.
#[derive(Clone, Copy, Debug)]
pub struct Signature {
    /// The name of the format: "a PNG file".
    pub what: &'static str,
    /// The first bytes.
    pub begins: &'static [u8],
}

impl Signature {
    /// True if a path leads to a regular file with this signature.
    #[must_use]
    pub fn begins(&self, path: &Path) -> bool {
        read_start(path, self.begins.len() as u64).is_ok_and(|start| start == self.begins)
    }
}

/// PNG pictures.
pub const PNG: Signature = Signature { what: "a PNG file", begins: b"\x89PNG\r\n\x1a\n" };
/// OpenEXR pictures.
pub const EXR: Signature = Signature { what: "an OpenEXR file", begins: b"\x76\x2f\x31\x01" };
/// Radiance pictures, whose first line has `#?RADIANCE` or `#?RGBE`.
pub const HDR: Signature = Signature { what: "a Radiance file", begins: b"#?R" };
/// Pictures in which a scene may be.
pub const PICTURES: [Signature; 3] = [PNG, EXR, HDR];

/// The reason why an output must not be written.
#[derive(Debug, thiserror::Error)]
pub enum Refused {
    /// The output is one of the inputs, or a folder that contains one.
    #[error("{} {}; it was not overwritten", .output.shown(), overlap(.output, .input))]
    Input {
        /// The output.
        output: PathBuf,
        /// The input that is the same file, or in the folder.
        input: PathBuf,
    },
    /// The existing file has another format.
    #[error("{} exists and is not {what}; it was not overwritten", .output.shown())]
    Foreign {
        /// The output.
        output: PathBuf,
        /// The required format.
        what: &'static str,
    },
    /// The existing file cannot be examined.
    #[error("{} exists and could not be examined ({error}); it was not overwritten", .output.shown())]
    Unknown {
        /// The output.
        output: PathBuf,
        /// The reason.
        error: FileError,
    },
    /// The file exists, and the user did not agree to replace it.
    #[error("{} exists; choose it in the list of files to replace it", .output.shown())]
    Exists {
        /// The output.
        output: PathBuf,
    },
}

fn overlap(output: &Path, input: &Path) -> String {
    // The program is named by its whole path.
    if matches!((fs::absolute(output), fs::absolute(input)), (Ok(output), Ok(input)) if output == input) {
        "is read by this command".to_owned()
    } else if fs::is_dir(output) {
        format!("holds {}, which is read by this command", input.shown())
    } else {
        format!("is the same file as {}, which is read by this command", input.shown())
    }
}

/// Refuses a result that would replace an input of its command, by whatever path, link or hard link, or a
/// folder that contains one. Everything that writes results calls this first.
///
/// # Errors
/// Returns an error if the result would replace an input.
pub fn spare<'a>(output: &Path, inputs: impl IntoIterator<Item = &'a Path>) -> Result<(), Refused> {
    // Files opened by the shell for this process are the shell's responsibility.
    if descriptor(output).is_some() {
        return Ok(());
    }
    let folder = fs::canonicalize(output).ok().filter(|whole| whole.is_dir());
    let holds = |input: &Path| match &folder {
        Some(folder) => fs::canonicalize(input).is_ok_and(|input| input.starts_with(folder)),
        None => kind(output).is_ok_and(|kind| kind == Kind::File) && same(input, output),
    };
    match inputs.into_iter().find(|input| holds(input)) {
        Some(input) => Err(Refused::Input { output: output.to_owned(), input: input.to_owned() }),
        None => Ok(()),
    }
}

/// Checks that a result may be written to a path. An existing file must have the same format, so that nothing
/// else is lost, and must not be an input, not even through links. An empty file or a device has nothing to
/// lose.
///
/// # Errors
/// Returns an error if the result must not be written there.
pub fn may_overwrite<'a>(
    output: &Path,
    sort: Signature,
    inputs: impl IntoIterator<Item = &'a Path>,
) -> Result<(), Refused> {
    // Nothing is lost if the path cannot be resolved; other problems appear on writing.
    if !kind(output).is_ok_and(|kind| kind == Kind::File) || descriptor(output).is_some() {
        return Ok(());
    }
    spare(output, inputs)?;
    let owned = || output.to_owned();
    match read_start(output, sort.begins.len() as u64) {
        Ok(start) if start.is_empty() || start == sort.begins => Ok(()),
        Ok(_) => Err(Refused::Foreign { output: owned(), what: sort.what }),
        Err(error) => Err(Refused::Unknown { output: owned(), error }),
    }
}

/// Checks the same for a window, in which the user agrees to replace the file, or not.
///
/// # Errors
/// Returns [`Refused::Exists`] if nothing but the user's consent is missing, or else the errors of [`may_overwrite`].
pub fn may_replace(output: &Path, sort: Signature, agreed: bool, inputs: &[PathBuf]) -> Result<(), Refused> {
    may_overwrite(output, sort, inputs.iter().map(PathBuf::as_path))?;
    match agreed || !fs::is_there(output) {
        true => Ok(()),
        false => Err(Refused::Exists { output: output.to_owned() }),
    }
}

/// Tries to begin a result where [`Output::put`] would write it, and leaves nothing behind: before it is calculated.
///
/// # Errors
/// Returns the error that [`Output::put`] would return: of folders that cannot be made or written to, and of places that
/// are no files. Devices and pipes are not opened.
pub fn can_begin(path: &Path) -> Result<(), FileError> {
    if descriptor(path).is_some() || matches!(kind(path), Ok(Kind::Pipe | Kind::Device)) {
        return Ok(());
    }
    // Missing folders are not made: another process might count on one that is removed again.
    let missing = missing_folders(folder_of(path))?;
    Draft::fleeting(missing.last().unwrap_or(&path)).map(drop)
}

/// The destination of a result: a file, which appears complete or not at all, or standard output, a device or a pipe.
#[derive(Debug)]
pub enum Output {
    /// A file; [`finish`](Self::finish) puts it in place.
    File(Draft),
    /// Standard output.
    Standard(io::Stdout),
    /// A device or a pipe.
    Stream(File),
}

impl Output {
    /// Opens a destination. A pipe gets some time to find a reader.
    ///
    /// # Errors
    /// Returns an error if the path is a folder or a socket, if a pipe has no reader, or if it cannot be
    /// written to.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        // An inherited descriptor is written to directly, even if it leads to a file, which may hold more.
        if descriptor(path) == Some("1") {
            return Ok(Self::Standard(io::stdout()));
        }
        match kind(path) {
            Ok(Kind::File) | Err(_) if descriptor(path).is_none() => Draft::fleeting(path).map(Self::File),
            Ok(kind @ (Kind::File | Kind::Pipe | Kind::Device)) => stream(path, kind).map(Self::Stream),
            Ok(kind) => Err(FileError::Kind(kind)),
            Err(error) => Err(error.into()),
        }
    }

    /// Writes a whole result, as every command does: missing folders are created, and removed again if the result cannot
    /// be written.
    ///
    /// # Errors
    /// Returns the errors of [`open`](Self::open) and of `write`.
    pub fn put(path: &Path, write: impl FnOnce(&mut Self) -> io::Result<()>) -> io::Result<()> {
        in_folder(folder_of(path), || {
            let mut output = Self::open(path)?;
            write(&mut output)?;
            Ok(output.finish()?)
        })
    }

    /// Finishes writing.
    ///
    /// # Errors
    /// Returns any error of the operating system.
    pub fn finish(mut self) -> Result<(), FileError> {
        self.flush()?;
        match self {
            Self::File(draft) => draft.replace(),
            Self::Standard(_) | Self::Stream(_) => Ok(()),
        }
    }
}

/// Opens a destination for direct writing.
#[cfg_attr(not(unix), allow(unused_variables))]
fn stream(path: &Path, kind: Kind) -> Result<File, FileError> {
    let begin = Instant::now();
    loop {
        match options().write(true).open(path) {
            // A pipe without a reader.
            #[cfg(unix)]
            Err(e) if kind == Kind::Pipe && e.raw_os_error() == Some(libc::ENXIO) => {
                if begin.elapsed() > PATIENCE {
                    return Err(io::Error::other("no process reads from it").into());
                }
                thread::sleep(PAUSE);
            }
            opened => return Ok(opened?),
        }
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File(draft) => draft.write(bytes),
            Self::Standard(out) => out.write(bytes),
            Self::Stream(file) => loop {
                match file.write(bytes) {
                    // The pipe is full for now.
                    Err(e) if e.kind() == io::ErrorKind::WouldBlock => thread::sleep(PAUSE),
                    done => return done,
                }
            },
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File(draft) => draft.flush(),
            Self::Standard(out) => out.flush(),
            Self::Stream(file) => file.flush(),
        }
    }
}
