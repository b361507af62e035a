//! Rendering without a window; PNG files.

pub mod png;
