//! # Lights, Camera, Models!
//!
//! A laboratory for the equations that light a surface. The modules are in the order of their dependencies: each
//! uses only those above it, which `tests/suite/code/modules.rs` checks.
//!
//! ```text
//! JSON ─► scene ─► document ─► entities ─► materials, lights, meshes ─► a texture per view ─► window
//!                   ▲                      reflection, shading, light, shape
//!   panels, files reloaded,
//!   components changed by systems
//! ```
//!
//! The program is a member of the family that Sasha Soraine specifies in the *Commonality Analysis for Lights, Camera,
//! Models!* (version 3.0, 2019). Comments call it CA, and name its parts by their numbers: DD are data definitions, IM
//! instance models, which are reflection models, AB and AR assumptions bound at build time and at run time, LC likely
//! changes; names in capitals are its system variables.
//!
//! The outside of the program:
//!
//! - [`declared`]: enums whose values are declared in a file each.
//! - [`text`]: words for messages, and JSON whose values know their place.
//! - [`caught`]: panics that are caught, so that the rest goes on.
//! - [`platform`]: what a desktop and a browser do differently.
//! - [`lettering`]: text in pictures.
//! - [`program`]: the name of the program, and folders by it.
//! - [`files`]: every read and write: size limits, atomic replacement.
//! - [`failure`]: why a command failed, and its exit status.
//! - [`progress`]: how far some work is, and the wish to stop it.
//! - [`signals`]: Ctrl+C and termination signals.
//! - [`watch`]: file watching.
//! - [`linear`]: pictures of linear light in files, Radiance's and OpenEXR's: reading within limits, writing.
//!
//! The equations:
//!
//! - [`optics`]: the vocabulary of every model: geometry, radiometry (1/d², cones), colour, tone mapping, D, G, F, albedo.
//! - [`parameter`]: the declaration of a knob, values by name, and their layout for shaders.
//! - [`shader`]: WGSL text in, WGSL text out: composing, checking, interpreting.
//! - [`reflection`], [`shading`], [`light`], [`shape`]: a trait and a list each; one file per model, per shading
//!   model, per light type, per object type.
//! - [`debug`]: debug channels: one file per channel, with its formula in Rust and WGSL and its legend.
//! - [`registry`]: all known models, lights and shapes, by id; registration from inside and outside the crate.
//! - [`custom`]: reflection models written as one WGSL file.
//!
//! The scene and its pictures:
//!
//! - [`scene`]: the scene as a value; reading, checking and writing JSON.
//! - [`picture`]: pictures in files, with the scene that they show.
//! - [`document`]: the one writer of the scene: edits, checks, undo and redo.
//! - [`channel`]: debug channels of scenes: their light, their scale, and their legends.
//! - [`caption`]: pictures in words, and the strip below a picture that says them.
//! - [`mod@reference`]: the CPU renderer, the same picture from the Rust functions.
//! - [`materials`]: the library of materials: those of the program, and the user's own in a folder.
//! - [`explain`]: the colour of one pixel, with the equation and every number in it.
//! - [`compare`]: pictures compared: layouts of views, maps of differences, numbers.
//! - [`matching`]: the parameters of one view that come nearest to another.
//! - [`library`]: the shader library: the files of all shader texts, and their errors.
//! - [`recovery`]: crash recovery of unsaved work.
//! - `render`: drawing with Bevy.
//! - [`sweep`]: pictures of a scene with some of its values varied, for a folder, a sheet or a film.
//! - [`export`]: a scene as code: projects, shader files, pages, programs.
//! - [`curves`]: curves of models: BRDF, albedo, factors alone, image slices; measured data; figures.
//! - [`lesson`]: lessons: text, scene states, and tasks with conditions on the scene, a pixel or a curve.
//!
//! The program:
//!
//! - `panel`: egui panels, as functions of a state that return actions.
//! - `window`: panels, camera and entities in one window.
//! - [`study`]: the differences between models, as numbers and a report.
//! - [`testing`]: the tests that models, light types and object types pass, for those of other crates.
//! - [`cli`]: the command line.
//! - [`prelude`]: the names that extensions of the program need most.
//!
//! Without the feature `window`, which is a default, `render`, `panel` and `window` are missing, and with them Bevy's
//! renderer and egui. Everything else works without them, and says so where it cannot.

// Much of the rest serves the window.
#![cfg_attr(not(feature = "window"), allow(dead_code, unused_imports))]

/// The version of Bevy used by the window.
#[cfg(feature = "window")]
pub use bevy;
/// Components, as which parameters, lights and shapes are known to Bevy.
pub use bevy_ecs;
/// The version of bevy_egui, which contains that of egui, used by the panels.
#[cfg(feature = "window")]
pub use bevy_egui;
/// Reflection, by which tools read and write parameters.
pub use bevy_reflect;
/// The version of glam used by the equations.
pub use glam;

pub mod declared;

pub mod text;

pub mod caught;
pub mod platform;

pub mod lettering;

pub mod program;

pub mod files;

pub mod failure;
pub mod progress;
pub mod signals;
pub mod watch;

pub mod linear;

pub mod optics;
pub mod parameter;
pub mod shader;

pub mod light;
pub mod reflection;
pub mod shading;
pub mod shape;

pub mod debug;

pub mod registry;

pub mod custom;

pub mod scene;

pub mod picture;

pub mod document;

pub mod channel;

pub mod caption;

pub mod reference;

pub mod materials;

pub mod explain;

pub mod compare;
pub mod matching;

pub mod library;
pub mod recovery;
#[cfg(feature = "window")]
pub mod render;
pub mod sweep;

pub mod export;

pub mod curves;

pub mod lesson;

#[cfg(feature = "window")]
pub mod panel;
#[cfg(feature = "window")]
pub mod window;

pub mod study;

pub mod testing;

pub mod cli;

pub mod prelude;
