//! The integration tests, in one binary: linking Bevy once is enough.
#![allow(missing_docs, clippy::unwrap_used)]

mod albedo;
mod command_line;
mod extension;
mod golden;
mod gpu_parity;
mod hot_swap;
mod interpret;
mod laws;
mod panels;
mod pictures;
mod readme;
mod reference_renderer;
mod saving;
mod scene_errors;
mod scene_roundtrip;
mod schema;
mod shader_panel;
mod study;
mod support;
mod tangents;
mod window;
mod witness;
