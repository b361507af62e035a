//! Temporary files and folders.

pub use tempfile::{Builder, NamedTempFile, PersistError, TempDir};
