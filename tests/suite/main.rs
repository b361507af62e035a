//! The integration tests, in one binary: linking Bevy once is enough.
#![allow(missing_docs, clippy::unwrap_used)]

mod albedo;
mod assets;
mod command_line;
mod extension;
mod files;
mod golden;
mod gpu_parity;
mod hostile;
mod hot_swap;
mod interpret;
mod keyboard;
mod laws;
mod own_folder;
mod own_models;
mod panels;
mod pictures;
mod readme;
mod reference_renderer;
mod reload;
mod saving;
mod scene_errors;
mod scene_reload;
mod scene_roundtrip;
mod schema;
mod screen;
mod shader_panel;
mod signals;
mod study;
mod support;
mod tangents;
#[cfg(unix)]
mod trial;
mod window;
mod window_reload;
mod witness;
