//! The terms on which a scene is read: how large its file may be, what may be missing, and which files it may name.

use std::fmt;

use super::problem::Problem;
use crate::{
    parameter::Outside,
    text::{path::Path, place::Place},
};

/// Larger files are refused before they are read. Reading takes time proportional to the file, whatever is in it, and at
/// most two seconds per mebibyte, as for all readers: `tests/suite/hostile/text.rs`. The largest legal scene, with every parameter of 10 000 objects
/// given, is less than a tenth of this.
pub const MAX_FILE_BYTES: u64 = 64 << 20;
/// The maximum size of a picture file: that of the largest picture, uncompressed.
pub const MAX_PICTURE_BYTES: u64 = 1 << 30;

/// The treatment of a missing scene size, reflection model or shading model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Defaults {
    /// The caller decides: [`Loaded::missing`](super::load::Loaded::missing) lists them, and the scene already has the defaults.
    #[default]
    Ask,
    /// Defaults are used without asking. [`Loaded::missing`](super::load::Loaded::missing) still lists the parts.
    Use,
    /// Missing parts are an error, which names the flags that accept the defaults.
    Refuse,
}

/// Options for reading a scene. Made of [`Defaults`] alone, they allow it to name no file outside its folder.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a> {
    /// The treatment of missing parts.
    pub defaults: Defaults,
    /// The files outside its folder that the scene may name.
    pub outside: &'a Outside,
}

impl Defaults {
    /// Reading with these defaults, for a scene that may name these files outside its folder.
    #[must_use]
    pub fn allowing(self, outside: &Outside) -> Reading<'_> {
        Reading { defaults: self, outside }
    }
}

impl From<Defaults> for Reading<'_> {
    fn from(defaults: Defaults) -> Self {
        defaults.allowing(Outside::NONE)
    }
}

/// A missing part with a default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// The path in the scene: `scene_size`, `scene_size.depth`, `reflection_model`, `shading_model`.
    pub path: Path,
    /// The default in readable form: `lambert`, `10 × 10 × 10 m`.
    pub default: String,
    /// The position of the enclosing object, which lacks the field.
    pub place: Option<Place>,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (default: {})", self.path, self.default)
    }
}

impl Missing {
    /// The missing part as a problem.
    #[must_use]
    pub fn problem(&self) -> Problem {
        let predicate = format!("is missing; --use-defaults accepts the default, {}", self.default);
        Problem { place: self.place, ..Problem::about(self.path.clone(), predicate) }
    }
}
