//! Reflection models: equations, laws, and models of users.

mod albedo;
mod custom_curves;
mod custom_folder;
mod custom_models;
mod foreign;
mod interpret;
mod laws;
mod mistakes;
mod openpbr_transmission;
mod parameters;
mod precision;
mod solids;
mod swallowed;
mod transmission;
#[cfg(unix)]
mod trial;
mod usage;
mod witness;
