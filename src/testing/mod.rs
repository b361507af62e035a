//! Tests for models, shading models, light types and object types of other crates: the tests that the
//! built-in ones pass.
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
//! Each also checks the registration, and panics with the id and the first error, where it is, and how large.
//! The functions in [`laws`], [`parity`], `gpu`, [`lights`], [`shadings`] and [`meshes`] perform parts of these
//! tests for entries of a registry.

pub mod equations;
mod extended;
#[cfg(feature = "window")]
pub mod gpu;
mod lamp;
pub mod laws;
pub mod lights;
pub mod meshes;
pub mod parity;
mod sample;
pub mod shadings;
#[doc(hidden)]
pub mod shared;
mod words;

#[cfg(feature = "window")]
pub use gpu::assert_parity_on_gpu;
pub use sample::{direction, random, random_values};

use crate::{
    light::{LightEntry, LightType},
    reflection::{ModelEntry, ReflectionModel},
    registry::{Register as _, RegistrationError, Registry},
    shader::compose::Sources,
    shading::{ShadingEntry, ShadingModel},
    shape::{ObjectType, ShapeEntry},
};

/// The outcome of a test: the first error.
pub type Outcome = Result<(), String>;

#[track_caller]
fn assert(id: &str, outcome: Outcome) {
    if let Err(what) = outcome {
        panic!("{id}: {what}");
    }
}

/// Fails if nothing would have noticed something slightly wrong.
fn noticed(sensitive: bool, why: &str) -> Outcome {
    if sensitive { Ok(()) } else { Err(format!("{why} would not be noticed")) }
}

/// The outcome of a registration, of something new or as a replacement of something built in.
macro_rules! registered {
    ($T:ty, $known:ident, $add:ident, $replace:ident) => {{
        let mut registry = Registry::builtin();
        let known = registry.$known(<$T>::DECLARATION.id).is_some();
        let outcome = if known { registry.$replace::<$T>() } else { registry.$add::<$T>() };
        outcome.map(drop).map_err(|error: RegistrationError| error.what)
    }};
}

#[track_caller]
fn assert_model<M: ReflectionModel>(check: impl FnOnce(&ModelEntry) -> Outcome) {
    let registered = registered!(M, model, try_add_reflection_model, replace_reflection_model);
    assert(M::DECLARATION.id, registered.and_then(|()| check(&ModelEntry::of::<M>())));
}

/// Asserts that a reflection model returns finite numbers, obeys the laws that it declares, violates the
/// others, and gives several lights at once what it gives each alone.
///
/// # Panics
/// Panics if it does not.
#[track_caller]
pub fn assert_laws<M: ReflectionModel>() {
    assert_model::<M>(laws::all);
}

/// Asserts that the equation of a reflection model can be followed by hand: every line of an explanation
/// yields its own value from the numbers that it shows, for many directions and parameters.
///
/// # Panics
/// Panics if a line does not.
#[track_caller]
pub fn assert_equation<M: ReflectionModel>() {
    assert_model::<M>(equations::followed);
}

/// Asserts that a reflection model is equal in Rust and in WGSL, which the CPU interprets: to 1e-4, for many
/// directions, frames and parameters.
///
/// # Panics
/// Panics if it is not.
#[track_caller]
pub fn assert_parity<M: ReflectionModel>() {
    assert_model::<M>(|model| parity::all(model, &Sources::default()));
}

/// Asserts that a light type is equal in Rust and in WGSL, and that its light is finite, not negative and
/// proportional to the intensity. Without extent, its light is the product of its factors, and its luminous
/// flux is its light in all directions; with extent, a sample is seen again in its direction, with its
/// radiance and its density.
///
/// # Panics
/// Panics if any of this is not true.
#[track_caller]
pub fn assert_light<L: LightType>() {
    let registered = registered!(L, light, try_add_light_type, replace_light_type);
    let all = || lights::all(&LightEntry::of::<L>(), &Sources::default());
    assert(L::DECLARATION.id, registered.and_then(|()| all()));
}

/// Asserts that a shading model is equal in Rust and in WGSL, at corners and in pixels, and evaluates the
/// light only at the stage that it declares.
///
/// # Panics
/// Panics if any of this is not true.
#[track_caller]
pub fn assert_shading<S: ShadingModel>() {
    let registered = registered!(S, shading_model, try_add_shading_model, replace_shading_model);
    let all = || shadings::all(&ShadingEntry::of::<S>(), &Sources::default());
    assert(S::DECLARATION.id, registered.and_then(|()| all()));
}

/// Asserts that the meshes of an object type can be drawn by every shading model: at both ends of its
/// tessellations, and at the default.
///
/// # Panics
/// Panics if a mesh cannot.
#[track_caller]
pub fn assert_mesh<T: ObjectType>() {
    // Its messages are about the mesh as drawn, so they come first.
    let all = meshes::all(&ShapeEntry::of::<T>());
    assert(
        T::DECLARATION.id,
        all.and_then(|()| registered!(T, shape, try_add_object_type, replace_object_type)),
    );
}
