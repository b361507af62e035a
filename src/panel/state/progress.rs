//! The user's progress in the lessons, kept between sessions.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

/// Progress in all lessons.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Progress {
    /// The most recent lesson: id of a shipped one, or path of a file.
    pub last: Option<String>,
    /// Progress by lesson, under the same names.
    pub lessons: BTreeMap<String, Past>,
}

/// Progress in a lesson.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Past {
    /// Title of the lesson.
    pub title: String,
    /// The latest step, from 0.
    pub step: usize,
    /// Number of steps.
    pub steps: usize,
    /// Steps whose tasks are done.
    pub done: BTreeSet<usize>,
    /// Number of answers given in each step up to and including the correct one.
    pub tries: BTreeMap<usize, usize>,
    /// True if the lesson was finished once.
    pub finished: bool,
}

impl Past {
    /// True if the lesson can be continued: merely opening it at the first step does not count.
    #[must_use]
    pub fn is_begun(&self) -> bool {
        let touched = !self.done.is_empty() || !self.tries.is_empty();
        self.step > 0 || (touched && !self.finished)
    }

    /// The progress in a few words: "step 3 of 9", "finished".
    #[must_use]
    pub fn words(&self) -> String {
        match (self.finished, self.step) {
            (true, 0) => "finished".to_owned(),
            (_, step) => format!("step {} of {}", step + 1, self.steps.max(step + 1)),
        }
    }

    /// The fraction of steps seen, from 0 to 1.
    #[must_use]
    pub fn fraction(&self) -> f32 {
        match (self.finished, self.step) {
            (true, 0) => 1.0,
            (_, step) => (step as f32 / self.steps.max(1) as f32).min(1.0),
        }
    }
}

impl Progress {
    /// Progress in the given lesson.
    #[must_use]
    pub fn of(&self, name: &str) -> Option<&Past> {
        self.lessons.get(name)
    }
}
