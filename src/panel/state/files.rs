//! The document and its file: opening, saving, replacing.

use std::path::{Path, PathBuf};

use super::{Action, Effect, Note, Question, Session, Severity};
use crate::{
    document::Document,
    files::printable,
    optics::TermSelection,
    registry::Registry,
    scene::{Scene, examples::EXAMPLES},
};

/// The most files that the list of recent files holds.
pub const RECENT_FILES: usize = 10;

impl Session {
    /// True if the document differs from its file.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.recovered || !self.defaulted.is_empty() || self.disk.gone || self.document.differs()
    }

    /// True while the user is asked about unsaved changes, or saves them, in order to close the window.
    #[must_use]
    pub fn is_quitting(&self) -> bool {
        let asked = matches!(&self.question, Some(Question::Unsaved { then }) if **then == Action::Quit);
        asked || self.after_save == Some(Action::Quit)
    }

    /// The scene of a file has been read: it becomes the document.
    pub fn opened(&mut self, path: PathBuf, scene: Scene) -> Vec<Effect> {
        self.view.examples_open = false;
        self.remember_file(&path);
        self.replace_document(Some(path), scene);
        vec![Effect::DocumentChanged, Effect::SaveSettings]
    }

    /// The document has been written. Returns what waited for it.
    pub fn saved(&mut self, path: PathBuf, registry: &Registry) -> Vec<Effect> {
        self.remember_file(&path);
        self.note_saved(&path);
        self.path = Some(path);
        self.document.mark_saved();
        self.recovered = false;
        self.defaulted.clear();
        self.disk_settled();
        let mut effects = vec![Effect::SaveSettings];
        if let Some(action) = self.after_save.take() {
            effects.extend(self.apply(action, registry));
        }
        effects
    }

    pub(super) fn note_saved(&mut self, path: &Path) {
        let mut text = format!("Saved to {}.", printable(&path.to_string_lossy()));
        let mut offer = None;
        if self.camera_left {
            text.push_str(" The view you turned to is not in the file: it has the observer’s.");
            match self.observer_problem() {
                None => offer = Some(("Set observer to this view", Box::new(Action::ObserverFromView))),
                Some(why) => text.push_str(&format!(" {why}")),
            }
        }
        self.messages.retain(|m| m.severity != Severity::Info || !m.text.starts_with("Saved to "));
        self.note(Note { severity: Severity::Info, text, offer });
    }

    /// The document could not be written, or no file was chosen: what waited for it is dropped.
    pub fn not_saved(&mut self) {
        self.after_save = None;
    }

    /// The dialog that chooses a file to open was closed without a choice.
    pub fn not_opened(&mut self) {
        self.may_discard = false;
    }

    pub(super) fn start_new(&mut self) -> Vec<Effect> {
        self.replace_document(None, Scene::default());
        vec![Effect::DocumentChanged]
    }

    pub(super) fn open_example(&mut self, i: usize, registry: &Registry) -> Vec<Effect> {
        match EXAMPLES.get(i).map(|example| example.scene(registry)) {
            Some(Ok(scene)) => {
                self.replace_document(None, scene);
                vec![Effect::DocumentChanged]
            }
            Some(Err(error)) => {
                self.say(Severity::Error, error.to_string());
                Vec::new()
            }
            None => Vec::new(),
        }
    }

    pub(super) fn replace_document(&mut self, path: Option<PathBuf>, scene: Scene) {
        self.document = Document::new(scene);
        self.path = path;
        self.stashed.clear();
        self.renaming = None;
        self.after_save = None;
        self.may_discard = false;
        self.recovered = false;
        self.defaulted.clear();
        self.disk_settled();
        self.view.terms = TermSelection::All;
        self.select_first();
        self.use_slot(&self.document.reflection_model.clone());
    }

    /// The scene of a recovery copy becomes the document; it is unsaved.
    pub(in crate::panel) fn recovered(&mut self, path: Option<PathBuf>, scene: Scene) {
        self.replace_document(path, scene);
        self.recovered = true;
    }

    pub(super) fn remember_file(&mut self, path: &Path) {
        // The next start may be in another folder.
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent_files.retain(|p| *p != path);
        self.recent_files.insert(0, path);
        self.recent_files.truncate(RECENT_FILES);
    }
}
