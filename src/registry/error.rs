//! Errors of registration.

use std::any::type_name;

use thiserror::Error;

use crate::shader::check::ShaderProblem;

/// The reason why something cannot be registered, phrased for its author.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{part} `{id}` ({type_name}): {what}")]
#[non_exhaustive]
pub struct RegistrationError {
    /// "reflection model", "shading model", "light type" or "object type".
    pub part: &'static str,
    /// Id of the type.
    pub id: &'static str,
    /// The type in Rust.
    pub type_name: &'static str,
    /// The error, its position, and the remedy.
    pub what: String,
    /// The error with its position in the file, if it is in the WGSL.
    pub shader: Option<Box<ShaderProblem>>,
}

/// An error without its context.
pub(super) enum Mistake {
    /// In the declaration, or in a mesh.
    Declared(String),
    /// In the WGSL.
    Wgsl(Box<ShaderProblem>),
}

impl From<String> for Mistake {
    fn from(what: String) -> Self {
        Self::Declared(what)
    }
}

impl From<Box<ShaderProblem>> for Mistake {
    fn from(problem: Box<ShaderProblem>) -> Self {
        Self::Wgsl(problem)
    }
}

impl RegistrationError {
    /// The error of a type.
    pub(super) fn of<T>(part: &'static str, id: &'static str, mistake: Mistake) -> Self {
        let (what, shader) = match mistake {
            Mistake::Declared(what) => (what, None),
            Mistake::Wgsl(problem) => (problem.to_string(), Some(problem)),
        };
        Self { part, id, type_name: type_name::<T>(), what, shader }
    }
}
