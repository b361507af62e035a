//! Errors of a scene and their messages: file, line, column, path, value, rule.

use std::{fmt, io, path::Path as FilePath};

use serde::{Serialize, Serializer};

use super::{
    formats::{self, UnknownExtension},
    load::{MAX_PICTURE_BYTES, Missing},
};
use crate::files::Shown as _;
pub use crate::text::{
    path::{Path, Segment},
    place::Place,
};
use crate::{
    files::{FileError, Kind, follow, words},
    registry::Registry,
};

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

/// The reason why a scene could not be read. [`fmt::Display`] gives one line per problem, each with the name of the
/// file.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file does not exist.
    #[error("{name}: file not found{}", .hint.as_deref().unwrap_or(""))]
    NotFound {
        /// The file.
        name: String,
        /// Similar files that exist, or the target of a link.
        hint: Option<String>,
    },
    /// The path leads to a folder.
    #[error("{name} is a folder; a scene is a single file{}", .hint.as_deref().unwrap_or(""))]
    Folder {
        /// The folder.
        name: String,
        /// The scenes in the folder.
        hint: Option<String>,
    },
    /// The path leads to something other than a file or folder.
    #[error("{name} is {kind}; a scene is a single file, or comes from standard input with -")]
    NoFile {
        /// The name given.
        name: String,
        /// The kind of thing that it is.
        kind: Kind,
    },
    /// The user has no permission to read it.
    #[error("{name}: no permission to read this file")]
    PermissionDenied {
        /// The file.
        name: String,
    },
    /// The file is larger than any legal scene, or picture with a scene.
    #[error("{name} is larger than {} MiB, the most allowed for a {}; it was not read", .most >> 20, kind_of(*.most))]
    TooLarge {
        /// The file.
        name: String,
        /// The limit in bytes.
        most: u64,
    },
    /// Another failure of the operating system.
    #[error("{name} could not be read: {}", words(.source))]
    Io {
        /// The file.
        name: String,
        /// The reason given by the system.
        source: io::Error,
    },
    /// The file contains nothing but white space.
    #[error("{name} is empty; --use-defaults loads the default scene")]
    Empty {
        /// The file.
        name: String,
    },
    /// The file is not UTF-8 text.
    #[error("{name}:{place}: not UTF-8 text: {what}")]
    NotUtf8 {
        /// The file.
        name: String,
        /// The position of the first wrong byte.
        place: Place,
        /// The probable cause.
        what: String,
    },
    /// The file name's extension belongs to no known format.
    #[error("{name}: {unknown}")]
    UnknownExtension {
        /// The file.
        name: String,
        /// The extension, and those that are known.
        unknown: UnknownExtension,
    },
    /// The content does not follow the syntax of the format.
    #[error("{name}:{place}: not {format}: {what}")]
    Syntax {
        /// The name of the format.
        format: &'static str,
        /// The file.
        name: String,
        /// The position where reading stopped.
        place: Place,
        /// What was expected there.
        what: String,
    },
    /// A picture without a readable scene.
    #[error("{name}: {what}")]
    Picture {
        /// The file.
        name: String,
        /// The mistake in the picture.
        what: String,
    },
    /// The content is readable, but not a valid scene. Contains every problem, in the order of the file.
    #[error("{}", lines(.name, .problems))]
    Invalid {
        /// The file.
        name: String,
        /// The problems, at least one.
        problems: Vec<Problem>,
    },
    /// Parts with defaults are missing, and the defaults were declined.
    #[error("{name}:{} {}", .missing.iter().find_map(|m| m.place).map_or_else(String::new, |p| format!("{p}:")), declined(.missing))]
    Missing {
        /// The file.
        name: String,
        /// The missing parts, at least one.
        missing: Vec<Missing>,
    },
}

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

    /// The problems as data: those of an invalid scene, or otherwise the error itself as a single problem.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let (place, what) = match self {
            Self::Invalid { problems, .. } => return problems.clone(),
            Self::Missing { missing, .. } => return missing.iter().map(Missing::problem).collect(),
            Self::NotUtf8 { place, what, .. } => (Some(*place), format!("is not UTF-8 text: {what}")),
            Self::Syntax { format, place, what, .. } => (Some(*place), format!("is not {format}: {what}")),
            Self::Picture { what, .. } => (None, format!("could not be read: {what}")),
            Self::UnknownExtension { unknown, .. } => (None, format!("could not be read: {unknown}")),
            Self::NotFound { .. } => (None, "could not be read: file not found".to_owned()),
            Self::Folder { .. } => (None, "could not be read: it is a folder".to_owned()),
            Self::NoFile { kind, .. } => (None, format!("could not be read: it is {kind}")),
            Self::PermissionDenied { .. } => (None, "could not be read: no permission".to_owned()),
            Self::TooLarge { most, .. } => (None, format!("is larger than {} MiB", most >> 20)),
            Self::Io { source, .. } => (None, format!("could not be read: {}", words(source))),
            Self::Empty { .. } => (None, "is empty".to_owned()),
        };
        vec![Problem { place, ..Problem::about(Path::root(), what) }]
    }
}

/// The kind of file with this limit.
fn kind_of(most: u64) -> &'static str {
    if most == MAX_PICTURE_BYTES { "picture with a scene in it" } else { "scene" }
}

/// One line per problem.
fn lines(name: &str, problems: &[Problem]) -> String {
    let line = |p: &Problem| match p.place {
        Some(_) => format!("{name}:{p}"),
        None => format!("{name}: {p}"),
    };
    problems.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The missing parts, and the flags that accept or reject their defaults.
fn declined(missing: &[Missing]) -> String {
    let parts: Vec<_> = missing.iter().map(ToString::to_string).collect();
    let verb = if missing.len() == 1 { "is" } else { "are" };
    format!(
        "{} {verb} missing; --use-defaults accepts the defaults, --no-defaults rejects them",
        crate::text::listed(&parts, "and")
    )
}

/// "; it is a link to room.json, which does not exist" if the path is such a link.
fn broken_link(path: &FilePath) -> Option<String> {
    if !std::fs::symlink_metadata(path).ok()?.is_symlink() {
        return None;
    }
    Some(format!("; it is a link to {}, which does not exist", follow(path).ok()?.shown()))
}

/// ". Did you mean scenes/room.json?" if there is a file with a similar name.
fn similar_file(path: &FilePath) -> Option<String> {
    let wanted = path.file_name()?.to_str()?.to_lowercase();
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(FilePath::new("."));
    // A folder can be huge; a hint is not worth more than a glance at it.
    let nearest = std::fs::read_dir(folder)
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
    let mut names: Vec<_> = std::fs::read_dir(path)
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
