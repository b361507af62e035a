//! Messages to the user, and badges in the picture.

use std::path::{Path, PathBuf};

use bevy::prelude::Deref;

use super::{Action, CODE_TAB, MESSAGES_TAB, SHADER_TAB, Session, Severity};
use crate::{files::printable, program::in_own_words};

/// Maximum number of messages; the oldest are dropped.
pub const MAX_MESSAGES: usize = 500;

/// A message to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// Severity of the message.
    pub severity: Severity,
    /// The event, its place, and the remedy.
    pub text: String,
    /// A button beside the message, and its action.
    pub offer: Option<(&'static str, Box<Action>)>,
}

impl Note {
    /// A message with unprintable characters, as file names may contain, removed.
    #[must_use]
    pub fn new(severity: Severity, text: impl Into<String>) -> Self {
        Self { severity, text: in_own_words(&printable(&text.into())).into_owned(), offer: None }
    }

    /// Adds a button to the message.
    #[must_use]
    pub fn offering(self, label: &'static str, action: Action) -> Self {
        Self { offer: Some((label, Box::new(action))), ..self }
    }
}

/// A note in the corner of the picture, such as "Clipped: 5 % of the picture".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Badge {
    /// Severity of the badge.
    pub severity: Severity,
    /// A few words.
    pub text: String,
    /// Fewer words, and fewer again, for one line where there is little room.
    pub shorter: Vec<String>,
    /// The full explanation, for the tooltip.
    pub help: String,
}

/// The messages, oldest first; each stays until it is dismissed, or pushed out by [`MAX_MESSAGES`] newer ones.
#[derive(Clone, Debug, Default, PartialEq, Deref)]
pub struct Messages {
    #[deref]
    notes: Vec<Note>,
    /// The step that a message offers to undo.
    undo: Option<Step>,
    /// The latest step at the time of the last message about this document.
    said_at: Option<Step>,
    /// Total number of messages added.
    added: usize,
    /// Messages about files, which are removed once the file is fine.
    about: Vec<(PathBuf, Note)>,
    /// The bottom strip before an error unfolded it, and the number of errors at that time.
    unfolded: Option<(Strip, usize)>,
    /// The bottom strip before a shader error unfolded it.
    shaders: Option<Strip>,
}

/// State of the bottom strip: open or not, and the panel.
type Strip = (bool, String);

/// The number of applied steps, and the name of the latest one.
pub(super) type Step = (usize, Option<String>);

impl Messages {
    /// Adds a message, unless it equals the latest one.
    pub fn add(&mut self, note: Note) {
        self.added += 1;
        if self.last() == Some(&note) {
            return;
        }
        if self.len() >= MAX_MESSAGES {
            self.notes.remove(0);
        }
        self.notes.push(note);
    }

    /// Adds a message that offers to undo the latest step.
    pub(super) fn offer_undo(&mut self, text: String, step: Step) {
        self.withdraw_undo();
        self.said_at = Some(step.clone());
        self.undo = Some(step);
        self.add(Note::new(Severity::Info, text).offering("Undo", Action::Undo));
    }

    /// Withdraws an offer to undo that would undo another step: `last` is the latest one.
    pub(super) fn check_undo(&mut self, last: &Step) {
        if self.undo.as_ref().is_some_and(|step| step != last) {
            self.withdraw_undo();
        }
    }

    fn withdraw_undo(&mut self) {
        let undo = |note: &Note| note.offer.as_ref().is_some_and(|(_, action)| **action == Action::Undo);
        self.notes.iter_mut().filter(|note| undo(note)).for_each(|note| note.offer = None);
        self.undo = None;
    }

    /// Detaches the messages from the document, which has been replaced.
    pub(super) fn another_document(&mut self) {
        self.said_at = None;
    }

    /// Total number of messages added, which also counts a repeated message.
    #[must_use]
    pub fn added(&self) -> usize {
        self.added
    }

    /// Removes a message.
    pub fn dismiss(&mut self, index: usize) {
        if index < self.len() {
            self.notes.remove(index);
        }
    }

    /// Keeps only the messages for which `keep` returns true.
    pub fn retain(&mut self, keep: impl FnMut(&Note) -> bool) {
        self.notes.retain(keep);
    }

    fn errors(&self) -> usize {
        self.iter().filter(|note| note.severity == Severity::Error).count()
    }

    /// Removes all messages.
    pub fn clear(&mut self) {
        self.notes.clear();
    }

    /// The worst severity among the messages.
    #[must_use]
    pub fn worst(&self) -> Option<Severity> {
        self.iter().map(|note| note.severity).max()
    }
}

impl Session {
    /// Adds a message; an error unfolds the strip that shows messages.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.note(Note::new(severity, text));
    }

    /// Reports a failure, if it is one.
    pub fn warn(&mut self, outcome: Result<(), String>) {
        if let Err(why) = outcome {
            self.say(Severity::Warning, why);
        }
    }

    pub(in crate::panel) fn note(&mut self, note: Note) {
        if note.severity == Severity::Error {
            if !self.sees(MESSAGES_TAB) && self.messages.unfolded.is_none() {
                self.messages.unfolded = Some((self.strip(), self.messages.errors()));
            }
            self.view.unfold(MESSAGES_TAB);
        }
        self.keep_news();
        self.messages.add(note);
    }

    /// Adds a message about a file, which is removed once the file is [`healed`](Self::healed).
    pub fn say_about(&mut self, path: &Path, severity: Severity, text: impl Into<String>) {
        let note = Note::new(severity, text);
        self.messages.about.push((path.to_owned(), note.clone()));
        self.messages.about.drain(..self.messages.about.len().saturating_sub(MAX_MESSAGES));
        self.note(note);
    }

    /// Removes the messages about a file that is fine again.
    pub fn healed(&mut self, path: &Path) {
        let about = std::mem::take(&mut self.messages.about);
        let (gone, stay): (Vec<_>, Vec<_>) = about.into_iter().partition(|(known, _)| known == path);
        self.messages.about = stay;
        if !gone.is_empty() {
            self.messages.retain(|note| gone.iter().all(|(_, known)| known != note));
            self.fold_healed();
        }
    }

    /// Folds the strip if an error unfolded it and no such error remains.
    pub(super) fn fold_healed(&mut self) {
        let errors = self.messages.errors();
        if self.sees(MESSAGES_TAB)
            && let Some((before, _)) = self.messages.unfolded.take_if(|(_, before)| errors <= *before)
        {
            (self.view.bottom_open, self.view.bottom_tab) = before;
        }
    }

    /// True if a panel is in sight at the bottom.
    pub(super) fn sees(&self, tab: &str) -> bool {
        self.view.bottom_open && self.view.bottom_tab == tab
    }

    fn strip(&self) -> Strip {
        (self.view.bottom_open, self.view.bottom_tab.clone())
    }

    /// Unfolds the strip with the shader panel because of an error.
    ///
    /// Not over the editor, which marks the error at its line.
    pub(in crate::panel) fn unfold_shaders(&mut self) {
        if self.sees(CODE_TAB) {
            return;
        }
        if !self.sees(SHADER_TAB) && self.messages.shaders.is_none() {
            self.messages.shaders = Some(self.strip());
        }
        self.view.unfold(SHADER_TAB);
    }

    /// Folds the strip once no shader errors remain, if one of them unfolded it.
    pub(in crate::panel) fn fold_shaders(&mut self) {
        let Some(strip) = self.messages.shaders.take() else { return };
        if self.sees(SHADER_TAB) {
            (self.view.bottom_open, self.view.bottom_tab) = strip;
        } else if let Some((before, _)) = self.messages.unfolded.as_mut().filter(|(b, _)| b.1 == SHADER_TAB) {
            // Messages were unfolded over the shaders.
            *before = strip;
        }
        // The errors below the shaders may have been fixed meanwhile.
        self.fold_healed();
    }

    /// Keeps the strip as it is, since the user has operated it.
    pub(super) fn keep_strip(&mut self) {
        (self.messages.unfolded, self.messages.shaders) = (None, None);
    }

    /// True if nothing has changed since the latest message.
    #[must_use]
    pub fn has_news(&self) -> bool {
        self.messages.said_at.as_ref() == Some(&self.last_step())
    }

    /// Keeps the latest message current after an automatic change.
    pub(in crate::panel) fn keep_news(&mut self) {
        self.messages.said_at = Some(self.last_step());
    }
}
