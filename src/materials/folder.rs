//! The folder of a user's materials.

use std::{
    fmt,
    path::{Path, PathBuf},
};

use super::{EXTENSION, Library, MAX_BYTES, MAX_FILES, Material, Origin, from_bytes};
use crate::files::{self, FileError, Shown as _, words};
use crate::registry::Registry;

/// A file that is no material, or a folder that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Broken {
    /// The file.
    pub path: PathBuf,
    /// The mistakes, each with its line and column if it has a place in the text.
    pub problems: Vec<String>,
}

impl Broken {
    fn new(path: &Path, problem: impl Into<String>) -> Self {
        Self { path: path.to_owned(), problems: vec![problem.into()] }
    }
}

impl fmt::Display for Broken {
    /// A line for each problem, with the file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, problem) in self.problems.iter().enumerate() {
            let end = if i == 0 { "" } else { "\n" };
            let gap = if problem.starts_with(|c: char| c.is_ascii_digit()) { ":" } else { ": " };
            write!(f, "{end}{}{gap}{problem}", self.path.shown())?;
        }
        Ok(())
    }
}

/// The folder of materials that belongs to a folder of custom models: `materials` beside it.
#[must_use]
pub fn beside(models: &Path) -> PathBuf {
    match models.file_name() {
        Some(_) => models.with_file_name("materials"),
        // Such as `..`.
        None => models.join("../materials"),
    }
}

/// The materials in a folder, in no order, and its broken files by path; nothing if the folder does not exist.
pub(super) fn read(folder: &Path, registry: &Registry) -> Library {
    let mut library = Library::default();
    let (files, more) = match files::listed(folder, EXTENSION, MAX_FILES) {
        Ok(found) => found,
        Err(error) => {
            library
                .broken
                .push(Broken::new(folder, format!("the folder could not be read: {}", words(&error))));
            return library;
        }
    };
    for path in files {
        match material(folder, &path, registry) {
            Ok(material) => library.materials.push(material),
            Err(broken) => library.broken.push(broken),
        }
    }
    if more {
        let what = format!("the folder has more than {MAX_FILES} materials; the others were not read");
        library.broken.push(Broken::new(folder, what));
    }
    library
}

/// The material in a file, which must be within the folder, also if it is a link.
fn material(folder: &Path, path: &Path, registry: &Registry) -> Result<Material, Broken> {
    let read = files::inside(folder, path).and_then(|file| files::read(&file, MAX_BYTES));
    let bytes = read.map_err(|error| {
        Broken::new(
            path,
            match error {
                FileError::TooLarge(_) => {
                    format!(
                        "the file is larger than {} KiB, the most allowed for a material",
                        MAX_BYTES >> 10
                    )
                }
                FileError::Kind(kind) => format!("this is {kind}, not a regular file"),
                error => format!("the file could not be read: {error}"),
            },
        )
    })?;
    let mut material =
        from_bytes(&bytes, registry).map_err(|problems| Broken { path: path.to_owned(), problems })?;
    material.origin = Origin::File(path.to_owned());
    Ok(material)
}
