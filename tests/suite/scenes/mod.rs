//! Scene files: reading, checking, writing.

mod errors;
pub(crate) mod formats;
mod in_pictures;
mod links;
mod measured;
mod mesh_files;
mod missing_size;
mod overrides;
mod photometric;
mod reload;
pub(crate) mod roundtrip;
mod rows;
mod saving;
mod schema;
mod tables;
