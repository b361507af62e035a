//! The views of a scene: their number and their letters.

/// Maximum number of variants of a scene: with the scene itself, four views.
pub const MAX_VARIANTS: usize = 3;

/// The letters of the views: A is the scene, the others are its variants.
pub const LETTERS: [&str; MAX_VARIANTS + 1] = ["A", "B", "C", "D"];
