//! Reading scene files: from bytes on disk to a checked [`Scene`], with an error for everything that can be
//! wrong and a list of missing parts.

use std::{
    collections::BTreeSet,
    fmt,
    hash::{DefaultHasher, Hash as _, Hasher as _},
    io::Read,
    path::Path as FilePath,
};

use super::{
    Scene,
    error::{LoadError, Path, Place, Problem},
    formats::{self, Source},
};
use crate::files::Shown as _;
use crate::{
    files::{self, FileError},
    registry::Registry,
};

pub use super::syntax::{MAX_DEPTH, MAX_VALUES};

/// Larger files are refused before they are read. Reading takes time proportional to the file, whatever is in it, and at
/// most two seconds per mebibyte, as for all readers: `tests/suite/hostile/text.rs`. The largest legal scene, with every parameter of 10 000 objects
/// given, is less than a tenth of this.
pub const MAX_FILE_BYTES: u64 = 64 << 20;
/// The maximum size of a picture file: that of the largest picture, uncompressed.
pub const MAX_PICTURE_BYTES: u64 = 1 << 30;
/// The name of standard input in messages.
pub const STDIN: &str = "standard input";

/// The treatment of a missing scene size, reflection model or shading model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Defaults {
    /// The caller decides: [`Loaded::missing`] lists them, and the scene already has the defaults.
    #[default]
    Ask,
    /// Defaults are used without asking. [`Loaded::missing`] still lists the parts.
    Use,
    /// Missing parts are an error, which names the flags that accept the defaults.
    Refuse,
}

/// A missing part with a default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// The path in the scene: `scene_size`, `scene_size.depth`, `reflection_model`, `shading_model`.
    pub path: Path,
    /// The default in readable form: `lambert`, `10 × 10 × 10 m`.
    pub default: String,
    /// The position of the enclosing object, which lacks the field.
    pub place: Option<Place>,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (default: {})", self.path, self.default)
    }
}

impl Missing {
    /// The missing part as a problem.
    #[must_use]
    pub fn problem(&self) -> Problem {
        let predicate = format!("is missing; --use-defaults accepts the default, {}", self.default);
        Problem { place: self.place, ..Problem::about(self.path.clone(), predicate) }
    }
}

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
pub fn file(path: &FilePath, registry: &Registry, defaults: Defaults) -> Result<Loaded, LoadError> {
    let folder = path.parent().unwrap_or(FilePath::new(""));
    in_folder(&bytes(path, registry)?, (&path.shown().to_string(), folder), registry, defaults)
}

/// The result of reading a file. A picture may be larger than other files: the scene is a small part of it.
fn larger_if_picture(
    path: &FilePath,
    read: impl Fn(u64) -> Result<Vec<u8>, FileError>,
) -> Result<Vec<u8>, FileError> {
    match read(MAX_FILE_BYTES) {
        Err(FileError::TooLarge(_)) if files::PNG.begins(path) => read(MAX_PICTURE_BYTES),
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
pub fn reader(
    from: impl Read,
    name: &str,
    registry: &Registry,
    defaults: Defaults,
) -> Result<Loaded, LoadError> {
    from_bytes(&all_of(from, name)?, name, registry, defaults)
}

/// The ids of the reflection models that a scene names, known or not, even in an invalid scene; empty if the
/// content does not follow the syntax of its format.
#[must_use]
pub fn models_named(bytes: &[u8], name: &str, registry: &Registry) -> BTreeSet<String> {
    let source = Source::new(bytes, (name, FilePath::new("")));
    let parsed = formats::of_source(&source, registry).ok().map(|format| format.read(&source, registry));
    let Some(Ok(parsed)) = parsed else { return BTreeSet::new() };
    parsed.scene.models().into_iter().map(str::to_owned).collect()
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
pub fn from_bytes(
    bytes: &[u8],
    name: &str,
    registry: &Registry,
    defaults: Defaults,
) -> Result<Loaded, LoadError> {
    let folder = FilePath::new(name).parent().unwrap_or(FilePath::new(""));
    in_folder(bytes, (name, folder), registry, defaults)
}

/// Like [`from_bytes`], with the folder of the files named in the scene.
///
/// # Errors
/// Returns a [`LoadError`] if the scene cannot be read.
pub fn in_folder(
    bytes: &[u8],
    (name, folder): (&str, &FilePath),
    registry: &Registry,
    defaults: Defaults,
) -> Result<Loaded, LoadError> {
    let source = Source::new(bytes, (name, folder));
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
pub fn from_text(
    text: &str,
    name: &str,
    registry: &Registry,
    defaults: Defaults,
) -> Result<Loaded, LoadError> {
    from_bytes(text.as_bytes(), name, registry, defaults)
}
