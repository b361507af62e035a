//! The interface to scene files: what the window needs, independent of the implementation.

use std::path::Path;

use super::{prelude::*, state::MissingPart};
use crate::{parameter::Outside, scene::load::Stamp};

/// Reading and writing scene files.
pub trait Files: Send + Sync + 'static {
    /// Reads a scene file, which may name the files `outside` its folder.
    fn open(&mut self, path: &Path, registry: &Registry, outside: &Outside) -> Opened;
    /// Writes a scene file completely or not at all. Without `overwrite`, leaves alone a file that changed on disk
    /// since it was opened or saved.
    fn save(&mut self, path: &Path, scene: &Scene, registry: &Registry, overwrite: bool) -> Saved;
    /// Writes a scene file other than the document's, completely or not at all. Without `overwrite`, leaves an existing
    /// file alone.
    fn save_copy(&mut self, path: &Path, scene: &Scene, registry: &Registry, overwrite: bool) -> Saved;
    /// Like [`open`](Self::open) if the content differs from when it was opened or saved.
    fn check(&mut self, path: &Path, registry: &Registry, outside: &Outside) -> OnDisk;
    /// Sets the state of the file that saving may replace: its content, or its absence.
    fn expect(&mut self, path: &Path, version: Option<Stamp>);
}

/// The result of checking a file for changes.
#[derive(Clone, Debug, PartialEq)]
pub enum OnDisk {
    /// The file is unchanged.
    Same,
    /// The file does not exist.
    Gone,
    /// The content has changed.
    Changed {
        /// Fingerprint of the content.
        version: Stamp,
        /// The new content.
        content: Opened,
    },
}

/// The result of opening a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Opened {
    /// A valid scene.
    Scene(Box<Scene>),
    /// A scene with missing parts, which are replaced by defaults.
    Incomplete {
        /// The scene with defaults.
        scene: Box<Scene>,
        /// The missing parts.
        parts: Vec<MissingPart>,
    },
    /// The file is empty.
    Empty,
    /// The file cannot be used: the problems, one sentence each.
    Failed(Vec<String>),
}

/// The result of saving a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Saved {
    /// The file was written.
    Done,
    /// Another program changed the file; it was left alone.
    ChangedOnDisk,
    /// Why the scene could not be written in this format, while another format can hold it.
    OtherFormat(String),
    /// Why the file could not be written.
    Failed(String),
}
