//! The open lesson: current step, answers and progress. The lesson's scenes replace the user's own document, which is
//! set aside; see [`Aside`].

use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
    sync::Arc,
};

use super::{Aside, LessonSource, Plots, aside::Shown};
use crate::files::Shown as _;
use crate::{
    document::Selection,
    lesson::{Lesson, Problem, Step},
    scene::Scene,
};

/// The state at the start of a step.
#[derive(Clone, Debug)]
pub(super) struct Entered {
    pub(super) scene: Arc<Scene>,
    pub(super) selection: Selection,
    pub(super) shown: Shown,
    pub(super) plots: Plots,
}

/// An open lesson.
#[derive(Clone, Debug)]
pub struct OpenLesson {
    /// The lesson.
    pub lesson: Arc<Lesson>,
    /// Origin of the lesson.
    pub source: LessonSource,
    /// The current step, from 0.
    pub step: usize,
    /// Answers given in each step; the last one counts.
    pub answers: BTreeMap<usize, Vec<usize>>,
    /// Steps whose tasks are done.
    pub done: BTreeSet<usize>,
    /// Number of answers given in each step up to and including the correct one.
    pub tries: BTreeMap<usize, usize>,
    /// True if the hint is shown.
    pub hint: bool,
    /// True while the learner is asked whether to skip the task.
    pub asking: bool,
    /// Problems in the edited file; the last good version is shown.
    pub problems: Vec<Problem>,
    /// True if the scene list below the lesson is unfolded.
    pub tree_open: bool,
    /// Number of steps entered so far.
    pub(in crate::panel) entries: u64,
    pub(super) entered: BTreeMap<usize, Entered>,
    pub(super) aside: Box<Aside>,
}

impl OpenLesson {
    /// The current step.
    #[must_use]
    pub fn now(&self) -> Option<&Step> {
        self.lesson.steps.get(self.step)
    }

    /// True if the task of the current step is done, or if the step has none.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.done.contains(&self.step) || self.now().is_none_or(|step| step.task.is_none())
    }

    /// True in the last step.
    #[must_use]
    pub fn is_last(&self) -> bool {
        self.step + 1 >= self.lesson.steps.len()
    }

    /// Number of tasks.
    #[must_use]
    pub fn tasks(&self) -> usize {
        self.lesson.steps.iter().filter(|step| step.task.is_some()).count()
    }

    /// Number of correctly answered questions, and how many of them at the first attempt.
    #[must_use]
    pub fn first_tries(&self) -> [usize; 2] {
        let right = || self.tries.iter().filter(|(step, _)| self.done.contains(step));
        [right().count(), right().filter(|(_, tries)| **tries == 1).count()]
    }

    /// The latest answer in this step.
    #[must_use]
    pub fn answer(&self) -> Option<usize> {
        self.answers.get(&self.step)?.last().copied()
    }
}

/// A problem, prefixed with its file.
pub(in crate::panel) fn problem_of(file: &Path, problem: &Problem) -> String {
    let space = if problem.place.is_some() { "" } else { " " };
    format!("{}:{space}{problem}", file.shown())
}
