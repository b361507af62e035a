//! What the user has done of the lessons. It survives a restart.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

/// What was done of all lessons.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Progress {
    /// The lesson that was open last: the id of one that comes with the program, or the path of a file.
    pub last: Option<String>,
    /// By the same names.
    pub lessons: BTreeMap<String, Past>,
}

/// What was done of a lesson.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Past {
    /// Its title.
    pub title: String,
    /// The step that was shown last, from 0.
    pub step: usize,
    /// The number of steps.
    pub steps: usize,
    /// The steps whose tasks are done.
    pub done: BTreeSet<usize>,
    /// The answers that were given in each step until the right one, that one included.
    pub tries: BTreeMap<usize, usize>,
    /// True if it was finished once.
    pub finished: bool,
}

impl Past {
    /// True if there is something to go on with: to open a lesson and look at its first step is no beginning.
    #[must_use]
    pub fn is_begun(&self) -> bool {
        let touched = !self.done.is_empty() || !self.tries.is_empty();
        self.step > 0 || (touched && !self.finished)
    }

    /// In a few words: "step 3 of 9", "finished".
    #[must_use]
    pub fn words(&self) -> String {
        match (self.finished, self.step) {
            (true, 0) => "finished".to_owned(),
            (_, step) => format!("step {} of {}", step + 1, self.steps.max(step + 1)),
        }
    }

    /// The part that was seen, from 0 to 1.
    #[must_use]
    pub fn fraction(&self) -> f32 {
        match (self.finished, self.step) {
            (true, 0) => 1.0,
            (_, step) => (step as f32 / self.steps.max(1) as f32).min(1.0),
        }
    }
}

impl Progress {
    /// What was done of a lesson.
    #[must_use]
    pub fn of(&self, name: &str) -> Option<&Past> {
        self.lessons.get(name)
    }
}
