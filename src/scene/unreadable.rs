//! The reason why a file could not be read as a scene, with hints at what may be meant.

use std::{io, path::Path as FilePath};

use super::{error::LoadError, formats};
use crate::files::Shown as _;
use crate::{
    files::{FileError, Kind, follow},
    registry::Registry,
};

impl LoadError {
    /// An error of the operating system when opening or reading a file.
    #[must_use]
    pub fn from_io(path: &FilePath, name: &str, source: io::Error, registry: &Registry) -> Self {
        let name = name.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound => {
                Self::NotFound { hint: broken_link(path).or_else(|| similar_file(path)), name }
            }
            io::ErrorKind::PermissionDenied => Self::PermissionDenied { name },
            io::ErrorKind::IsADirectory => Self::Folder { hint: scenes_within(path, registry), name },
            _ => Self::Io { name, source },
        }
    }

    /// The error for a file that could not be read.
    #[must_use]
    pub fn from_file(path: &FilePath, error: FileError, registry: &Registry) -> Self {
        let name = path.shown().to_string();
        match error {
            FileError::Kind(Kind::Folder) => Self::Folder { hint: scenes_within(path, registry), name },
            FileError::Kind(kind) => Self::NoFile { name, kind },
            FileError::TooLarge(most) => Self::TooLarge { name, most },
            error => Self::from_io(path, &name, error.into(), registry),
        }
    }
}

/// "; it is a link to room.json, which does not exist" if the path is such a link.
fn broken_link(path: &FilePath) -> Option<String> {
    if !crate::platform::fs::symlink_metadata(path).ok()?.is_symlink() {
        return None;
    }
    Some(format!("; it is a link to {}, which does not exist", follow(path).ok()?.shown()))
}

/// ". Did you mean scenes/room.json?" if there is a file with a similar name.
fn similar_file(path: &FilePath) -> Option<String> {
    let wanted = path.file_name()?.to_str()?.to_lowercase();
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(FilePath::new("."));
    // A folder can be huge; a hint is not worth more than a glance at it.
    let nearest = crate::platform::fs::read_dir(folder)
        .ok()?
        .take(1000)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        // A suggestion equal to the given name helps nobody.
        .filter(|name| path.file_name().is_none_or(|given| given != name.as_str()))
        .map(|name| (strsim::jaro_winkler(&wanted, &name.to_lowercase()), name))
        .filter(|(likeness, _)| *likeness > 0.85)
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(format!(". Did you mean {}?", path.with_file_name(nearest.1).shown()))
}

/// "; it holds a.json, b.json".
fn scenes_within(path: &FilePath, registry: &Registry) -> Option<String> {
    let mut names: Vec<_> = crate::platform::fs::read_dir(path)
        .ok()?
        .take(1000)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| formats::is_scene_file(FilePath::new(name), registry))
        // Most pictures hold no scene.
        .filter(|name| !formats::is_picture(FilePath::new(name)))
        .collect();
    names.sort();
    let more = if names.len() > 5 { " and more" } else { "" };
    names.truncate(5);
    (!names.is_empty()).then(|| format!("; this one holds {}{more}", names.join(", ")))
}
