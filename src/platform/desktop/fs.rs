//! Files.

pub use std::{fs::*, path::absolute};

use std::path::Path;

/// True if something is there.
pub fn is_there(path: impl AsRef<Path>) -> bool {
    path.as_ref().exists()
}

/// True if a folder is there.
pub fn is_dir(path: impl AsRef<Path>) -> bool {
    path.as_ref().is_dir()
}

/// True if a file is there.
pub fn is_file(path: impl AsRef<Path>) -> bool {
    path.as_ref().is_file()
}

/// True for a link.
pub fn is_symlink(path: impl AsRef<Path>) -> bool {
    path.as_ref().is_symlink()
}
