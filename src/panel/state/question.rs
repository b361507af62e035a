//! Questions that must be answered, and what becomes of the answers.

use std::path::PathBuf;

use super::{Action, Effect, Session, Severity};
use crate::{
    panel::recovery::Offer,
    registry::Registry,
    scene::{Scene, load::Stamp},
};

/// A question that must be answered.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// There are unsaved changes, and this would lose them.
    Unsaved {
        /// What was asked for.
        then: Box<Action>,
    },
    /// A file lacks parts that have defaults (R3).
    MissingParts {
        /// The file.
        path: PathBuf,
        /// The scene with the defaults in place.
        scene: Box<Scene>,
        /// Which parts are missing.
        parts: Vec<MissingPart>,
    },
    /// The file is empty (R2).
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
    /// An earlier window left unsaved changes.
    Recover(Box<Offer>),
}

/// A part that a scene file lacks, and its default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingPart {
    /// What people call it: "the scene size".
    pub name: String,
    /// The default in words: "10 × 10 × 10 m".
    pub default: String,
}

/// The answer to a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Save first, then do what was asked for.
    Save,
    /// Lose the changes and do what was asked for.
    Discard,
    /// Do nothing.
    Cancel,
    /// Use the defaults.
    UseDefaults,
    /// Replace what is on disk.
    Overwrite,
    /// Take what is on disk.
    Reload,
    /// Keep what is on screen; saving replaces what is on disk now.
    Keep,
    /// Go on with what an earlier window left.
    Recover,
}

impl Session {
    /// Asks a question.
    pub fn ask(&mut self, question: Question) {
        self.question = Some(question);
    }

    pub(super) fn unless_unsaved(
        &mut self,
        action: Action,
        go: impl FnOnce(&mut Self) -> Vec<Effect>,
    ) -> Vec<Effect> {
        if self.is_dirty() {
            self.question = Some(Question::Unsaved { then: Box::new(action) });
            return Vec::new();
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
                self.may_discard = true;
                vec![Effect::PickOpen]
            }
            other => self.apply(other, registry),
        }
    }

    pub(super) fn answer(&mut self, answer: Answer, registry: &Registry) -> Vec<Effect> {
        let Some(question) = self.question.take() else { return Vec::new() };
        match (question, answer) {
            (Question::Unsaved { then }, Answer::Discard) => self.confirmed(*then, registry),
            (Question::Unsaved { then }, Answer::Save) => {
                self.after_save = Some(*then);
                self.apply(Action::Save, registry)
            }
            (Question::MissingParts { path, scene, parts }, Answer::UseDefaults) => {
                let effects = self.opened(path, *scene);
                // Until it is saved, the file differs from what is on screen.
                self.defaulted = parts.into_iter().map(|p| p.name).collect();
                effects
            }
            (Question::MissingParts { path, parts, .. }, _) => {
                let names: Vec<_> = parts.iter().map(|p| p.name.as_str()).collect();
                self.say(
                    Severity::Warning,
                    format!("{} was not opened: it lacks {}.", path.display(), names.join(" and ")),
                );
                Vec::new()
            }
            (Question::EmptyFile { .. }, Answer::UseDefaults) => self.start_new(),
            (Question::Recover(offer), answer) => self.answer_offer(*offer, answer),
            (Question::ChangedOnDisk { path }, Answer::Overwrite) => {
                vec![Effect::SaveFile { path, overwrite: true }]
            }
            (Question::ChangedOnDisk { path }, Answer::Reload) => {
                self.not_saved();
                vec![Effect::OpenFile(path)]
            }
            (Question::NewerOnDisk { path, scene, version }, Answer::Keep) => {
                // What is on disk is known now: saving replaces it.
                self.document.set_saved(*scene);
                self.recovered = false;
                self.disk_settled();
                vec![Effect::ExpectFile { path, version }]
            }
            (Question::NewerOnDisk { .. }, Answer::Reload) => vec![Effect::LookAtFile { discard: true }],
            (Question::NewerOnDisk { path, .. }, _) => {
                self.disk_undecided(&path);
                Vec::new()
            }
            _ => {
                self.not_saved();
                Vec::new()
            }
        }
    }
}
