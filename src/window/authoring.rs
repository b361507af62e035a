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
    materials::{self, Material, NotSaved},
    panel::{
        code, keys,
        state::{Authoring, Effect, ModelDraft, Question, Session, Severity},
    },
    registry::Registry,
    text::sentence,
};

/// Carries out an effect that writes a file of the user's, reports the result, and requests the selection of a new
/// model. Returns the folder to read shaders from, if it changes.
pub fn write(effect: &Effect, session: &mut Session, registry: &Registry) -> Option<PathBuf> {
    let (said, folder) = match effect {
        Effect::NewModel { of, id, name } => (new_model(session, registry, of, id, name), None),
        Effect::AdoptModel(path) => (adopt(session, registry, path), None),
        Effect::ExportShaders(folder) => match assets::export(folder, registry) {
            Ok(exported) => (Ok(told(&exported, folder)), Some(folder.clone())),
            Err(why) => (Err(format!("The shaders were not exported: {why}.")), None),
        },
        _ => return None,
    };
    match said {
        Ok(text) => session.say(Severity::Info, text),
        Err(why) => session.say(Severity::Error, why),
    }
    folder
}

/// The folder of custom models; if there is none, the one in which they are looked for.
fn models_folder(registry: &Registry) -> Result<PathBuf, String> {
    let known = registry.custom_folder().map(Path::to_owned);
    known.or_else(|| Folders::find(None, None).ok()?.models).ok_or_else(|| {
        "There is no folder for custom models: name one with `lcm --models FOLDER`.".to_owned()
    })
}

/// Saves a material beside the folder of custom models; asks before it replaces another.
pub(super) fn save_material(session: &mut Session, registry: &Registry, material: Material, overwrite: bool) {
    let save = if overwrite { materials::replace } else { materials::save };
    let Ok(models) = models_folder(registry) else {
        return session.say(Severity::Error, materials::NO_FOLDER);
    };
    match save(&material, &materials::beside(&models), registry) {
        Ok(path) => {
            session.say(Severity::Info, format!("{} was saved: {}.", material.name, path.shown()));
            session.materials.was_saved(path);
        }
        Err(NotSaved::Taken(path)) => {
            session.questions.ask(Question::ReplaceMaterial { material: Box::new(material), path });
        }
        Err(why) => {
            session.say(Severity::Error, format!("{} was not saved: {why}.", material.name));
            // Asks again, with the typed name.
            session.materials.draft = Some(Box::new(material));
        }
    }
}

/// Writes the file of a model, which is selected in the active view as soon as it is read. `taken` says what to do if
/// there is such a file.
fn new_file(
    session: &mut Session,
    path: &Path,
    text: &str,
    taken: impl FnOnce(&mut Authoring) -> &'static str,
) -> Result<(), String> {
    match write_new(path, text) {
        Ok(()) => {
            session.authoring.wanted_view = session.active();
            session.authoring.wanted_model = path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
            Ok(())
        }
        Err(e) if e.kind() == io::ErrorKind::AlreadyExists => Err(format!(
            "{} already exists and was not changed; {}.",
            path.shown(),
            taken(&mut session.authoring)
        )),
        Err(e) => Err(format!("{} could not be written: {}.", path.shown(), words(&e))),
    }
}

/// Writes a new model, or a copy `of` a model.
fn new_model(
    session: &mut Session,
    registry: &Registry,
    of: &Option<String>,
    id: &str,
    name: &str,
) -> Result<String, String> {
    let text = match of {
        Some(model) => copy_of(model, registry, id, name)?,
        None => custom::template(id, name),
    };
    let path = models_folder(registry)?.join(format!("{id}.{}", custom::EXTENSION));
    new_file(session, &path, &text, |authoring| {
        // Asks again, with the typed name.
        authoring.draft = Some(ModelDraft { of: of.clone(), name: name.to_owned() });
        "choose another name"
    })?;
    let open = match code::open_new(session, &path) {
        true => "It is open in the panel Code".to_owned(),
        false => keys::hint_beside(session, registry, "Open it in an editor", "edit_model"),
    };
    Ok(format!("{} was written. {open}: change it and save it, and the picture follows.", path.shown()))
}

fn copy_of(model: &str, registry: &Registry, id: &str, name: &str) -> Result<String, String> {
    let entry = registry.model(model);
    let entry = entry.ok_or_else(|| format!("There is no reflection model “{model}” to copy."))?;
    let copied = entry.declaration.name;
    let sources = custom::folder::sources_with(model, registry);
    let sources = sources.map_err(|why| sentence(&format!("{copied} was not copied: {}", why.message)))?;
    custom::duplicate(entry, &sources, id, name).map_err(|why| format!("{copied} was not copied: {why}."))
}

/// Copies a model into the folder of custom models.
fn adopt(session: &mut Session, registry: &Registry, from: &Path) -> Result<String, String> {
    let folder = models_folder(registry)?;
    let name = from.file_name().unwrap_or_default();
    let text = custom::file::read(from, &name.to_string_lossy());
    let text = text.map_err(|problem| format!("{} was not copied: {}.", from.shown(), problem.message))?;
    new_file(session, &folder.join(name), &text, |_| "rename the other file")?;
    Ok(format!("{} was copied to {}.", from.shown(), folder.shown()))
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
