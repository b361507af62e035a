//! Parts of a scene as components, and components as parts of a scene.

use bevy::{
    camera::visibility::Visibility,
    ecs::{
        component::Mutable,
        prelude::*,
        world::{EntityRef, EntityWorldMut},
    },
    transform::components::Transform,
};
use glam::{Quat, Vec3};

use super::{
    parts::{
        Animated, LightColour, LightPower, SceneLight, SceneObject, SceneObserver, Surface, Tessellation,
    },
    typed::PartTypes,
};
use crate::{
    registry::Registry,
    scene::{
        Light, Object, Observer, Repetition, SceneSize, observer,
        rotation::{euler_degrees, rotation},
    },
};

/// The transform of an object: unit mesh → size → rotation → position.
#[must_use]
pub fn object_transform(object: &Object) -> Transform {
    Transform {
        translation: object.position,
        rotation: rotation(object.rotation),
        scale: Vec3::splat(object.size),
    }
}

fn observer_transform(observer: &Observer) -> Transform {
    Transform::from_translation(observer.position).with_rotation(observer::rotation(observer.direction))
}

fn light_transform(light: &Light) -> Transform {
    Transform::from_translation(light.position.unwrap_or(Vec3::ZERO))
        .with_rotation(light.direction.map_or(Quat::IDENTITY, observer::rotation))
}

/// The name of an entity for tools: the name of its part, or else its type. A number would change with every
/// part before it.
fn label<'a>(name: &'a Option<String>, type_name: &'a str) -> &'a str {
    name.as_deref().unwrap_or(type_name)
}

impl From<&Light> for SceneLight {
    fn from(light: &Light) -> Self {
        Self {
            enabled: light.enabled,
            colour: light.colour_temperature.map_or(LightColour::Rgb(light.colour), LightColour::Temperature),
            power: light.luminous_flux.map_or(LightPower::Intensity(light.intensity), LightPower::Flux),
        }
    }
}

impl From<&Object> for Surface {
    fn from(object: &Object) -> Self {
        Self {
            reflection_model: object.reflection_model.clone(),
            shading_model: object.shading_model.clone(),
            material: object.material.clone(),
        }
    }
}

fn visibility(object: &Object) -> Visibility {
    if object.visible { Visibility::Inherited } else { Visibility::Hidden }
}

// ── from the scene ──

/// Sets a component, unless it is equal.
fn set<C: Component<Mutability = Mutable> + PartialEq>(entity: &mut EntityWorldMut, new: C) {
    match entity.get_mut::<C>() {
        Some(mut known) => _ = known.set_if_neq(new),
        None => _ = entity.insert(new),
    }
}

/// Moves an entity where the transform of its part has changed. Other aspects may be animated.
fn place(entity: &mut EntityWorldMut, old: Option<Transform>, new: Transform) {
    let mut now = entity.get::<Transform>().copied().unwrap_or(new);
    if old.is_none_or(|old| old.translation != new.translation) {
        now.translation = new.translation;
    }
    if old.is_none_or(|old| old.rotation != new.rotation) {
        now.rotation = new.rotation;
    }
    if old.is_none_or(|old| old.scale != new.scale) {
        now.scale = new.scale;
    }
    set(entity, now);
}

/// A part of the scene that has an entity.
pub(super) trait Part: Clone + PartialEq {
    /// Writes the differences from `old` into an entity, or everything.
    fn write(&self, entity: &mut EntityWorldMut, old: Option<&Self>, types: &PartTypes);

    /// Spawns an entity for the part.
    fn spawn(&self, world: &mut World, types: &PartTypes) -> Entity;
}

impl Part for Light {
    fn write(&self, entity: &mut EntityWorldMut, old: Option<&Self>, types: &PartTypes) {
        if entity.contains::<SceneObject>() {
            entity.remove::<SceneObject>();
            types.objects.strip(entity);
        }
        place(entity, old.map(light_transform), light_transform(self));
        if old.map(SceneLight::from) != Some(self.into()) {
            set(entity, SceneLight::from(self));
        }
        let name = label(&self.name, &self.light_type);
        if old.is_none_or(|old| label(&old.name, &old.light_type) != name) {
            set(entity, Name::new(name.to_owned()));
        }
        if old.is_none_or(|old| (&old.light_type, &old.parameters) != (&self.light_type, &self.parameters)) {
            types.lights.write(entity, &self.light_type, &self.parameters);
        }
    }

    fn spawn(&self, world: &mut World, types: &PartTypes) -> Entity {
        let name = Name::new(label(&self.name, &self.light_type).to_owned());
        let mut entity = world.spawn((SceneLight::from(self), light_transform(self), name));
        types.lights.write(&mut entity, &self.light_type, &self.parameters);
        entity.id()
    }
}

impl Part for Object {
    fn write(&self, entity: &mut EntityWorldMut, old: Option<&Self>, types: &PartTypes) {
        if entity.contains::<SceneLight>() {
            entity.remove::<SceneLight>();
            types.lights.strip(entity);
        }
        place(entity, old.map(object_transform), object_transform(self));
        if !entity.contains::<SceneObject>() {
            entity.insert(SceneObject);
        }
        if old.is_none_or(|old| {
            (&old.reflection_model, &old.shading_model, &old.material)
                != (&self.reflection_model, &self.shading_model, &self.material)
        }) {
            set(entity, Surface::from(self));
        }
        if old.is_none_or(|old| old.tessellation != self.tessellation) {
            set(entity, Tessellation(self.tessellation));
        }
        if old.is_none_or(|old| old.visible != self.visible) {
            set(entity, visibility(self));
        }
        let name = label(&self.name, &self.object_type);
        if old.is_none_or(|old| label(&old.name, &old.object_type) != name) {
            set(entity, Name::new(name.to_owned()));
        }
        if old.is_none_or(|old| (&old.object_type, &old.shape) != (&self.object_type, &self.shape)) {
            types.objects.write(entity, &self.object_type, &self.shape);
        }
    }

    fn spawn(&self, world: &mut World, types: &PartTypes) -> Entity {
        let name = Name::new(label(&self.name, &self.object_type).to_owned());
        let tessellation = Tessellation(self.tessellation);
        let place = object_transform(self);
        let mut entity =
            world.spawn((SceneObject, place, Surface::from(self), tessellation, visibility(self), name));
        types.objects.write(&mut entity, &self.object_type, &self.shape);
        entity.id()
    }
}

impl Part for Observer {
    fn write(&self, entity: &mut EntityWorldMut, old: Option<&Self>, _: &PartTypes) {
        place(entity, old.map(observer_transform), observer_transform(self));
        if old.map(SceneObserver::from) != Some(self.into()) {
            set(entity, SceneObserver::from(self));
        }
    }

    fn spawn(&self, world: &mut World, _: &PartTypes) -> Entity {
        world.spawn((SceneObserver::from(self), observer_transform(self), Name::new("Observer"))).id()
    }
}

// ── from components ──

/// The component that a part needs.
fn needed<'w, C: Component>(entity: &EntityRef<'w>) -> Result<&'w C, String> {
    entity.get::<C>().ok_or_else(|| {
        let name = std::any::type_name::<C>().rsplit("::").next().unwrap_or_default();
        format!("it needs the component `{name}`")
    })
}

/// The name of a part that had a given name or none, and a given label.
fn name_of(entity: &EntityRef, known: Option<(&Option<String>, &str)>) -> Option<String> {
    let given = entity.get::<Name>().map(Name::as_str);
    match (given, known) {
        (Some(given), Some((own, type_name))) if given == label(own, type_name) => own.clone(),
        (None, Some((own, _))) => own.clone(),
        (given, _) => given.map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned),
    }
}

/// Copies the position, rotation and size in a transform to an object.
///
/// # Errors
/// Returns an error if the scale is not uniform.
pub(super) fn read_place(transform: &Transform, known: bool, object: &mut Object) -> Result<(), String> {
    /// Relative difference of sizes attributed to rounding.
    const ROUNDING: f32 = 1e-4;
    let old = object_transform(object);
    let Transform { translation, rotation, scale } = *transform;
    if !known || scale != old.scale {
        let [x, y, z] = scale.to_array();
        let size = scale.max_element();
        if size - scale.min_element() > ROUNDING * size.abs() {
            return Err(format!(
                "its scale is ({x}, {y}, {z}), but an object has one size: the scale must be the same in x, y and z"
            ));
        }
        object.size = size;
    }
    if !known || translation != old.translation {
        object.position = translation;
    }
    if !known || rotation != old.rotation {
        // Otherwise the angles of a zero rotation would have signs.
        let turned = rotation != Quat::IDENTITY;
        object.rotation = if turned { euler_degrees(rotation.normalize()) } else { Vec3::ZERO };
    }
    Ok(())
}

/// Lets an object that changed alone leave its row.
fn leave_row(object: &mut Object, known: Option<&Object>) {
    if known.is_some_and(|known| *object != *known) {
        object.repeat = Repetition::None;
    }
}

/// The object that an entity represents; values equal to those of the `known` object stay as they were.
///
/// # Errors
/// Returns the reason why it does not represent an object.
pub(super) fn read_object(
    entity: EntityRef,
    known: Option<&Object>,
    types: &PartTypes,
    registry: &Registry,
) -> Result<Object, String> {
    if entity.contains::<SceneLight>() {
        return Err("it is both a light and an object, but must be only one of them".to_owned());
    }
    needed::<SceneObject>(&entity)?;
    let mut object = known.cloned().unwrap_or_default();
    let of_type = types.objects.find(&entity, known.map(|known| &*known.object_type), "object")?;
    let retyped = object.object_type != of_type.id;
    if retyped && let Some(entry) = registry.shape(of_type.id) {
        object.set_type(entry);
    }
    let parameters = of_type.read(&entity, &mut object.shape);
    let place = read_place(needed(&entity)?, known.is_some(), &mut object);
    // Animated objects may be stretched, and their colours may leave their range.
    if !entity.contains::<Animated>() || known.is_none() {
        parameters?;
        place?;
    }
    let Tessellation(tessellation) = *needed::<Tessellation>(&entity)?;
    // Each type counts something else.
    if !retyped || known.is_none_or(|known| known.tessellation != tessellation) {
        object.tessellation = tessellation;
    }
    let Surface { reflection_model, shading_model, material } = needed::<Surface>(&entity)?;
    object.reflection_model.clone_from(reflection_model);
    object.shading_model.clone_from(shading_model);
    if object.material != *material {
        object.material.clone_from(material);
    }
    object.visible = *needed::<Visibility>(&entity)? != Visibility::Hidden;
    object.name = name_of(&entity, known.map(|known| (&known.name, &*known.object_type)));
    leave_row(&mut object, known);
    Ok(object)
}

/// The light that an entity represents; values equal to those of the `known` light stay as they were.
///
/// # Errors
/// Returns the reason why it does not represent a light.
pub(super) fn read_light(
    entity: EntityRef,
    known: Option<&Light>,
    types: &PartTypes,
    registry: &Registry,
    room: SceneSize,
) -> Result<Light, String> {
    if entity.contains::<SceneObject>() {
        return Err("it is both a light and an object, but must be only one of them".to_owned());
    }
    let mut light = known.cloned().unwrap_or_default();
    let of_type = types.lights.find(&entity, known.map(|known| &*known.light_type), "light")?;
    let Some(entry) = registry.light(of_type.id) else {
        return Err(format!("the light type `{}` is not registered", of_type.id));
    };
    if light.light_type != of_type.id {
        light.set_type(entry, registry, room);
    }
    let parameters = of_type.read(&entity, &mut light.parameters);
    // Colours of animated lights may leave their range.
    if !entity.contains::<Animated>() || known.is_none() {
        parameters?;
    }
    let transform = needed::<Transform>(&entity)?;
    let old = known.map(light_transform);
    if entry.declaration.has_position && old.is_none_or(|old| old.translation != transform.translation) {
        light.position = Some(transform.translation);
    }
    if entry.declaration.has_direction && old.is_none_or(|old| old.rotation != transform.rotation) {
        light.direction = Some(transform.rotation * Vec3::NEG_Z);
    }
    let now = *needed::<SceneLight>(&entity)?;
    let before = known.map(SceneLight::from);
    light.enabled = now.enabled;
    // A missing field gets the value that it has when the file is read again.
    if before.is_none_or(|before| before.colour != now.colour) {
        (light.colour, light.colour_temperature) = match now.colour {
            LightColour::Rgb(colour) => (colour, None),
            LightColour::Temperature(kelvin) => (Light::default().colour, Some(kelvin)),
        };
    }
    if before.is_none_or(|before| before.power != now.power) {
        (light.intensity, light.luminous_flux) = match now.power {
            LightPower::Intensity(intensity) => (intensity, None),
            LightPower::Flux(lumen) => (entry.declaration.default_intensity, Some(lumen)),
        };
    }
    light.name = name_of(&entity, known.map(|known| (&known.name, &*known.light_type)));
    Ok(light)
}

/// The observer that an entity represents; values equal to those of the `known` observer stay as they were.
///
/// # Errors
/// Returns the reason why it does not represent an observer.
pub(super) fn read_observer(entity: EntityRef, known: &Observer) -> Result<Observer, String> {
    let mut observer = *known;
    let transform = needed::<Transform>(&entity)?;
    let old = observer_transform(known);
    if transform.translation != old.translation {
        observer.position = transform.translation;
    }
    if transform.rotation != old.rotation {
        observer.direction = transform.rotation * Vec3::NEG_Z;
    }
    Ok(needed::<SceneObserver>(&entity)?.at(observer))
}
