//! The shaders that a picture of the scene needs.

use bevy::ecs::{prelude::*, system::SystemParam};

use super::{CurrentScene, LiveShaders, Overrides, Registry, Shown};
use crate::scene::Scene;

/// The shaders that pictures of the scene need.
#[derive(SystemParam)]
pub struct NeededShaders<'w> {
    scene: Res<'w, CurrentScene>,
    shown: Res<'w, Shown>,
    live: Res<'w, LiveShaders>,
    registry: Res<'w, Registry>,
}

impl NeededShaders<'_> {
    /// The displayed scene.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene.0
    }

    /// True if a picture with these overrides needs a shader that is not made yet, and is announced before it is.
    #[must_use]
    pub fn lacks_one(&self, overrides: Option<&Overrides>) -> bool {
        let scene = self.scene();
        scene.objects.iter().any(|object| {
            let [model, shading] = Overrides::models_of(overrides, scene, object);
            let (model, shading) = (self.registry.model(model), self.registry.shading_model(shading));
            model.zip(shading).is_some_and(|(model, shading)| {
                let passage = Overrides::passage_of(overrides, model, object);
                self.live.is_announced((model, passage, shading, self.shown.types))
            })
        })
    }
}
