//! Scenes, lessons and reflection models that can be opened or chosen, as commands: for the finder, and for own keys.

use super::{Group, List, Mark, Menu, command};
use crate::{
    lesson::shipped::LESSONS,
    panel::state::{Action, LessonCommand, LessonSource},
    scene::examples::EXAMPLES,
};

/// The beginnings of their ids.
pub(super) const KINDS: [&str; 3] = ["example.", "lesson.", "model."];

pub(super) fn library(to: &mut List) {
    to.menu(Menu::new("Example scene").group(Group::File), |to| {
        for (i, example) in EXAMPLES.iter().enumerate() {
            let stem = example.file.split('.').next().unwrap_or(example.file);
            let open = command(format!("example.{stem}"), &*example.name, Action::OpenExample(i));
            to.add(open.tip(&*example.description));
        }
    });
    to.menu(Menu::new("Lesson").group(Group::Lessons), |to| {
        for (i, lesson) in LESSONS.iter().enumerate() {
            let action = Action::Lesson(LessonCommand::Open(LessonSource::Shipped(i)));
            let open =
                command(format!("lesson.{}", lesson.id), format!("{}. {}", i + 1, lesson.title), action);
            to.add(open.tip(&*lesson.summary));
        }
    });
    let (session, registry) = (to.session, to.registry);
    to.menu(Menu::new("Reflection model").group(Group::Reflection), |to| {
        for d in registry.models().iter().map(|model| model.declaration) {
            let choose = command(format!("model.{}", d.id), d.name, Action::ChooseModel(d.id.to_owned()));
            to.add(choose.mark(Mark::Radio(session.model_shown() == d.id)).tip(d.summary));
        }
    });
}
