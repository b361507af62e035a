//! The results of trials.

use crate::shader::check::ShaderProblem;

/// The result of a trial.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It can be drawn with.
    Good,
    /// It cannot, for this reason.
    Bad(Box<ShaderProblem>),
    /// Not known yet: nothing has been drawn, or the process that tries is still at it. Ask again in the next
    /// frame.
    NotYet,
}

/// The reason why a trial did not succeed.
pub(super) enum Refusal {
    NotYet,
    Problem(Box<ShaderProblem>),
}
