//! Messages to the user, and what the picture says of itself.

use super::{Action, Session};
use crate::files::printable;

/// The most messages that are kept; the oldest give way.
pub const MAX_MESSAGES: usize = 500;

/// A message to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// How bad it is.
    pub severity: Severity,
    /// What happened, where, and what to do.
    pub text: String,
    /// A button beside it, and what it does.
    pub offer: Option<(&'static str, Box<Action>)>,
}

/// How bad a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// Good to know.
    Info,
    /// Something is not as asked, and the picture is still right.
    Warning,
    /// Something failed.
    Error,
}

impl Severity {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Info => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// What the picture says about itself in its corner, such as "stale shader".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Badge {
    /// How bad it is.
    pub severity: Severity,
    /// A few words.
    pub text: String,
    /// The whole story, for the tooltip.
    pub help: String,
}

impl Session {
    /// Adds a message; an error unfolds the strip that shows it.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.note(Note { severity, text: printable(&text.into()).into_owned(), offer: None });
    }

    pub(super) fn note(&mut self, message: Note) {
        let severity = message.severity;
        // The same words twice in a row say no more than once.
        if self.messages.last() != Some(&message) {
            if self.messages.len() >= MAX_MESSAGES {
                self.messages.remove(0);
            }
            self.messages.push(message);
        }
        if severity == Severity::Error {
            self.view.bottom_open = true;
            "messages".clone_into(&mut self.view.bottom_tab);
        }
    }

    /// How many steps are done, and the last one's name.
    pub(super) fn last_step(&self) -> (usize, Option<String>) {
        let done = self.document.done();
        let last = done.checked_sub(1).and_then(|last| self.document.steps().nth(last));
        (done, last.map(str::to_owned))
    }

    /// No message offers any more to undo the last step.
    pub(super) fn withdraw_undo(&mut self) {
        let undo = |note: &Note| note.offer.as_ref().is_some_and(|(_, action)| **action == Action::Undo);
        self.messages.iter_mut().filter(|note| undo(note)).for_each(|note| note.offer = None);
        self.undo_offered = None;
    }

    /// The worst severity among the messages.
    #[must_use]
    pub fn worst(&self) -> Option<Severity> {
        self.messages.iter().map(|m| m.severity).max()
    }
}
