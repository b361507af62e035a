//! Everything of Bevy that draws: the scene as entities, materials, lights in a buffer, live shaders, views, and
//! pictures without a window.

pub(crate) mod absorb;
pub(crate) mod backdrop;
pub mod camera;
pub mod capture;
pub mod converge;
pub mod drawn;
pub mod entities;
pub(crate) mod exchange;
mod facing;
pub mod illumination;
pub mod live;
pub mod material;
mod mean;
pub mod meshes;
mod mirror;
mod nearest;
pub mod noise;
mod noticed;
pub mod overrides;
pub mod parts;
mod pass;
pub mod plugin;
pub mod reconcile;
mod register;
pub mod schedule;
mod seen;
pub mod show;
mod shown;
mod solids;
pub mod stage;
pub mod straight;
pub mod swap;
pub mod tables;
pub mod trial;
pub(crate) mod typed;
pub mod view;
