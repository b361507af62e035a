//! Scene files on disk, for the panels.

use std::{
    io,
    path::{Path, PathBuf},
};

use bevy::ecs::resource::Resource;

use crate::{
    files::{self, Kind, Shown as _},
    panel::{
        files::{Files, OnDisk, Opened, Saved},
        state::MissingPart,
    },
    parameter::Outside,
    registry::Registry,
    scene::{
        Scene,
        error::LoadError,
        load::{self, Defaults, Loaded, Stamp},
        save::{self, Expected, SaveError, Unwritten},
    },
};

/// Reads and writes scene files, and remembers the last seen version of the document's file.
#[derive(Debug, Resource)]
pub struct DiskFiles {
    seen: Option<(PathBuf, Stamp)>,
    /// A file that was read, but is not the document yet, since the user may have to answer a question first.
    read: Option<(PathBuf, Stamp)>,
    /// A document from a pipe or a device, which can be read only once.
    stream: Option<PathBuf>,
}

impl DiskFiles {
    /// Creates the state for a file that was already read, with its version.
    #[must_use]
    pub fn new(file: Option<PathBuf>, stamp: Option<Stamp>) -> Self {
        let stream = if stamp.is_none() { file.clone() } else { None };
        Self { seen: file.zip(stamp), read: None, stream }
    }

    /// The version of a file when it was last read or written, if ever.
    #[must_use]
    pub fn known(&self, path: &Path) -> Option<Stamp> {
        self.seen.as_ref().filter(|(seen, _)| seen == path).map(|(_, stamp)| *stamp)
    }

    /// Makes the file that was just read the document's file, if it has this path.
    pub fn document_changed(&mut self, path: Option<&Path>) {
        self.seen = self.read.take().filter(|read| Some(read.0.as_path()) == path);
    }
}

impl Files for DiskFiles {
    fn open(&mut self, path: &Path, registry: &Registry, outside: &Outside) -> Opened {
        let read = load::file(path, registry, Defaults::Ask.allowing(outside));
        if let Ok(loaded) = &read {
            self.read = Some((path.to_owned(), loaded.stamp));
        }
        opened(read)
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
            Err(SaveError { why: Unwritten::Changed | Unwritten::Exists | Unwritten::Gone, .. }) => {
                Saved::ChangedOnDisk
            }
            Err(error) if error.is_about_format() => Saved::OtherFormat(error.to_string()),
            Err(error) => Saved::Failed(error.to_string()),
        }
    }

    fn save_copy(&mut self, path: &Path, scene: &Scene, registry: &Registry, overwrite: bool) -> Saved {
        // The known version of the document's own file stays.
        let seen = self.seen.take();
        let saved = self.save(path, scene, registry, overwrite);
        self.seen = seen;
        saved
    }

    fn check(&mut self, path: &Path, registry: &Registry, outside: &Outside) -> OnDisk {
        match files::kind(path) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => return OnDisk::Gone,
            Ok(Kind::Pipe | Kind::Device) if self.stream.as_deref() == Some(path) => return OnDisk::Same,
            // Anything else at that path is an error like any other.
            _ => {}
        }
        let bytes = match load::bytes(path, registry) {
            Ok(bytes) => bytes,
            Err(error) => {
                let version = Stamp::of(error.to_string().as_bytes());
                return OnDisk::Changed { version, content: opened(Err(error)) };
            }
        };
        let version = Stamp::of(&bytes);
        if self.seen.as_ref().is_some_and(|(seen, stamp)| seen == path && *stamp == version) {
            return OnDisk::Same;
        }
        let name = path.shown().to_string();
        let read = load::from_bytes(&bytes, &name, registry, Defaults::Ask.allowing(outside));
        let content = opened(read);
        OnDisk::Changed { version, content }
    }

    fn expect(&mut self, path: &Path, version: Option<Stamp>) {
        self.seen = version.map(|version| (path.to_owned(), version));
    }
}

/// Converts the result of reading a file for the panels.
fn opened(read: Result<Loaded, LoadError>) -> Opened {
    match read {
        Ok(Loaded { scene, missing, .. }) if missing.is_empty() => Opened::Scene(Box::new(scene)),
        Ok(Loaded { scene, missing, .. }) => {
            let part = |m: load::Missing| MissingPart { name: m.path.to_string(), default: m.default };
            Opened::Incomplete { scene: Box::new(scene), parts: missing.into_iter().map(part).collect() }
        }
        Err(LoadError::Empty { .. }) => Opened::Empty,
        Err(error) => Opened::Failed(error.to_string().lines().map(str::to_owned).collect()),
    }
}
