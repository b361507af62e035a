//! Files that several paths lead to.

use std::path::Path;

pub use file_id::FileId;

/// What identifies a file, whatever paths lead to it.
#[must_use]
pub fn file_id(path: &Path) -> Option<FileId> {
    file_id::get_file_id(path).ok()
}
