//! Structs of declared parameters as components of entities, without their types: light types and object types are
//! known by lists.

use std::{any::type_name, fmt};

use bevy::{
    ecs::{
        component::ComponentId,
        prelude::*,
        reflect::AppTypeRegistry,
        world::{EntityRef, EntityWorldMut},
    },
    reflect::GetTypeRegistration,
};

use super::{declaration::Parameter, set::ParameterSet, value::Values};
use crate::optics::colour::Encoding;

/// The encoding of colours in components: they are linear, however a scene is displayed.
const ENCODING: Encoding = Encoding::Srgb;

/// Finds the entities on which a component changed since the last run of the exclusive system that asks.
pub type Watch = Box<dyn FnMut(&mut World, &mut Vec<Entity>) + Send + Sync>;

/// A struct of parameters as a component, without its type.
#[derive(Clone, Copy)]
pub struct TypeComponent {
    /// Name of the struct.
    pub name: &'static str,
    parameters: &'static [Parameter],
    /// Makes the component known to a world and its tools.
    pub register: fn(&mut World) -> ComponentId,
    /// Finds changes of the component.
    pub watch: fn() -> Watch,
    /// Gives an entity the component with these parameters.
    pub insert: fn(&mut EntityWorldMut, &Values),
    /// Takes the component from an entity.
    pub remove: fn(&mut EntityWorldMut),
    read: fn(&EntityRef) -> Option<Values>,
}

impl TypeComponent {
    /// The component that a struct of parameters is.
    #[must_use]
    pub fn of<T: ParameterSet + Component + GetTypeRegistration>() -> Self {
        Self {
            name: type_name::<T>().rsplit("::").next().unwrap_or_default(),
            parameters: T::PARAMETERS,
            register: |world| {
                if let Some(types) = world.get_resource::<AppTypeRegistry>() {
                    types.write().register::<T>();
                }
                world.register_component::<T>()
            },
            watch: || {
                let mut changed: Option<QueryState<Entity, Changed<T>>> = None;
                Box::new(move |world, found| {
                    let changed = changed.get_or_insert_with(|| world.query_filtered());
                    found.extend(changed.iter(world));
                })
            },
            insert: |entity, values| {
                let new = T::from_values(values, ENCODING);
                let known = entity.get::<T>().map(|known| known.to_values(ENCODING));
                if known != Some(new.to_values(ENCODING)) {
                    entity.insert(new);
                }
            },
            remove: |entity| _ = entity.remove::<T>(),
            read: |entity| Some(entity.get::<T>()?.to_values(ENCODING)),
        }
    }

    /// Puts the parameters of an entity's component into others. Where both mean the same, the others stay as written.
    pub fn read(&self, entity: &EntityRef, into: &mut Values) {
        let Some(Values(values)) = (self.read)(entity) else { return };
        for p in self.parameters {
            if let Some(value) = values.get(p.name).filter(|value| into.get(p) != **value) {
                into.set(p.name, value.clone());
            }
        }
    }
}

impl fmt::Debug for TypeComponent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("TypeComponent").field(&self.name).finish()
    }
}
