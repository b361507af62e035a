//! What happens around the program.

use std::path::PathBuf;

/// Something that happened around the program, for its user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// Something to know.
    Info(String),
    /// Something that went wrong.
    Warning(String),
    /// A file that was written, but could not be kept after all, and why.
    Unkept(PathBuf, String),
    /// A text that is on the clipboard now.
    Copied(String),
    /// A text that was not copied to the clipboard, and why.
    Uncopied(String, String),
}
