//! The order of the window's work within [`LabSystems::Load`].

use bevy::ecs::prelude::*;

#[cfg(doc)]
use crate::render::schedule::LabSystems;

/// The steps within [`LabSystems::Load`], in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Loading {
    /// Collect changed files from the watcher.
    Watch,
    /// Read shaders and custom models.
    Shaders,
    /// Check the file of the document.
    Follow,
    /// Carry out the effects of the panels.
    Effects,
    /// Offer recovery copies of unsaved work.
    Recovery,
    /// Select on clicks into the picture.
    Pick,
    /// Copy the document to the displayed scene.
    Publish,
}
