//! The hidden command that tries shaders for a window: see [`crate::render::trial::process`].

use std::{env, io, path::PathBuf};

use super::Outcome;
use crate::render::capture::trial::serve;

pub(super) fn run() -> Outcome {
    Ok(serve(io::stdin().lock(), io::stdout().lock())?)
}

/// The program whose command this is, to be started again.
pub(super) fn program() -> Option<PathBuf> {
    // This name stays right when the file is replaced or removed, as a new build does.
    let own = PathBuf::from("/proc/self/exe");
    if cfg!(target_os = "linux") && own.exists() { Some(own) } else { env::current_exe().ok() }
}
