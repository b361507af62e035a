//! The boundary to scene files: what the window needs, and nothing of how it is done.

use std::path::Path;

use super::state::MissingPart;
use crate::{
    registry::Registry,
    scene::{Scene, load::Stamp},
};

/// Reading and writing scene files.
pub trait Files: Send + Sync + 'static {
    /// Reads a scene file.
    fn open(&mut self, path: &Path, registry: &Registry) -> Opened;
    /// Writes a scene file, all or nothing. Without `overwrite`, a file that changed on disk since it
    /// was opened or saved is left alone.
    fn save(&mut self, path: &Path, scene: &Scene, registry: &Registry, overwrite: bool) -> Saved;
    /// Writes a scene file that is not the document's, all or nothing. Without `overwrite`, a file that is there is left
    /// alone.
    fn save_copy(&mut self, path: &Path, scene: &Scene, registry: &Registry, overwrite: bool) -> Saved;
    /// Reads a scene file if its content is another one than when it was opened or saved.
    fn look(&mut self, path: &Path, registry: &Registry) -> Looked;
    /// Sets the state of the file that saving may replace: its content, or its absence.
    fn expect(&mut self, path: &Path, version: Option<Stamp>);
}

/// The result of looking at a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Looked {
    /// It is unchanged.
    Same,
    /// There is no such file.
    Gone,
    /// Its content has changed.
    Changed {
        /// The fingerprint of the content.
        version: Stamp,
        /// Its content.
        content: Opened,
    },
}

/// The result of opening a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Opened {
    /// It holds a legal scene.
    Scene(Box<Scene>),
    /// It holds a scene that lacks parts; here it is with the defaults in place.
    Incomplete {
        /// With defaults.
        scene: Box<Scene>,
        /// The missing parts.
        parts: Vec<MissingPart>,
    },
    /// It is empty.
    Empty,
    /// It cannot be used: every problem, one sentence each.
    Failed(Vec<String>),
}

/// The result of saving a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Saved {
    /// It is on disk.
    Done,
    /// Somebody else changed it; it was left alone.
    ChangedOnDisk,
    /// The reason why it could not be written in its format. Another one can hold the scene.
    OtherFormat(String),
    /// The reason why it could not be written.
    Failed(String),
}
