//! What people are told of the shaders: where they are edited, what is wrong with them, and what the
//! picture shows instead.

use std::path::PathBuf;

use crate::shader::check::ShaderProblem;

/// Where the shaders come from and what is wrong with them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShaderStatus {
    /// The folder whose shader files are watched; none when the built-in copies are in use.
    pub shaders: Option<PathBuf>,
    /// The folder whose files are custom models.
    pub models: Option<PathBuf>,
    /// What is wrong, one entry for each problem.
    pub troubles: Vec<Trouble>,
    /// The last change that came through, for people: what, and how long it took.
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

/// A problem with a shader, and what it means for the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Trouble {
    /// What is wrong, and where.
    pub problem: ShaderProblem,
    /// The file to open, when it is one on disk.
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
    /// From the news of the change to the new shader, milliseconds.
    pub milliseconds: f32,
}
