//! In place of the window and the GPU: nothing.

use super::Engine;

/// In place of Bevy's app: there is none.
#[derive(Debug)]
pub enum App {}

pub(in crate::cli) const ENGINE: Option<&Engine> = None;
