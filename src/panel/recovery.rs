//! The question about work that an earlier window left unsaved.

use std::path::{self, PathBuf};

use super::{
    question::Words,
    state::{Answer, Effect, Session},
};
use crate::scene::Scene;

/// A recovery copy that the user may have back.
#[derive(Clone, Debug, PartialEq)]
pub struct Offer {
    /// The name of the document.
    pub title: String,
    /// The file of the document, if it had one.
    pub path: Option<PathBuf>,
    /// The file of the copy.
    pub file: PathBuf,
    /// Its age: "5 minutes ago".
    pub when: String,
    /// The scene, or what is wrong with it.
    pub scene: Result<Scene, String>,
}

/// The fate of a recovery copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// It is the document now.
    Recovered,
    /// Nobody wants it.
    Discarded,
    /// It stays for another time; there may be others.
    Next,
    /// All stay for another time.
    Later,
}

impl Offer {
    /// The question about it.
    pub(super) fn words(&self, session: &Session) -> Words {
        let Self { title, path: at, file, when, scene } = self;
        let mut text = format!("“{title}” had unsaved changes when its window closed unexpectedly {when}.");
        let mut details = Vec::new();
        if let Err(problem) = scene {
            text += " The recovery copy can't be read.";
            // Behind the name of the file come line and column.
            let at = problem.strip_prefix(&format!("{}:", file.display()));
            let problem = at.map_or_else(|| problem.clone(), |at| format!("line {at}"));
            details.push(("Problem".to_owned(), problem));
            details.push(("Copy".to_owned(), file.display().to_string()));
            let answers = vec![("Keep the copy", Answer::Cancel), ("Delete it", Answer::Discard)];
            return ("Keep the recovery copy?", text, details, answers);
        }
        let shown = session.path.as_ref().and_then(|shown| path::absolute(shown).ok());
        if shown.is_some() && shown != *at {
            text += &format!(" Recovering them closes “{}”.", session.title());
        }
        let place = at.as_ref().map_or_else(|| "never saved".to_owned(), |at| at.display().to_string());
        details.push(("File".to_owned(), place));
        let answers =
            vec![("Recover", Answer::Recover), ("Discard", Answer::Discard), ("Later", Answer::Cancel)];
        ("Recover unsaved changes?", text, details, answers)
    }
}

impl Session {
    /// Carries out the answer to the question about a copy.
    pub(super) fn answer_offer(&mut self, offer: Offer, answer: Answer) -> Vec<Effect> {
        match (answer, offer.scene) {
            (Answer::Recover, Ok(scene)) => {
                self.recovered(offer.path, scene);
                vec![Effect::DocumentChanged, Effect::Recovery(Choice::Recovered)]
            }
            (Answer::Discard, _) => vec![Effect::Recovery(Choice::Discarded)],
            (_, Ok(_)) => vec![Effect::Recovery(Choice::Later)],
            (_, Err(_)) => vec![Effect::Recovery(Choice::Next)],
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
        // Even if it were what the window shows anyway.
        for scene in [Scene { name: Some("Mine".to_owned()), ..Scene::default() }, Scene::default()] {
            let mut session = Session::default();
            assert!(!session.is_dirty());
            let effects = answered(&mut session, offer(Ok(scene.clone())), Answer::Recover);
            assert_eq!(effects, [Effect::DocumentChanged, Effect::Recovery(Choice::Recovered)]);
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
            (Ok(Scene::default()), Answer::Cancel, Choice::Later),
            (Ok(Scene::default()), Answer::Discard, Choice::Discarded),
            (Err("line 3".to_owned()), Answer::Cancel, Choice::Next),
            (Err("line 3".to_owned()), Answer::Discard, Choice::Discarded),
        ] {
            let mut session = Session::default();
            assert_eq!(answered(&mut session, offer(scene), answer), [Effect::Recovery(choice)]);
            assert!(!session.is_dirty() && session.path.is_none());
        }
    }

    #[test]
    fn the_question_names_the_scene_its_file_and_what_is_wrong() {
        let session = Session::default();
        let all = |offer: Offer| {
            let (title, text, details, answers) = offer.words(&session);
            let details: Vec<_> = details.into_iter().map(|(what, more)| format!("{what}: {more}")).collect();
            (format!("{title}\n{text}\n{}", details.join("\n")), answers)
        };
        let (text, answers) = all(offer(Ok(Scene::default())));
        for part in ["“Room”", "/scenes/room.json", "5 minutes ago"] {
            assert!(text.contains(part), "{text}");
        }
        // Enter loses nothing, and neither does Escape.
        assert_eq!(answers[0].1, Answer::Recover);
        let copy = "/data/recovery/1-2/scene.json";
        let (text, answers) = all(offer(Err(format!("{copy}:3:1: what is odd"))));
        assert!(
            text.contains("Problem: line 3:1: what is odd") && text.contains(&format!("Copy: {copy}")),
            "{text}"
        );
        assert_eq!(answers[0].1, Answer::Cancel);
        let (text, _) = all(Offer { path: None, ..offer(Ok(Scene::default())) });
        assert!(text.contains("never saved"), "{text}");
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
