//! A problem of a scene: path, value, rule, and the position in the file.

use std::fmt;

use serde::{Serialize, Serializer};

use crate::text::{behind, path::Path, place::Place};

/// Maximum number of problems kept while a file is read. A scene within the limits of lights and objects with errors in
/// every field has fewer; a hostile file could have millions.
pub(super) const MAX_PROBLEMS: usize = 200_000;

/// Maximum number of problems listed, the first in the file; the others are counted.
pub const MOST_LISTED: usize = 200;

/// One problem of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The position in the file, if the scene came from one.
    pub place: Option<Place>,
    /// The path of the value in the scene.
    pub path: Path,
    /// The value as written, if a value breaks a rule.
    pub found: Option<String>,
    /// The broken rule, as the end of "k_d is 0.2, but …"; without a value, the whole predicate: "is missing;
    /// …".
    pub rule: String,
}

impl Problem {
    /// A value that breaks a rule.
    #[must_use]
    pub fn value(path: Path, found: impl fmt::Display, rule: impl Into<String>) -> Self {
        Self { place: None, path, found: Some(found.to_string()), rule: rule.into() }
    }

    /// A problem without a value: a missing field, an unknown key.
    #[must_use]
    pub fn about(path: Path, predicate: impl Into<String>) -> Self {
        Self { place: None, path, found: None, rule: predicate.into() }
    }

    /// The predicate without position and path: "is 0.2, but the diffuse coefficient must be between 0.5 and
    /// 1".
    #[must_use]
    pub fn message(&self) -> String {
        match &self.found {
            Some(found) => format!("is {found}, but {}", behind(self.path.last_key(), &self.rule)),
            None => self.rule.clone(),
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = self.place {
            write!(f, "{place}: ")?;
        }
        if self.path.segments().is_empty() {
            write!(f, "the scene {}", self.message())
        } else {
            write!(f, "{} {}", self.path, self.message())
        }
    }
}

impl Serialize for Problem {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        /// The problem in machine-readable form.
        #[derive(Serialize)]
        struct Record<'a> {
            line: Option<usize>,
            column: Option<usize>,
            path: Option<&'a Path>,
            value: Option<&'a str>,
            message: String,
        }
        Record {
            line: self.place.map(|p| p.line),
            column: self.place.map(|p| p.column),
            path: Some(&self.path),
            value: self.found.as_deref(),
            message: Self { place: None, ..self.clone() }.to_string(),
        }
        .serialize(serializer)
    }
}
