//! The parts as displayed: with the values of the scene, or as animated by systems.

use bevy::ecs::prelude::*;

use super::{
    entities::{CurrentScene, SceneEntities},
    mirror::{read_light, read_object, read_observer},
    parts::{Animated, SceneLight, SceneObserver},
    typed::PartTypes,
};
use crate::{
    registry::{LightSet, Registry},
    scene::{Light, Object, Observer, Repetition, has_extent},
};

/// The displayed values of an object, except for its transform.
#[derive(Clone, Component, Debug, PartialEq)]
pub struct ShownObject(pub(super) Object);

/// The displayed lights and observer.
#[derive(Clone, Debug, Default, PartialEq, Resource)]
pub struct Shown {
    pub(super) lights: Vec<Light>,
    pub(super) observer: Observer,
    /// The types of all lights, including those switched off: the light types in shaders. Read in each frame.
    pub(super) types: LightSet,
}

impl Shown {
    /// The active lights.
    pub(super) fn shining(&self) -> impl Iterator<Item = &Light> {
        self.lights.iter().filter(|light| light.enabled)
    }

    /// True if any active light has extent, so that pictures are means of samples.
    pub(super) fn has_extent(&self, registry: &Registry) -> bool {
        has_extent(self.shining(), registry)
    }
}

/// The displayed values of an object.
fn look(object: &Object) -> ShownObject {
    let Object { position, size, rotation, .. } = Object::default();
    ShownObject(Object { position, size, rotation, name: None, repeat: Repetition::None, ..object.clone() })
}

/// Displays objects whose components changed. An animated object that temporarily has no type or two types
/// stays unchanged.
pub(super) fn show_objects(world: &mut World, changed: &[Entity]) {
    for entity in changed {
        let entities = world.resource::<SceneEntities>();
        let Some(known) =
            entities.place_of(*entity).and_then(|i| world.resource::<CurrentScene>().0.objects.get(i))
        else {
            continue;
        };
        let Ok(components) = world.get_entity(*entity) else { continue };
        let now = if components.contains::<Animated>() {
            let (types, registry) = (world.resource::<PartTypes>(), world.resource::<Registry>());
            match read_object(components, Some(known), types, registry) {
                Ok(object) => look(&object),
                Err(_) => continue,
            }
        } else {
            look(known)
        };
        if components.get::<ShownObject>() != Some(&now) {
            world.entity_mut(*entity).insert(now);
        }
    }
}

/// Displays lights and the observer. Exclusive, since their types may be any.
pub(super) fn show_lights(
    world: &mut World,
    animated: &mut QueryState<(), (With<Animated>, Or<(With<SceneLight>, With<SceneObserver>)>)>,
    mut was_animated: Local<bool>,
) {
    let is_animated = animated.iter(world).next().is_some();
    let changed = world.is_resource_changed::<CurrentScene>() || world.is_resource_changed::<Registry>();
    if !changed && !is_animated && !*was_animated {
        return;
    }
    *was_animated = is_animated;
    let (known, entities) = (&world.resource::<CurrentScene>().0, world.resource::<SceneEntities>());
    let (types, registry) = (world.resource::<PartTypes>(), world.resource::<Registry>());
    let components = |entity: Option<Entity>| {
        world.get_entity(entity?).ok().filter(|components| components.contains::<Animated>())
    };
    let lights = known.lights.iter().enumerate().map(|(i, light)| {
        let now = components(entities.lights.get(i).copied())
            .map(|entity| read_light(entity, Some(light), types, registry, known.scene_size));
        now.and_then(Result::ok).unwrap_or_else(|| light.clone())
    });
    let eye = components(entities.observer).and_then(|entity| read_observer(entity, &known.observer).ok());
    let lights: Vec<Light> = lights.collect();
    let types = registry.light_set(lights.iter().map(|light| light.light_type.as_str()));
    let now = Shown { lights, observer: eye.unwrap_or(known.observer), types };
    world.resource_mut::<Shown>().set_if_neq(now);
}
