//! Permission to read files outside the folder of a scene: a scene may come from anybody, and cannot grant it. Whoever
//! reads a scene says which it has.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

/// The files outside its folder that a scene may name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outside {
    all: bool,
    some: BTreeSet<PathBuf>,
}

impl Outside {
    /// The command-line option that allows all.
    pub const OPTION: &'static str = "--allow-outside";
    /// None.
    pub const NONE: &'static Self = &Self { all: false, some: BTreeSet::new() };
    /// All.
    pub const ALL: &'static Self = &Self { all: true, some: BTreeSet::new() };

    /// Allows a file.
    pub(super) fn add(&mut self, path: &Path) {
        self.some.insert(path.to_owned());
    }

    /// True for a file that may be anywhere.
    pub(crate) fn allows(&self, path: &Path) -> bool {
        self.all || self.some.contains(path)
    }
}
