//! The choices with which the window opens.

use std::path::PathBuf;

use crate::{
    panel::state::LessonSource,
    registry::Registry,
    scene::{
        Scene,
        load::{Defaults, Stamp},
    },
};

/// The choices with which the window starts.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct ViewOptions {
    /// The scene, checked.
    pub scene: Scene,
    /// The file that it came from, if any.
    pub file: Option<PathBuf>,
    /// The state of that file when it was read.
    pub stamp: Option<Stamp>,
    /// A file that the window opens itself, and asks about where there is something to ask.
    pub open: Option<PathBuf>,
    /// A file whose types the window may know once all of it is there, and what is done about missing parts; what is
    /// wrong with it ends the program then.
    pub late: Option<(PathBuf, Defaults)>,
    /// A lesson that the window opens.
    pub lesson: Option<LessonSource>,
    /// The step of the lesson, from 0; else the one that the user was at.
    pub step: Option<usize>,
    /// True if the window shows the examples: it begins without a scene of the user's.
    pub examples: bool,
    /// True if the defaults are used when the file comes to lack parts.
    pub use_defaults: bool,
    /// The size of the window in pixels; else 1280×720 points.
    pub size: Option<[u32; 2]>,
    /// Close the window after so many frames.
    pub exit_after: Option<u32>,
    /// Write the whole window to this file before it closes.
    pub capture: Option<PathBuf>,
    /// Leave the scene out of that file.
    pub no_scene: bool,
    /// Everything that is known, with the declarations of custom models, if they were read already. What is registered
    /// with the app and missing here is added.
    pub registry: Option<Registry>,
    /// The program that tries shaders when it is called with
    /// [`COMMAND`](crate::render::trial::process::COMMAND); without it the window itself does.
    pub trial_program: Option<PathBuf>,
    /// Warnings for the start.
    pub warnings: Vec<String>,
    /// Log more.
    pub verbose: bool,
    /// Log errors only.
    pub quiet: bool,
}
