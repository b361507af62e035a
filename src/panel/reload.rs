//! Reloading of the document's file when it changes on disk.
//!
//! The scene follows when another program edits the file. Changes made in the window are never replaced without a
//! question, and an invalid file replaces nothing.

use std::path::{Path, PathBuf};

use super::{
    files::{Files, OnDisk, Opened},
    prelude::*,
    state::{Effect, MissingPart, Question},
};
use crate::scene::load::Stamp;

/// Checks whether the document's file differs from the last seen version, and reacts. With `discard`, loads the version
/// on disk even at the cost of unsaved changes, which the user has agreed to.
///
/// An invalid file is checked again after a moment before it is reported: many editors write in steps.
#[must_use]
pub fn check(
    session: &mut Session,
    registry: &Registry,
    discard: bool,
    files: &mut dyn Files,
) -> Vec<Effect> {
    let Some(path) = session.path.clone() else { return Vec::new() };
    // What cannot happen beside an open question is made up for after the answer.
    session.disk.deferred |= session.questions.open.is_some();
    match files.check(&path, registry, &session.outside) {
        OnDisk::Same => {
            session.disk.suspect = None;
            // A note about the reload stays until it is dismissed.
            if session.disk.badge.is_some() {
                session.disk_settled();
            }
            Vec::new()
        }
        OnDisk::Gone => doubt(session, files, path, None, Vec::new()),
        OnDisk::Changed { version, content } => match found(session, &path, content) {
            Ok(found) => take(session, registry, files, path, version, found, discard),
            Err(problems) => doubt(session, files, path, Some(version), problems),
        },
    }
}

/// The scene in a file that has changed, with the names of the parts that get defaults; or the problems.
fn found(session: &Session, path: &Path, content: Opened) -> Result<(Scene, Vec<String>), Vec<String>> {
    let name = path.shown();
    match content {
        Opened::Scene(scene) => Ok((*scene, Vec::new())),
        Opened::Incomplete { scene, parts } if session.may_default(&parts) => {
            Ok((*scene, parts.into_iter().map(|p| p.name).collect()))
        }
        Opened::Incomplete { parts, .. } => {
            let lacks = |p: MissingPart| {
                format!("{name}: {} is missing (the default would be {})", p.name, p.default)
            };
            Err(parts.into_iter().map(lacks).collect())
        }
        Opened::Empty => Err(vec![format!("{name} is empty.")]),
        Opened::Failed(problems) => Err(problems),
    }
}

/// Handles another valid scene in the file, with defaults for the named parts.
fn take(
    session: &mut Session,
    registry: &Registry,
    files: &mut dyn Files,
    path: PathBuf,
    version: Stamp,
    (scene, defaulted): (Scene, Vec<String>),
    discard: bool,
) -> Vec<Effect> {
    let news = session.document.named(registry) != scene;
    // The file that a recovered document was based on is unknown.
    let edited = (session.disk.recovered || session.document.differs()) && news;
    let asks = edited && !discard && (session.disk.recovered || !session.document.was_saved_as(&scene));
    // One question at a time, and none whose document is replaced meanwhile: only that about a copy is not about it.
    let blocks = |open: &Question| asks || !matches!(open, Question::Recover(_));
    if session.questions.open.as_ref().is_some_and(blocks) {
        return Vec::new();
    }
    if asks {
        if session.disk.asked != Some(Some(version)) {
            session.disk_settled();
            session.disk.asked = Some(Some(version));
            session.questions.ask(Question::NewerOnDisk { path, scene: Box::new(scene), version });
        }
        return Vec::new();
    }
    files.expect(&path, Some(version));
    session.disk_settled();
    if edited && !discard {
        // Only the layout of the file has changed: the content is what the changes are based on.
        return Vec::new();
    }
    session.reloaded(scene, defaulted, registry);
    if news {
        session.say_of_disk(Severity::Info, format!("{} was reloaded: it changed on disk.", path.shown()));
    }
    Vec::new()
}

/// Reports that the file cannot be used, after a grace period.
fn doubt(
    session: &mut Session,
    files: &mut dyn Files,
    path: PathBuf,
    version: Option<Stamp>,
    problems: Vec<String>,
) -> Vec<Effect> {
    if session.disk.told == Some(version) {
        session.disk.suspect = None;
        return Vec::new();
    }
    if session.disk.suspect != Some(version) {
        session.disk.suspect = Some(version);
        return vec![Effect::LookAgain(path)];
    }
    session.disk_settled();
    session.disk.told = Some(version);
    session.disk.lost = true;
    let name = path.shown();
    if version.is_none() {
        // Saving creates the file if it is still missing.
        files.expect(&path, None);
        let text = format!(
            "{name} was deleted or moved; this window still has the scene. Saving writes the file again."
        );
        let what = "was deleted: only this window has the scene";
        session.set_disk_badge(Severity::Warning, &path, what, &text);
        session.say_of_disk(Severity::Warning, text);
        return Vec::new();
    }
    let what = "has errors: showing the last good version";
    session.set_disk_badge(Severity::Error, &path, what, &problems.join("\n"));
    let text =
        format!("{name} can no longer be read as a scene; the scene that is shown is kept, but now unsaved.");
    session.say_of_disk(Severity::Warning, text);
    // The latest message is on top: the first problem.
    for problem in problems.iter().rev() {
        session.say_of_disk(Severity::Error, problem.clone());
    }
    vec![Effect::Complain(problems.join("\n"))]
}

impl Session {
    /// Makes the scene in the file the document. Keeps camera, terms and, where it remains valid, the selection.
    fn reloaded(&mut self, scene: Scene, defaulted: Vec<String>, registry: &Registry) {
        let id = self.selected_id();
        if self.document.reflection_model != scene.reflection_model {
            self.model_slots.take(&scene.reflection_model);
        }
        let before = self.document.revision();
        self.document.replace("Reload from disk", self.selection, scene, registry);
        self.document.mark_saved(registry);
        let at = |known: Option<usize>, i: usize, count: usize| {
            known.or(count.checked_sub(1).map(|last| i.min(last)))
        };
        let (document, lights, objects) =
            (&self.document, self.document.lights.len(), self.document.objects.len());
        let selection = match self.selection {
            Selection::Light(i) => at(id.and_then(|id| document.light(id)), i, lights).map(Selection::Light),
            Selection::Object(i) => {
                at(id.and_then(|id| document.object(id)), i, objects).map(Selection::Object)
            }
            other => Some(other),
        };
        let selection = selection.unwrap_or(Selection::Room);
        if selection != self.selection {
            self.renaming = None;
        }
        self.selection = selection;
        if self.document.revision() != before {
            self.document.selected(selection);
        }
        self.disk.recovered = false;
        self.disk.defaulted = defaulted;
    }
}
