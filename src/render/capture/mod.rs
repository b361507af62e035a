//! Rendering without a window: [`gpu`] draws the pictures of `lcm render`, [`evaluate`] computes values,
//! [`trial`] draws small pictures to try shaders, [`png`] writes files.

pub mod evaluate;
pub mod gpu;
pub mod png;
pub mod settle;
pub mod trial;
