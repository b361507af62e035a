//! The document's file on disk, beyond the document itself.

use std::path::Path;

use super::{Badge, MissingPart, Note, Session, Severity};
use crate::files::Shown as _;
use crate::{files::printable, scene::load::Stamp};

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
    pub(in crate::panel) recovered: bool,
    /// The names of the parts that the file lacks and that the document got as defaults.
    pub(in crate::panel) defaulted: Vec<String>,
    /// True if the file was deleted or holds no scene any more, so that only the window has the document.
    pub(in crate::panel) lost: bool,
    /// News came while a question was open.
    pub(in crate::panel) deferred: bool,
    /// A version that cannot be used, but that may be in the middle of being written.
    pub(in crate::panel) suspect: Option<Version>,
    /// The version that cannot be used of which the user was told.
    pub(in crate::panel) told: Option<Version>,
    /// The version about which the user was asked.
    pub(in crate::panel) asked: Option<Version>,
    /// The messages about the file, which give way to newer ones.
    notes: Vec<Note>,
}

impl OnDisk {
    /// True if no file has what the document began with.
    pub(super) fn lacks_document(&self) -> bool {
        self.recovered || !self.defaulted.is_empty() || self.lost
    }
}

impl Session {
    /// The document's file is as it should be, or is the user's concern: what was said of it is over.
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

    /// The remark on the document's file, if there is one.
    #[must_use]
    pub fn disk_badge(&self) -> Option<Badge> {
        let mut badge = self.disk.badge.clone()?;
        // The file cannot be read, so what is shown is the scene before it, or what became of that here.
        if badge.severity == Severity::Error && self.lesson.is_none() && self.document.differs() {
            badge.text += " with your unsaved changes";
        }
        Some(badge)
    }

    /// The document is as its file has it, or is another one.
    pub(super) fn disk_saved(&mut self) {
        self.disk_settled();
        self.disk.recovered = false;
        self.disk.defaulted.clear();
    }

    /// The user leaves it open whether the file on disk or the document counts.
    pub(super) fn disk_undecided(&mut self, path: &Path) {
        self.set_disk_badge(
            Severity::Warning,
            path,
            "changed on disk: showing yours",
            &format!(
                "{} was changed by another program, and there are changes here that are not saved. Saving asks which \
                 of both to keep.",
                path.shown()
            ),
        );
    }

    /// Puts a badge on the picture that begins with the name of the file, without what names of files may hold that is
    /// not to be shown.
    pub(in crate::panel) fn set_disk_badge(
        &mut self,
        severity: Severity,
        path: &Path,
        what: &str,
        help: &str,
    ) {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let text = printable(&format!("{name} {what}")).into_owned();
        self.disk.badge = Some(Badge { severity, text, help: printable(help).into_owned() });
    }

    /// Says something about the file that gives way when there is something newer to say.
    pub(in crate::panel) fn say_of_disk(&mut self, severity: Severity, text: String) {
        let note = Note::new(severity, text);
        self.disk.notes.push(note.clone());
        self.note(note);
    }

    /// True if the user agreed to the defaults of all these parts.
    pub(in crate::panel) fn may_default(&self, parts: &[MissingPart]) -> bool {
        self.disk.use_defaults || parts.iter().all(|p| self.disk.defaulted.contains(&p.name))
    }
}
