//! From a [`Material`] to JSON.

use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

use super::{EXTENSION, MAX_BYTES, Material};
use crate::{
    custom::{BadName, id_of_name},
    files::{self, FileError, Shown as _},
    parameter::{Parameter, Value},
    registry::Registry,
    scene::layout::{ShortNumbers, pretty},
};

/// The reason why a material could not be saved.
#[derive(Debug, thiserror::Error)]
pub enum NotSaved {
    /// The name gives no name of a file.
    #[error("{0}")]
    Name(#[from] BadName),
    /// The model is not registered, so the file could not be read back.
    #[error("there is no reflection model {0}")]
    Model(String),
    /// The texts are too long.
    #[error("the material takes more than {} KiB; shorten its description", MAX_BYTES >> 10)]
    TooLarge,
    /// The folder has such a file.
    #[error("there is a material of that name: {}; choose another name", .0.shown())]
    Taken(PathBuf),
    /// The file could not be written.
    #[error("{} could not be written: {error}", .path.shown())]
    File {
        /// The file.
        path: PathBuf,
        /// The reason.
        error: FileError,
    },
}

/// The values of a model's parameters in the order of their declarations.
struct Ordered<'a>(Vec<(&'static str, &'a Value)>);

impl Serialize for Ordered<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

/// The keys of a file in their order.
#[derive(Serialize)]
struct Written<'a> {
    name: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    description: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    source: Option<&'a str>,
    reflection_model: &'a str,
    material: Ordered<'a>,
}

/// The text of the file of a material. Only the legal values of its model's parameters are in it.
#[must_use]
pub fn to_json(material: &Material, registry: &Registry) -> String {
    let parameters = registry.model(&material.reflection_model).map_or(&[][..], |model| model.parameters);
    let given = |p: &'static Parameter| {
        material.material.0.get(p.name).filter(|value| p.allows(value)).map(|value| (p.name, value))
    };
    let written = Written {
        name: &material.name,
        description: material.description.as_deref(),
        source: material.source.as_deref(),
        reflection_model: &material.reflection_model,
        material: Ordered(parameters.iter().filter_map(given).collect()),
    };
    let mut compact = Vec::new();
    // Writing to memory, with text as keys, cannot fail.
    let _ = written.serialize(&mut serde_json::Serializer::with_formatter(&mut compact, ShortNumbers));
    let compact = String::from_utf8_lossy(&compact);
    pretty(&compact).unwrap_or_else(|| compact.into_owned())
}

/// Saves a material as [`save`] does, in place of the file of that name if there is one.
///
/// # Errors
/// Returns the reason why nothing was written.
pub fn replace(material: &Material, folder: &Path, registry: &Registry) -> Result<PathBuf, NotSaved> {
    put(material, folder, registry, files::write)
}

/// Saves a material into a folder, which is created if necessary; the name of the file follows from its name.
/// An existing file is kept.
///
/// # Errors
/// Returns the reason why nothing was written.
pub fn save(material: &Material, folder: &Path, registry: &Registry) -> Result<PathBuf, NotSaved> {
    put(material, folder, registry, files::create)
}

/// Writes a material into a folder by a function.
fn put(
    material: &Material,
    folder: &Path,
    registry: &Registry,
    write: impl FnOnce(&Path, &[u8]) -> Result<(), FileError>,
) -> Result<PathBuf, NotSaved> {
    let id = id_of_name(&material.name)?;
    if registry.model(&material.reflection_model).is_none() {
        return Err(NotSaved::Model(material.reflection_model.clone()));
    }
    let text = to_json(material, registry);
    if text.len() as u64 > MAX_BYTES {
        return Err(NotSaved::TooLarge);
    }
    let path = folder.join(id).with_extension(EXTENSION);
    match files::in_folder(folder, || write(&path, text.as_bytes())) {
        Ok(()) => Ok(path),
        Err(FileError::Io(error)) if error.kind() == std::io::ErrorKind::AlreadyExists => {
            Err(NotSaved::Taken(path))
        }
        Err(error) => Err(NotSaved::File { path, error }),
    }
}
