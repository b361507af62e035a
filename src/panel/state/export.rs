//! Exports and pictures: commands and results.

use std::path::{Path, PathBuf};

use super::{Action, Effect, ExportCommand, Note, Pick, Session, Severity};
use crate::{
    export::{Form, form},
    files::{self, Shown as _},
    platform::{self, fs},
    scene::variant::LETTERS,
    sweep::Format,
};

/// Result of saving or copying a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureEnd {
    /// Saved to a file.
    Saved {
        /// The file.
        path: PathBuf,
        /// Why its scene has the observer elsewhere than the camera, if so.
        elsewhere: Option<&'static str>,
    },
    /// Copied to the clipboard, with this width and height in pixels.
    Copied([u32; 2]),
    /// The user cancelled it.
    Cancelled,
    /// Neither saved nor copied, for the given reason.
    Failed(String),
}

impl Session {
    pub(super) fn export(&mut self, command: ExportCommand) {
        match command {
            _ if self.facts.export.is_some() => {
                self.say(Severity::Info, "An export is still running: wait for it, or cancel it below.");
            }
            ExportCommand::Dialog(form) => self.request(Effect::Pick(Pick::Export(form))),
            ExportCommand::To { form, path } => {
                self.request(Effect::Export { form, path, overwrite: false });
            }
        }
    }

    /// Reports a written file or folder, and offers to show the folder.
    pub(super) fn note_file(&mut self, text: String, path: &Path) {
        let folder = if fs::is_dir(path) { path } else { files::folder_of(path) };
        let reveal = Action::Do(Effect::Reveal(folder.to_owned()));
        self.note(Note::new(Severity::Info, text).offering("Open the folder", reveal));
    }

    /// Says what there is to say about a file that was written, and that it was.
    pub(super) fn note_written(&mut self, notes: Vec<String>, text: String, path: &Path) {
        notes.into_iter().for_each(|note| self.say(Severity::Info, note));
        self.note_file(text, path);
    }

    /// Reports the end of an export: its notes, or why it failed, one sentence each.
    pub fn exported(&mut self, id: &str, path: PathBuf, outcome: Result<Vec<String>, Vec<String>>) {
        let name = form(id).map_or("", |form: &Form| form.name);
        match outcome {
            Ok(notes) => self.note_written(notes, format!("Exported as {name} to {}.", path.shown()), &path),
            // The latest message is on top.
            Err(reasons) => {
                reasons.into_iter().rev().for_each(|reason| self.say(Severity::Error, reason));
                self.say(Severity::Error, format!("The scene was not exported as {name}."));
            }
        }
    }

    /// The suggested name for a picture, without extension.
    #[must_use]
    pub fn picture_stem(&self, view: Option<usize>) -> String {
        let letter = view.filter(|_| !self.document.variants.is_empty()).and_then(|view| LETTERS.get(view));
        letter.map_or_else(|| self.stem(), |letter| format!("{}_{}", self.stem(), letter.to_lowercase()))
    }

    /// Reports the result of saving a sheet; `Ok` may have the reason why its scene has the observer elsewhere than the camera.
    pub fn sheet_written(&mut self, path: &Path, outcome: Result<Option<&'static str>, String>) {
        let is_film = Format::of(path).is_some_and(Format::is_film);
        let what = if is_film { "film" } else { "sheet" };
        match outcome {
            Ok(elsewhere) => {
                let text = format!("Saved the {what} to {}.{}", path.shown(), opens(elsewhere));
                self.note_file(text, path);
            }
            Err(why) => self.say(Severity::Error, format!("The {what} was not saved: {why}.")),
        }
    }

    /// Reports the result of saving or copying a picture.
    pub fn pictured(&mut self, end: PictureEnd) {
        match end {
            PictureEnd::Saved { path, elsewhere } => {
                let text = format!("Saved the picture to {}.{}", path.shown(), opens(elsewhere));
                self.note_file(text, &path);
            }
            PictureEnd::Copied([width, height]) if platform::COPIES_AT_ONCE => {
                self.say(Severity::Info, format!("Copied the picture: {width}×{height} pixels."));
            }
            PictureEnd::Copied(_) => {}
            PictureEnd::Cancelled => {
                self.say(Severity::Info, "The picture was cancelled; nothing was written.");
            }
            PictureEnd::Failed(why) => self.say(Severity::Error, why),
        }
    }
}

/// The words about the scene in a picture whose observer is elsewhere than the camera.
fn opens(elsewhere: Option<&'static str>) -> String {
    elsewhere.map_or_else(String::new, |why| {
        format!(" It opens with the observer’s view, not the one you turned to. {why}")
    })
}
