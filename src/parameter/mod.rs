//! Parameters of models and lights: one declaration drives JSON, checks, the window's controls, the layout in
//! shaders and `lcm models`.
//!
//! Models share parameters **by name**, so changing the model keeps the user's settings. What has another name goes along
//! by its [meaning]. Parameters of several models are declared here once.

mod builder;
mod component;
mod declaration;
mod file;
pub mod kind;
mod layout;
pub mod limits;
pub mod meaning;
mod outside;
mod parse;
mod reflect;
mod set;
mod shared;
mod values;

pub use component::{TypeComponent, Watch, watch};
pub use file::{
    FileFormat, FileProblem, MAX_FILES_BYTES, MAX_FILES_NUMBERS, NamedFile, Shipped, Table, file_changes,
    files_read, read_all,
};
pub use kind::{ParameterKind, Value, json, lanes};
pub use layout::{BLOCK_BYTES, layout, pack, stride, words};
pub use limits::ABOVE_ZERO;
pub use meaning::{Meaning, Side};
pub use outside::Outside;
pub use parse::ParseError;
pub use set::ParameterSet;
pub use shared::{
    ALPHA, ALPHA_X, ALPHA_Y, BASE_COLOUR, EXTINCTION, IOR, K_A, K_D, K_S, METALLIC, REFLECTANCE,
    REFRACTIVE_INDEX, ROUGHNESS, SIGMA, SPECULAR_COLOUR, TRANSMITTANCE_COLOUR,
};
pub use values::Values;

/// The declaration of one parameter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Parameter {
    /// The name in scene files and on the command line.
    pub name: &'static str,
    /// The symbol in the equation, e.g. `k_d` or `α`.
    pub symbol: &'static str,
    /// The word beside the symbol, e.g. "diffuse coefficient".
    pub label: &'static str,
    /// The unit, empty for dimensionless numbers.
    pub unit: &'static str,
    /// One sentence about the effect, for tooltips and manuals.
    pub help: &'static str,
    /// Type, range and default.
    pub kind: ParameterKind,
    /// The condition under which the parameter is used; `None` if always. See [`Parameter::used_when`].
    pub used_when: Option<UsedWhen>,
    /// The quantity that it stands for, by which its value goes along to a model that has it under another name.
    pub stands_for: Option<&'static Meaning>,
    /// True if other values than the default take many times as long to calculate. See [`Parameter::costly`].
    pub costly: bool,
}

/// A condition for the use of a parameter: another parameter of the model has one of these choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UsedWhen {
    /// The name of the other parameter.
    pub parameter: &'static str,
    /// The names of the required choices.
    pub choices: &'static [&'static str],
}
