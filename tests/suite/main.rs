//! The integration tests: modules of one binary, because linking Bevy takes long.

mod command_line;
mod saving;
mod scene_errors;
mod scene_roundtrip;
mod schema;
mod support;
