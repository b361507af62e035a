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
    let (good, bare) = parted(names);
    let good = (!good.is_empty()).then(|| format!("the last good version of {}", listed(&good, "and")));
    let bare = (!bare.is_empty()).then(|| format!("a grey stand-in for {}", listed(&bare, "and")));
    good.into_iter().chain(bare).collect::<Vec<_>>().join(", and ")
}

/// The same without names, in short: "the last good version", "a grey stand-in".
#[must_use]
pub fn kind_shown_instead(names: &[impl AsRef<str>]) -> &'static str {
    match parted(names) {
        (_, bare) if bare.is_empty() => "the last good version",
        (good, bare) if good.is_empty() && bare.len() == 1 => "a grey stand-in",
        (good, _) if good.is_empty() => "grey stand-ins",
        _ => "last good versions and grey stand-ins",
    }
}

/// The names of models of which the last good version is shown, and of those with a stand-in.
fn parted(names: &[impl AsRef<str>]) -> (Vec<&str>, Vec<&str>) {
    let (bare, good): (Vec<_>, Vec<_>) =
        names.iter().map(AsRef::<str>::as_ref).partition(|name| name.ends_with(STAND_IN));
    (good, bare.into_iter().map(|name| name.trim_end_matches(STAND_IN)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stand_in_is_no_last_good_version() {
        let said = |names: &[&str]| shown_instead(names);
        assert_eq!(said(&["A", "B"]), "the last good version of A and B");
        assert_eq!(said(&["A (a grey stand-in)"]), "a grey stand-in for A");
        let both = ["A (a grey stand-in)", "B"];
        assert_eq!(said(&both), "the last good version of B, and a grey stand-in for A");
        assert_eq!(kind_shown_instead(&both[1..]), "the last good version");
        assert_eq!(kind_shown_instead(&both[..1]), "a grey stand-in");
        assert_eq!(kind_shown_instead(&[both[0]; 2]), "grey stand-ins");
        assert_eq!(kind_shown_instead(&both), "last good versions and grey stand-ins");
    }
}
