//! The status of the shaders for people: the folders in which they are edited, their problems, and the models that the
//! picture shows in an older version.

use std::path::PathBuf;

use crate::{registry::Folders, shader::check::ShaderProblem};

/// The folders of the shaders, and their problems. Made anew by the renderer when something changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShaderStatus {
    /// The folders, as the registry has them.
    pub folders: Folders,
    /// The problems.
    pub troubles: Vec<Trouble>,
    /// The last change that came through.
    pub last: Option<Reloaded>,
}

impl ShaderStatus {
    /// The names of the models of which the picture shows the last good version, each once.
    #[must_use]
    pub fn stale(&self) -> Vec<&str> {
        let mut names: Vec<_> =
            self.troubles.iter().flat_map(|t| t.stale.iter().map(String::as_str)).collect();
        names.sort_unstable();
        names.dedup();
        names
    }
}

/// A problem of a shader, and its consequence for the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Trouble {
    /// The problem and its place.
    pub problem: ShaderProblem,
    /// The file to open, if it is one on disk.
    pub path: Option<PathBuf>,
    /// The names of the models that are on the picture in their last good version because of it. Empty
    /// when nothing on the picture depends on the file.
    pub stale: Vec<String>,
}

/// A change that came through.
#[derive(Clone, Debug, PartialEq)]
pub struct Reloaded {
    /// The file, as messages name it.
    pub file: String,
    /// The time from the news of the change to the new shader, milliseconds.
    pub milliseconds: f32,
}
