//! Tests for models, shading models, light types and object types of other crates: those that the built-in ones pass.
//!
//! ```
//! use lights_camera_models::{light, reflection, shading, shape, testing};
//!
//! // In the tests of your crate, with your types:
//! testing::assert_laws::<reflection::Lambert>();
//! testing::assert_equation::<reflection::Lambert>();
//! testing::assert_parity::<reflection::Lambert>();
//! testing::assert_light::<light::Spot>();
//! testing::assert_shading::<shading::Gouraud>();
//! testing::assert_mesh::<shape::Torus>();
//! ```
//!
//! Each also tries the registration, and panics with the id and the first thing that is wrong, where, and by how much. The
//! functions in [`laws`], [`parity`], [`lights`], [`shadings`] and [`meshes`] do parts of it for entries of a registry.

pub mod equations;
mod extended;
pub mod laws;
pub mod lights;
pub mod meshes;
pub mod parity;
mod sample;
pub mod shadings;

pub use sample::{direction, random, random_values};

use crate::{
    light::{LightEntry, LightType},
    reflection::{ModelEntry, ReflectionModel},
    registry::{Register as _, RegistrationError, Registry},
    shader::compose::Sources,
    shading::{ShadingEntry, ShadingModel},
    shape::{ObjectType, ShapeEntry},
};

/// The outcome of a test: the first thing that is wrong.
pub type Outcome = Result<(), String>;

#[track_caller]
fn assert(id: &str, outcome: Outcome) {
    if let Err(what) = outcome {
        panic!("{id}: {what}");
    }
}

/// The outcome of a registration, of something new or in the place of what is built in.
macro_rules! registered {
    ($T:ty, $known:ident, $add:ident, $replace:ident) => {{
        let mut registry = Registry::builtin();
        let known = registry.$known(<$T>::DECLARATION.id).is_some();
        let outcome = if known { registry.$replace::<$T>() } else { registry.$add::<$T>() };
        outcome.map(drop).map_err(|error: RegistrationError| error.what)
    }};
}

fn registered_model<M: ReflectionModel>() -> Outcome {
    registered!(M, model, try_add_reflection_model, replace_reflection_model)
}

/// Asserts that a reflection model gives finite numbers, keeps the laws that it declares, and breaks the others.
///
/// # Panics
/// If it does not.
#[track_caller]
pub fn assert_laws<M: ReflectionModel>() {
    assert(M::DECLARATION.id, registered_model::<M>().and_then(|()| laws::all(&ModelEntry::of::<M>())));
}

/// Asserts that the equation of a reflection model can be followed by hand: every line of an explanation gives its own
/// value from the numbers that it shows, for many directions and parameters.
///
/// # Panics
/// If one does not.
#[track_caller]
pub fn assert_equation<M: ReflectionModel>() {
    let followed = || equations::followed(&ModelEntry::of::<M>());
    assert(M::DECLARATION.id, registered_model::<M>().and_then(|()| followed()));
}

/// Asserts that a reflection model is the same in Rust and in WGSL, which the CPU interprets: to 1e-4, for many
/// directions, frames and parameters.
///
/// # Panics
/// If it is not.
#[track_caller]
pub fn assert_parity<M: ReflectionModel>() {
    let both = || parity::all(&ModelEntry::of::<M>(), &Sources::default());
    assert(M::DECLARATION.id, registered_model::<M>().and_then(|()| both()));
}

/// Asserts the same on the GPU, at the ends of all ranges too. Needs a Vulkan driver; a software one will do.
///
/// # Panics
/// If it is not, or if there is no driver.
#[track_caller]
pub fn assert_parity_on_gpu<M: ReflectionModel>() {
    let (model, sources) = (ModelEntry::of::<M>(), Sources::default());
    let both = || {
        registered_model::<M>()?;
        parity::on_gpu(&model, &sources)?;
        parity::at_the_ends_on_gpu(&model, &sources, &mut { parity::SEED_OF_ENDS })
    };
    assert(M::DECLARATION.id, both());
}

/// Asserts that a light type is the same in Rust and in WGSL, that its light is finite, not negative, proportional
/// to the intensity and the product of its factors, and that its luminous flux is what it sends out in all directions.
///
/// # Panics
/// If it is not.
#[track_caller]
pub fn assert_light<L: LightType>() {
    let registered = registered!(L, light, try_add_light_type, replace_light_type);
    let all = || lights::all(&LightEntry::of::<L>(), &Sources::default());
    assert(L::DECLARATION.id, registered.and_then(|()| all()));
}

/// Asserts that a shading model is the same in Rust and in WGSL, at corners and in pixels, and evaluates the light at the
/// stage that it declares and at no other.
///
/// # Panics
/// If it is not, or does not.
#[track_caller]
pub fn assert_shading<S: ShadingModel>() {
    let registered = registered!(S, shading_model, try_add_shading_model, replace_shading_model);
    let all = || shadings::all(&ShadingEntry::of::<S>(), &Sources::default());
    assert(S::DECLARATION.id, registered.and_then(|()| all()));
}

/// Asserts that the meshes of an object type can be drawn by every shading model: at both ends of its tessellations,
/// and at the default.
///
/// # Panics
/// If one cannot.
#[track_caller]
pub fn assert_mesh<T: ObjectType>() {
    // Its messages are about what is drawn, so they come first.
    let all = meshes::all(&ShapeEntry::of::<T>());
    assert(
        T::DECLARATION.id,
        all.and_then(|()| registered!(T, shape, try_add_object_type, replace_object_type)),
    );
}
