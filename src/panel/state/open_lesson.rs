//! The open lesson: current step, answers and progress. The lesson's scenes replace the user's own document, which is
//! set aside; see [`Aside`].

use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
    sync::Arc,
};

use super::{Aside, Effect, LessonSource, Past, Plots, Progress, aside::DocumentView};
use crate::files::Shown as _;
use crate::{
    document::Selection,
    lesson::{Lesson, Problem, Step, Task},
    scene::Scene,
};

/// The state at the start of a step.
#[derive(Clone, Debug)]
pub(super) struct Entered {
    pub(super) scene: Arc<Scene>,
    pub(super) selection: Selection,
    pub(super) shown: DocumentView,
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

    /// Records the step and the progress.
    pub(super) fn note_step(&mut self, progress: &mut Progress) -> Vec<Effect> {
        (self.hint, self.asking) = (false, false);
        self.entries += 1;
        self.note(progress)
    }

    /// Records the progress within the step.
    pub(super) fn note(&mut self, progress: &mut Progress) -> Vec<Effect> {
        self.asking = false;
        let name = self.source.name();
        let past = progress.lessons.entry(name.clone()).or_default();
        *past = Past {
            title: self.lesson.title.clone(),
            step: self.step,
            steps: self.lesson.steps.len(),
            done: self.done.clone(),
            tries: self.tries.clone(),
            finished: past.finished,
        };
        progress.last = Some(name.clone());
        vec![Effect::SaveProgress(name)]
    }

    /// Chooses an answer to the question of the step.
    pub(super) fn choose(&mut self, answer: usize, progress: &mut Progress) -> Vec<Effect> {
        let step = self.step;
        let Some(Task::Predict { answers, .. }) = self.now().and_then(|step| step.task.as_ref()) else {
            return Vec::new();
        };
        let Some(right) = answers.get(answer).map(|chosen| chosen.right) else { return Vec::new() };
        self.asking = false;
        let all = self.answers.entry(step).or_default();
        if all.last() != Some(&answer) {
            all.push(answer);
            if !self.done.contains(&step) {
                *self.tries.entry(step).or_default() += 1;
            }
        }
        if right { self.solve(step, progress) } else { self.note(progress) }
    }

    /// Records that the task of a step is done.
    pub(super) fn solve(&mut self, step: usize, progress: &mut Progress) -> Vec<Effect> {
        if self.done.insert(step) { self.note(progress) } else { Vec::new() }
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
