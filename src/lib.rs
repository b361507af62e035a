//! # Lights, Camera, Models!
//!
//! A laboratory for the equations that light a surface. The modules stand in the order in which a
//! scene flows through them:
//!
//! ```text
//! JSON ─ scene ─ spawn ─► entities: Light · Object · Observer ─► materials ─► shader ─► picture
//!                              ▲                                    ▲
//!                            panel                     reflection, shading, light, shape
//! ```
//!
//! - [`optics`]: the vocabulary of every model, pure functions on vectors, no Bevy.
//! - [`reflection`], [`shading`], [`light`], [`shape`]: a trait and a list each; one file per kind.
//! - [`files`]: the one guard between the program and files.
//! - [`assets`]: where shader files and own models are read from.
//! - [`registry`]: what is known, looked up by id; registration from inside and outside the crate.
//! - [`observer`]: the camera.
//! - [`scene`]: the scene as a value; JSON; entities.
//! - [`shader`]: WGSL text in, WGSL text out.
//! - [`mod@reference`]: the CPU renderer, the same picture from the Rust functions.
//! - [`render`]: views, each with its picture in a texture of its own.
//! - [`capture`]: rendering without a window, PNG files.
//! - [`study`]: what tells the models apart, as numbers and a report.
//! - [`watch`]: which files on disk change.
//! - [`recovery`]: copies of unsaved work, for the next start.
//! - [`signals`]: what ends the program from outside.
//! - [`panel`]: what the window shows, as functions of a state that return actions.
//! - [`app`]: the scene plugin and the order of the systems.
//! - [`window`]: panels, camera and entities in one window.
//! - [`cli`]: the command line.

pub mod files;
pub mod optics;

pub mod light;
pub mod reflection;
pub mod shading;
pub mod shape;

pub mod registry;

pub mod observer;
pub mod scene;
pub mod shader;

pub mod capture;
pub mod panel;
pub mod recovery;
pub mod reference;
pub mod render;
pub mod signals;
pub mod study;
pub mod watch;

pub mod app;
pub mod assets;
pub mod cli;
pub mod window;
