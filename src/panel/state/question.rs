//! Questions that must be answered, and the consequences of the answers.

use std::path::PathBuf;

use super::{Action, Answer, Effect, Pick, RecoveryChoice, Session, Severity};
use crate::files::Shown as _;
use crate::{
    materials::Material,
    registry::Registry,
    scene::{Scene, load::Stamp},
    text::listed,
};

/// A question that must be answered.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// The requested action would lose unsaved changes.
    Unsaved(Box<Action>),
    /// The requested action would lose unsaved changes of texts in the editor.
    UnsavedTexts(Box<Action>),
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
    EmptyFile(PathBuf),
    /// The file changed on disk since it was read.
    ChangedOnDisk(PathBuf),
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
    /// This destination for a copy of a lesson's scene exists.
    ReplaceScene(PathBuf),
    /// The destination of a picture exists.
    ReplacePicture {
        /// The single view, if any.
        view: Option<usize>,
        /// The file.
        path: PathBuf,
    },
    /// There is a material of this name, in this file.
    ReplaceMaterial {
        /// The new material.
        material: Box<Material>,
        /// The file.
        path: PathBuf,
    },
    /// An earlier window left unsaved changes.
    Recover(Box<Offer>),
}

/// A recovery copy that is offered to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Offer {
    /// Name of the document.
    pub title: String,
    /// File of the document, if it had one.
    pub path: Option<PathBuf>,
    /// File of the copy.
    pub file: PathBuf,
    /// Age of the copy: "5 minutes ago".
    pub when: String,
    /// The scene, or the problem with it.
    pub scene: Result<Scene, String>,
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
        let asked = matches!(
            &self.open,
            Some(Question::Unsaved(then) | Question::UnsavedTexts(then)) if **then == Action::Quit
        );
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
    pub(super) fn unless_unsaved(&mut self, action: Action, registry: &Registry) {
        let is_free = match &action {
            Action::Open(_) => std::mem::take(&mut self.questions.may_discard),
            Action::Reload => self.path.is_none(),
            _ => false,
        };
        if !is_free && !self.names_at_risk(&action).is_empty() {
            self.questions.open = Some(Question::UnsavedTexts(Box::new(action)));
            return;
        }
        if self.is_dirty() && !is_free {
            // The question is about the user's own document, so show that.
            self.park_lesson();
            self.questions.open = Some(Question::Unsaved(Box::new(action)));
            return;
        }
        match action {
            Action::OpenDialog => self.request(Effect::Pick(Pick::Open)),
            action => self.confirmed(action, registry),
        }
    }

    /// Performs an action for which the user has accepted to lose unsaved changes. The changes are kept until it
    /// succeeds: a dialog can be cancelled, a file can be invalid.
    pub(super) fn confirmed(&mut self, action: Action, registry: &Registry) {
        match action {
            Action::New => self.start_with(Scene::default()),
            Action::Quit => self.request(Effect::Quit),
            Action::Open(path) => self.request(Effect::OpenFile(path)),
            Action::OpenExample(i) => self.open_example(i, registry),
            Action::Reload => self.requested.extend(self.path.clone().map(Effect::OpenFile)),
            Action::OpenDialog => {
                self.questions.may_discard = true;
                self.request(Effect::Pick(Pick::Open));
            }
            other => self.act(other, registry),
        }
    }

    /// Handles the answer to the open question. A file that changed meanwhile is looked at afterwards.
    pub(super) fn answered(&mut self, answer: Answer, registry: &Registry) {
        self.answer(answer, registry);
        if self.questions.open.is_none() && std::mem::take(&mut self.disk.deferred) {
            self.request(Effect::CheckFile { discard: false });
        }
    }

    fn answer(&mut self, answer: Answer, registry: &Registry) {
        let Some(question) = self.questions.open.take() else { return };
        match (question, answer) {
            (Question::UnsavedTexts(then), Answer::Keep) => self.show_at_risk(&then),
            (Question::UnsavedTexts(then), Answer::Discard) => {
                self.forget_at_risk(&then);
                self.unless_unsaved(*then, registry);
            }
            (Question::Unsaved(then), Answer::Discard) => self.confirmed(*then, registry),
            (Question::Unsaved(then), Answer::Save) => {
                self.questions.after_save = Some(*then);
                self.act(Action::Save, registry);
            }
            (Question::MissingParts { path, scene, parts }, Answer::UseDefaults) => {
                self.show_opened(path, *scene);
                // Until it is saved, the file differs from the document.
                self.disk.defaulted = parts.into_iter().map(|p| p.name).collect();
            }
            (Question::MissingParts { path, parts, .. }, _) => {
                let names: Vec<_> = parts.iter().map(|p| p.name.as_str()).collect();
                self.say(
                    Severity::Warning,
                    format!("{} was not opened: it lacks {}.", path.shown(), listed(&names, "and")),
                );
            }
            (Question::EmptyFile(_), Answer::UseDefaults) => self.start_with(Scene::default()),
            (Question::Recover(offer), answer) => self.answer_offer(*offer, answer),
            (Question::ChangedOnDisk(path) | Question::ReplaceScene(path), Answer::Overwrite) => {
                self.request(Effect::SaveFile { path, overwrite: true });
            }
            (Question::ChangedOnDisk(path), Answer::Reload) => {
                self.questions.not_saved();
                self.request(Effect::OpenFile(path));
            }
            (Question::NewerOnDisk { path, scene, version }, Answer::Keep) => {
                // The user has seen the version on disk: saving overwrites it.
                self.document.set_saved(*scene);
                self.disk.recovered = false;
                self.disk_settled();
                self.request(Effect::ExpectFile { path, version });
            }
            (Question::NewerOnDisk { .. }, Answer::Reload) => {
                self.request(Effect::CheckFile { discard: true });
            }
            (Question::ReplaceExport { form, path }, Answer::Overwrite) => {
                self.request(Effect::Export { form, path, overwrite: true });
            }
            (Question::ReplacePicture { view, path }, Answer::Overwrite) => {
                self.request(Effect::Picture { view, file: Some(path), overwrite: true });
            }
            (Question::ReplaceMaterial { material, .. }, Answer::Overwrite) => {
                self.request(Effect::SaveMaterial { material, overwrite: true });
            }
            // Asks for another name.
            (Question::ReplaceMaterial { material, .. }, _) => self.materials.draft = Some(material),
            (Question::ReplaceExport { .. } | Question::ReplacePicture { .. }, _) => {}
            (Question::NewerOnDisk { path, .. }, _) => self.disk_undecided(&path),
            _ => self.questions.not_saved(),
        }
    }

    /// Handles the answer to the question about a copy.
    pub(super) fn answer_offer(&mut self, offer: Offer, answer: Answer) {
        let choice = match (answer, offer.scene) {
            (Answer::Recover, Ok(scene)) => {
                self.recovered(offer.path, scene);
                self.request(Effect::DocumentChanged);
                RecoveryChoice::Recovered
            }
            (Answer::Discard, _) => RecoveryChoice::Discarded,
            (_, Ok(_)) => RecoveryChoice::Later,
            (_, Err(_)) => RecoveryChoice::Next,
        };
        self.request(Effect::Recovery(choice));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offer(scene: Result<Scene, String>) -> Offer {
        Offer {
            title: "Room".to_owned(),
            path: Some("/scenes/room.json".into()),
            file: "/data/recovery/1-2/scene.json".into(),
            when: "5 minutes ago".to_owned(),
            scene,
        }
    }

    fn answered(session: &mut Session, offer: Offer, answer: Answer) -> Vec<Effect> {
        session.questions.ask(Question::Recover(Box::new(offer)));
        let effects = session.apply(Action::Answer(answer), &Registry::builtin());
        assert_eq!(session.questions.open, None);
        effects
    }

    #[test]
    fn what_is_recovered_is_unsaved_and_belongs_to_its_file() {
        let registry = Registry::builtin();
        // Even if the window already shows the same scene.
        for scene in [Scene { name: Some("Mine".to_owned()), ..Scene::default() }, Scene::default()] {
            let mut session = Session::default();
            assert!(!session.is_dirty());
            let effects = answered(&mut session, offer(Ok(scene.clone())), Answer::Recover);
            assert_eq!(effects, [Effect::DocumentChanged, Effect::Recovery(RecoveryChoice::Recovered)]);
            assert!(session.is_dirty());
            assert_eq!(session.document, scene);
            let path = PathBuf::from("/scenes/room.json");
            let save = session.apply(Action::Save, &registry);
            assert_eq!(save, [Effect::SaveFile { path: path.clone(), overwrite: false }]);
            let _ = session.saved(path, &registry);
            assert!(!session.is_dirty());
        }
    }

    #[test]
    fn nothing_but_a_word_of_the_user_decides_about_a_copy() {
        for (scene, answer, choice) in [
            (Ok(Scene::default()), Answer::Cancel, RecoveryChoice::Later),
            (Ok(Scene::default()), Answer::Discard, RecoveryChoice::Discarded),
            (Err("line 3".to_owned()), Answer::Cancel, RecoveryChoice::Next),
            (Err("line 3".to_owned()), Answer::Discard, RecoveryChoice::Discarded),
        ] {
            let mut session = Session::default();
            assert_eq!(answered(&mut session, offer(scene), answer), [Effect::Recovery(choice)]);
            assert!(!session.is_dirty() && session.path.is_none());
        }
    }

    #[test]
    fn a_window_that_is_asked_to_close_knows_that_it_is() {
        let registry = Registry::builtin();
        let mut session = Session::default();
        answered(&mut session, offer(Ok(Scene::default())), Answer::Recover);
        assert!(!session.questions.is_quitting());
        assert_eq!(session.apply(Action::Quit, &registry), []);
        assert!(session.questions.is_quitting());
        session.apply(Action::Answer(Answer::Cancel), &registry);
        assert!(!session.questions.is_quitting());
        session.apply(Action::Quit, &registry);
        session.apply(Action::Answer(Answer::Save), &registry);
        assert!(session.questions.is_quitting(), "it closes once it is saved");
        session.questions.not_saved();
        assert!(!session.questions.is_quitting());
    }
}
