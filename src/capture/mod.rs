//! Rendering without a window.

pub mod gpu;
