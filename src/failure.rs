//! Failure of a command, with its exit status.

use std::{fmt, io};

use crate::files::words;

/// The reason why a command failed.
#[derive(Debug)]
pub enum Failure {
    /// A scene or an input is invalid: exit status 1. One line per problem.
    Invalid(String),
    /// The command line is wrong: exit status 2.
    Usage(String),
    /// No renderer or no display is available: exit status 3.
    NoRenderer(String),
    /// A result could not be written: exit status 4.
    Write(String),
    /// The reader of the output closed it: not an error.
    Closed,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid(what) | Self::Usage(what) | Self::NoRenderer(what) | Self::Write(what) => {
                f.write_str(what)
            }
            Self::Closed => f.write_str("no process reads the output"),
        }
    }
}

impl From<io::Error> for Failure {
    /// An error on standard output.
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::Closed,
            _ => Self::Write(format!("standard output: {}", words(&error))),
        }
    }
}

impl Failure {
    /// The exit status.
    #[must_use]
    pub fn status(&self) -> u8 {
        match self {
            Self::Closed => 0,
            Self::Invalid(_) => 1,
            Self::Usage(_) => 2,
            Self::NoRenderer(_) => 3,
            Self::Write(_) => 4,
        }
    }
}
