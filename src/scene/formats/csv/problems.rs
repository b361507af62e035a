//! The problems found before the values of a table are read: up to the maximum that is listed, and the number
//! of the rest.

use crate::scene::{
    problem::{MAX_PROBLEMS, Problem},
    read::MAX_SUGGESTIONS,
};

/// Problems, each with its byte index.
#[derive(Debug, Default)]
pub(super) struct Problems {
    list: Vec<(usize, Problem)>,
    unlisted: usize,
}

impl Problems {
    /// Adds a problem. The argument of `problem` is true if it should look for suggestions, which takes time.
    pub(super) fn add(&mut self, at: usize, problem: impl FnOnce(bool) -> Problem) {
        match self.list.len() {
            MAX_PROBLEMS.. => self.unlisted += 1,
            listed => self.list.push((at, problem(listed < MAX_SUGGESTIONS))),
        }
    }

    /// The listed problems, and the number of the rest.
    pub(super) fn into_parts(self) -> (Vec<(usize, Problem)>, usize) {
        (self.list, self.unlisted)
    }
}
