//! `lcm view`: the window.

use std::path::{Path, PathBuf};

use clap::{Args, CommandFactory as _};

use super::{Outcome, above_zero, outputs, window_sides};
use crate::{failure::Failure, files::Shown as _, text::nearest};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene file, or a link with a scene in it; `-` is standard input; without one, the default scene
    pub(super) scene: Option<PathBuf>,
    /// Open a lesson: the name of one that comes with the program, or a file
    #[arg(long, value_name = "NAME_OR_FILE")]
    pub(super) lesson: Option<PathBuf>,
    /// Begin at this step of the lesson
    #[arg(long, value_name = "NUMBER", requires = "lesson", value_parser = above_zero)]
    pub(super) step: Option<u32>,
    /// Close the window after this many frames
    #[arg(long, value_name = "FRAMES", value_parser = above_zero)]
    pub(super) exit_after: Option<u32>,
    /// Write the whole window, panels included, to a PNG file before it closes
    #[arg(long, value_name = "FILE", requires = "exit_after", value_parser = outputs::place())]
    pub(super) capture: Option<PathBuf>,
    /// Leave the scene out of that file: lcm cannot open it then
    #[arg(long, requires = "capture")]
    pub(super) no_scene: bool,
    /// Size of the window in pixels
    #[arg(long, value_name = "WxH", value_parser = window_sides)]
    pub(super) size: Option<[u32; 2]>,
}

impl Arguments {
    /// The first argument given, for messages.
    pub(super) fn given(&self) -> Option<String> {
        let scene = self.scene.as_ref().map(|s| s.shown().to_string());
        scene
            .or_else(|| self.exit_after.map(|_| "--exit-after".to_owned()))
            .or_else(|| self.capture.as_ref().map(|_| "--capture".to_owned()))
    }
}

/// `lcm rendr room.json` is a misspelt command, not a scene called rendr.
pub(super) fn meant_command(path: &Path) -> Outcome {
    let Some(word) = path.to_str().filter(|w| !w.contains(['.', '/', '\\'])) else { return Ok(()) };
    if path.exists() {
        return Ok(());
    }
    let program = super::Cli::command();
    let commands =
        program.get_subcommands().filter(|c| !c.is_hide_set()).map(|c| (c.get_name(), c.get_name()));
    match nearest(word, commands) {
        Some(command) if command == word => {
            Err(Failure::Usage(format!("there is no scene file {word}; the command is lcm {word}")))
        }
        Some(command) => Err(Failure::Usage(format!(
            "there is no command {word}, and no scene file of that name; did you mean lcm {command}?"
        ))),
        None => Ok(()),
    }
}
