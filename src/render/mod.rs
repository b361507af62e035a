//! Everything of Bevy that draws: the scene as entities, materials, lights in a buffer, live shaders, views, and
//! pictures without a window.

pub mod camera;
pub mod capture;
pub mod drawn;
pub mod entities;
mod exchange;
pub mod illumination;
pub mod live;
pub mod material;
pub mod meshes;
pub mod overrides;
pub mod plugin;
mod register;
pub mod schedule;
pub mod show;
pub mod stage;
pub mod swap;
pub mod tables;
pub mod trial;
pub mod view;
