//! Writes exports to disk: whole or not at all, and never replacing anything without being asked.

use std::{
    env,
    io::Write as _,
    path::{Path, PathBuf},
};

use super::{Export, File, Form, Makes};
use crate::files::Shown as _;
use crate::{
    files::{self, Before, Draft, FileError, FolderDraft, Refused},
    platform::fs,
    registry::Registry,
    scene::Scene,
};

/// The reason why an export was not written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The place is already occupied.
    #[error("{} exists; it was not overwritten", .0.shown())]
    Exists(PathBuf),
    /// The existing item is of another kind than the export.
    #[error("{} {}; it was not overwritten", .0.shown(), .1)]
    OtherKind(PathBuf, &'static str),
    /// The place is the working folder of this program, or contains it.
    #[error("{} is the current folder, or contains it; name a new folder", .0.shown())]
    Here(PathBuf),
    /// The place is a folder of something else.
    #[error("{} has no {}, so it is not an export of this form; it was not overwritten", .0.shown(), .1)]
    Foreign(PathBuf, String),
    /// The folder contains something that no export of this form has.
    #[error("{} has {}, which is not part of an export of this form; it was not overwritten", .0.shown(), .1.shown())]
    Stranger(PathBuf, PathBuf),
    /// The place holds a file of another kind.
    #[error("{} is a file of a different kind from the export; it was not overwritten", .0.shown())]
    OtherFile(PathBuf),
    /// The name exceeds the limit of file systems.
    #[error("{} cannot be written: its name has {} bytes, but at most {NAME} are allowed", .0.shown(), .1)]
    Name(PathBuf, usize),
    /// The place is, or contains, an input of this command.
    #[error(transparent)]
    Input(#[from] Refused),
    /// The place changed after it was examined.
    #[error("another program wrote {} during this export; its version was kept, and this one was not written", .0.shown())]
    Taken(PathBuf),
    /// The operating system reported an error.
    #[error("{} could not be written: {}", .0.shown(), .1)]
    System(PathBuf, FileError),
}

/// Maximum length of a file name on all common file systems, in bytes.
const NAME: usize = 255;

/// Everything that a command or the window reads: scene files and the files named in them, models and
/// shaders, and this program. No result may replace any of it: see [`files::spare`].
#[must_use]
pub fn inputs<'a>(
    files: impl IntoIterator<Item = &'a Path>,
    scenes: impl IntoIterator<Item = &'a Scene>,
    registry: &Registry,
) -> Vec<PathBuf> {
    let named = scenes.into_iter().flat_map(Scene::files).filter_map(|file| file.path().map(Path::to_owned));
    // By its common name.
    let program = files::program().and_then(|program| fs::canonicalize(program).ok());
    let files = files.into_iter().map(Path::to_owned).chain(named);
    files.chain(registry.files_on_disk()).chain(program).collect()
}

/// Refuses an occupied place unless the user wants it replaced; inputs, and things of another kind, are never
/// replaced. Called before anything is calculated. Returns the present state, which [`write()`] expects.
///
/// # Errors
/// Returns an error if an export must not be written there.
pub fn may_write(
    form: &Form,
    place: &Path,
    overwrite: bool,
    inputs: &[PathBuf],
) -> Result<Before, WriteError> {
    if let Some(bytes) = place.file_name().map(|name| name.len()).filter(|bytes| *bytes > NAME) {
        return Err(WriteError::Name(place.to_owned(), bytes));
    }
    let before = Before::of(place);
    if fs::symlink_metadata(place).is_err() {
        return Ok(before);
    }
    let folder = fs::metadata(place).is_ok_and(|target| target.is_dir());
    match form.makes {
        Makes::Folder if !folder => {
            return Err(WriteError::OtherKind(place.to_owned(), "is not a folder, but this form makes one"));
        }
        Makes::File(_) if folder => {
            return Err(WriteError::OtherKind(place.to_owned(), "is a folder, but this form makes a file"));
        }
        Makes::File(_) | Makes::Folder => {}
    }
    let empty = folder && is_empty(place);
    if !empty && !overwrite {
        return Err(WriteError::Exists(place.to_owned()));
    }
    let whole = fs::canonicalize(place).unwrap_or_else(|_| place.to_owned());
    // A terminal would stay in the replaced folder, where nothing is left.
    if folder && env::current_dir().is_ok_and(|here| here.starts_with(&whole)) {
        return Err(WriteError::Here(place.to_owned()));
    }
    files::spare(place, inputs.iter().map(PathBuf::as_path))?;
    Ok(before)
}

/// Writes an export, after [`may_write`] has returned the state of the place. The place is replaced only once
/// everything is on disk; anything written there since by somebody else stays.
///
/// # Errors
/// Returns an error if the place is a folder of something else, if somebody else wrote there, or if the
/// operating system reports one. Nothing is then left behind, and the place is unchanged.
pub fn write(export: &Export, place: &Path, before: &Before) -> Result<(), WriteError> {
    if Before::of(place) != *before {
        return Err(WriteError::Taken(place.to_owned()));
    }
    // Naming a folder in order to put the export into it must not destroy its contents.
    if let [first, _, ..] = export.files.as_slice()
        && !is_empty(place)
        && !fs::is_file(place.join(&first.path))
    {
        return Err(WriteError::Foreign(place.to_owned(), first.path.clone()));
    }
    let stranger = match export.files.as_slice() {
        [only] if only.path.is_empty() => {
            let old = files::read_start(place, KIND).unwrap_or_default();
            (!only.bytes.starts_with(&old)).then(|| WriteError::OtherFile(place.to_owned()))
        }
        all => stranger(all, place, Path::new("")).map(|path| WriteError::Stranger(place.to_owned(), path)),
    };
    stranger.map_or(Ok(()), Err)?;
    let written = files::in_folder(files::folder_of(place), || match export.files.as_slice() {
        [only] if only.path.is_empty() => single(only, place, before),
        all => folder(all, place, before),
    });
    written.map_err(|error| match error {
        FileError::Taken => WriteError::Taken(place.to_owned()),
        error => WriteError::System(place.to_owned(), error),
    })
}

/// Length of the prefix that identifies the kind of a file.
const KIND: u64 = 4;

/// Something below a folder that an earlier export cannot have left there, whatever the scene was then. In a
/// Cargo project, files made by cargo may be lost.
fn stranger(all: &[File], place: &Path, below: &Path) -> Option<PathBuf> {
    let is = |name: &str| all.iter().any(|file| file.path == name);
    for entry in fs::read_dir(place.join(below)).ok()? {
        let Ok(entry) = entry else { return Some(below.to_owned()) };
        let path = below.join(entry.file_name());
        if is("Cargo.toml") && (path == Path::new("target") || path == Path::new("Cargo.lock")) {
            continue;
        }
        let kind = entry.file_type().ok();
        if kind.is_some_and(|kind| kind.is_dir()) {
            if let Some(found) = stranger(all, place, &path) {
                return Some(found);
            }
            // An empty folder may have another owner too.
            if all.iter().all(|file| !Path::new(&file.path).starts_with(&path)) {
                return Some(path);
            }
            continue;
        }
        // Another scene has other shaders and meshes.
        let alike = |file: &File| {
            let file = Path::new(&file.path);
            let beside = file.parent() == Some(below) && !below.as_os_str().is_empty();
            file == path || beside && file.extension() == path.extension()
        };
        if !kind.is_some_and(|kind| kind.is_file()) || !all.iter().any(alike) {
            return Some(path);
        }
    }
    None
}

/// True if the place is free, or an empty folder.
fn is_empty(place: &Path) -> bool {
    match fs::read_dir(place) {
        Ok(mut entries) => entries.next().is_none(),
        Err(_) => fs::symlink_metadata(place).is_err(),
    }
}

fn single(file: &File, place: &Path, before: &Before) -> Result<(), FileError> {
    let draft = Draft::new(place)?;
    let mut draft = if file.executable { draft.executable() } else { draft };
    draft.write_all(&file.bytes)?;
    draft.replace_if(before)
}

fn folder(all: &[File], place: &Path, before: &Before) -> Result<(), FileError> {
    let draft = FolderDraft::new(place)?;
    for file in all {
        draft.add(&file.path, &file.bytes, file.executable)?;
    }
    draft.replace_if(before)
}
