//! The components of light types and object types: one for each, known by a table of functions.

use std::any::type_name;

use bevy::{
    ecs::{
        component::{ComponentId, RequiredComponentsError},
        lifecycle::Remove,
        prelude::*,
        world::{EntityRef, EntityWorldMut},
    },
    log::warn,
};

use super::parts::{LightPower, SceneLight, SceneObject, Touched};
use crate::{
    light::LightType,
    optics::colour::Encoding,
    parameter::{Parameter, ParameterSet, Values},
    shape::ObjectType,
};

/// The encoding of colours in components: they are linear, however a scene is displayed.
const ENCODING: Encoding = Encoding::Srgb;

/// The component of a type.
#[derive(Clone, Copy, Debug)]
pub(super) struct PartType {
    /// Id of the type.
    pub(super) id: &'static str,
    /// Name of the component in code.
    pub(super) name: &'static str,
    component: ComponentId,
    parameters: &'static [Parameter],
    insert: fn(&mut EntityWorldMut, &Values),
    remove: fn(&mut EntityWorldMut),
    read: fn(&EntityRef) -> Option<Values>,
}

impl PartType {
    fn of<T: ParameterSet + Component>(id: &'static str, world: &mut World) -> Self {
        Self {
            id,
            name: type_name::<T>().rsplit("::").next().unwrap_or(id),
            component: world.register_component::<T>(),
            parameters: T::PARAMETERS,
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

    fn is_on(&self, entity: &EntityRef) -> bool {
        entity.contains_id(self.component)
    }

    /// Puts the parameters of the component into those of a part. Where both mean the same, the part's stay as written.
    pub(super) fn read(&self, entity: &EntityRef, into: &mut Values) {
        let Some(Values(values)) = (self.read)(entity) else { return };
        for p in self.parameters {
            if let Some(value) = values.get(p.name).filter(|value| into.get(p) != **value) {
                into.set(p.name, value.clone());
            }
        }
    }
}

/// The components of light types or of object types.
#[derive(Clone, Debug, Default)]
pub(super) struct TypeList(Vec<PartType>);

impl TypeList {
    fn put(&mut self, entry: PartType) -> bool {
        let new = self.0.iter().all(|known| known.component != entry.component);
        match self.0.iter_mut().find(|known| known.id == entry.id) {
            Some(known) => *known = entry,
            None => self.0.push(entry),
        }
        new
    }

    /// Gives an entity the component of a type with these parameters, and takes those of others.
    pub(super) fn write(&self, entity: &mut EntityWorldMut, id: &str, values: &Values) {
        if self.0.iter().all(|part_type| part_type.id != id) {
            warn!("`{id}` is no type of a light or an object that is registered: nothing is shown of it");
        }
        for part_type in &self.0 {
            if part_type.id == id {
                (part_type.insert)(entity, values);
            } else if entity.contains_id(part_type.component) {
                (part_type.remove)(entity);
            }
        }
    }

    /// Takes the components of all types from an entity.
    pub(super) fn strip(&self, entity: &mut EntityWorldMut) {
        self.0.iter().for_each(|part_type| (part_type.remove)(entity));
    }

    /// The type of an entity. One that is added to the `known` type takes its place.
    ///
    /// # Errors
    /// The components have no type, or several.
    pub(super) fn find(
        &self,
        entity: &EntityRef,
        known: Option<&str>,
        what: &str,
    ) -> Result<&PartType, String> {
        let mut found: Vec<_> = self.0.iter().filter(|part_type| part_type.is_on(entity)).collect();
        if found.len() == 2 {
            found.retain(|part_type| Some(part_type.id) != known);
        }
        match found[..] {
            [one] => Ok(one),
            [] => {
                let example = self.0.first().map_or("", |first| first.name);
                Err(format!("it needs the component of one {what} type, such as `{example}`"))
            }
            [one, other, ..] => {
                Err(format!("it has `{}` and `{}`, but must have one {what} type", one.name, other.name))
            }
        }
    }
}

/// The components of all types.
#[derive(Clone, Debug, Default, Resource)]
pub(super) struct PartTypes {
    pub(super) lights: TypeList,
    pub(super) objects: TypeList,
}

/// Finds the entities on which the component of a type changed.
type Watch = Box<dyn FnMut(&mut World, &mut Vec<Entity>) + Send + Sync>;

/// Finds changes of the components of all types.
#[derive(Default, Resource)]
pub(super) struct Watches(Vec<Watch>);

impl Watches {
    /// The entities on which one changed since the last run of the exclusive system that asks.
    pub(super) fn changed(&mut self, world: &mut World, found: &mut Vec<Entity>) {
        self.0.iter_mut().for_each(|watch| watch(world, found));
    }
}

fn watch<T: Component>(world: &mut World) {
    let mut changed: Option<QueryState<Entity, Changed<T>>> = None;
    world.get_resource_or_init::<Watches>().0.push(Box::new(
        move |world: &mut World, found: &mut Vec<Entity>| {
            let changed = changed.get_or_insert_with(|| world.query_filtered());
            found.extend(changed.iter(world));
        },
    ));
    world.add_observer(|gone: On<Remove, T>, mut touched: ResMut<Touched>| {
        touched.entities.push(gone.entity);
    });
}

fn require<T: Component, R: Component>(world: &mut World, id: &str, bring: fn() -> R) {
    if let Err(error @ RequiredComponentsError::ArchetypeExists(_)) =
        world.try_register_required_components_with::<T, R>(bring)
    {
        warn!("`{id}` must be registered before the first entity of the type is spawned: {error}");
    }
}

/// Makes the component of a light type known to a world.
pub(super) fn add_light_type<L: LightType>(world: &mut World) {
    let entry = PartType::of::<L>(L::DECLARATION.id, world);
    world.init_resource::<Touched>();
    if world.get_resource_or_init::<PartTypes>().lights.put(entry) {
        require::<L, SceneLight>(world, entry.id, || SceneLight {
            power: LightPower::Intensity(const { &L::DECLARATION }.default_intensity),
            ..SceneLight::default()
        });
        watch::<L>(world);
    }
}

/// Makes the component of an object type known to a world.
pub(super) fn add_object_type<T: ObjectType>(world: &mut World) {
    let entry = PartType::of::<T>(T::DECLARATION.id, world);
    world.init_resource::<Touched>();
    if world.get_resource_or_init::<PartTypes>().objects.put(entry) {
        require::<T, SceneObject>(world, entry.id, || SceneObject);
        watch::<T>(world);
    }
}

/// Makes the components of all built-in types known to a world.
#[cfg(test)]
pub(super) fn add_builtin(world: &mut World) {
    use crate::{light, shape};
    struct To<'a>(&'a mut World);
    impl light::Take for To<'_> {
        fn take<T: LightType>(&mut self) {
            add_light_type::<T>(self.0);
        }
    }
    impl shape::Take for To<'_> {
        fn take<T: ObjectType>(&mut self) {
            add_object_type::<T>(self.0);
        }
    }
    light::register_builtin(&mut To(world));
    shape::register_builtin(&mut To(world));
}
