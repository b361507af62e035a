//! Parameters of models and lights: one declaration drives JSON, checks, the window's controls, the layout in
//! shaders and `lcm models`.
//!
//! Models share parameters **by name**, so changing the model keeps the user's settings. Parameters of several models
//! are declared here once.

mod builder;
mod component;
mod declaration;
mod file;
mod layout;
pub mod outside;
mod parse;
mod reflect;
mod set;
mod shared;
mod value;
mod values;

pub use component::{TypeComponent, Watch};
pub use declaration::{ABOVE_ZERO, Parameter, ParameterKind, UsedWhen};
pub use file::{
    FileFormat, FileProblem, MAX_FILES_BYTES, MAX_FILES_NUMBERS, NamedFile, Table, file_changes, files_read,
    read_all,
};
pub use layout::{BLOCK_BYTES, layout, pack, stride, words};
pub use parse::ParseError;
pub use set::ParameterSet;
pub use shared::{
    ALPHA, ALPHA_X, ALPHA_Y, BASE_COLOUR, EXTINCTION, IOR, K_A, K_D, K_S, METALLIC, REFLECTANCE, ROUGHNESS,
    SIGMA, SPECULAR_COLOUR,
};
pub use value::{Value, json};
pub use values::Values;
