//! Start options of the window.

use std::path::PathBuf;

use crate::{
    panel::state::LessonSource,
    parameter::Outside,
    registry::Registry,
    scene::{
        Scene,
        load::{Defaults, Stamp},
    },
};

/// Start options of the window.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct ViewOptions {
    /// The scene, checked.
    pub scene: Scene,
    /// The file of the scene, if any.
    pub file: Option<PathBuf>,
    /// Version of the file when it was read.
    pub stamp: Option<Stamp>,
    /// A file for the window to open, which may ask the user questions about it.
    pub open: Option<PathBuf>,
    /// A file whose types may be unknown until the app is complete, and how to handle missing parts. Problems with the
    /// file end the program.
    pub late: Option<(PathBuf, Defaults)>,
    /// A lesson to open.
    pub lesson: Option<LessonSource>,
    /// The step of the lesson, from 0; `None` for the user's last step.
    pub step: Option<usize>,
    /// True to show the examples, because the window starts without a scene of the user's.
    pub examples: bool,
    /// The files outside their folders that scenes may name.
    pub outside: Outside,
    /// True to use defaults if the file is later missing parts.
    pub use_defaults: bool,
    /// Size of the window in pixels; `None` for 1280×720 points.
    pub size: Option<[u32; 2]>,
    /// Close the window after this number of frames.
    pub exit_after: Option<u32>,
    /// Capture the whole window to this file before closing.
    pub capture: Option<PathBuf>,
    /// Leave the scene out of the capture.
    pub no_scene: bool,
    /// The registry, with the declarations of custom models, if it was already built. Types registered with the app are
    /// added.
    pub registry: Option<Registry>,
    /// The program that tests shaders when called with [`COMMAND`](crate::render::trial::process::COMMAND); `None` to
    /// test them in the window itself.
    pub trial_program: Option<PathBuf>,
    /// Warnings to show at the start.
    pub warnings: Vec<String>,
    /// Log more messages.
    pub verbose: bool,
    /// Log errors only.
    pub quiet: bool,
}
