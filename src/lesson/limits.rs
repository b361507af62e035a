//! The limits of lessons. With them every lesson of [`MAX_FILE_BYTES`] is read in two seconds and shown without delay,
//! whatever is in it.
//!
//! Equations have limits of their own, [`LONGEST_LINE`](crate::text::mathematics::LONGEST_LINE) and
//! [`MAX_DEPTH`](crate::text::mathematics::MAX_DEPTH), and so have the scenes that a lesson names.

/// Larger files are refused before they are read. The longest shipped lesson is a hundredth of this.
pub const MAX_FILE_BYTES: u64 = 1 << 20;
/// The most steps.
pub const MAX_STEPS: usize = 100;
/// The longest title of a lesson or a step, and the longest summary, characters.
pub const LONGEST_TITLE: usize = 300;
/// The most text of a step with its equations and its task, characters: about ten pages.
pub const LONGEST_STEP: usize = 20_000;
/// The longest condition, characters.
pub const LONGEST_CONDITION: usize = 1000;
/// The most comparisons in a condition: each may take milliseconds to evaluate.
pub const MAX_COMPARISONS: usize = 16;
/// The deepest brackets and negations of a condition.
pub const DEEPEST_CONDITION: usize = 24;
/// The most lines of a block `view` or `point`, and the most values that a block `scene` sets.
pub const MAX_LINES: usize = 100;
/// The most problems reported; the lesson is read no further.
pub const MAX_PROBLEMS: usize = 200;
