//! Registering in an app: the registry learns of it, and the renderer gets a material for each reflection model,
//! and a component for each type.

use bevy::app::App;

use super::{material::MaterialApp as _, typed};
use crate::{
    light::LightType,
    reflection::ReflectionModel,
    registry::{Register, Registry},
    shading::ShadingModel,
    shape::ObjectType,
};

impl Register for App {
    fn add_reflection_model<M: ReflectionModel>(&mut self) -> &mut Self {
        self.init_resource::<Registry>();
        self.world_mut().resource_mut::<Registry>().add_reflection_model::<M>();
        self.add_model_material::<M>();
        self
    }

    fn add_shading_model<S: ShadingModel>(&mut self) -> &mut Self {
        self.init_resource::<Registry>();
        self.world_mut().resource_mut::<Registry>().add_shading_model::<S>();
        self
    }

    fn add_light_type<L: LightType>(&mut self) -> &mut Self {
        self.init_resource::<Registry>();
        self.world_mut().resource_mut::<Registry>().add_light_type::<L>();
        typed::add_light_type::<L>(self.world_mut());
        self
    }

    fn add_object_type<T: ObjectType>(&mut self) -> &mut Self {
        self.init_resource::<Registry>();
        self.world_mut().resource_mut::<Registry>().add_object_type::<T>();
        typed::add_object_type::<T>(self.world_mut());
        self
    }
}
