//! The document's file changed on disk: what becomes of the document.
//!
//! Whoever edits the file elsewhere sees the scene follow. What was changed in the window is never
//! replaced without a question, and a file that cannot be used replaces nothing.

use std::path::{Path, PathBuf};

use super::{
    files::{Files, Looked, Opened},
    state::{Badge, Effect, MissingPart, Note, Question, Session, Severity},
};
use crate::document::Selection;
use crate::{
    files::printable,
    registry::Registry,
    scene::{Scene, load::Stamp},
};

/// A state of a file on disk: its content, or that there is no file.
type Version = Option<Stamp>;

/// Facts about the document's file on disk beyond the document itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OnDisk {
    /// The remark of the picture on it.
    pub badge: Option<Badge>,
    /// The document may take the defaults of any part that its file lacks.
    pub use_defaults: bool,
    /// True if the document came from a recovery copy: no file is known to have it.
    pub(super) recovered: bool,
    /// The names of the parts that the file lacks and that the document got as defaults.
    pub(super) defaulted: Vec<String>,
    /// True if the file was deleted, so that only the window has the document.
    gone: bool,
    /// News came while a question was open.
    pub(super) deferred: bool,
    /// A version that cannot be used, but that may be in the middle of being written.
    suspect: Option<Version>,
    /// The version that cannot be used of which the user was told.
    told: Option<Version>,
    /// The version about which the user was asked.
    asked: Option<Version>,
    /// The messages about the file, which give way to newer ones.
    notes: Vec<Note>,
}

impl OnDisk {
    /// True if no file has what the document began with.
    pub(super) fn lacks_document(&self) -> bool {
        self.recovered || !self.defaulted.is_empty() || self.gone
    }
}

/// Looks whether the document's file is another one than was last seen, and does what follows.
/// `discard` takes what is on disk even if it costs unsaved changes: the user was asked.
///
/// A file that cannot be used is looked at again after a moment before anything is said: many editors
/// write in steps.
#[must_use]
pub fn look(session: &mut Session, registry: &Registry, discard: bool, files: &mut dyn Files) -> Vec<Effect> {
    let Some(path) = session.path.clone() else { return Vec::new() };
    if session.questions.open.is_some() {
        // One question after the other.
        session.disk.deferred = true;
        return Vec::new();
    }
    let name = path.display();
    match files.look(&path, registry) {
        Looked::Same => {
            session.disk.suspect = None;
            // A message that it was reloaded stays until it is dismissed.
            if session.disk.badge.is_some() {
                session.disk_settled();
            }
            Vec::new()
        }
        Looked::Gone => doubt(session, files, path, None, Vec::new()),
        Looked::Changed { version, content } => match content {
            Opened::Scene(scene) => take(session, files, path, version, (*scene, Vec::new()), discard),
            Opened::Incomplete { scene, parts } if session.may_default(&parts) => {
                let names = parts.into_iter().map(|p| p.name).collect();
                take(session, files, path, version, (*scene, names), discard)
            }
            Opened::Incomplete { parts, .. } => {
                let lacks = |p: MissingPart| {
                    format!("{name}: {} is missing (the default would be {})", p.name, p.default)
                };
                let problems = parts.into_iter().map(lacks).collect();
                doubt(session, files, path, Some(version), problems)
            }
            Opened::Empty => {
                let problems = vec![format!("{name} is empty.")];
                doubt(session, files, path, Some(version), problems)
            }
            Opened::Failed(problems) => doubt(session, files, path, Some(version), problems),
        },
    }
}

/// There is another legal scene in the file, with defaults for the parts that are named.
fn take(
    session: &mut Session,
    files: &mut dyn Files,
    path: PathBuf,
    version: Stamp,
    (scene, defaulted): (Scene, Vec<String>),
    discard: bool,
) -> Vec<Effect> {
    // What a recovered document began with is not known.
    let edited = (session.disk.recovered || session.document.differs()) && session.document != scene;
    if edited && !discard && (session.disk.recovered || scene != *session.document.saved()) {
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
        // Only the layout of the file is another: what is in it is what the changes began with.
        return Vec::new();
    }
    let news = session.document != scene;
    session.reloaded(scene, defaulted);
    if news {
        session.say_of_disk(Severity::Info, format!("{} was reloaded: it changed on disk.", path.display()));
    }
    Vec::new()
}

/// The file cannot be used: after a moment of grace, says so.
fn doubt(
    session: &mut Session,
    files: &mut dyn Files,
    path: PathBuf,
    version: Version,
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
    if version.is_none() {
        // Saving writes the file anew, if there is still none.
        files.expect(&path, None);
        session.disk.gone = true;
        let text =
            format!("{} is no longer there; what is shown is kept. Saving writes it anew.", path.display());
        session.disk.badge = badge(
            Severity::Warning,
            &format!("{} was deleted: only this window has the scene", file_name(&path)),
            &text,
        );
        session.say_of_disk(Severity::Warning, text);
        return Vec::new();
    }
    session.disk.badge = badge(
        Severity::Error,
        &format!("{} has errors: showing the last good version", file_name(&path)),
        &problems.join("\n"),
    );
    // The latest stands on top: the first problem.
    for problem in problems.iter().rev() {
        session.say_of_disk(Severity::Error, problem.clone());
    }
    vec![Effect::Complain(problems.join("\n"))]
}

/// A badge without what names of files may hold that is not to be shown.
fn badge(severity: Severity, text: &str, help: &str) -> Option<Badge> {
    Some(Badge { severity, text: printable(text).into_owned(), help: printable(help).into_owned() })
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

impl Session {
    /// The document's file is as it should be, or is the user's concern: what was said of it is over.
    pub(super) fn disk_settled(&mut self) {
        let notes = std::mem::take(&mut self.disk.notes);
        self.messages.retain(|m| !notes.contains(m));
        let known = std::mem::take(&mut self.disk);
        self.disk = OnDisk {
            use_defaults: known.use_defaults,
            recovered: known.recovered,
            defaulted: known.defaulted,
            deferred: known.deferred,
            ..OnDisk::default()
        };
    }

    /// The document is as its file has it, or is another one.
    pub(super) fn disk_saved(&mut self) {
        self.disk_settled();
        self.disk.recovered = false;
        self.disk.defaulted.clear();
    }

    /// The user leaves it open whether the file on disk or the document counts.
    pub(super) fn disk_undecided(&mut self, path: &Path) {
        self.disk.badge = badge(
            Severity::Warning,
            &format!("{} changed on disk: showing yours", file_name(path)),
            &format!(
                "{} was changed by another program, and there are changes here that are not saved. Saving asks which \
                 of both to keep.",
                path.display()
            ),
        );
    }

    /// Says something about the file that gives way when there is something newer to say.
    fn say_of_disk(&mut self, severity: Severity, text: String) {
        let note = Note::new(severity, text);
        self.disk.notes.push(note.clone());
        self.note(note);
    }

    /// True if the user agreed to the defaults of all these parts.
    fn may_default(&self, parts: &[MissingPart]) -> bool {
        self.disk.use_defaults || parts.iter().all(|p| self.disk.defaulted.contains(&p.name))
    }

    /// The scene in the document's file becomes the document. Camera and terms stay as they are, and so
    /// does the selection where it still means something.
    fn reloaded(&mut self, scene: Scene, defaulted: Vec<String>) {
        let id = match self.selection {
            Selection::Light(i) => self.document.light_id(i),
            Selection::Object(i) => self.document.object_id(i),
            Selection::Room | Selection::Observer => None,
        };
        if self.document.reflection_model != scene.reflection_model {
            self.model_slots.take(&scene.reflection_model);
        }
        self.document.set_saved(scene.clone());
        let before = self.document.revision();
        self.document.replace("Reload from disk", self.selection, scene);
        self.document.end_gesture();
        let selection = match self.selection {
            Selection::Light(i) => {
                let last = self.document.lights.len().checked_sub(1);
                let at = id.and_then(|id| self.document.light(id)).or(last.map(|last| i.min(last)));
                at.map_or(Selection::Room, Selection::Light)
            }
            Selection::Object(i) => {
                let last = self.document.objects.len().checked_sub(1);
                let at = id.and_then(|id| self.document.object(id)).or(last.map(|last| i.min(last)));
                at.map_or(Selection::Room, Selection::Object)
            }
            other => other,
        };
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
