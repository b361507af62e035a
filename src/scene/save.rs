//! Writing scene files: readable, in a fixed order, completely or not at all.

use std::{
    fs, io,
    io::Write as _,
    path::{Path, PathBuf},
};

pub use super::write::to_json;
use super::{
    Scene, check,
    error::{Path as ScenePath, Problem},
    formats::{self, Target, UnknownExtension},
    load::{self, Defaults, MAX_FILE_BYTES, Stamp},
};
use crate::files::{Shown as _, words};
use crate::{
    files::{self, Draft, FileError, Kind},
    parameter::Outside,
    registry::Registry,
};

/// The state that the writer expects at its destination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// Nothing: a new file.
    Nothing,
    /// The content that was read or written last.
    Unchanged(Stamp),
    /// Anything: the user has agreed.
    Anything,
}

/// The reason why a scene could not be written. In that case nothing has changed: the old file is still
/// complete.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The scene breaks rules, so it could not be read again.
    #[error("{} was not written: the scene has problems:\n{}", .path.shown(), lines(.problems))]
    Invalid {
        /// The file.
        path: PathBuf,
        /// The problems, at least one.
        problems: Vec<Problem>,
    },
    /// The file name's extension belongs to no known format.
    #[error("{} was not written: {unknown}", .path.shown())]
    UnknownExtension {
        /// The file.
        path: PathBuf,
        /// The extension, and those that are known.
        unknown: UnknownExtension,
    },
    /// The format can only be read.
    #[error("{} was not written: files of the format {format} can only be read; save the scene as JSON, for example as {}", .path.shown(), as_json(.path).shown())]
    CannotWrite {
        /// The file.
        path: PathBuf,
        /// The name of the format.
        format: &'static str,
    },
    /// The format cannot hold the whole scene.
    #[error("{} was not written: {why}; save the scene as JSON, for example as {}", .path.shown(), as_json(.path).shown())]
    Lossy {
        /// The file.
        path: PathBuf,
        /// The part that would be lost.
        why: String,
    },
    /// A new file was requested, but one exists.
    #[error("{} already exists; it was not overwritten", .path.shown())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// Another program wrote the file since it was read.
    #[error("{} changed on disk since it was read; it was not overwritten", .path.shown())]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// The file was deleted or moved since it was read.
    #[error("{} is no longer there; it was deleted or moved since it was read", .path.shown())]
    Gone {
        /// The file.
        path: PathBuf,
    },
    /// The file is protected.
    #[error("{} is read-only; it was not overwritten", .path.shown())]
    ReadOnly {
        /// The file.
        path: PathBuf,
    },
    /// The path leads to a folder.
    #[error("{} is a folder; choose a file name", .path.shown())]
    Folder {
        /// The folder.
        path: PathBuf,
    },
    /// The path leads to something other than a file or folder.
    #[error("{} was not written: it is {kind}, not a regular file", .path.shown())]
    NoFile {
        /// The path given.
        path: PathBuf,
        /// The kind of thing that it is.
        kind: Kind,
    },
    /// The folder of the file does not exist.
    #[error("{} was not written: there is no folder {}", .path.shown(), .folder.shown())]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The missing folder.
        folder: PathBuf,
    },
    /// A failure of the operating system: no permission, no space.
    #[error("{} was not written: {}", .path.shown(), words(.source))]
    Io {
        /// The file.
        path: PathBuf,
        /// The reason given by the system.
        source: io::Error,
    },
}

/// The name of a file with the extension of JSON, the format that holds every scene.
#[must_use]
pub fn as_json(path: &Path) -> PathBuf {
    path.with_extension("json")
}

fn lines(problems: &[Problem]) -> String {
    problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// Writes a scene, completely or not at all, as [`files::write`](fn@files::write) does, in the
/// [format](super::formats) of the file's extension. Returns the stamp to expect next time.
///
/// # Errors
/// Returns a [`SaveError`]; the old file is then untouched.
pub fn write(
    path: &Path,
    scene: &Scene,
    registry: &Registry,
    expected: Expected,
) -> Result<Stamp, SaveError> {
    let shown = || path.to_owned();
    let problems = check::scene(scene, registry);
    if !problems.is_empty() {
        return Err(SaveError::Invalid { path: shown(), problems });
    }
    let format = formats::of_path(path, registry)
        .map_err(|unknown| SaveError::UnknownExtension { path: shown(), unknown })?;
    let writer =
        format.writer().ok_or_else(|| SaveError::CannotWrite { path: shown(), format: format.name() })?;
    let failed = |error| SaveError::from_file(path, error);
    // The target of /dev/stdout has no folder for a draft.
    if let Ok(kind @ (files::Kind::Pipe | files::Kind::Device)) = files::kind(path) {
        return Err(failed(files::FileError::Kind(kind)));
    }
    let target = files::follow(path).map_err(|e| failed(e.into()))?;
    let folder = files::folder_of(&target);
    if !folder.is_dir() {
        return Err(SaveError::NoFolder { path: shown(), folder: folder.to_owned() });
    }
    let old = on_disk(&target, path, expected)?;
    let lossy = |why| SaveError::Lossy { path: shown(), why };
    let bytes = writer.write(scene, &Target::new(folder, old.as_deref()), registry).map_err(lossy)?;
    if !formats::is_json(format) {
        comes_back(&bytes, scene, (path, folder), registry).map_err(lossy)?;
    }

    let mut draft = Draft::new(&target).map_err(failed)?;
    draft.write_all(&bytes).map_err(|e| failed(e.into()))?;
    if expected == Expected::Nothing {
        draft.create().map_err(failed)?;
    } else {
        // Check again: writing took time.
        on_disk(&target, path, expected)?;
        draft.replace().map_err(failed)?;
    }
    Ok(Stamp::of(&bytes))
}

/// `Ok` if the written scene can be read back from the content of the file; otherwise the first part that is
/// lost.
fn comes_back(
    bytes: &[u8],
    scene: &Scene,
    (path, folder): (&Path, &Path),
    registry: &Registry,
) -> Result<(), String> {
    let name = path.shown().to_string();
    let mut outside = Outside::default();
    outside.allow(scene.files());
    let back = load::in_folder(bytes, (&name, folder), registry, Defaults::Refuse.allowing(&outside))
        .map_err(|error| format!("what was written could not be read again: {error}"))?;
    if back.scene == *scene {
        return Ok(());
    }
    let json = |scene: &Scene| {
        serde_json::from_str(&to_json(scene, None, registry)).unwrap_or(serde_json::Value::Null)
    };
    let lost = difference(&json(scene), &json(&back.scene), &ScenePath::root());
    let what = lost.map_or_else(|| "a part of the scene".to_owned(), |path| path.to_string());
    Err(format!("its format would lose {what}"))
}

/// The path of the first value that differs.
fn difference(a: &serde_json::Value, b: &serde_json::Value, at: &ScenePath) -> Option<ScenePath> {
    use serde_json::Value::{Array, Object};
    match (a, b) {
        _ if a == b => None,
        (Object(a), Object(b)) => {
            let mut keys = a.keys().chain(b.keys());
            let key = keys.find(|key| a.get(*key) != b.get(*key))?;
            let at = at.key(key.clone());
            a.get(key).zip(b.get(key)).map_or(Some(at.clone()), |(a, b)| difference(a, b, &at))
        }
        (Array(a), Array(b)) => {
            let i = (0..a.len().max(b.len())).find(|i| a.get(*i) != b.get(*i))?;
            let at = at.index(i);
            a.get(i).zip(b.get(i)).map_or(Some(at.clone()), |(a, b)| difference(a, b, &at))
        }
        _ => Some(at.clone()),
    }
}

impl SaveError {
    /// True if the scene can be saved in another format.
    #[must_use]
    pub fn is_about_format(&self) -> bool {
        matches!(self, Self::UnknownExtension { .. } | Self::CannotWrite { .. } | Self::Lossy { .. })
    }

    fn from_file(path: &Path, error: FileError) -> Self {
        let path = path.to_owned();
        match error {
            FileError::Kind(Kind::Folder) => Self::Folder { path },
            FileError::Kind(kind) => Self::NoFile { path, kind },
            error => match io::Error::from(error) {
                e if e.kind() == io::ErrorKind::AlreadyExists => Self::Exists { path },
                source => Self::Io { path, source },
            },
        }
    }
}

/// Examines the destination and compares it with the expectation. Returns its content, if there is any.
fn on_disk(target: &Path, path: &Path, expected: Expected) -> Result<Option<Vec<u8>>, SaveError> {
    let shown = || path.to_owned();
    let io = |source| SaveError::Io { path: shown(), source };
    let metadata = match fs::metadata(target) {
        Ok(metadata) => metadata,
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            return match expected {
                Expected::Unchanged(_) => Err(SaveError::Gone { path: shown() }),
                Expected::Nothing | Expected::Anything => Ok(None),
            };
        }
        Err(e) => return Err(io(e)),
    };
    match Kind::of(metadata.file_type()) {
        Kind::File => {}
        kind => return Err(SaveError::from_file(path, FileError::Kind(kind))),
    }
    if expected == Expected::Nothing {
        return Err(SaveError::Exists { path: shown() });
    }
    if metadata.permissions().readonly() {
        return Err(SaveError::ReadOnly { path: shown() });
    }
    let bytes = match files::read(target, MAX_FILE_BYTES) {
        Ok(bytes) => bytes,
        // Not a scene.
        Err(FileError::TooLarge(_)) => Vec::new(),
        Err(error) => return Err(SaveError::from_file(path, error)),
    };
    if let Expected::Unchanged(stamp) = expected
        && stamp != Stamp::of(&bytes)
    {
        return Err(SaveError::Changed { path: shown() });
    }
    Ok(Some(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_saved_scene_reads_like_one_written_by_hand() {
        let text = to_json(&Scene::default(), Some("./scene.schema.json"), &Registry::builtin());
        assert_eq!(
            text,
            r#"{
  "$schema": "./scene.schema.json",
  "name": "Default scene",
  "description": "One white point light, one matte sphere: the scene to start from.",
  "scene_size": { "height": 10, "width": 10, "depth": 10 },
  "reflection_model": "lambert",
  "shading_model": "gouraud",
  "lights": [
    { "type": "point", "position": [7.5, 8, 9], "colour": [255, 255, 255], "intensity": 20 }
  ],
  "observer": { "position": [5, 5, 9.5], "direction": [0, 0, -1], "field_of_view": 45 },
  "objects": [
    { "type": "sphere", "position": [5, 5, 5], "size": 2 }
  ]
}
"#
        );
    }
}
