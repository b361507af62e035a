//! Comparisons of views, and matching one to another.

pub(crate) mod matching;
mod metrics;
mod views;
