//! The components shared by the lights, objects and observers of all types. The struct of a light type or an
//! object type, such as `Spot` or `Torus`, is an additional component.

use bevy::{
    ecs::{
        component::{Immutable, StorageType},
        lifecycle::HookContext,
        world::DeferredWorld,
    },
    prelude::*,
    reflect::impl_reflect_opaque,
};

use crate::{
    declared::with_defaults,
    document::PartId,
    parameter::Values,
    scene::{Light, Observer, observer::observer},
};

/// Entities that others changed, and that the scene has not followed yet.
#[derive(Debug, Default, Resource)]
pub(super) struct Touched {
    /// Entities with other components, and those that were despawned.
    pub(super) entities: Vec<Entity>,
    /// Entities with another transform, unless they are [`Animated`].
    pub(super) moved: Vec<Entity>,
    /// Entities that are no longer [`Animated`].
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

// The document is independent of Bevy.
impl_reflect_opaque!((in lights_camera_models::document) PartId(Component, Clone, Debug, Hash, PartialEq));
impl Component for PartId {
    const STORAGE_TYPE: StorageType = StorageType::Table;
    type Mutability = Immutable;
}

with_defaults! {
    /// A light of the scene. Required by the component of its type. The position is the translation of the
    /// `Transform`, and the light shines along −z of its rotation.
    #[derive(Clone, Component, Copy, Debug, PartialEq, Reflect)]
    #[reflect(Component, Default, Clone, Debug, PartialEq)]
    #[require(Transform, Visibility)]
    #[component(on_remove = touch)]
    pub struct SceneLight {
        /// False if switched off.
        pub enabled: bool = true,
        /// Colour.
        pub colour: LightColour = LightColour::default(),
        /// Strength.
        pub power: LightPower = LightPower::default(),
    }
}

/// The colour of a light.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub enum LightColour {
    /// sRGB-encoded.
    Rgb([u8; 3]),
    /// The colour of a black body with this temperature, in kelvin.
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

/// An object of the scene. Required by the component of its type. The size is the scale of the `Transform`,
/// which must be uniform; `Visibility::Hidden` hides it.
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
    /// Parameters by name, of this model and of others.
    pub material: Values,
}

/// The tessellation of an object; `None` for the default of its type.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[component(on_remove = touch)]
pub struct Tessellation(pub Option<u32>);

/// The component of the observer: the declared fields without its place.
macro_rules! component {
    (
        $(#[$about:meta])+
        pub struct Observer($what:literal) {
            $(#[$of_position:meta])+ position: $position:ty = $at:expr, $there:expr;
            $(#[$of_direction:meta])+ direction: $direction:ty = $to:expr, $ahead:expr;
            $($(#[$help:meta])+ $field:ident: $type:ty = $declared:expr, $default:expr;)+
        }
    ) => {
        /// The observer of the scene, who looks along −z of the `Transform`.
        #[derive(Clone, Component, Copy, Debug, PartialEq, Reflect)]
        #[reflect(Component, Default, Clone, Debug, PartialEq)]
        #[require(Transform)]
        #[component(on_remove = touch)]
        pub struct SceneObserver {
            $($(#[$help])+ pub $field: $type,)+
        }

        impl From<&Observer> for SceneObserver {
            fn from(observer: &Observer) -> Self {
                Self { $($field: observer.$field,)+ }
            }
        }

        impl SceneObserver {
            /// The observer with these values.
            pub(super) fn at(self, place: Observer) -> Observer {
                Observer { $($field: self.$field,)+ ..place }
            }
        }
    };
}
observer!(component);

impl Default for SceneObserver {
    fn default() -> Self {
        Self::from(&Observer::default())
    }
}

/// Marks a part whose changes are shown but not stored: changes of its components by systems appear in the
/// picture, but reach neither the scene nor the document. When the marker is removed, the part returns to the
/// values of the document. An edit of the document writes only its changes into the components.
#[derive(Clone, Component, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[component(on_remove = rest)]
pub struct Animated;

/// The entities of parts of a scene.
pub(super) type IsPart = Or<(With<SceneLight>, With<SceneObject>, With<SceneObserver>)>;
