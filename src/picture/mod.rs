//! Pictures in files, with what they show: [`png`] writes display codes, [`linear`] the light itself.

pub mod linear;
pub mod png;
