//! The integration tests, in one binary: linking Bevy once is enough.
#![allow(missing_docs, clippy::unwrap_used)]

mod laws;
mod reference_renderer;
