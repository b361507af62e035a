//! Parameter structs as components of entities, without their types: light types and object types are known
//! by lists.

use std::any::type_name;

use bevy_ecs::{
    component::ComponentId,
    prelude::*,
    query::QueryFilter,
    reflect::AppTypeRegistry,
    world::{EntityRef, EntityWorldMut},
};
use bevy_reflect::GetTypeRegistration;

use super::{Parameter, set::ParameterSet, values::Values};
use crate::{declared::debug_by, optics::colour::Encoding};

/// The encoding of colours in components: they are linear, whatever the display settings.
const ENCODING: Encoding = Encoding::Srgb;

/// Finds the entities, all or among some, on which components changed since the world's last change tick.
pub type Watch = Box<dyn FnMut(&mut World, Option<&[Entity]>, &mut Vec<Entity>) + Send + Sync>;

/// Finds the entities that pass a filter for changes.
#[must_use]
pub fn watch<F: QueryFilter + 'static>() -> Watch {
    let mut changed: Option<QueryState<Entity, F>> = None;
    Box::new(move |world: &mut World, among: Option<&[Entity]>, found: &mut Vec<Entity>| {
        let changed = changed.get_or_insert_with(|| world.query_filtered());
        match among {
            Some(among) => found.extend(changed.iter_many(world, among)),
            None => found.extend(changed.iter(world)),
        }
    })
}

/// A parameter struct as a component, without its type.
#[derive(Clone, Copy)]
pub struct TypeComponent {
    /// Name of the struct.
    pub name: &'static str,
    parameters: &'static [Parameter],
    /// Registers the component with a world and its tools.
    pub register: fn(&mut World) -> ComponentId,
    /// Finds changes of the component.
    pub watch: fn() -> Watch,
    /// Gives an entity the component with these parameters.
    pub insert: fn(&mut EntityWorldMut, &Values),
    /// Removes the component from an entity.
    pub remove: fn(&mut EntityWorldMut),
    read: fn(&EntityRef) -> Option<Values>,
}

impl TypeComponent {
    /// The component of a parameter struct.
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
            watch: watch::<Changed<T>>,
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

    /// Copies the parameters of an entity's component into others. Others that mean the same stay as written.
    ///
    /// # Errors
    /// Returns an error if a colour or the index of a choice is invalid: the others then get the nearest
    /// colour, and the default choice.
    pub fn read(&self, entity: &EntityRef, into: &mut Values) -> Result<(), String> {
        let Some(Values(mut values)) = (self.read)(entity) else { return Ok(()) };
        let mut refused = Ok(());
        for p in self.parameters {
            let Some(value) = values.remove(p.name) else { continue };
            let (value, rule) = match p.kind.mended(&value) {
                Some((nearest, rule)) => (nearest, Some(rule)),
                None => (value, None),
            };
            if let Some(rule) = rule.filter(|_| refused.is_ok()) {
                refused = Err(format!("the {} of `{}` is {rule}", p.label, self.name));
            }
            if into.get(p) != value {
                into.set(p.name, value);
            }
        }
        refused
    }
}

debug_by!(TypeComponent: name);

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{parameter::BASE_COLOUR, parameters};

    const FORM: Parameter = Parameter::choice("form", &[("flat", "Flat"), ("round", "Round")], 1);

    parameters! {
        /// A lamp with a filter.
        struct Lamp {
            /// The colour of the filter.
            tint: colour = BASE_COLOUR,
            /// The form.
            form: choice = FORM,
        }
    }

    #[test]
    fn what_is_no_colour_or_no_choice_is_refused_and_written_back() {
        let of = TypeComponent::of::<Lamp>();
        let mut world = World::new();
        let good = Lamp { tint: Vec3::new(1.0, 0.5, 0.0), form: 0 };
        let entity = world.spawn(good).id();
        let read = |world: &World| {
            let mut values = Values::default();
            let read = of.read(&world.entity(entity), &mut values);
            (values, read)
        };
        let (known, answer) = read(&world);
        assert_eq!(answer, Ok(()));
        // Rounding is none of their business.
        for v in [1.001, -1e-5] {
            *world.get_mut(entity).expect("there") = Lamp { tint: Vec3::splat(v), ..good };
            assert_eq!(read(&world).1, Ok(()), "{v}");
        }
        for (wrong, text) in [
            (
                Lamp { tint: Vec3::new(5.0, 0.5, 0.0), ..good },
                "the base colour of `Lamp` is (5, 0.5, 0), but",
            ),
            (Lamp { tint: Vec3::splat(-0.1), ..good }, "(-0.1, -0.1, -0.1), but a linear colour"),
            (Lamp { tint: Vec3::splat(f32::NAN), ..good }, "is (NaN, NaN, NaN), but"),
            (Lamp { form: 7, ..good }, "of `Lamp` is 7, but the last choice is 1"),
        ] {
            *world.get_mut(entity).expect("there") = wrong;
            let (values, answer) = read(&world);
            let why = answer.expect_err("it is refused");
            assert!(why.contains(text), "{why}");
            assert!(Lamp::PARAMETERS.iter().all(|p| values.0.get(p.name).is_none_or(|v| p.allows(v))));
            (of.insert)(&mut world.entity_mut(entity), &known);
            assert_eq!(read(&world), (known.clone(), Ok(())), "it goes back");
        }
    }
}
