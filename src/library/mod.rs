//! The shader library: the files of shaders and custom models as they come and change. It reads them, knows the text of
//! each that was good last, and the problems of those that cannot be used.
//!
//! The texts that are drawn with and the folders are held by the [`Registry`](crate::registry::Registry), which the
//! library keeps up to date; it holds only the texts that are not drawn with. [`Library`] is in `texts`, problems in
//! `problem` and `blame`, what panels are told in [`status`], reading on a thread in [`reading`],
//! the texts that replace broken ones in [`stand_in`].

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
