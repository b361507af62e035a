//! The user's own files: creating models and exporting shaders.

use std::{
    io,
    path::{Path, PathBuf},
};

use crate::files::{Shown as _, words};
pub use crate::library::assets::write_new;
use crate::{
    custom,
    library::assets::{self, Exported, Folders},
    panel::{
        keys,
        state::{Effect, ModelDraft, Session, Severity},
    },
    registry::Registry,
    text::sentence,
};

/// Carries out an effect that writes a file of the user's, reports the result, and requests the selection of a new
/// model. Returns the folder to read shaders from, if it changes.
pub fn write(effect: &Effect, session: &mut Session, registry: &Registry) -> Option<PathBuf> {
    match effect {
        Effect::NewModel { id, name } => {
            new_file(session, registry, id, name, None, &custom::template(id, name))
        }
        Effect::DuplicateModel { model, id, name } => {
            let Some(entry) = registry.model(model) else {
                session.say(Severity::Error, format!("There is no reflection model “{model}” to copy."));
                return None;
            };
            let sources = match custom::folder::sources_with(model, registry) {
                Ok(sources) => sources,
                Err(why) => {
                    let copied = entry.declaration.name;
                    session
                        .say(Severity::Error, sentence(&format!("{copied} was not copied: {}", why.message)));
                    return None;
                }
            };
            match custom::duplicate(entry, &sources, id, name) {
                Ok(text) => new_file(session, registry, id, name, Some(model), &text),
                Err(why) => {
                    session
                        .say(Severity::Error, format!("{} was not copied: {why}.", entry.declaration.name));
                }
            }
        }
        Effect::AdoptModel(path) => adopt(session, registry, path),
        Effect::ExportShaders(folder) => match assets::export(folder, registry) {
            Ok(exported) => {
                session.say(Severity::Info, told(&exported, folder));
                return Some(folder.clone());
            }
            Err(why) => session.say(Severity::Error, format!("The shaders were not exported: {why}.")),
        },
        _ => {}
    }
    None
}

/// The folder of custom models; if there is none, the one in which they are looked for.
fn models_folder(registry: &Registry) -> Option<PathBuf> {
    registry.custom_folder().map(Path::to_owned).or_else(|| Folders::find(None, None).ok()?.models)
}

fn new_file(session: &mut Session, registry: &Registry, id: &str, name: &str, of: Option<&str>, text: &str) {
    let Some(folder) = models_folder(registry) else {
        let why = "There is no folder for custom models: name one with `lcm --models FOLDER`.";
        return session.say(Severity::Error, why);
    };
    let path = folder.join(format!("{id}.{}", custom::EXTENSION));
    match write_new(&path, text) {
        Ok(()) => {
            session.wanted_model = Some(id.to_owned());
            session.say(
                Severity::Info,
                format!(
                    "{} was written. {}, change it and save it: the picture updates.",
                    path.shown(),
                    keys::hint_beside(session, registry, "Open it in an editor", "edit_model")
                ),
            );
        }
        Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {
            // Asks again, with the typed name.
            session.draft = Some(ModelDraft { of: of.map(str::to_owned), name: name.to_owned() });
            session.say(
                Severity::Error,
                format!("{} already exists and was not changed; choose another name.", path.shown()),
            );
        }
        Err(e) => {
            session.say(Severity::Error, format!("{} could not be written: {}.", path.shown(), words(&e)))
        }
    }
}

/// Copies a model into the folder of custom models.
fn adopt(session: &mut Session, registry: &Registry, from: &Path) {
    let Some((folder, name)) = models_folder(registry).zip(from.file_name()) else {
        let why = "There is no folder for custom models: name one with `lcm --models FOLDER`.";
        return session.say(Severity::Error, why);
    };
    let path = folder.join(name);
    let text = match custom::file::read(from, &name.to_string_lossy()) {
        Ok(text) => text,
        Err(problem) => {
            let text = format!("{} was not copied: {}.", from.shown(), problem.message);
            return session.say(Severity::Error, text);
        }
    };
    match write_new(&path, &text) {
        Ok(()) => {
            session.wanted_model = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            session.say(Severity::Info, format!("{} was copied to {}.", from.shown(), folder.shown()));
        }
        Err(e) if e.kind() == io::ErrorKind::AlreadyExists => session.say(
            Severity::Error,
            format!("{} already exists and was not changed; rename the other file.", path.shown()),
        ),
        Err(e) => {
            session.say(Severity::Error, format!("{} could not be written: {}.", path.shown(), words(&e)))
        }
    }
}

/// The result of an export in words.
fn told(exported: &Exported, folder: &Path) -> String {
    let count = |n: usize| if n == 1 { "1 file".to_owned() } else { format!("{n} files") };
    let mut text = match exported.written.len() {
        0 => format!("The shaders are already in {}", folder.shown()),
        n => format!("{} of shaders and example models were written to {}", count(n), folder.shown()),
    };
    if !exported.kept.is_empty() {
        text += &format!("; {} that differ were not changed", count(exported.kept.len()));
    }
    format!(
        "{text}. Change one and save it: the picture updates. Next time, `lcm --assets {}` starts with them.",
        folder.shown()
    )
}
