//! Lessons: text with equations, scene states, and steps with tasks checked by conditions. Written in
//! Markdown with a few fenced blocks of our own. Independent of the window: the panel displays lessons read
//! here, and asks this module whether a task is done.
//!
//! ```
//! use lights_camera_models::{lesson::Lesson, registry::Registry};
//! let text = "---\ntitle: Light\nsummary: A sphere.\n---\n\n## Look\n\nA *matte* sphere.\n";
//! let lesson = Lesson::from_text(text, "light", None, &Registry::builtin()).unwrap();
//! assert_eq!(lesson.steps[0].title, "Look");
//! ```

use std::{path::Path, sync::Arc};

use crate::{
    channel::DebugChannel, curves::Kind, document::Selection, optics::TermSelection, parameter::Outside,
    registry::Registry, scene::Scene,
};

mod blocks;
mod check;
mod condition;
mod controls;
mod draft;
mod front;
pub mod limits;
mod markdown;
mod problem;
mod read;
mod runs;
pub mod shipped;
mod situation;
mod state;
mod text;
mod window;
mod words;

pub use condition::{Condition, QUANTITIES, Quantity};
pub use controls::{BUTTONS, Control, KNOBS, MENUS, PartName, TABS, VALUES, Which};
pub use problem::Problem;
pub use situation::{Situation, WindowFacts};
pub use state::SceneChange;
use state::Shelf;
pub use window::SETTINGS;

/// A lesson.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// Name of the file or folder, without `.md`; identifies the learner's progress.
    pub id: String,
    /// Title.
    pub title: String,
    /// One sentence: the content.
    pub summary: String,
    /// Duration in minutes.
    pub minutes: Option<u32>,
    /// The scene before the first step.
    pub start: Arc<Scene>,
    /// The steps; at least one.
    pub steps: Vec<Step>,
}

/// A step of a lesson.
#[derive(Clone, Debug, Default)]
pub struct Step {
    /// Heading.
    pub title: String,
    /// Text, in order.
    pub blocks: Vec<Block>,
    /// The change of the scene on entering the step.
    pub scene: Option<SceneChange>,
    /// The change of the window on entering the step.
    pub window: WindowChange,
    /// The controls that are highlighted during the step.
    pub points: Vec<Control>,
    /// The task of the learner; [`Block::Task`] marks its position among the blocks.
    pub task: Option<Task>,
}

/// A part of a step's content.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Block {
    /// A paragraph.
    Paragraph(Vec<Run>),
    /// An item of a list.
    Item {
        /// Number, in numbered lists.
        number: Option<u64>,
        /// Nesting: 0 for a list, 1 for a list within it.
        depth: usize,
        /// Text of the item.
        runs: Vec<Run>,
    },
    /// An equation, in the notation of the models' equations, possibly with several lines.
    Equation(String),
    /// The task of the step.
    Task,
}

/// Text in one style.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// The text; line breaks only where intended.
    pub text: String,
    /// Style.
    pub style: RunStyle,
}

/// The style of a text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RunStyle {
    /// Plain text.
    #[default]
    Plain,
    /// Emphasised text.
    Emphasis,
    /// A key or the name of a menu.
    Strong,
    /// Code, as typed.
    Code,
}

/// The task of a step.
#[derive(Clone, Debug)]
pub enum Task {
    /// Answer a question before the answer can be seen.
    Predict {
        /// The question.
        question: Vec<Run>,
        /// At least two answers, of which at least one is right and one wrong.
        answers: Vec<AnswerChoice>,
    },
    /// Change something.
    Do(Goal),
    /// Find something.
    Find(Goal),
}

/// A possible answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnswerChoice {
    /// The answer.
    pub text: Vec<Run>,
    /// True if the answer is right.
    pub right: bool,
    /// Comment shown to those who choose the answer.
    pub feedback: Vec<Run>,
}

/// Something to reach.
#[derive(Clone, Debug)]
pub struct Goal {
    /// Task in words.
    pub text: Vec<Run>,
    /// Condition that completes the task.
    pub until: Condition,
    /// Hint, shown on request.
    pub hint: Option<Vec<Run>>,
}

/// The change of the window on entering a step. `None` leaves a setting unchanged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WindowChange {
    /// The debug channel of the active view; `Some(None)` shows the picture.
    pub channel: Option<Option<DebugChannel>>,
    /// The displayed terms of the equation.
    pub terms: Option<TermSelection>,
    /// True to show the *Explain* panel, false to hide it.
    pub explain: Option<bool>,
    /// True to show the markers of lights, false to hide them.
    pub markers: Option<bool>,
    /// The displayed plot; `Some(None)` hides plots.
    pub plots: Option<Option<Kind>>,
    /// The active view: 0 is the scene, 1 view B.
    pub active: Option<usize>,
    /// The selected part.
    pub select: Option<PartName>,
    /// The pinned pixel, as fractions of the picture from the left and the top; `Some(None)` unpins it.
    pub pin: Option<Option<[f32; 2]>>,
}

impl Lesson {
    /// Reads a lesson: a Markdown file, or a folder with `lesson.md` and the scenes that it names. The scenes may name
    /// the files `outside` its folder.
    ///
    /// # Errors
    /// Returns every problem, in the order of the file.
    pub fn read(path: &Path, registry: &Registry, outside: &Outside) -> Result<Self, Vec<Problem>> {
        read::file(path, registry, outside)
    }

    /// Reads a lesson from text. `name` becomes its [`id`](Self::id). Scenes are looked up in the folder,
    /// then among the shipped scenes.
    ///
    /// # Errors
    /// Returns every problem, in the order of the text.
    pub fn from_text(
        text: &str,
        name: &str,
        folder: Option<&Path>,
        registry: &Registry,
    ) -> Result<Self, Vec<Problem>> {
        read::text(text, name, Shelf { folder, outside: Outside::NONE, registry })
    }

    /// The scene on entering a step, if the learner changes nothing in the earlier steps.
    ///
    /// # Errors
    /// Returns an error if the step does not exist, or if its scene breaks a rule because the registry is not
    /// the one with which the lesson was read.
    pub fn state(&self, step: usize, registry: &Registry) -> Result<Scene, String> {
        let Some(until) = self.steps.get(..=step) else {
            return Err(format!("the lesson has {} steps; there is no step {}", self.steps.len(), step + 1));
        };
        let mut scene = (*self.start).clone();
        for change in until.iter().filter_map(|step| step.scene.as_ref()) {
            scene = change.apply(&scene, registry)?;
        }
        Ok(scene)
    }

    /// The lesson as plain text.
    #[must_use]
    pub fn to_text(&self) -> String {
        text::of(self)
    }
}

impl Task {
    /// The goal of a task with a condition.
    #[must_use]
    pub fn goal(&self) -> Option<&Goal> {
        match self {
            Self::Predict { .. } => None,
            Self::Do(goal) | Self::Find(goal) => Some(goal),
        }
    }
}

/// The text of runs, without styles.
#[must_use]
pub fn plain(runs: &[Run]) -> String {
    runs.iter().map(|run| run.text.as_str()).collect()
}

/// The word for a kind of selection in conditions.
fn kind_of(selection: Selection) -> &'static str {
    match selection {
        Selection::Room => "room",
        Selection::Observer => "observer",
        Selection::Light(_) => "light",
        Selection::Object(_) => "object",
    }
}

#[cfg(test)]
mod tests;
