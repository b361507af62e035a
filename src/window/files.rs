//! Scene files on disk, for the panels.

use std::path::{Path, PathBuf};

use bevy::ecs::resource::Resource;

use crate::{
    panel::{
        files::{Files, Opened, Saved},
        state::MissingPart,
    },
    registry::Registry,
    scene::{
        Scene,
        error::LoadError,
        load::{self, Defaults, Stamp},
        save::{self, Expected, SaveError},
    },
};

/// Reads and writes scene files, and remembers in which state it saw the last one.
#[derive(Debug, Resource)]
pub(super) struct DiskFiles {
    seen: Option<(PathBuf, Stamp)>,
    /// A file that was read, but is not yet the document: there may be something to ask first.
    read: Option<(PathBuf, Stamp)>,
}

impl DiskFiles {
    pub(super) fn new(file: Option<PathBuf>, stamp: Option<Stamp>) -> Self {
        Self { seen: file.zip(stamp), read: None }
    }

    /// Another document is open: what was read of its file is what counts from now on.
    pub(super) fn document_changed(&mut self, path: Option<&Path>) {
        self.seen = self.read.take().filter(|read| Some(read.0.as_path()) == path);
    }
}

impl Files for DiskFiles {
    fn open(&mut self, path: &Path, registry: &Registry) -> Opened {
        match load::file(path, registry, Defaults::Ask) {
            Ok(loaded) => {
                self.read = Some((path.to_owned(), loaded.stamp));
                if loaded.missing.is_empty() {
                    return Opened::Scene(Box::new(loaded.scene));
                }
                let parts = loaded
                    .missing
                    .iter()
                    .map(|m| MissingPart { name: m.path.to_string(), default: m.default.clone() })
                    .collect();
                Opened::Incomplete { scene: Box::new(loaded.scene), parts }
            }
            Err(LoadError::Empty { .. }) => Opened::Empty,
            Err(error) => Opened::Failed(error.to_string().lines().map(str::to_owned).collect()),
        }
    }

    fn save(&mut self, path: &Path, scene: &Scene, registry: &Registry, overwrite: bool) -> Saved {
        let expected = match &self.seen {
            _ if overwrite => Expected::Anything,
            Some((seen, stamp)) if seen == path => Expected::Unchanged(*stamp),
            _ => Expected::Nothing,
        };
        match save::write(path, scene, registry, expected) {
            Ok(stamp) => {
                self.seen = Some((path.to_owned(), stamp));
                Saved::Done
            }
            Err(SaveError::Changed { .. } | SaveError::Exists { .. } | SaveError::Gone { .. }) => {
                Saved::ChangedOnDisk
            }
            Err(error) => Saved::Failed(error.to_string()),
        }
    }
}
