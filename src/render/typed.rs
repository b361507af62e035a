//! The components of light types and object types, from the registry.

use bevy::{ecs::component::ComponentId, prelude::*};

use super::{
    noticed::Watches,
    parts::{LightPower, SceneLight, SceneObject, Touched},
};
use crate::{
    parameter::{TypeComponent, Values},
    registry::Registry,
};

/// The component of a type.
#[derive(Clone, Copy, Debug)]
pub(super) struct PartType {
    /// Id of the type.
    pub(super) id: &'static str,
    component: ComponentId,
    of: TypeComponent,
}

impl PartType {
    /// Copies the parameters of the component into those of a part.
    ///
    /// # Errors
    /// Returns an error if the component contains an invalid colour or choice.
    pub(super) fn read(&self, entity: &EntityRef, into: &mut Values) -> Result<(), String> {
        self.of.read(entity, into)
    }
}

/// The components of light types or of object types.
#[derive(Clone, Debug, Default)]
pub(super) struct TypeList(Vec<PartType>);

impl TypeList {
    /// Adds a type, or replaces the one with its id. False if its component is known.
    fn put(&mut self, entry: PartType) -> bool {
        let new = self.0.iter().all(|known| known.component != entry.component);
        match self.0.iter_mut().find(|known| known.id == entry.id) {
            Some(known) => *known = entry,
            None => self.0.push(entry),
        }
        new
    }

    /// Gives an entity the component of a type with these parameters, and removes those of other types.
    pub(super) fn write(&self, entity: &mut EntityWorldMut, id: &str, values: &Values) {
        if self.0.iter().all(|part_type| part_type.id != id) {
            warn!("`{id}` is not a registered light type or object type: it is not shown");
        }
        for part_type in &self.0 {
            if part_type.id == id {
                (part_type.of.insert)(entity, values);
            } else if entity.contains_id(part_type.component) {
                (part_type.of.remove)(entity);
            }
        }
    }

    /// Removes the components of all types from an entity.
    pub(super) fn strip(&self, entity: &mut EntityWorldMut) {
        self.0.iter().for_each(|part_type| (part_type.of.remove)(entity));
    }

    /// The type of an entity. A type added to the `known` one replaces it.
    ///
    /// # Errors
    /// Returns an error if the entity has components of no type, or of several.
    pub(super) fn find(
        &self,
        entity: &EntityRef,
        known: Option<&str>,
        what: &str,
    ) -> Result<&PartType, String> {
        let mut found: Vec<_> =
            self.0.iter().filter(|part_type| entity.contains_id(part_type.component)).collect();
        if found.len() == 2 {
            found.retain(|part_type| Some(part_type.id) != known);
        }
        match found[..] {
            [one] => Ok(one),
            [] => {
                let example = self.0.first().map_or("", |first| first.of.name);
                Err(format!("it needs the component of one {what} type, such as `{example}`"))
            }
            [one, other, ..] => {
                let (one, other) = (one.of.name, other.of.name);
                Err(format!("it has `{one}` and `{other}`, but must have one {what} type"))
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

/// Registers the components of all types in the registry with a world: they require the component shared by
/// all lights or all objects.
pub(crate) fn know_types(world: &mut World) {
    world.init_resource::<Touched>();
    world.init_resource::<PartTypes>();
    world.get_resource_or_insert_with(Watches::of_parts);
    let registry = world.resource::<Registry>().clone();
    for entry in registry.lights() {
        let declaration = entry.declaration;
        let light = SceneLight {
            power: LightPower::Intensity(declaration.default_intensity),
            ..SceneLight::default()
        };
        know(world, |types| &mut types.lights, declaration.id, entry.component, light);
    }
    for entry in registry.shapes() {
        know(world, |types| &mut types.objects, entry.declaration.id, entry.component, SceneObject);
    }
}

fn know<C: Component + Copy>(
    world: &mut World,
    list: fn(&mut PartTypes) -> &mut TypeList,
    id: &'static str,
    of: TypeComponent,
    brings: C,
) {
    let component = (of.register)(world);
    if !list(&mut world.resource_mut::<PartTypes>()).put(PartType { id, component, of }) {
        return;
    }
    world.resource_mut::<Watches>().add((of.watch)());
    // Bevy's required components would need the type itself.
    let bring = move |new: On<Add>, marked: Query<(), With<C>>, mut commands: Commands| {
        if !marked.contains(new.entity) {
            commands.entity(new.entity).insert_if_new(brings);
        }
    };
    let miss = |gone: On<Remove>, mut touched: ResMut<Touched>| touched.entities.push(gone.entity);
    world.spawn(Observer::new(bring).with_component(component));
    world.spawn(Observer::new(miss).with_component(component));
}
