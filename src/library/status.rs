//! The status of the shaders for people: the folders in which they are edited, their problems, and the models that the
//! picture shows in an older version.

use std::path::PathBuf;

use crate::{registry::Folders, shader::check::ShaderProblem, text::listed};

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

/// Behind the name of a model of which there is no good version: grey Lambert is drawn instead.
pub const STAND_IN: &str = " (a grey stand-in)";

/// What the picture shows instead of these models: "the last good version of A and B", "a grey stand-in for A".
#[must_use]
pub fn shown_instead(names: &[impl AsRef<str>]) -> String {
    let bare: Option<Vec<_>> = names.iter().map(|name| name.as_ref().strip_suffix(STAND_IN)).collect();
    match bare {
        Some(bare) => format!("a grey stand-in for {}", listed(&bare, "and")),
        None => format!("the last good version of {}", listed(names, "and")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stand_in_is_no_last_good_version() {
        let said = |names: &[&str]| shown_instead(names);
        assert_eq!(said(&["A", "B"]), "the last good version of A and B");
        assert_eq!(said(&["A (a grey stand-in)"]), "a grey stand-in for A");
        assert_eq!(said(&["A (a grey stand-in)", "B"]), "the last good version of A (a grey stand-in) and B");
    }
}
