//! The scene formats from outside the crate, by name and extension. Reading and writing is the business of
//! [`scene::formats`](crate::scene::formats), which stands below the registry: here a format is opaque.

use std::{any::Any, fmt, sync::Arc};

use super::{Registry, put};

/// A format of scene files.
#[derive(Clone)]
#[non_exhaustive]
pub struct FormatEntry {
    /// Its name for people.
    pub name: &'static str,
    /// The extensions of its files, without the dot.
    pub extensions: &'static [&'static str],
    /// The format itself, for those who know its type.
    pub(crate) format: Arc<dyn Any + Send + Sync>,
}

impl fmt::Debug for FormatEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FormatEntry").field("name", &self.name).finish_non_exhaustive()
    }
}

impl FormatEntry {
    pub(crate) fn new(
        name: &'static str,
        extensions: &'static [&'static str],
        format: Arc<dyn Any + Send + Sync>,
    ) -> Self {
        Self { name, extensions, format }
    }
}

impl Registry {
    /// The scene formats from outside the crate. [`scene::formats`](crate::scene::formats) lists the built-in ones too.
    #[must_use]
    pub fn scene_formats(&self) -> &[FormatEntry] {
        &self.formats
    }

    /// Adds a checked scene format.
    pub(crate) fn put_scene_format(&mut self, entry: FormatEntry) {
        put(Arc::make_mut(&mut self.formats), entry, |f| f.name);
    }
}
