//! Exports: commands and results.

use std::path::{Path, PathBuf};

use super::{Action, Answer, Effect, ExportCommand, Note, Question, Session, Severity};
use crate::export::{Form, form};
use crate::files::Shown as _;

impl Session {
    pub(super) fn export(&mut self, command: ExportCommand) -> Vec<Effect> {
        match command {
            ExportCommand::Cancel => vec![Effect::CancelExport],
            ExportCommand::Reveal(path) => vec![Effect::Reveal(path)],
            _ if self.facts.export.is_some() => {
                self.say(Severity::Info, "An export is still running: wait for it, or cancel it below.");
                Vec::new()
            }
            ExportCommand::Dialog(form) => vec![Effect::PickExport(form)],
            ExportCommand::To { form, path } => vec![Effect::Export { form, path, overwrite: false }],
        }
    }

    /// Asks whether to overwrite an existing destination of an export.
    pub fn export_exists(&mut self, form: &'static str, path: PathBuf) {
        self.questions.ask(Question::ReplaceExport { form, path });
    }

    pub(super) fn answer_export(&self, form: &'static str, path: PathBuf, answer: Answer) -> Vec<Effect> {
        match answer {
            Answer::Overwrite => vec![Effect::Export { form, path, overwrite: true }],
            _ => Vec::new(),
        }
    }

    /// Reports a written file, and offers to show its folder.
    pub(super) fn note_file(&mut self, text: String, folder: &Path) {
        let reveal = Action::Export(ExportCommand::Reveal(folder.to_owned()));
        self.note(Note::new(Severity::Info, text).offering("Open the folder", reveal));
    }

    /// Reports the end of an export: its notes, or why it failed, one sentence each.
    pub fn exported(&mut self, id: &str, path: PathBuf, outcome: Result<Vec<String>, Vec<String>>) {
        let name = form(id).map_or("", |form: &Form| form.name);
        match outcome {
            Ok(notes) => {
                notes.into_iter().for_each(|note| self.say(Severity::Info, note));
                let text = format!("Exported as {name} to {}.", path.shown());
                self.note_file(text, if path.is_dir() { &path } else { crate::files::folder_of(&path) });
            }
            // The latest message is on top.
            Err(reasons) => {
                reasons.into_iter().rev().for_each(|reason| self.say(Severity::Error, reason));
                self.say(Severity::Error, format!("The scene was not exported as {name}."));
            }
        }
    }
}
