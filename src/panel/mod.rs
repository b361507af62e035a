//! The window: panels around the picture.

pub mod files;
pub mod limits;
pub mod settings;
pub mod state;
