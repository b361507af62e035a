//! Rendering without a window; PNG files.

pub mod evaluate;
pub mod gpu;
pub mod png;
pub mod trial;
