//! The code itself: modules, features, and what it costs to build it.

mod cycles;
mod features;
pub(crate) mod modules;
