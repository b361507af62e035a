//! Messages to the user, and badges of the picture.

use std::{
    ops::Deref,
    path::{Path, PathBuf},
};

use super::{Action, MESSAGES_TAB, SHADER_TAB, Session, Severity};
use crate::{files::printable, program::in_own_words};

/// The most messages that are kept; the oldest give way.
pub const MAX_MESSAGES: usize = 500;

/// A message to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// Its severity.
    pub severity: Severity,
    /// The event, its place, and the remedy.
    pub text: String,
    /// A button beside it, and its action.
    pub offer: Option<(&'static str, Box<Action>)>,
}

impl Note {
    /// A message without what names of files may hold that is not to be shown.
    #[must_use]
    pub fn new(severity: Severity, text: impl Into<String>) -> Self {
        Self { severity, text: in_own_words(&printable(&text.into())).into_owned(), offer: None }
    }

    /// The same with a button beside it.
    #[must_use]
    pub fn offering(self, label: &'static str, action: Action) -> Self {
        Self { offer: Some((label, Box::new(action))), ..self }
    }
}

/// A remark of the picture on itself in its corner, such as "Clipped: 5 % of the picture".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Badge {
    /// Its severity.
    pub severity: Severity,
    /// A few words.
    pub text: String,
    /// The whole story, for the tooltip.
    pub help: String,
}

/// The messages, oldest first; each stays until it is dismissed, or until [`MAX_MESSAGES`] newer ones are there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Messages {
    notes: Vec<Note>,
    /// The step that a message offers to undo: the number of steps done with it, and its name.
    undo: Option<Step>,
    /// The last step when the last message about this document was added.
    said_at: Option<Step>,
    /// The number of messages that were ever added.
    added: usize,
    /// The messages about a file, which go once it is as it should be.
    about: Vec<(PathBuf, Note)>,
    /// The strip as it was before an error unfolded it, and the errors that there were then.
    unfolded: Option<Unfolded>,
    /// The strip as it was before an error in a shader unfolded it: open or not, and its panel.
    shaders: Option<(bool, String)>,
}

/// The strip before it unfolded itself.
#[derive(Clone, Debug, PartialEq)]
struct Unfolded {
    open: bool,
    tab: String,
    errors: usize,
}

/// The number of steps that are done, and the name of the last one.
pub(super) type Step = (usize, Option<String>);

impl Deref for Messages {
    type Target = [Note];

    fn deref(&self) -> &[Note] {
        &self.notes
    }
}

impl Messages {
    /// Adds a message, unless the last one says the same.
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

    /// Adds a message that offers to undo the last step.
    pub(super) fn offer_undo(&mut self, text: String, step: Step) {
        self.withdraw_undo();
        self.said_at = Some(step.clone());
        self.undo = Some(step);
        self.add(Note::new(Severity::Info, text).offering("Undo", Action::Undo));
    }

    /// Offers no undo that would undo something else than the step which was done `last`.
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

    /// No message is about the document that is opened now.
    pub(super) fn another_document(&mut self) {
        self.said_at = None;
    }

    /// The number of messages that were ever added: it tells the same one, said again, from none.
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

    /// Removes all messages but those that `keep` is true for.
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
    /// Adds a message; an error unfolds the strip that shows it.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.note(Note::new(severity, text));
    }

    pub(in crate::panel) fn note(&mut self, note: Note) {
        if note.severity == Severity::Error {
            let seen = self.view.bottom_open && self.view.bottom_tab == MESSAGES_TAB;
            if !seen && self.messages.unfolded.is_none() {
                let (open, tab) = (self.view.bottom_open, self.view.bottom_tab.clone());
                self.messages.unfolded = Some(Unfolded { open, tab, errors: self.messages.errors() });
            }
            self.view.unfold(MESSAGES_TAB);
        }
        self.keep_news();
        self.messages.add(note);
    }

    /// Says something about a file, which goes once the file is [`healed`](Self::healed).
    pub fn say_about(&mut self, path: &Path, severity: Severity, text: impl Into<String>) {
        let note = Note::new(severity, text);
        self.messages.about.push((path.to_owned(), note.clone()));
        self.messages.about.drain(..self.messages.about.len().saturating_sub(MAX_MESSAGES));
        self.note(note);
    }

    /// A file is as it should be: what was said of it is over.
    pub fn healed(&mut self, path: &Path) {
        let about = std::mem::take(&mut self.messages.about);
        let (gone, stay): (Vec<_>, Vec<_>) = about.into_iter().partition(|(known, _)| known == path);
        self.messages.about = stay;
        if !gone.is_empty() {
            self.messages.retain(|note| gone.iter().all(|(_, known)| known != note));
            self.fold_healed();
        }
    }

    /// The strip folds itself if an error unfolded it and no such error is left.
    pub(super) fn fold_healed(&mut self) {
        let Some(before) = &self.messages.unfolded else { return };
        let seen = self.view.bottom_open && self.view.bottom_tab == MESSAGES_TAB;
        if seen && self.messages.errors() <= before.errors {
            (self.view.bottom_open, self.view.bottom_tab) = (before.open, before.tab.clone());
            self.messages.unfolded = None;
        }
    }

    /// An error in a shader unfolds the strip that tells of it.
    pub(in crate::panel) fn unfold_shaders(&mut self) {
        let seen = self.view.bottom_open && self.view.bottom_tab == SHADER_TAB;
        if !seen && self.messages.shaders.is_none() {
            self.messages.shaders = Some((self.view.bottom_open, self.view.bottom_tab.clone()));
        }
        self.view.unfold(SHADER_TAB);
    }

    /// No error is left in the shaders: the strip folds itself if one unfolded it.
    pub(in crate::panel) fn fold_shaders(&mut self) {
        let Some((open, tab)) = self.messages.shaders.take() else { return };
        if self.view.bottom_open && self.view.bottom_tab == SHADER_TAB {
            (self.view.bottom_open, self.view.bottom_tab) = (open, tab);
        } else if let Some(before) = self.messages.unfolded.as_mut().filter(|b| b.tab == SHADER_TAB) {
            // The messages unfolded over it.
            (before.open, before.tab) = (open, tab);
        }
        // Those that the shaders unfolded over may have healed meanwhile.
        self.fold_healed();
    }

    /// The user did something with the strip: it stays as it is.
    pub(super) fn keep_strip(&mut self) {
        (self.messages.unfolded, self.messages.shaders) = (None, None);
    }

    /// True if nothing was changed since the last message was added.
    #[must_use]
    pub fn has_news(&self) -> bool {
        self.messages.said_at.as_ref() == Some(&self.last_step())
    }

    /// The last message stays news after a change that followed by itself.
    pub(in crate::panel) fn keep_news(&mut self) {
        self.messages.said_at = Some(self.last_step());
    }
}
