//! The hidden command that tries shaders for a window: see [`crate::render::trial::process`].

use std::io;

use super::Outcome;
use crate::render::capture::trial::serve;

pub(super) fn run() -> Outcome {
    Ok(serve(io::stdin().lock(), io::stdout().lock())?)
}
