//! The hidden command that tries shaders for a window: see [`crate::render::trial::process`].

use std::{env, io, path::PathBuf};

use super::Outcome;
use crate::render::capture::trial::serve;

pub(super) fn run() -> Outcome {
    Ok(serve(io::stdin().lock(), io::stdout().lock())?)
}

/// This program's executable, to start it again.
pub(super) fn program() -> Option<PathBuf> {
    // This name stays valid when the file is replaced or removed, as by a new build.
    let own = PathBuf::from("/proc/self/exe");
    if cfg!(target_os = "linux") && own.exists() { Some(own) } else { env::current_exe().ok() }
}
