//! State of the document's file on disk.

use std::path::Path;

use super::{Badge, MissingPart, Note, Session, Severity};
use crate::files::Shown as _;
use crate::{files::printable, scene::load::Stamp};

/// Version of a file on disk: its content, or `None` if there is no file.
type Version = Option<Stamp>;

/// State of the document's file on disk.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OnDisk {
    /// Badge in the picture about the file.
    pub badge: Option<Badge>,
    /// True if the user accepts defaults for any parts missing from the file.
    pub use_defaults: bool,
    /// True if the document was recovered, so that its file is unknown.
    pub(in crate::panel) recovered: bool,
    /// Names of the parts that are missing from the file and were set to defaults.
    pub(in crate::panel) defaulted: Vec<String>,
    /// True if the file was deleted or is no longer a valid scene, so that only the window has the document.
    pub(in crate::panel) lost: bool,
    /// True if the file changed while a question was open.
    pub(in crate::panel) deferred: bool,
    /// An unusable version that may still be in the process of being written.
    pub(in crate::panel) suspect: Option<Version>,
    /// The unusable version that was reported to the user.
    pub(in crate::panel) told: Option<Version>,
    /// The version that the user was asked about.
    pub(in crate::panel) asked: Option<Version>,
    /// Messages about the file, which newer ones replace.
    notes: Vec<Note>,
}

impl OnDisk {
    /// True if no file contains the document that the changes are based on.
    pub(super) fn lacks_document(&self) -> bool {
        self.recovered || !self.defaulted.is_empty() || self.lost
    }
}

impl Session {
    /// Removes badge and messages about the file, once the file is as expected or the user has decided.
    pub(in crate::panel) fn disk_settled(&mut self) {
        let notes = std::mem::take(&mut self.disk.notes);
        self.messages.retain(|m| !notes.contains(m));
        if !notes.is_empty() {
            self.fold_healed();
        }
        let known = std::mem::take(&mut self.disk);
        self.disk = OnDisk {
            use_defaults: known.use_defaults,
            recovered: known.recovered,
            defaulted: known.defaulted,
            deferred: known.deferred,
            ..OnDisk::default()
        };
    }

    /// The badge about the document's file, if there is one.
    #[must_use]
    pub fn disk_badge(&self) -> Option<Badge> {
        let mut badge = self.disk.badge.clone()?;
        // The file is unreadable: the picture shows the previous scene, with any later changes.
        if badge.severity == Severity::Error && self.lesson.is_none() && self.document.differs() {
            badge.text += " with your unsaved changes";
        }
        Some(badge)
    }

    /// Resets the state after the document was saved or replaced.
    pub(super) fn disk_saved(&mut self) {
        self.disk_settled();
        self.disk.recovered = false;
        self.disk.defaulted.clear();
    }

    /// Shows a badge while the user has not decided between the version on disk and the document.
    pub(super) fn disk_undecided(&mut self, path: &Path) {
        self.set_disk_badge(
            Severity::Warning,
            path,
            "changed on disk: showing yours",
            &format!(
                "{} was changed by another program, and you have unsaved changes. Saving asks which version \
                 to keep.",
                path.shown()
            ),
        );
    }

    /// Sets the badge about the file, which begins with the file name. Unprintable characters are removed.
    pub(in crate::panel) fn set_disk_badge(
        &mut self,
        severity: Severity,
        path: &Path,
        what: &str,
        help: &str,
    ) {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let text = printable(&format!("{name} {what}")).into_owned();
        let short = what.split(':').next().unwrap_or(what);
        let shorter = vec![printable(&format!("{name} {short}")).into_owned(), format!("File {short}")];
        self.disk.badge = Some(Badge { severity, text, shorter, help: printable(help).into_owned() });
    }

    /// Reports that a file which was written could not be kept after all.
    pub fn not_kept(&mut self, path: &Path, why: &str) {
        self.messages.retain(|m| m.severity != Severity::Info || !m.text.starts_with("Saved to "));
        if self.own_path() == Some(path) {
            self.lose_own_file();
        }
        self.say(Severity::Error, format!("{} was not saved: {why}.", path.shown()));
    }

    /// Shows a message about the file, which newer ones replace.
    pub(in crate::panel) fn say_of_disk(&mut self, severity: Severity, text: String) {
        let note = Note::new(severity, text);
        self.disk.notes.push(note.clone());
        self.note(note);
    }

    /// True if the user has accepted the defaults of all these parts.
    pub(in crate::panel) fn may_default(&self, parts: &[MissingPart]) -> bool {
        self.disk.use_defaults || parts.iter().all(|p| self.disk.defaulted.contains(&p.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{registry::Registry, scene::Scene};

    #[test]
    fn a_file_that_could_not_be_kept_is_not_saved() {
        let (registry, path) = (Registry::builtin(), Path::new("/Files/room.json"));
        let mut session = Session::new(Scene::default());
        let _ = session.saved(path.to_owned(), &registry);
        let said = |session: &Session| session.messages.iter().any(|m| m.text.starts_with("Saved to "));
        assert!(said(&session) && !session.is_dirty());
        session.not_kept(Path::new("/Files/other.json"), "no room");
        assert!(!session.is_dirty(), "another file");
        session.not_kept(path, "no room");
        assert!(!said(&session) && session.is_dirty());
        let last = session.messages.last().expect("said");
        assert_eq!(
            (last.severity, last.text.as_str()),
            (Severity::Error, "/Files/room.json was not saved: no room.")
        );
        let _ = session.saved(path.to_owned(), &registry);
        assert!(said(&session) && !session.is_dirty(), "there is room again");
    }
}
