//! Reading scene files: from bytes on disk to a checked [`Scene`], with an error for everything that can be
//! wrong and a list of missing parts.

use std::{
    collections::BTreeSet,
    hash::{DefaultHasher, Hash as _, Hasher as _},
    io::Read,
    path::Path as FilePath,
};

use super::{
    Scene,
    error::LoadError,
    formats::{self, Source},
};
use crate::files::Shown as _;
use crate::{
    files::{self, FileError},
    parameter::Outside,
    registry::Registry,
};

pub use super::{
    reading::{Defaults, MAX_FILE_BYTES, MAX_PICTURE_BYTES, Missing, Reading},
    syntax::{MAX_DEPTH, MAX_VALUES},
};

/// The name of standard input in messages.
pub const STDIN: &str = "standard input";

/// The state of a file, to detect changes by others: its length and a hash of its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Stamp {
    length: u64,
    hash: u64,
}

impl Stamp {
    /// The stamp of this content.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        let mut hasher = DefaultHasher::new();
        bytes.hash(&mut hasher);
        Self { length: bytes.len() as u64, hash: hasher.finish() }
    }
}

/// A scene that was read: valid, apart from [missing](Self::missing) parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The scene, with defaults where parts are missing.
    pub scene: Scene,
    /// The parts that were missing, in the order of the scene file.
    pub missing: Vec<Missing>,
    /// The state of the file when it was read.
    pub stamp: Stamp,
}

/// Reads a scene from a regular file.
///
/// # Errors
/// Returns a [`LoadError`]; its text names the file as `path` does.
pub fn file<'r>(
    path: &FilePath,
    registry: &Registry,
    how: impl Into<Reading<'r>>,
) -> Result<Loaded, LoadError> {
    let folder = path.parent().unwrap_or(FilePath::new(""));
    in_folder(&bytes(path, registry)?, (&path.shown().to_string(), folder), registry, how)
}

/// The result of reading a file. A picture may be larger than other files: the scene is a small part of it.
fn larger_if_picture(
    path: &FilePath,
    read: impl Fn(u64) -> Result<Vec<u8>, FileError>,
) -> Result<Vec<u8>, FileError> {
    match read(MAX_FILE_BYTES) {
        Err(FileError::TooLarge(_)) if files::PICTURES.iter().any(|picture| picture.begins(path)) => {
            read(MAX_PICTURE_BYTES)
        }
        read => read,
    }
}

/// Reads the content of a path from the command line: a file, or a stream such as `/dev/stdin`.
///
/// # Errors
/// Returns a [`LoadError`]; its text names the input as `path` does.
pub fn input_bytes(path: &FilePath, registry: &Registry) -> Result<Vec<u8>, LoadError> {
    larger_if_picture(path, |most| files::read_input(path, most))
        .map_err(|e| LoadError::from_file(path, e, registry))
}

/// Reads the content of a scene file, valid or not.
///
/// # Errors
/// Returns a [`LoadError`] if it is not a regular file, is too large, or cannot be read.
pub fn bytes(path: &FilePath, registry: &Registry) -> Result<Vec<u8>, LoadError> {
    larger_if_picture(path, |most| files::read(path, most))
        .map_err(|e| LoadError::from_file(path, e, registry))
}

/// Reads a scene from a stream, for example [standard input](STDIN).
///
/// # Errors
/// Returns a [`LoadError`] with `name` as the name of the file.
pub fn reader<'r>(
    from: impl Read,
    name: &str,
    registry: &Registry,
    how: impl Into<Reading<'r>>,
) -> Result<Loaded, LoadError> {
    from_bytes(&all_of(from, name)?, name, registry, how)
}

/// The ids of the reflection models that a scene names, known or not, even in an invalid scene; empty if the
/// content does not follow the syntax of its format.
#[must_use]
pub fn models_named(bytes: &[u8], name: &str, registry: &Registry) -> BTreeSet<String> {
    let source = Source::new(bytes, (name, FilePath::new("")), Outside::NONE);
    let parsed = formats::of_source(&source, registry).ok().map(|format| format.read(&source, registry));
    let Some(Ok(parsed)) = parsed else { return BTreeSet::new() };
    parsed.scene.expanded_as_far(registry).0.models().into_iter().map(str::to_owned).collect()
}

/// Reads the content of a stream, which can be read only once.
///
/// # Errors
/// Returns a [`LoadError`] if it is too large for a scene, or cannot be read.
pub fn all_of(from: impl Read, name: &str) -> Result<Vec<u8>, LoadError> {
    let failed = |source| LoadError::Io { name: name.to_owned(), source };
    let mut bytes = Vec::new();
    // A stream does not report its length.
    from.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(LoadError::TooLarge { name: name.to_owned(), most: MAX_FILE_BYTES });
    }
    Ok(bytes)
}

/// Reads a scene from the content of a file; `name` is its name in messages, its folder that of the files that the
/// scene names, and its extension decides on the [format](super::formats).
///
/// # Errors
/// Returns a [`LoadError`] if the scene cannot be read.
pub fn from_bytes<'r>(
    bytes: &[u8],
    name: &str,
    registry: &Registry,
    how: impl Into<Reading<'r>>,
) -> Result<Loaded, LoadError> {
    let folder = FilePath::new(name).parent().unwrap_or(FilePath::new(""));
    in_folder(bytes, (name, folder), registry, how)
}

/// Like [`from_bytes`], with the folder of the files named in the scene.
///
/// # Errors
/// Returns a [`LoadError`] if the scene cannot be read.
pub fn in_folder<'r>(
    bytes: &[u8],
    (name, folder): (&str, &FilePath),
    registry: &Registry,
    how: impl Into<Reading<'r>>,
) -> Result<Loaded, LoadError> {
    let Reading { defaults, outside } = how.into();
    let source = Source::new(bytes, (name, folder), outside);
    let format = formats::of_source(&source, registry)
        .map_err(|unknown| LoadError::UnknownExtension { name: name.to_owned(), unknown })?;
    let (scene, missing) = formats::checked(format.read(&source, registry)?, name, registry, defaults)?;
    if defaults == Defaults::Refuse && !missing.is_empty() {
        return Err(LoadError::Missing { name: name.to_owned(), missing });
    }
    Ok(Loaded { scene, missing, stamp: Stamp::of(bytes) })
}

/// Reads a scene from text, like [`from_bytes`].
///
/// # Errors
/// Returns a [`LoadError`] if the scene cannot be read.
pub fn from_text<'r>(
    text: &str,
    name: &str,
    registry: &Registry,
    how: impl Into<Reading<'r>>,
) -> Result<Loaded, LoadError> {
    from_bytes(text.as_bytes(), name, registry, how)
}
