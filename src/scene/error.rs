//! What can be wrong with a scene, and how it is said: file, line, column, path, value, rule.

use std::{fmt, io, path::Path as FilePath};

use serde::{Serialize, Serializer};

use super::load::{MAX_FILE_BYTES, Missing};
use crate::files::{FileError, Kind};
pub use crate::text::{
    path::{Path, Segment},
    place::Place,
};

/// One thing that is wrong with a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Where in the file, if the scene came from one.
    pub place: Option<Place>,
    /// Where in the scene.
    pub path: Path,
    /// The value as it is written, if a value breaks a rule.
    pub found: Option<String>,
    /// The rule that it breaks, as the end of "k_d is 0.2, but …"; without a value the whole predicate:
    /// "is missing; …".
    pub rule: String,
}

impl Problem {
    /// A value that breaks a rule.
    #[must_use]
    pub fn value(path: Path, found: impl fmt::Display, rule: impl Into<String>) -> Self {
        Self { place: None, path, found: Some(found.to_string()), rule: rule.into() }
    }

    /// Something that is not about a value: a missing field, an unknown key.
    #[must_use]
    pub fn about(path: Path, predicate: impl Into<String>) -> Self {
        Self { place: None, path, found: None, rule: predicate.into() }
    }

    /// The predicate without place and path: "is 0.2, but the diffuse coefficient must be between 0.5
    /// and 1".
    #[must_use]
    pub fn message(&self) -> String {
        match &self.found {
            Some(found) => format!("is {found}, but {}", self.rule),
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
        /// What programs read.
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

/// Why a scene could not be read. [`fmt::Display`] gives one line per problem, each with the name of
/// the file.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// There is no such file.
    #[error("{name}: there is no such file{}", .hint.as_deref().unwrap_or(""))]
    NotFound {
        /// The file.
        name: String,
        /// What there is instead.
        hint: Option<String>,
    },
    /// The path leads to a folder.
    #[error("{name} is a folder; a scene is a single JSON file{}", .hint.as_deref().unwrap_or(""))]
    Folder {
        /// The folder.
        name: String,
        /// Which scenes are in it.
        hint: Option<String>,
    },
    /// The path leads to something that is neither file nor folder.
    #[error("{name} is {kind}; a scene is a single JSON file, or comes from standard input with -")]
    NoFile {
        /// What was named.
        name: String,
        /// What it is.
        kind: Kind,
    },
    /// The operating system does not let this user read it.
    #[error("{name}: no permission to read this file")]
    PermissionDenied {
        /// The file.
        name: String,
    },
    /// Larger than any scene can be.
    #[error("{name} is larger than {} MiB, which no scene is; it was not read", MAX_FILE_BYTES >> 20)]
    TooLarge {
        /// The file.
        name: String,
    },
    /// Another failure of the operating system.
    #[error("{name} could not be read: {source}")]
    Io {
        /// The file.
        name: String,
        /// What the system says.
        source: io::Error,
    },
    /// Nothing but white space.
    #[error("{name} is empty. Load the default scene?")]
    Empty {
        /// The file.
        name: String,
    },
    /// Not text in UTF-8.
    #[error("{name}:{place}: not UTF-8 text: {what}")]
    NotUtf8 {
        /// The file.
        name: String,
        /// Where the first wrong byte is.
        place: Place,
        /// What it is, as far as one can tell.
        what: String,
    },
    /// Not JSON.
    #[error("{name}:{place}: not JSON: {what}")]
    Syntax {
        /// The file.
        name: String,
        /// Where reading stopped.
        place: Place,
        /// What was expected.
        what: String,
    },
    /// JSON, but not a valid scene. Every problem is here, in the order of the file.
    #[error("{}", lines(.name, .problems))]
    Invalid {
        /// The file.
        name: String,
        /// At least one.
        problems: Vec<Problem>,
    },
    /// Parts are missing for which there are defaults, and these were declined (R3).
    #[error("{name}:{} {}", .missing.iter().find_map(|m| m.place).map_or_else(String::new, |p| format!("{p}:")), declined(.missing))]
    Missing {
        /// The file.
        name: String,
        /// At least one.
        missing: Vec<Missing>,
    },
}

impl LoadError {
    /// An error of the operating system while a file was opened or read.
    #[must_use]
    pub fn from_io(path: &FilePath, name: &str, source: io::Error) -> Self {
        let name = name.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound => Self::NotFound { hint: similar_file(path), name },
            io::ErrorKind::PermissionDenied => Self::PermissionDenied { name },
            io::ErrorKind::IsADirectory => Self::Folder { hint: scenes_within(path), name },
            _ => Self::Io { name, source },
        }
    }

    /// The error that a file could not be read.
    #[must_use]
    pub fn from_file(path: &FilePath, error: FileError) -> Self {
        let name = path.display().to_string();
        match error {
            FileError::Kind(Kind::Folder) => Self::Folder { hint: scenes_within(path), name },
            FileError::Kind(kind) => Self::NoFile { name, kind },
            FileError::TooLarge(_) => Self::TooLarge { name },
            error => Self::from_io(path, &name, error.into()),
        }
    }

    /// The problems as data: those of an invalid scene, or the error itself as the only one.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let (place, what) = match self {
            Self::Invalid { problems, .. } => return problems.clone(),
            Self::Missing { missing, .. } => return missing.iter().map(Missing::problem).collect(),
            Self::NotUtf8 { place, what, .. } => (Some(*place), format!("is not UTF-8 text: {what}")),
            Self::Syntax { place, what, .. } => (Some(*place), format!("is not JSON: {what}")),
            Self::NotFound { .. } => (None, "could not be read: there is no such file".to_owned()),
            Self::Folder { .. } => (None, "could not be read: it is a folder".to_owned()),
            Self::NoFile { kind, .. } => (None, format!("could not be read: it is {kind}")),
            Self::PermissionDenied { .. } => (None, "could not be read: no permission".to_owned()),
            Self::TooLarge { .. } => (None, format!("is larger than {} MiB", MAX_FILE_BYTES >> 20)),
            Self::Io { source, .. } => (None, format!("could not be read: {source}")),
            Self::Empty { .. } => (None, "is empty".to_owned()),
        };
        vec![Problem { place, ..Problem::about(Path::root(), what) }]
    }
}

/// One line per problem.
fn lines(name: &str, problems: &[Problem]) -> String {
    let line = |p: &Problem| match p.place {
        Some(_) => format!("{name}:{p}"),
        None => format!("{name}: {p}"),
    };
    problems.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// What is missing and how to say yes.
fn declined(missing: &[Missing]) -> String {
    let parts: Vec<_> = missing.iter().map(ToString::to_string).collect();
    let verb = if missing.len() == 1 { "is" } else { "are" };
    format!(
        "{} {verb} missing; --use-defaults takes the defaults, --no-defaults refuses them",
        crate::text::listed(&parts, "and")
    )
}

/// ". Did you mean scenes/room.json?" if a file with a similar name is there.
fn similar_file(path: &FilePath) -> Option<String> {
    let wanted = path.file_name()?.to_str()?.to_lowercase();
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(FilePath::new("."));
    // A folder can be huge; a hint is not worth more than a glance at it.
    let nearest = std::fs::read_dir(folder)
        .ok()?
        .take(1000)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .map(|name| (strsim::jaro_winkler(&wanted, &name.to_lowercase()), name))
        .filter(|(likeness, _)| *likeness > 0.85)
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(format!(". Did you mean {}?", path.with_file_name(nearest.1).display()))
}

/// "; it holds a.json, b.json".
fn scenes_within(path: &FilePath) -> Option<String> {
    let mut names: Vec<_> = std::fs::read_dir(path)
        .ok()?
        .take(1000)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".json") && !name.ends_with(".schema.json"))
        .collect();
    names.sort();
    let more = if names.len() > 5 { " and more" } else { "" };
    names.truncate(5);
    (!names.is_empty()).then(|| format!("; this one holds {}{more}", names.join(", ")))
}
