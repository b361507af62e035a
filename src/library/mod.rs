//! The shader library: which file holds which text, where it is on disk, and what is wrong with it.

pub mod assets;
pub mod reading;
pub mod status;
