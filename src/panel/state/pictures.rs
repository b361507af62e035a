//! Saved and copied pictures: commands and results.

use std::path::PathBuf;

use super::{Answer, Effect, PictureCommand, Question, Session, Severity};
use crate::files::Shown as _;
use crate::{files, scene::variant::LETTERS};

/// Result of saving or copying a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureEnd {
    /// Saved to a file.
    Saved(PathBuf),
    /// Copied to the clipboard, with this width and height in pixels.
    Copied([u32; 2]),
    /// Neither saved nor copied, for the given reason.
    Failed(String),
}

impl Session {
    pub(super) fn picture(&mut self, command: PictureCommand) -> Vec<Effect> {
        let effect = |view, file, overwrite| Effect::Picture { view, file, overwrite };
        vec![match command {
            PictureCommand::Dialog(view) => Effect::PickPicture(view),
            // The dialog asked about the name as typed, but not about the name with an extension.
            PictureCommand::To { view, path } => {
                let asked = path.extension().is_some();
                effect(view, Some(path), asked)
            }
            PictureCommand::Copy(view) => effect(view, None, false),
        }]
    }

    /// The suggested name for a picture, without extension.
    #[must_use]
    pub fn picture_stem(&self, view: Option<usize>) -> String {
        let letter = view.filter(|_| !self.document.variants.is_empty()).and_then(|view| LETTERS.get(view));
        letter.map_or_else(|| self.stem(), |letter| format!("{}_{}", self.stem(), letter.to_lowercase()))
    }

    /// Asks whether to overwrite an existing picture.
    pub fn picture_exists(&mut self, view: Option<usize>, path: PathBuf) {
        self.questions.ask(Question::ReplacePicture { view, path });
    }

    pub(super) fn answer_picture(view: Option<usize>, path: PathBuf, answer: Answer) -> Vec<Effect> {
        match answer {
            Answer::Overwrite => vec![Effect::Picture { view, file: Some(path), overwrite: true }],
            _ => Vec::new(),
        }
    }

    /// Reports the result of saving or copying a picture.
    pub fn pictured(&mut self, end: PictureEnd) {
        match end {
            PictureEnd::Saved(path) => {
                self.note_file(format!("Saved the picture to {}.", path.shown()), files::folder_of(&path));
            }
            PictureEnd::Copied([width, height]) => {
                self.say(Severity::Info, format!("Copied the picture: {width}×{height} pixels."));
            }
            PictureEnd::Failed(why) => self.say(Severity::Error, why),
        }
    }
}
