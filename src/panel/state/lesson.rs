//! Lessons, and the commands about them.

use std::path::PathBuf;

use super::{Past, Pin, Progress};
use crate::lesson::shipped::LESSONS;

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

impl Progress {
    /// The lesson to go on with: the one that was open last, if it was begun and not finished; else the first that is not
    /// finished.
    #[must_use]
    pub fn next(&self) -> Option<LessonSource> {
        let begun = |name: &str| self.of(name).is_some_and(Past::is_begun);
        if let Some(last) = self.last.as_deref().filter(|last| begun(last)) {
            return Some(LessonSource::named(last));
        }
        let finished = |name: &str| self.of(name).is_some_and(|past| past.finished && !past.is_begun());
        let open = LESSONS.iter().position(|lesson| !finished(&lesson.id));
        (!LESSONS.is_empty()).then(|| LessonSource::Shipped(open.unwrap_or(0)))
    }
}
