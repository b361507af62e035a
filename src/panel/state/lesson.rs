//! Lessons and their commands.

use std::path::PathBuf;

use super::{Past, Pin, Progress};
use crate::{lesson::shipped::LESSONS, platform::fs};

/// The origin of a lesson.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum LessonSource {
    /// One of the shipped [`LESSONS`].
    Shipped(usize),
    /// A file, or a folder that contains one.
    File(PathBuf),
}

impl LessonSource {
    /// The name under which progress is stored.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Shipped(i) => LESSONS.get(*i).map_or_else(String::new, |lesson| lesson.id.clone()),
            Self::File(path) => fs::absolute(path).unwrap_or_else(|_| path.clone()).display().to_string(),
        }
    }

    /// The lesson with the given name.
    #[must_use]
    pub fn named(name: &str) -> Self {
        let shipped = LESSONS.iter().position(|lesson| lesson.id == name);
        shipped.map_or_else(|| Self::File(name.into()), Self::Shipped)
    }
}

/// A command for lessons.
#[derive(Clone, Debug, PartialEq)]
pub enum LessonCommand {
    /// Open a lesson at the learner's last step.
    Open(LessonSource),
    /// Continue the most recent lesson, or start the next one.
    Continue,
    /// Go to the next step; if the task is not done, ask first. After the last step, finish.
    Next,
    /// Go to the previous step, as it was at its start.
    Previous,
    /// Restart the step.
    Again,
    /// Go to a step, from 0.
    GoTo(usize),
    /// Leave the lesson and return to the user's own document.
    Leave,
    /// Give an answer.
    Answer(usize),
    /// Show or hide the hint.
    Hint,
    /// Pin a pixel for the task, without opening the panel that explains it.
    Point(Pin),
    /// Complete the task of the step, whose condition holds.
    Solved(usize),
    /// Show or fold the scene list below the lesson.
    Tree(bool),
}

impl Progress {
    /// The lesson to continue: the most recent one if it is unfinished, otherwise the first unfinished one.
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
