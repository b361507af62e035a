//! The integration tests, in one binary: linking Bevy once is enough.
#![allow(missing_docs, clippy::unwrap_used)]

mod extension;
mod gpu_parity;
mod hot_swap;
mod laws;
mod reference_renderer;
mod support;
