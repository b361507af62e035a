//! The limits of lessons. They ensure that any lesson up to [`MAX_FILE_BYTES`] is read within two seconds and
//! shown without delay, whatever its content.
//!
//! Equations have separate limits, [`LONGEST_LINE`](crate::text::mathematics::LONGEST_LINE) and
//! [`MAX_DEPTH`](crate::text::mathematics::MAX_DEPTH), and so do the scenes that a lesson names.

/// Maximum size of a file; larger files are refused before they are read. The longest shipped lesson has a
/// hundredth of it.
pub const MAX_FILE_BYTES: u64 = 1 << 20;
/// Maximum number of steps.
pub const MAX_STEPS: usize = 100;
/// Maximum length of the title of a lesson or a step, and of the summary, in characters.
pub const LONGEST_TITLE: usize = 300;
/// Maximum length of a step's text with its equations and its task, in characters: about ten pages.
pub const LONGEST_STEP: usize = 20_000;
/// Maximum length of a condition, in characters.
pub const LONGEST_CONDITION: usize = 1000;
/// Maximum number of comparisons in a condition: each may take milliseconds to evaluate.
pub const MAX_COMPARISONS: usize = 16;
/// Maximum nesting of brackets and negations in a condition.
pub const DEEPEST_CONDITION: usize = 24;
/// Maximum number of lines in a `view` or `point` block, and of values set by a `scene` block.
pub const MAX_LINES: usize = 100;
/// Maximum number of objects and lights in the scenes of all steps that change theirs, together: each of these scenes is
/// checked as a whole.
pub const MAX_PARTS: usize = 250_000;
/// Maximum number of problems reported; the rest of the lesson is not read.
pub const MAX_PROBLEMS: usize = crate::scene::error::MOST_LISTED;
