//! Recovery of unsaved work from an earlier window.

use std::path::PathBuf;

use super::{Answer, Effect, RecoveryChoice, Session};
use crate::scene::Scene;

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

impl Session {
    /// Handles the answer to the question about a copy.
    pub(super) fn answer_offer(&mut self, offer: Offer, answer: Answer) -> Vec<Effect> {
        match (answer, offer.scene) {
            (Answer::Recover, Ok(scene)) => {
                self.recovered(offer.path, scene);
                vec![Effect::DocumentChanged, Effect::Recovery(RecoveryChoice::Recovered)]
            }
            (Answer::Discard, _) => vec![Effect::Recovery(RecoveryChoice::Discarded)],
            (_, Ok(_)) => vec![Effect::Recovery(RecoveryChoice::Later)],
            (_, Err(_)) => vec![Effect::Recovery(RecoveryChoice::Next)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        panel::state::{Action, Question},
        registry::Registry,
    };

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
