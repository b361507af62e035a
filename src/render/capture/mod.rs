//! Rendering without a window: [`gpu`] draws the pictures of `lcm render`, [`light`] those in linear light,
//! [`evaluate`] computes values, [`trial`] draws small pictures to try shaders. [`picture`](crate::picture) writes files.

pub mod evaluate;
pub mod gpu;
pub mod light;
pub mod settle;
#[cfg(test)]
mod tests;
pub mod trial;
