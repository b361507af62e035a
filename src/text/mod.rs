//! Words for people, and JSON whose values know where they stand.

pub mod json;
pub mod path;
pub mod place;
mod words;

pub use words::{did_you_mean, listed, nearest, number, one_of, plural, quoted, shortened};
