//! Everything of Bevy that draws: views, and how they reach the window.

pub mod show;
pub mod view;
