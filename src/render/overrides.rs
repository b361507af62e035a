//! The differences between a view and the scene: another reflection model, other parameters, another exposure.

use bevy::ecs::component::Component;

use crate::{
    optics::TermSelection,
    parameter::Values,
    scene::{Display, Object, Scene},
};

/// The differences between a view and the scene. Stands beside the camera of the view.
#[derive(Clone, Component, Debug, Default, PartialEq)]
pub struct Overrides {
    /// The reflection model of every object.
    pub reflection_model: Option<String>,
    /// The shading model of every object.
    pub shading_model: Option<String>,
    /// Parameters of every object. Those that are absent stay as they are.
    pub parameters: Values,
    /// The terms of the equation that are shown.
    pub terms: Option<TermSelection>,
    /// Exposure, tone mapping and encoding.
    pub display: Option<Display>,
}

impl Overrides {
    /// The scene as the view shows it. Its terms are no part of it.
    #[must_use]
    pub fn applied(&self, scene: &Scene) -> Scene {
        let mut shown = Scene { display: self.display_of(scene), ..scene.clone() };
        shown.objects.iter_mut().for_each(|object| self.dress(object));
        shown
    }

    /// Makes an object what the view shows.
    pub(super) fn dress(&self, object: &mut Object) {
        if self.reflection_model.is_some() {
            object.reflection_model.clone_from(&self.reflection_model);
        }
        if self.shading_model.is_some() {
            object.shading_model.clone_from(&self.shading_model);
        }
        object.material.0.extend(self.parameters.0.clone());
    }

    pub(super) fn model_of<'a>(&'a self, scene: &'a Scene, object: &'a Object) -> &'a str {
        self.reflection_model.as_deref().unwrap_or_else(|| scene.model_of(object))
    }

    pub(super) fn shading_model_of<'a>(&'a self, scene: &'a Scene, object: &'a Object) -> &'a str {
        self.shading_model.as_deref().unwrap_or_else(|| scene.shading_model_of(object))
    }

    pub(super) fn display_of(&self, scene: &Scene) -> Display {
        self.display.unwrap_or(scene.display)
    }
}
