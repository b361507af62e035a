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
            let mut object = object.clone();
            if let Some(overrides) = overrides {
                overrides.dress(&mut object, &self.registry);
            }
            let model = self.registry.model(scene.model_of(&object));
            let shading = self.registry.shading_model(scene.shading_model_of(&object));
            model.zip(shading).is_some_and(|(model, shading)| {
                self.live.is_announced((model, model.passage(&object.material), shading, self.shown.types))
            })
        })
    }
}
