//! The library: programs, plugins, panels and types of other crates.

pub(crate) mod animation;
pub(crate) mod extension;
mod guests;
pub(crate) mod plugins;
mod programs;
mod registration;
mod testing;
