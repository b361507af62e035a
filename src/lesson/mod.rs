//! Lessons: text with equations, scene states, and steps with a task that a condition checks. Markdown with a few fenced
//! blocks of our own; no window: the panel shows what this module reads, and asks it whether a task is done.
//!
//! ```
//! use lights_camera_models::{lesson::Lesson, registry::Registry};
//! let text = "---\ntitle: Light\nsummary: A sphere.\n---\n\n## Look\n\nA *matte* sphere.\n";
//! let lesson = Lesson::from_text(text, "light", None, &Registry::builtin()).unwrap();
//! assert_eq!(lesson.steps[0].title, "Look");
//! ```

use std::{path::Path, sync::Arc};

use crate::{
    channel::DebugChannel, curves::Kind, document::Selection, optics::TermSelection, registry::Registry,
    scene::Scene,
};

mod blocks;
mod check;
mod condition;
mod controls;
mod front;
pub mod limits;
mod markdown;
mod problem;
mod read;
pub mod shipped;
mod situation;
mod state;
mod text;
mod window;
mod words;

pub use condition::{Condition, QUANTITIES, Quantity};
pub use controls::{BUTTONS, Control, KNOBS, MENUS, PartName, TABS, Which};
pub use problem::Problem;
pub use situation::{Situation, WindowFacts};
pub use state::SceneChange;
pub use window::SETTINGS;

/// A lesson.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// The name of its file or folder, without `.md`: progress is kept by it.
    pub id: String,
    /// Its title.
    pub title: String,
    /// One sentence: its content.
    pub summary: String,
    /// The time that it takes, minutes.
    pub minutes: Option<u32>,
    /// The scene before the first step.
    pub start: Arc<Scene>,
    /// The steps, one at least.
    pub steps: Vec<Step>,
}

/// A step of a lesson.
#[derive(Clone, Debug, Default)]
pub struct Step {
    /// Its heading.
    pub title: String,
    /// Its text, in order.
    pub blocks: Vec<Block>,
    /// The change of the scene on entering it.
    pub scene: Option<SceneChange>,
    /// The change of the window on entering it.
    pub window: WindowChange,
    /// The controls that are highlighted while it is shown.
    pub points: Vec<Control>,
    /// The task of the learner; [`Block::Task`] is its place among the blocks.
    pub task: Option<Task>,
}

/// A piece of a step.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Block {
    /// A paragraph.
    Paragraph(Vec<Run>),
    /// An item of a list.
    Item {
        /// Its number, in numbered lists.
        number: Option<u64>,
        /// 0 for a list, 1 for a list within it.
        depth: usize,
        /// Its text.
        runs: Vec<Run>,
    },
    /// An equation, a line of it per line, in the notation of the models' equations.
    Equation(String),
    /// The task of the step.
    Task,
}

/// Text in one style.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// The text; a line break only where one is meant.
    pub text: String,
    /// Its style.
    pub style: RunStyle,
}

/// The style of a text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RunStyle {
    /// Plain.
    #[default]
    Plain,
    /// Emphasised.
    Emphasis,
    /// A key or the name of a menu.
    Strong,
    /// As it is typed.
    Code,
}

/// The task of a step.
#[derive(Clone, Debug)]
pub enum Task {
    /// Answers a question before the answer can be seen.
    Predict {
        /// The question.
        question: Vec<Run>,
        /// The answers, two at least, of which one at least is right and one wrong.
        answers: Vec<AnswerChoice>,
    },
    /// Changes something.
    Do(Goal),
    /// Finds something.
    Find(Goal),
}

/// A possible answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnswerChoice {
    /// The answer.
    pub text: Vec<Run>,
    /// True if it is right.
    pub right: bool,
    /// The comment for those who choose it.
    pub feedback: Vec<Run>,
}

/// Something to reach.
#[derive(Clone, Debug)]
pub struct Goal {
    /// The task in words.
    pub text: Vec<Run>,
    /// The task is done once this holds.
    pub until: Condition,
    /// Help for those who ask for it.
    pub hint: Option<Vec<Run>>,
}

/// The change of the window on entering a step. What is `None` stays as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WindowChange {
    /// The debug channel of the active view; `Some(None)` shows the picture.
    pub channel: Option<Option<DebugChannel>>,
    /// The terms of the equation that are shown.
    pub terms: Option<TermSelection>,
    /// True if the panel *Explain* is shown, false if it is not.
    pub explain: Option<bool>,
    /// The plot that is shown; `Some(None)` shows none.
    pub plots: Option<Option<Kind>>,
    /// The active view: 0 is the scene, 1 view B.
    pub active: Option<usize>,
    /// The selected part.
    pub select: Option<PartName>,
    /// The pinned pixel, as fractions of the picture from the left and from the top; `Some(None)` lets go of it.
    pub pin: Option<Option<[f32; 2]>>,
}

impl Lesson {
    /// Reads a lesson: a Markdown file, or a folder with `lesson.md` and the scenes that it names.
    ///
    /// # Errors
    /// Every problem, in the order of the file.
    pub fn read(path: &Path, registry: &Registry) -> Result<Self, Vec<Problem>> {
        read::file(path, registry)
    }

    /// Reads a lesson from text. `name` becomes its [`id`](Self::id); scenes that it names are looked for in the folder,
    /// then among those shipped.
    ///
    /// # Errors
    /// Every problem, in the order of the text.
    pub fn from_text(
        text: &str,
        name: &str,
        folder: Option<&Path>,
        registry: &Registry,
    ) -> Result<Self, Vec<Problem>> {
        read::text(text, name, folder, registry)
    }

    /// The scene on entering a step, as those before it leave it if the learner changes nothing.
    ///
    /// # Errors
    /// If there is no such step, or its scene breaks a rule: with another registry than the one it was read with.
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
    /// The goal, of tasks that a condition checks.
    #[must_use]
    pub fn goal(&self) -> Option<&Goal> {
        match self {
            Self::Predict { .. } => None,
            Self::Do(goal) | Self::Find(goal) => Some(goal),
        }
    }
}

/// The text of some runs, without their styles.
#[must_use]
pub fn plain(runs: &[Run]) -> String {
    runs.iter().map(|run| run.text.as_str()).collect()
}

/// The word for the kind of a selection, in conditions.
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
