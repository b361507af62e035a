//! The lesson that is open: its step, what the learner answered and did. Its scenes are shown in place of the user's own
//! document, which waits meanwhile; see [`Aside`].

use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
    sync::Arc,
};

use super::{Aside, Pin, Plots, Progress, aside::Shown};
use crate::{
    document::Selection,
    lesson::{Lesson, Problem, Step, shipped::LESSONS},
    scene::Scene,
};

/// Where a lesson comes from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum LessonSource {
    /// One of [`LESSONS`].
    Shipped(usize),
    /// A file, or a folder with one.
    File(PathBuf),
}

impl LessonSource {
    /// The name under which progress is kept.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Shipped(i) => LESSONS.get(*i).map_or_else(String::new, |lesson| lesson.id.clone()),
            Self::File(path) => {
                std::path::absolute(path).unwrap_or_else(|_| path.clone()).display().to_string()
            }
        }
    }

    /// The lesson whose progress is kept under a name.
    #[must_use]
    pub fn named(name: &str) -> Self {
        let shipped = LESSONS.iter().position(|lesson| lesson.id == name);
        shipped.map_or_else(|| Self::File(name.into()), Self::Shipped)
    }
}

/// A command about lessons.
#[derive(Clone, Debug, PartialEq)]
pub enum LessonCommand {
    /// Open a lesson where the learner left it.
    Open(LessonSource),
    /// Choose a file with a lesson.
    OpenDialog,
    /// Go on with the lesson that was open last, or begin the next one.
    Continue,
    /// Go to the next step; with a task that is not done, ask first. After the last step, finish.
    Next,
    /// Go to the step before, as it began.
    Previous,
    /// Begin the step again.
    Again,
    /// Go to a step, from 0.
    GoTo(usize),
    /// Leave the lesson: the user's own document comes back.
    Leave,
    /// Choose an answer.
    Answer(usize),
    /// Show the hint, or hide it.
    Hint,
    /// Pin a pixel for the task, without the panel that explains it.
    Point(Pin),
    /// The condition of the step's task holds.
    Solved(usize),
    /// Show the scene list below the lesson, or fold it.
    Tree(bool),
}

/// What was there when a step began.
#[derive(Clone, Debug)]
pub(super) struct Entered {
    pub(super) scene: Arc<Scene>,
    pub(super) selection: Selection,
    pub(super) shown: Shown,
    pub(super) plots: Plots,
}

/// A lesson that is open.
#[derive(Clone, Debug)]
pub struct OpenLesson {
    /// The lesson.
    pub lesson: Arc<Lesson>,
    /// Where it comes from.
    pub source: LessonSource,
    /// The step that is shown, from 0.
    pub step: usize,
    /// The answers that were chosen, by step; the last one counts.
    pub answers: BTreeMap<usize, Vec<usize>>,
    /// The steps whose tasks are done.
    pub done: BTreeSet<usize>,
    /// True if the hint is shown.
    pub hint: bool,
    /// True while the learner is asked whether to skip the task.
    pub asking: bool,
    /// The problems in its file, which was edited since: the last good version is shown.
    pub problems: Vec<Problem>,
    /// True if the scene list is unfolded below it.
    pub tree_open: bool,
    /// Counts the steps that were entered.
    pub(in crate::panel) entries: u64,
    pub(super) entered: BTreeMap<usize, Entered>,
    pub(super) aside: Box<Aside>,
}

impl OpenLesson {
    /// The step that is shown.
    #[must_use]
    pub fn now(&self) -> Option<&Step> {
        self.lesson.steps.get(self.step)
    }

    /// True if the step's task is done, or it has none.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.done.contains(&self.step) || self.now().is_none_or(|step| step.task.is_none())
    }

    /// True if there is no step after this one.
    #[must_use]
    pub fn is_last(&self) -> bool {
        self.step + 1 >= self.lesson.steps.len()
    }

    /// The number of tasks.
    #[must_use]
    pub fn tasks(&self) -> usize {
        self.lesson.steps.iter().filter(|step| step.task.is_some()).count()
    }

    /// The answer that was chosen last in this step.
    #[must_use]
    pub fn answer(&self) -> Option<usize> {
        self.answers.get(&self.step)?.last().copied()
    }
}

impl Progress {
    /// The lesson to go on with: the one that was open last, unless it is finished; else the first that is not.
    #[must_use]
    pub fn next(&self) -> Option<LessonSource> {
        let finished = |name: &str| self.of(name).is_some_and(|past| past.finished && past.step == 0);
        if let Some(last) = self.last.as_deref().filter(|last| !finished(last)) {
            return Some(LessonSource::named(last));
        }
        let open = LESSONS.iter().position(|lesson| !finished(&lesson.id));
        (!LESSONS.is_empty()).then(|| LessonSource::Shipped(open.unwrap_or(0)))
    }
}
