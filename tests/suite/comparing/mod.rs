//! Comparisons of views, and matching one to another.

mod fits;
pub(crate) mod matching;
mod metrics;
mod searches;
mod views;
