//! Effects that need files: opening, saving, settings.

use std::path::PathBuf;

use super::{
    code,
    files::{Files, Opened, Saved},
    prelude::*,
    progress, reload, settings,
    state::{Effect, LessonSource, Pick, Question},
};
use crate::lesson::Lesson;

/// Carries out an effect that needs files. Returns the effects that follow, or the given effect unchanged if this
/// module does not handle it.
#[must_use]
pub fn run(session: &mut Session, registry: &Registry, effect: Effect, files: &mut dyn Files) -> Vec<Effect> {
    match effect {
        Effect::OpenFile(path) => return open(session, registry, path, files),
        Effect::SaveFile { path, overwrite } => {
            session.settle_comparison();
            return save(session, registry, path, overwrite, files);
        }
        Effect::CheckFile { discard } => return reload::check(session, registry, discard, files),
        Effect::ExpectFile { path, version } => files.expect(&path, Some(version)),
        Effect::SaveSettings => {
            let saved = settings::save_own(&session.settings);
            session.warn(saved);
        }
        Effect::OpenLesson(path) => {
            let read = Lesson::read(&path, registry, &session.outside);
            session.lesson_read(path, read, registry);
        }
        Effect::LookAtLesson => {
            if let Some(LessonSource::File(path)) = session.lesson.as_ref().map(|open| open.source.clone()) {
                let read = Lesson::read(&path, registry, &session.outside);
                session.lesson_edited(read, registry);
            }
        }
        Effect::OpenCode { path, line } => code::disk::open(session, path, line),
        Effect::RecoverCode { path, text } => code::disk::recover(session, path, text),
        Effect::SaveCode { path, overwrite } => code::disk::save(session, &path, overwrite),
        Effect::LookAtCode(path) => code::disk::look(session, &path),
        Effect::SaveProgress(name) => {
            let saved = progress::save_own(&session.progress, &name);
            session.warn(saved);
        }
        other => return vec![other],
    }
    session.requests()
}

fn open(session: &mut Session, registry: &Registry, path: PathBuf, files: &mut dyn Files) -> Vec<Effect> {
    match files.open(&path, registry, &session.outside) {
        Opened::Scene(scene) => return session.opened(path, *scene),
        Opened::Incomplete { scene, parts } => {
            session.questions.ask(Question::MissingParts { path, scene, parts });
        }
        Opened::Empty => session.questions.ask(Question::EmptyFile(path)),
        Opened::Failed(problems) => {
            // A second attempt may have other problems.
            session.healed(&path);
            // The latest message is on top: first the problem, then above it the consequence.
            for problem in problems.into_iter().rev() {
                session.say_about(&path, Severity::Error, problem);
            }
            let text = format!("{} was not opened; {} is still shown.", path.shown(), session.title());
            session.say_about(&path, Severity::Error, text);
        }
    }
    Vec::new()
}

/// Saves the document, or a copy of the scene of the open lesson.
fn save(
    session: &mut Session,
    registry: &Registry,
    path: PathBuf,
    overwrite: bool,
    files: &mut dyn Files,
) -> Vec<Effect> {
    let is_copy = session.lesson.is_some();
    let scene = session.document.named(registry);
    let saved = match is_copy {
        true => files.save_copy(&path, &scene, registry, overwrite),
        false => files.save(&path, &scene, registry, overwrite),
    };
    match saved {
        Saved::Done if is_copy => return session.copy_saved(&path),
        Saved::Done => return session.saved(path, registry),
        Saved::ChangedOnDisk if is_copy => session.questions.ask(Question::ReplaceScene(path)),
        Saved::ChangedOnDisk => session.questions.ask(Question::ChangedOnDisk(path)),
        // Asks for a file that can be written. A pending action stays pending.
        Saved::OtherFormat(why) => {
            session.say(Severity::Warning, why);
            return vec![Effect::Pick(Pick::Save)];
        }
        Saved::Failed(why) => {
            session.questions.not_saved();
            session.say(Severity::Error, why);
        }
    }
    Vec::new()
}
