//! Errors of a scene and their messages: file, line, column, path, value, rule.

use std::io;

use super::reading::{MAX_PICTURE_BYTES, Missing};
use crate::files::{Kind, words};

pub use super::problem::{MOST_LISTED, Problem};
pub use crate::text::{
    path::{Path, Segment},
    place::Place,
};

/// The reason why a scene could not be read. [`Display`](std::fmt::Display) gives one line per problem, each with the name of the
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
    #[error(
        "{name} is {kind}; a scene is a single file, or what a program writes to a pipe or, with -, to standard input"
    )]
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
        /// The content that was expected there.
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
    /// An address that holds or names no readable scene.
    #[error("{name}: {what}")]
    Address {
        /// The link, or the name in the address.
        name: String,
        /// The mistake.
        what: String,
    },
    /// The content is readable, but not a valid scene. Contains the problems in the order of the file: [`MOST_LISTED`], and
    /// one that says how many more there are.
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
    /// The problems as data: those of an invalid scene, or otherwise the error itself as a single problem.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let (place, what) = match self {
            Self::Invalid { problems, .. } => return problems.clone(),
            Self::Missing { missing, .. } => return missing.iter().map(Missing::problem).collect(),
            Self::NotUtf8 { place, what, .. } => (Some(*place), format!("is not UTF-8 text: {what}")),
            Self::Syntax { format, place, what, .. } => (Some(*place), format!("is not {format}: {what}")),
            Self::Picture { what, .. } | Self::Address { what, .. } => {
                (None, format!("could not be read: {what}"))
            }
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

/// The error for a file whose extension belongs to no format.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(".{extension} is not the extension of a scene; scenes are {known}")]
#[non_exhaustive]
pub struct UnknownExtension {
    /// The extension, without the dot.
    pub extension: String,
    /// The extensions of scenes, with the names of their formats.
    pub known: String,
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
