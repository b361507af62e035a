//! The results of trials.

use crate::shader::check::ShaderProblem;

/// The result of a trial.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The shader is valid.
    Good,
    /// The shader is invalid, for this reason.
    Bad(Box<ShaderProblem>),
    /// Not known yet: nothing has been drawn, or the trial process is still busy. Ask again in the next
    /// frame.
    NotYet,
}
