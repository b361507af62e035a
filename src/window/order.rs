//! The order of the window's work within [`LabSystems::Load`].

use bevy::ecs::prelude::*;

#[cfg(doc)]
use crate::render::schedule::LabSystems;

/// The steps within [`LabSystems::Load`], in their order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Loading {
    /// The watcher is asked for files that changed.
    Watch,
    /// Shaders and custom models are read.
    Shaders,
    /// The file of the document is looked at.
    Follow,
    /// What the panels asked for is carried out.
    Effects,
    /// Copies of unsaved work are offered.
    Recovery,
    /// A click into the picture selects.
    Pick,
    /// The document goes into the scene that is shown.
    Publish,
}
