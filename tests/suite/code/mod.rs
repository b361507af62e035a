//! The code itself: modules, features, and what it costs to build it.

mod cycles;
mod features;
mod lengths;
pub(crate) mod modules;
mod packaging;
mod platform;
mod window;
