//! Effects that need files: opening, saving, settings.

use super::{
    files::{Files, Opened, Saved},
    progress, reload, settings,
    state::{Effect, LessonSource, Question, Session, Severity},
};
use crate::files::Shown as _;
use crate::{lesson::Lesson, registry::Registry};

/// Carries out an effect that needs files. Returns the effects that follow, or the given effect unchanged if this
/// module does not handle it.
#[must_use]
pub fn run(session: &mut Session, registry: &Registry, effect: Effect, files: &mut dyn Files) -> Vec<Effect> {
    match effect {
        Effect::OpenFile(path) => match files.open(&path, registry) {
            Opened::Scene(scene) => session.opened(path, *scene),
            Opened::Incomplete { scene, parts } => {
                session.questions.ask(Question::MissingParts { path, scene, parts });
                Vec::new()
            }
            Opened::Empty => {
                session.questions.ask(Question::EmptyFile { path });
                Vec::new()
            }
            Opened::Failed(problems) => {
                // A second attempt may have other problems.
                session.healed(&path);
                // The latest message is on top: first the problem, then above it the consequence.
                for problem in problems.into_iter().rev() {
                    session.say_about(&path, Severity::Error, problem);
                }
                session.say_about(
                    &path,
                    Severity::Error,
                    format!("{} was not opened; {} is still shown.", path.shown(), session.title()),
                );
                Vec::new()
            }
        },
        Effect::SaveFile { path, overwrite } if session.lesson.is_some() => {
            session.settle_comparison();
            match files.save_copy(&path, &session.document.named(registry), registry, overwrite) {
                Saved::Done => session.copy_saved(&path),
                Saved::ChangedOnDisk => {
                    session.questions.ask(Question::ReplaceScene { path });
                    Vec::new()
                }
                Saved::OtherFormat(why) => {
                    session.say(Severity::Warning, why);
                    vec![Effect::PickSave]
                }
                Saved::Failed(why) => {
                    session.say(Severity::Error, why);
                    Vec::new()
                }
            }
        }
        Effect::SaveFile { path, overwrite } => {
            session.settle_comparison();
            match files.save(&path, &session.document.named(registry), registry, overwrite) {
                Saved::Done => session.saved(path, registry),
                Saved::ChangedOnDisk => {
                    session.questions.ask(Question::ChangedOnDisk { path });
                    Vec::new()
                }
                Saved::OtherFormat(why) => {
                    // The pending action stays pending: the dialog offers a file that can be written.
                    session.say(Severity::Warning, why);
                    vec![Effect::PickSave]
                }
                Saved::Failed(why) => {
                    session.questions.not_saved();
                    session.say(Severity::Error, why);
                    Vec::new()
                }
            }
        }
        Effect::CheckFile { discard } => reload::check(session, registry, discard, files),
        Effect::ExpectFile { path, version } => {
            files.expect(&path, Some(version));
            Vec::new()
        }
        Effect::SaveSettings => {
            settings::save_settings(session);
            Vec::new()
        }
        Effect::OpenLesson(path) => {
            let read = Lesson::read(&path, registry);
            session.lesson_read(path, read, registry)
        }
        Effect::LookAtLesson => match session.lesson.as_ref().map(|open| open.source.clone()) {
            Some(LessonSource::File(path)) => {
                let read = Lesson::read(&path, registry);
                session.lesson_edited(read, registry)
            }
            _ => Vec::new(),
        },
        Effect::SaveProgress(name) => {
            progress::save_progress(session, &name);
            Vec::new()
        }
        other => vec![other],
    }
}
