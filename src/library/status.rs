//! The status of the shaders for display: the folders in which they are edited, their problems, and the
//! models that the picture shows in an older version.

use std::path::PathBuf;

use crate::{registry::Folders, shader::check::ShaderProblem, text::listed};

/// The shader folders and their problems. Updated by the renderer when something changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShaderStatus {
    /// Folders, as in the registry.
    pub folders: Folders,
    /// Problems.
    pub troubles: Vec<Trouble>,
    /// The last change that took effect.
    pub last: Option<Reloaded>,
}

impl ShaderStatus {
    /// The names of the models that the picture shows in their last valid version, each once.
    #[must_use]
    pub fn stale(&self) -> Vec<&str> {
        let mut names: Vec<_> =
            self.troubles.iter().flat_map(|t| t.stale.iter().map(String::as_str)).collect();
        names.sort_unstable();
        names.dedup();
        names
    }
}

/// A problem with a shader, and its effect on the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Trouble {
    /// The problem and its position.
    pub problem: ShaderProblem,
    /// The file to open, if it is on disk.
    pub path: Option<PathBuf>,
    /// The names of the models that the picture shows in their last valid version because of the problem.
    /// Empty if nothing in the picture depends on the file.
    pub stale: Vec<String>,
}

/// A change that took effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Reloaded {
    /// Name of the file, as in messages.
    pub file: String,
    /// Time from the notification of the change to the new shader, in milliseconds.
    pub milliseconds: f32,
}

/// Appended to the name of a model without a valid version: grey Lambert is drawn instead.
pub const STAND_IN: &str = " (a grey stand-in)";

/// A description of what the picture shows instead of these models: "the last good version of A and B", "a
/// grey stand-in for A".
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
