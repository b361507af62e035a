//! Questions that must be answered, and the consequences of the answers.

use std::path::PathBuf;

use super::{Action, Answer, Effect, Offer, Session, Severity};
use crate::files::Shown as _;
use crate::{
    registry::Registry,
    scene::{Scene, load::Stamp},
    text::listed,
};

/// A question that must be answered.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// An action would lose unsaved changes.
    Unsaved {
        /// The requested action.
        then: Box<Action>,
    },
    /// A file is missing parts that have defaults.
    MissingParts {
        /// The file.
        path: PathBuf,
        /// The scene with defaults for the missing parts.
        scene: Box<Scene>,
        /// The missing parts.
        parts: Vec<MissingPart>,
    },
    /// The file is empty.
    EmptyFile {
        /// The file.
        path: PathBuf,
    },
    /// The file changed on disk since it was read.
    ChangedOnDisk {
        /// The file.
        path: PathBuf,
    },
    /// Both the document and its file on disk have changed.
    NewerOnDisk {
        /// The file.
        path: PathBuf,
        /// The scene in the file.
        scene: Box<Scene>,
        /// Version of the file.
        version: Stamp,
    },
    /// The destination of an export exists.
    ReplaceExport {
        /// Id of the format.
        form: &'static str,
        /// The file or folder.
        path: PathBuf,
    },
    /// The destination for a copy of a lesson's scene exists.
    ReplaceScene {
        /// The file.
        path: PathBuf,
    },
    /// The destination of a picture exists.
    ReplacePicture {
        /// The single view, if any.
        view: Option<usize>,
        /// The file.
        path: PathBuf,
    },
    /// An earlier window left unsaved changes.
    Recover(Box<Offer>),
}

/// A missing part of a scene file, and its default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingPart {
    /// Display name: "the scene size".
    pub name: String,
    /// The default in words: "10 × 10 × 10 m".
    pub default: String,
}

/// The open question, and the state that depends on answers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Questions {
    /// The question that waits for an answer. While there is one, it blocks everything else.
    pub open: Option<Question>,
    /// The action to perform after the document is saved.
    pub(super) after_save: Option<Action>,
    /// True if the next opened file may replace unsaved changes, which the user has confirmed.
    pub(super) may_discard: bool,
}

impl Questions {
    /// Asks a question.
    pub fn ask(&mut self, question: Question) {
        self.open = Some(question);
    }

    /// True if the user is asked about unsaved changes, or is saving them, because the window closes.
    #[must_use]
    pub fn is_quitting(&self) -> bool {
        let asked = matches!(&self.open, Some(Question::Unsaved { then }) if **then == Action::Quit);
        asked || self.after_save == Some(Action::Quit)
    }

    /// Drops the pending action, because the document was not saved.
    pub fn not_saved(&mut self) {
        self.after_save = None;
    }

    /// True while an answer, or the dialog that follows it, decides about unsaved changes.
    pub(super) fn are_pending(&self) -> bool {
        self.open.is_some() || self.after_save.is_some() || self.may_discard
    }

    /// Handles closing the open dialog without a choice.
    pub fn not_opened(&mut self) {
        self.may_discard = false;
    }
}

impl Session {
    /// Performs an action that replaces the document. If that has unsaved changes, asks the user first.
    pub(super) fn unless_unsaved(&mut self, action: Action, registry: &Registry) -> Vec<Effect> {
        let is_free = match &action {
            Action::Open(_) => std::mem::take(&mut self.questions.may_discard),
            Action::Reload => self.path.is_none(),
            _ => false,
        };
        if self.is_dirty() && !is_free {
            // The question is about the user's own document, so show that.
            let effects = self.park_lesson();
            self.questions.open = Some(Question::Unsaved { then: Box::new(action) });
            return effects;
        }
        match action {
            Action::OpenDialog => vec![Effect::PickOpen],
            action => self.confirmed(action, registry),
        }
    }

    /// Performs an action for which the user has accepted to lose unsaved changes. The changes are kept until it
    /// succeeds: a dialog can be cancelled, a file can be invalid.
    pub(super) fn confirmed(&mut self, action: Action, registry: &Registry) -> Vec<Effect> {
        match action {
            Action::New => self.start_new(),
            Action::Quit => vec![Effect::Quit],
            Action::Open(path) => vec![Effect::OpenFile(path)],
            Action::OpenExample(i) => self.open_example(i, registry),
            Action::Reload => self.path.clone().map(Effect::OpenFile).into_iter().collect(),
            Action::OpenDialog => {
                self.questions.may_discard = true;
                vec![Effect::PickOpen]
            }
            other => self.apply(other, registry),
        }
    }

    /// Handles the answer to the open question. A file that changed meanwhile is looked at afterwards.
    pub(super) fn answered(&mut self, answer: Answer, registry: &Registry) -> Vec<Effect> {
        let mut effects = self.answer(answer, registry);
        if self.questions.open.is_none() && std::mem::take(&mut self.disk.deferred) {
            effects.push(Effect::CheckFile { discard: false });
        }
        effects
    }

    fn answer(&mut self, answer: Answer, registry: &Registry) -> Vec<Effect> {
        let Some(question) = self.questions.open.take() else { return Vec::new() };
        match (question, answer) {
            (Question::Unsaved { then }, Answer::Discard) => self.confirmed(*then, registry),
            (Question::Unsaved { then }, Answer::Save) => {
                self.questions.after_save = Some(*then);
                self.apply(Action::Save, registry)
            }
            (Question::MissingParts { path, scene, parts }, Answer::UseDefaults) => {
                let effects = self.opened(path, *scene);
                // Until it is saved, the file differs from the document.
                self.disk.defaulted = parts.into_iter().map(|p| p.name).collect();
                effects
            }
            (Question::MissingParts { path, parts, .. }, _) => {
                let names: Vec<_> = parts.iter().map(|p| p.name.as_str()).collect();
                self.say(
                    Severity::Warning,
                    format!("{} was not opened: it lacks {}.", path.shown(), listed(&names, "and")),
                );
                Vec::new()
            }
            (Question::EmptyFile { .. }, Answer::UseDefaults) => self.start_new(),
            (Question::Recover(offer), answer) => self.answer_offer(*offer, answer),
            (Question::ChangedOnDisk { path } | Question::ReplaceScene { path }, Answer::Overwrite) => {
                vec![Effect::SaveFile { path, overwrite: true }]
            }
            (Question::ChangedOnDisk { path }, Answer::Reload) => {
                self.questions.not_saved();
                vec![Effect::OpenFile(path)]
            }
            (Question::NewerOnDisk { path, scene, version }, Answer::Keep) => {
                // The user has seen the version on disk: saving overwrites it.
                self.document.set_saved(*scene);
                self.disk.recovered = false;
                self.disk_settled();
                vec![Effect::ExpectFile { path, version }]
            }
            (Question::NewerOnDisk { .. }, Answer::Reload) => vec![Effect::CheckFile { discard: true }],
            (Question::ReplaceExport { form, path }, answer) => self.answer_export(form, path, answer),
            (Question::ReplacePicture { view, path }, answer) => Self::answer_picture(view, path, answer),
            (Question::NewerOnDisk { path, .. }, _) => {
                self.disk_undecided(&path);
                Vec::new()
            }
            _ => {
                self.questions.not_saved();
                Vec::new()
            }
        }
    }
}
