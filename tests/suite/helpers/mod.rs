//! Helpers of several tests.

pub(crate) mod browser;
pub(crate) mod keyboard;
pub(crate) mod pages;
pub(crate) mod pictures;
pub(crate) mod screen;
pub(crate) mod skipped;
pub(crate) mod support;
pub(crate) mod tensor;
