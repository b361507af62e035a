//! The choices with which an object is drawn.

use bevy::ecs::component::Component;

use crate::{optics::colour::Encoding, reflection::Passage, registry::LightSet};

/// The model, shading model and settings with which an object is drawn.
#[derive(Clone, Component, Debug, Default, PartialEq)]
pub struct Drawn {
    pub(super) model: String,
    pub(super) shading: String,
    /// The passage of light through its surface.
    pub(super) passage: Passage,
    pub(super) encoding: Encoding,
    pub(super) everywhere: bool,
    /// The light types in its shader.
    pub(super) lights: LightSet,
    /// Version of the model, which changes when its file is read again.
    pub(super) version: u64,
}

/// Light takes one of many ways through the drawn body, by chance.
#[derive(Clone, Component, Copy, Debug)]
pub(super) struct ByChance;

impl Drawn {
    /// Id of the reflection model.
    #[must_use]
    pub fn model(&self) -> &str {
        &self.model
    }

    /// Id of the shading model.
    #[must_use]
    pub fn shading(&self) -> &str {
        &self.shading
    }
}
