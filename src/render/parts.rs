//! The components of the parts of a scene: those that lights, objects and the observer share. The struct of a light
//! type or an object type, such as `Spot` or `Torus`, is a component too, and stands beside them.

use bevy::{
    camera::visibility::Visibility,
    ecs::{
        component::{Immutable, StorageType},
        lifecycle::HookContext,
        prelude::*,
        world::DeferredWorld,
    },
    reflect::{Reflect, impl_reflect_opaque, std_traits::ReflectDefault},
    transform::components::Transform,
};

use crate::{
    document::PartId,
    parameter::Values,
    scene::{DEFAULT_FIELD_OF_VIEW, Light},
};

/// Entities whose components went.
#[derive(Debug, Default, Resource)]
pub(super) struct Touched {
    /// Those that lost a component of a part, or were despawned.
    pub(super) entities: Vec<Entity>,
    /// Those that are no longer [`Animated`].
    pub(super) rested: Vec<Entity>,
}

fn touch(mut world: DeferredWorld, context: HookContext) {
    if let Some(mut touched) = world.get_resource_mut::<Touched>() {
        touched.entities.push(context.entity);
    }
}

fn rest(mut world: DeferredWorld, context: HookContext) {
    if let Some(mut touched) = world.get_resource_mut::<Touched>() {
        touched.rested.push(context.entity);
    }
}

// The document knows nothing of Bevy.
impl_reflect_opaque!((in lights_camera_models::document) PartId(Component, Clone, Debug, Hash, PartialEq));
impl Component for PartId {
    const STORAGE_TYPE: StorageType = StorageType::Table;
    type Mutability = Immutable;
}

/// A light of the scene. The component of its type brings it along. Its place is the translation of the `Transform`, and
/// it shines along −z of its rotation.
#[derive(Clone, Component, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(Transform, Visibility)]
#[component(on_remove = touch)]
pub struct SceneLight {
    /// False while switched off.
    pub enabled: bool,
    /// Its colour.
    pub colour: LightColour,
    /// Its strength.
    pub power: LightPower,
}

/// The colour of a light.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub enum LightColour {
    /// sRGB-encoded.
    Rgb([u8; 3]),
    /// That of a black body of so many kelvin.
    Temperature(f32),
}

/// The strength of a light.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub enum LightPower {
    /// Intensity in the unit of the type.
    Intensity(f32),
    /// Luminous flux in lumen, for types that have one.
    Flux(f32),
}

impl Default for LightColour {
    fn default() -> Self {
        Self::Rgb(Light::default().colour)
    }
}

impl Default for LightPower {
    fn default() -> Self {
        Self::Intensity(Light::default().intensity)
    }
}

impl Default for SceneLight {
    fn default() -> Self {
        Self { enabled: true, colour: LightColour::default(), power: LightPower::default() }
    }
}

/// An object of the scene. The component of its type brings it along. Its size is the scale of the `Transform`, which is
/// the same in all directions; `Visibility::Hidden` hides it.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(Transform, Visibility, Surface, Tessellation)]
#[component(on_remove = touch)]
pub struct SceneObject;

/// The surface of an object.
#[derive(Clone, Component, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[component(on_remove = touch)]
pub struct Surface {
    /// Id of the reflection model that overrides the scene's, if any.
    pub reflection_model: Option<String>,
    /// Id of the shading model that overrides the scene's, if any.
    pub shading_model: Option<String>,
    /// Parameters by name, of this model and of any other.
    pub material: Values,
}

/// The tessellation of an object; `None` for the default of its type.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[component(on_remove = touch)]
pub struct Tessellation(pub Option<u32>);

/// The observer of the scene, who looks along −z of the `Transform`.
#[derive(Clone, Component, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(Transform)]
#[component(on_remove = touch)]
pub struct SceneObserver {
    /// Vertical field of view, degrees.
    pub field_of_view: f32,
}

impl Default for SceneObserver {
    fn default() -> Self {
        Self { field_of_view: DEFAULT_FIELD_OF_VIEW }
    }
}

/// Marks a part whose changes are shown and not stored: what systems do to its components shows in the picture, and
/// reaches neither the scene nor the document. Without the marker it is again what the document has. A change of the
/// document writes what it changed into the components, and nothing else.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[component(on_remove = rest)]
pub struct Animated;

/// The entities of parts of a scene.
pub(super) type IsPart = Or<(With<SceneLight>, With<SceneObject>, With<SceneObserver>)>;
