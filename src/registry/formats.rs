//! Scene formats from other crates, by name and extension. They are read and written by
//! [`scene::formats`](crate::scene::formats), which depends on the registry: here a format is opaque.

use std::{any::Any, fmt, sync::Arc};

use super::{Registry, put};

/// A format of scene files.
#[derive(Clone)]
#[non_exhaustive]
pub struct FormatEntry {
    /// Display name.
    pub name: &'static str,
    /// File extensions, without the dot.
    pub extensions: &'static [&'static str],
    /// The format itself, for code that knows its type.
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
    /// The scene formats from other crates. [`scene::formats`](crate::scene::formats) lists the built-in ones
    /// too.
    #[must_use]
    pub fn scene_formats(&self) -> &[FormatEntry] {
        &self.formats
    }

    /// Adds a checked scene format.
    pub(crate) fn put_scene_format(&mut self, entry: FormatEntry) {
        put(Arc::make_mut(&mut self.formats), entry, |f| f.name);
    }
}
