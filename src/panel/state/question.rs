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
    /// There are unsaved changes, and this would lose them.
    Unsaved {
        /// The action that was asked for.
        then: Box<Action>,
    },
    /// A file lacks parts that have defaults.
    MissingParts {
        /// The file.
        path: PathBuf,
        /// The scene with the defaults in place.
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
    /// The file of the document changed on disk, and so did the document.
    NewerOnDisk {
        /// The file.
        path: PathBuf,
        /// The scene in it.
        scene: Box<Scene>,
        /// The state of the file.
        version: Stamp,
    },
    /// There is something where an export should go.
    ReplaceExport {
        /// The id of the form.
        form: &'static str,
        /// The file or folder.
        path: PathBuf,
    },
    /// There is a file where a copy of the scene of a lesson should go.
    ReplaceScene {
        /// The file.
        path: PathBuf,
    },
    /// There is a picture where another one should go.
    ReplacePicture {
        /// The view that is wanted alone.
        view: Option<usize>,
        /// The file.
        path: PathBuf,
    },
    /// An earlier window left unsaved changes.
    Recover(Box<Offer>),
}

/// A part that a scene file lacks, and its default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingPart {
    /// Its name for people: "the scene size".
    pub name: String,
    /// The default in words: "10 × 10 × 10 m".
    pub default: String,
}

/// The open question, and what depends on answers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Questions {
    /// The question that waits for an answer. While there is one, nothing else can be done.
    pub open: Option<Question>,
    /// The action that waits for the document to be saved first.
    pub(super) after_save: Option<Action>,
    /// True if the next file that is opened may replace unsaved changes: the user was asked.
    pub(super) may_discard: bool,
}

impl Questions {
    /// Asks a question.
    pub fn ask(&mut self, question: Question) {
        self.open = Some(question);
    }

    /// True while the user is asked about unsaved changes, or saves them, in order to close the window.
    #[must_use]
    pub fn is_quitting(&self) -> bool {
        let asked = matches!(&self.open, Some(Question::Unsaved { then }) if **then == Action::Quit);
        asked || self.after_save == Some(Action::Quit)
    }

    /// The document could not be written, or no file was chosen: the action that waited for it is dropped.
    pub fn not_saved(&mut self) {
        self.after_save = None;
    }

    /// True while an answer, or a dialog that followed from one, decides about unsaved changes.
    pub(super) fn are_pending(&self) -> bool {
        self.open.is_some() || self.after_save.is_some() || self.may_discard
    }

    /// The dialog that chooses a file to open was closed without a choice.
    pub fn not_opened(&mut self) {
        self.may_discard = false;
    }
}

impl Session {
    pub(super) fn unless_unsaved(
        &mut self,
        action: Action,
        go: impl FnOnce(&mut Self) -> Vec<Effect>,
    ) -> Vec<Effect> {
        if self.is_dirty() {
            // The question is about the user's own document, so that is what is shown.
            let effects = self.park_lesson();
            self.questions.open = Some(Question::Unsaved { then: Box::new(action) });
            return effects;
        }
        go(self)
    }

    /// An action whose loss of unsaved changes the user has accepted. The changes are not gone before
    /// it succeeds: a dialog can still be cancelled, a file can turn out to be broken.
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

    pub(super) fn answer(&mut self, answer: Answer, registry: &Registry) -> Vec<Effect> {
        let Some(question) = self.questions.open.take() else { return Vec::new() };
        match (question, answer) {
            (Question::Unsaved { then }, Answer::Discard) => self.confirmed(*then, registry),
            (Question::Unsaved { then }, Answer::Save) => {
                self.questions.after_save = Some(*then);
                self.apply(Action::Save, registry)
            }
            (Question::MissingParts { path, scene, parts }, Answer::UseDefaults) => {
                let effects = self.opened(path, *scene);
                // Until it is saved, the file differs from what is on screen.
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
                // The file on disk is known now: saving replaces it.
                self.document.set_saved(*scene);
                self.disk.recovered = false;
                self.disk_settled();
                vec![Effect::ExpectFile { path, version }]
            }
            (Question::NewerOnDisk { .. }, Answer::Reload) => vec![Effect::LookAtFile { discard: true }],
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
