//! The shader library: keeps track of shader files and custom models as they change. It reads them, remembers
//! the last valid text of each, and the problems of the invalid ones.
//!
//! The texts in use and the folders are in the [`Registry`](crate::registry::Registry), which the library
//! keeps up to date; the library itself holds only texts that are not in use. [`Library`] is in `texts`,
//! problems in `problem` and `blame`, the state shown in panels in [`status`], reading on a thread in
//! [`reading`], the fallbacks for broken texts in [`stand_in`].

pub mod assets;
mod blame;
pub mod problem;
pub mod reading;
pub mod stand_in;
pub mod status;
#[cfg(test)]
mod tests;
mod texts;

pub use texts::Library;
pub(crate) use texts::model_of;
