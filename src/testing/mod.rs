//! Tests for models, light types and object types of other crates: those that the built-in ones pass.
//!
//! ```
//! use lights_camera_models::{light, reflection, shape, testing};
//!
//! // In the tests of your crate, with your types:
//! testing::assert_laws::<reflection::Lambert>();
//! testing::assert_parity::<reflection::Lambert>();
//! testing::assert_light::<light::Spot>();
//! testing::assert_mesh::<shape::Torus>();
//! ```
//!
//! Each panics with the id and the first thing that is wrong, where, and by how much. The functions in [`laws`],
//! [`parity`], [`lights`] and [`meshes`] do parts of it for entries of a registry.

pub mod laws;
pub mod lights;
pub mod meshes;
pub mod parity;
mod sample;

pub use sample::{direction, random, random_values};

use crate::{
    light::{LightEntry, LightType},
    reflection::{ModelEntry, ReflectionModel},
    shader::compose::Sources,
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

/// Asserts that a reflection model gives finite numbers, keeps the laws that it declares, and breaks the others.
///
/// # Panics
/// If it does not.
#[track_caller]
pub fn assert_laws<M: ReflectionModel>() {
    assert(M::DECLARATION.id, laws::all(&ModelEntry::of::<M>()));
}

/// Asserts that a reflection model is the same in Rust and in WGSL, which the CPU interprets: to 1e-4, for many
/// directions, frames and parameters.
///
/// # Panics
/// If it is not.
#[track_caller]
pub fn assert_parity<M: ReflectionModel>() {
    assert(M::DECLARATION.id, parity::all(&ModelEntry::of::<M>(), &Sources::default()));
}

/// Asserts the same on the GPU, at the ends of all ranges too. Needs a Vulkan driver; a software one will do.
///
/// # Panics
/// If it is not, or if there is no driver.
#[track_caller]
pub fn assert_parity_on_gpu<M: ReflectionModel>() {
    let (model, sources) = (ModelEntry::of::<M>(), Sources::default());
    let both = || {
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
    assert(L::DECLARATION.id, lights::all(&LightEntry::of::<L>(), &Sources::default()));
}

/// Asserts that the meshes of an object type can be drawn by every shading model: at both ends of its tessellations,
/// and at the default.
///
/// # Panics
/// If one cannot.
#[track_caller]
pub fn assert_mesh<T: ObjectType>() {
    assert(T::DECLARATION.id, meshes::all(&ShapeEntry::of::<T>()));
}
