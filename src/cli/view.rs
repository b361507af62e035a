//! `lcm view`: the window.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Failure, Options, Outcome, scenes::Source};
use crate::{registry::Registry, scene::Scene};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// The scene; - is standard input; none is the default scene
    scene: Option<PathBuf>,
    /// Close the window after so many frames
    #[arg(long, value_name = "FRAMES", value_parser = clap::value_parser!(u32).range(1..))]
    exit_after: Option<u32>,
    /// Write the whole window, panels included, to a PNG file before it closes
    #[arg(long, value_name = "FILE", requires = "exit_after")]
    capture: Option<PathBuf>,
}

impl Arguments {
    /// What was given, if anything, for messages.
    pub(super) fn given(&self) -> Option<String> {
        let scene = self.scene.as_ref().map(|s| s.display().to_string());
        scene
            .or_else(|| self.exit_after.map(|_| "--exit-after".to_owned()))
            .or_else(|| self.capture.as_ref().map(|_| "--capture".to_owned()))
    }
}

/// What the window starts with.
#[derive(Clone, Debug)]
pub struct ViewOptions {
    /// The scene, checked.
    pub scene: Scene,
    /// The file that it came from, if any.
    pub file: Option<PathBuf>,
    /// Close the window after so many frames.
    pub exit_after: Option<u32>,
    /// Write the whole window to this file before it closes.
    pub capture: Option<PathBuf>,
    /// Log more.
    pub verbose: bool,
    /// Log errors only.
    pub quiet: bool,
}

pub(super) fn run(arguments: Arguments, options: Options, registry: &Registry) -> Outcome {
    let source = Source::of(arguments.scene.as_deref());
    if let Source::File(path) = &source {
        meant_command(path)?;
    }
    let scene = source.open(registry, options)?;
    let Arguments { exit_after, capture, .. } = arguments;
    let file = match source {
        Source::File(path) => Some(path),
        Source::Default | Source::Stdin => None,
    };
    let Options { verbose, quiet, .. } = options;
    crate::app::view(ViewOptions { scene, file, exit_after, capture, verbose, quiet })
}

/// `lcm rendr room.json` is not a scene called rendr.
fn meant_command(path: &Path) -> Outcome {
    const COMMANDS: [&str; 7] = ["view", "render", "check", "new", "models", "evaluate", "schema"];
    let Some(word) = path.to_str().filter(|w| !w.contains(['.', '/', '\\'])) else { return Ok(()) };
    if path.exists() {
        return Ok(());
    }
    match crate::scene::check::nearest(word, COMMANDS.map(|c| (c, c)).into_iter()) {
        Some(command) => Err(Failure::Usage(format!(
            "there is no command {word}, and no scene file of that name; did you mean lcm {command}?"
        ))),
        None => Ok(()),
    }
}
