//! A step while it is read.

use super::Step;

/// A step, and the bytes of what is checked once its scene is known.
#[derive(Debug, Default)]
pub(super) struct Draft {
    pub(super) step: Step,
    /// The byte of its heading.
    pub(super) at: usize,
    pub(super) is_empty: bool,
    /// The values of a block `view`, by setting.
    pub(super) settings: Vec<(&'static str, usize)>,
    /// The controls of a block `point`.
    pub(super) points: Vec<usize>,
    /// Texts that should name parts of the scene, and do not.
    pub(super) misnamed: Vec<(usize, String)>,
    /// The condition of the task.
    pub(super) until: Option<usize>,
    /// True if the block `scene` could not be read.
    pub(super) is_lost: bool,
    pub(super) kinds: Vec<&'static str>,
}
