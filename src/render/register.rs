//! Registration in an app: adds types to the registry, and a component for each light type and object type.

use std::path::PathBuf;

use bevy::prelude::*;

use super::typed::know_types;
use crate::{
    light::LightType,
    reflection::ReflectionModel,
    registry::{Admission, Register, RegistrationError, Registry},
    scene::formats::{FormatError, SceneFormat, SceneFormats},
    shading::ShadingModel,
    shape::ObjectType,
};

/// The registry of an app, created if missing.
fn registry(app: &mut App) -> Mut<'_, Registry> {
    app.init_resource::<Registry>();
    app.world_mut().resource_mut::<Registry>()
}

impl SceneFormats for App {
    fn try_add_scene_format(&mut self, format: impl SceneFormat) -> Result<&mut Self, FormatError> {
        registry(self).try_add_scene_format(format)?;
        Ok(self)
    }
}

impl Register for App {
    fn add_shader_folder(&mut self, folder: impl Into<PathBuf>) -> &mut Self {
        registry(self).add_shader_folder(folder);
        self
    }

    fn admit_reflection_model<M: ReflectionModel>(
        &mut self,
        admission: Admission,
    ) -> Result<(), RegistrationError> {
        registry(self).admit_reflection_model::<M>(admission)
    }

    fn admit_shading_model<S: ShadingModel>(
        &mut self,
        admission: Admission,
    ) -> Result<(), RegistrationError> {
        registry(self).admit_shading_model::<S>(admission)
    }

    fn admit_light_type<L: LightType>(&mut self, admission: Admission) -> Result<(), RegistrationError> {
        registry(self).admit_light_type::<L>(admission)?;
        know_types(self.world_mut());
        Ok(())
    }

    fn admit_object_type<T: ObjectType>(&mut self, admission: Admission) -> Result<(), RegistrationError> {
        registry(self).admit_object_type::<T>(admission)?;
        know_types(self.world_mut());
        Ok(())
    }
}
