//! Exports: what is asked for, and how they end.

use std::path::PathBuf;

use super::{Action, Answer, Effect, ExportCommand, Note, Question, Session, Severity};
use crate::export::{Form, form};

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

    /// There is something where the export should go.
    pub fn export_exists(&mut self, form: &'static str, path: PathBuf) {
        self.questions.ask(Question::ReplaceExport { form, path });
    }

    pub(super) fn answer_export(&self, form: &'static str, path: PathBuf, answer: Answer) -> Vec<Effect> {
        match answer {
            Answer::Overwrite => vec![Effect::Export { form, path, overwrite: true }],
            _ => Vec::new(),
        }
    }

    /// An export has ended: its notes, or why there is none, a sentence each.
    pub fn exported(&mut self, id: &str, path: PathBuf, outcome: Result<Vec<String>, Vec<String>>) {
        let name = form(id).map_or("", |form: &Form| form.name);
        match outcome {
            Ok(notes) => {
                notes.into_iter().for_each(|note| self.say(Severity::Info, note));
                let text = format!("Exported as {name} to {}.", path.display());
                let folder = if path.is_dir() { path } else { crate::files::folder_of(&path).to_owned() };
                let reveal = Action::Export(ExportCommand::Reveal(folder));
                self.note(Note::new(Severity::Info, text).offering("Open the folder", reveal));
            }
            // The latest message stands on top.
            Err(reasons) => {
                reasons.into_iter().rev().for_each(|reason| self.say(Severity::Error, reason));
                self.say(Severity::Error, format!("The scene was not exported as {name}."));
            }
        }
    }
}
