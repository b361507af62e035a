//! Pictures that are saved or copied: what is asked for, and how it ends.

use std::path::PathBuf;

use super::{Answer, Effect, PictureCommand, Question, Session, Severity};
use crate::files::Shown as _;
use crate::{files, scene::variant::LETTERS};

/// The end of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureEnd {
    /// It was written to a file.
    Saved(PathBuf),
    /// It is on the clipboard, with so many pixels across and down.
    Copied([u32; 2]),
    /// It was neither saved nor copied; a sentence says why.
    Failed(String),
}

impl Session {
    pub(super) fn picture(&mut self, command: PictureCommand) -> Vec<Effect> {
        let effect = |view, file, overwrite| Effect::Picture { view, file, overwrite };
        vec![match command {
            PictureCommand::Dialog(view) => Effect::PickPicture(view),
            // The dialog has asked about the name that was typed, but not about the one with an ending.
            PictureCommand::To { view, path } => {
                let asked = path.extension().is_some();
                effect(view, Some(path), asked)
            }
            PictureCommand::Copy(view) => effect(view, None, false),
        }]
    }

    /// The name that a dialog offers for a picture, without its extension.
    #[must_use]
    pub fn picture_stem(&self, view: Option<usize>) -> String {
        let letter = view.filter(|_| !self.document.variants.is_empty()).and_then(|view| LETTERS.get(view));
        letter.map_or_else(|| self.stem(), |letter| format!("{}_{}", self.stem(), letter.to_lowercase()))
    }

    /// There is a picture where another one should go.
    pub fn picture_exists(&mut self, view: Option<usize>, path: PathBuf) {
        self.questions.ask(Question::ReplacePicture { view, path });
    }

    pub(super) fn answer_picture(view: Option<usize>, path: PathBuf, answer: Answer) -> Vec<Effect> {
        match answer {
            Answer::Overwrite => vec![Effect::Picture { view, file: Some(path), overwrite: true }],
            _ => Vec::new(),
        }
    }

    /// Says how a picture ended.
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
