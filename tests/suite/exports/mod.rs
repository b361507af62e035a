//! Exports: each form, and their common properties.

mod bevy;
mod bodies;
mod executable;
mod forms;
mod mitsuba;
mod pages;
mod shaders;
mod slow;
pub(crate) mod window;
