//! The lesson that is open: its step, what the learner answered and did. Its scenes are shown in place of the user's own
//! document, which waits meanwhile; see [`Aside`].

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
    /// The answers that were given in each step until the right one, that one included.
    pub tries: BTreeMap<usize, usize>,
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

    /// The number of questions that were answered rightly, and of those at the first try.
    #[must_use]
    pub fn first_tries(&self) -> [usize; 2] {
        let right = || self.tries.iter().filter(|(step, _)| self.done.contains(step));
        [right().count(), right().filter(|(_, tries)| **tries == 1).count()]
    }

    /// The answer that was chosen last in this step.
    #[must_use]
    pub fn answer(&self) -> Option<usize> {
        self.answers.get(&self.step)?.last().copied()
    }
}

/// A problem with the file that it is in.
pub(in crate::panel) fn problem_of(file: &Path, problem: &Problem) -> String {
    let space = if problem.place.is_some() { "" } else { " " };
    format!("{}:{space}{problem}", file.shown())
}
