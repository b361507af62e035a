//! Writing scene files: readable, in a fixed order, completely or not at all.

use std::{
    io,
    io::Write as _,
    path::{Path, PathBuf},
};

pub use super::write::to_json;
use super::{
    Scene, check,
    error::{Path as ScenePath, Problem},
    formats::{self, SceneFormat, Target, UnknownExtension},
    load::{self, Defaults, MAX_FILE_BYTES, Stamp},
};
use crate::{
    files::{self, Draft, FileError, Kind, Shown as _, words},
    parameter::Outside,
    platform::fs,
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

/// A scene that could not be written. In that case nothing has changed: the old file is still complete.
#[derive(Debug, thiserror::Error)]
#[error("{} {why}{}", .path.shown(), instead(.path, .why))]
pub struct SaveError {
    /// The file.
    pub path: PathBuf,
    /// The reason.
    pub why: Unwritten,
}

/// The reason why a scene could not be written.
#[derive(Debug, thiserror::Error)]
pub enum Unwritten {
    /// The scene breaks rules, so it could not be read again: the problems, at least one.
    #[error("was not written: the scene has problems:\n{}", lines(.0))]
    Invalid(Vec<Problem>),
    /// The file name's extension belongs to no known format.
    #[error("was not written: {0}")]
    UnknownExtension(UnknownExtension),
    /// The format of this name can only be read.
    #[error("was not written: files of the format {0} can only be read")]
    CannotWrite(&'static str),
    /// The format cannot hold the whole scene: the part that would be lost.
    #[error("was not written: {0}")]
    Lossy(String),
    /// A new file was requested, but one exists.
    #[error("already exists; it was not overwritten")]
    Exists,
    /// Another program wrote the file since it was read.
    #[error("changed on disk since it was read; it was not overwritten")]
    Changed,
    /// The file was deleted or moved since it was read.
    #[error("is no longer there; it was deleted or moved since it was read")]
    Gone,
    /// The file is protected.
    #[error("is read-only; it was not overwritten")]
    ReadOnly,
    /// The path leads to a folder.
    #[error("is a folder; choose a file name")]
    Folder,
    /// The path leads to something other than a file or folder.
    #[error("was not written: it is {0}, not a regular file")]
    NoFile(Kind),
    /// A failure of the operating system: no permission, no space.
    #[error("was not written: {}", words(.0))]
    Io(#[source] io::Error),
}

impl From<io::Error> for Unwritten {
    fn from(error: io::Error) -> Self {
        FileError::from(error).into()
    }
}

impl From<FileError> for Unwritten {
    fn from(error: FileError) -> Self {
        match error {
            FileError::Kind(Kind::Folder) => Self::Folder,
            FileError::Kind(kind) => Self::NoFile(kind),
            error => match io::Error::from(error) {
                e if e.kind() == io::ErrorKind::AlreadyExists => Self::Exists,
                source => Self::Io(source),
            },
        }
    }
}

/// The advice to choose the format that holds every scene, where that of the file is the reason.
fn instead(path: &Path, why: &Unwritten) -> String {
    match why {
        Unwritten::CannotWrite(_) | Unwritten::Lossy(_) => {
            format!("; save the scene as JSON, for example as {}", as_json(path).shown())
        }
        _ => String::new(),
    }
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
/// [format](super::formats) of the file's extension. Missing folders are created, as [`files::in_folder`] does. Returns the
/// stamp to expect next time.
///
/// # Errors
/// Returns a [`SaveError`]; the old file is then untouched.
pub fn write(
    path: &Path,
    scene: &Scene,
    registry: &Registry,
    expected: Expected,
) -> Result<Stamp, SaveError> {
    written(path, scene, registry, expected).map_err(|why| SaveError { path: path.to_owned(), why })
}

/// Fails where [`write()`] would, for reasons that are known before the scene is complete: the format of the file, and what is there. For
/// long work whose result would be lost. Changes nothing.
///
/// # Errors
/// Returns a [`SaveError`].
pub fn can_write(
    path: &Path,
    scene: &Scene,
    registry: &Registry,
    expected: Expected,
) -> Result<(), SaveError> {
    let check = || -> Result<(), Unwritten> {
        let (format, target) = destination(path, scene, registry)?;
        let old = on_disk(&target, expected)?;
        // Files that the scene names cannot be looked for in a folder that is made only on writing.
        let folder = files::folder_of(&target);
        match matches!(files::kind(folder), Ok(Kind::Folder)) || scene.files().next().is_none() {
            true => content(format, scene, (path, folder, old.as_deref()), registry).map(drop),
            false => Ok(()),
        }
    };
    check().map_err(|why| SaveError { path: path.to_owned(), why })
}

fn written(path: &Path, scene: &Scene, registry: &Registry, expected: Expected) -> Result<Stamp, Unwritten> {
    let (format, target) = destination(path, scene, registry)?;
    let folder = files::folder_of(&target);
    let old = on_disk(&target, expected)?;
    files::in_folder(folder, || {
        let bytes = content(format, scene, (path, folder, old.as_deref()), registry)?;
        let mut draft = Draft::new(&target)?;
        draft.write_all(&bytes).map_err(FileError::from)?;
        if expected == Expected::Nothing {
            draft.create()?;
        } else {
            // Check again: writing took time.
            on_disk(&target, expected)?;
            draft.replace()?;
        }
        Ok(Stamp::of(&bytes))
    })
}

/// The format of a path for a valid scene, and the file to which the path leads.
fn destination<'r>(
    path: &Path,
    scene: &Scene,
    registry: &'r Registry,
) -> Result<(&'r dyn SceneFormat, PathBuf), Unwritten> {
    let problems = check::scene(scene, registry);
    if !problems.is_empty() {
        return Err(Unwritten::Invalid(problems));
    }
    let format = formats::of_path(path, registry).map_err(Unwritten::UnknownExtension)?;
    format.writer().ok_or(Unwritten::CannotWrite(format.name()))?;
    // The target of /dev/stdout has no folder for a draft.
    if let Ok(kind @ (Kind::Pipe | Kind::Device)) = files::kind(path) {
        return Err(Unwritten::NoFile(kind));
    }
    Ok((format, files::follow(path).map_err(FileError::from)?))
}

/// The scene in a format, from which it can be read back.
fn content(
    format: &dyn SceneFormat,
    scene: &Scene,
    (path, folder, old): (&Path, &Path, Option<&[u8]>),
    registry: &Registry,
) -> Result<Vec<u8>, Unwritten> {
    let writer = format.writer().ok_or(Unwritten::CannotWrite(format.name()))?;
    let bytes = writer.write(scene, &Target::new(folder, old), registry).map_err(Unwritten::Lossy)?;
    if !formats::is_json(format) {
        comes_back(&bytes, scene, (path, folder), registry).map_err(Unwritten::Lossy)?;
    }
    Ok(bytes)
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
        use Unwritten::{CannotWrite, Lossy, UnknownExtension};
        matches!(self.why, UnknownExtension(_) | CannotWrite(_) | Lossy(_))
    }
}

/// Examines the destination and compares it with the expectation. Returns its content, if there is any.
fn on_disk(target: &Path, expected: Expected) -> Result<Option<Vec<u8>>, Unwritten> {
    let metadata = match fs::metadata(target) {
        Ok(metadata) => metadata,
        Err(e) if e.kind() == io::ErrorKind::NotFound => {
            return match expected {
                Expected::Unchanged(_) => Err(Unwritten::Gone),
                Expected::Nothing | Expected::Anything => Ok(None),
            };
        }
        Err(e) => return Err(Unwritten::Io(e)),
    };
    match Kind::of(metadata.file_type()) {
        Kind::File => {}
        kind => return Err(FileError::Kind(kind).into()),
    }
    if expected == Expected::Nothing {
        return Err(Unwritten::Exists);
    }
    if metadata.permissions().readonly() {
        return Err(Unwritten::ReadOnly);
    }
    let bytes = match files::read(target, MAX_FILE_BYTES) {
        // Not a scene.
        Err(FileError::TooLarge(_)) => Vec::new(),
        read => read?,
    };
    match expected {
        Expected::Unchanged(stamp) if stamp != Stamp::of(&bytes) => Err(Unwritten::Changed),
        _ => Ok(Some(bytes)),
    }
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
