//! Files of one's own: writing new models, writing the shaders out, opening files in an editor. Nothing
//! here waits for another program.

use std::{
    io,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::{Arc, Mutex, PoisonError},
    thread,
    time::{Duration, Instant},
};

use bevy::ecs::prelude::*;

pub use crate::assets::write_new;
use crate::{
    assets::{self, Exported, Folders},
    panel::{
        author::ModelDraft,
        state::{Effect, Lab, Severity},
    },
    reflection::own,
    registry::Registry,
};

/// The environment variable that names the editor: a command, split at spaces. `{file}` and `{line}` stand
/// for the file and the line; without `{file}` the file comes last.
pub const EDITOR_VARIABLE: &str = "LCM_EDITOR";
/// A command that fails within this time is told of.
const PATIENCE: Duration = Duration::from_secs(5);

/// The command that opens a file at a line, program and arguments. None when the variable says nothing: then
/// the operating system chooses.
#[must_use]
pub fn editor_command(variable: Option<&str>, file: &Path, line: usize) -> Option<(String, Vec<String>)> {
    let variable = variable?;
    let named = variable.contains("{file}");
    let name = file.to_string_lossy();
    // Split first: a file name may hold spaces.
    let mut words = variable
        .split_whitespace()
        .map(|word| word.replace("{line}", &line.to_string()).replace("{file}", &name))
        .collect::<Vec<_>>();
    if words.is_empty() {
        return None;
    }
    if !named {
        words.push(name.into_owned());
    }
    let program = words.remove(0);
    Some((program, words))
}

/// What went wrong with editors that were started, told by the threads that wait for them.
#[derive(Clone, Debug, Default, Resource)]
pub struct Editors {
    complaints: Arc<Mutex<Vec<String>>>,
}

impl Editors {
    /// Opens a file in an editor, as `variable` (the value of [`EDITOR_VARIABLE`]) says, and comes back at
    /// once. `wake` is called when there is a complaint.
    pub fn open(
        &self,
        variable: Option<&str>,
        file: &Path,
        line: usize,
        wake: impl FnOnce() + Send + 'static,
    ) {
        let command = editor_command(variable, file, line);
        let complaints = self.complaints.clone();
        let file = file.to_owned();
        thread::spawn(move || {
            let Err(why) = start(command, &file) else { return };
            let text = format!(
                "{} could not be opened in an editor: {why}. Open it by hand, or name an editor in the environment \
                 variable {EDITOR_VARIABLE}, such as \"code --goto {{file}}:{{line}}\".",
                file.display()
            );
            complaints.lock().unwrap_or_else(PoisonError::into_inner).push(text);
            wake();
        });
    }

    /// The complaints since the last call.
    #[must_use]
    pub fn take(&self) -> Vec<String> {
        std::mem::take(&mut *self.complaints.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Starts the editor. Waits a little, since many programs that cannot open a file say so by their exit status.
fn start(command: Option<(String, Vec<String>)>, file: &Path) -> Result<(), String> {
    let Some((program, arguments)) = command else {
        return open::that_detached(file).map_err(|e| e.to_string());
    };
    let mut child = Command::new(&program)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|e| format!("the command {program} of {EDITOR_VARIABLE} does not start ({e})"))?;
    let started = Instant::now();
    match child.wait() {
        Ok(status) if !status.success() && started.elapsed() < PATIENCE => {
            Err(format!("the command {program} of {EDITOR_VARIABLE} ended with {status}"))
        }
        _ => Ok(()),
    }
}

/// Carries out an effect that writes a file of one's own: says what became of it, and wishes for a new model to be
/// chosen. Returns the folder whose shaders are to be read from now on, if there is a new one.
pub fn write(effect: &Effect, lab: &mut Lab, registry: &Registry) -> Option<PathBuf> {
    match effect {
        Effect::NewModel { id, name } => new_file(lab, registry, id, None, &own::template(id, name)),
        Effect::DuplicateModel { model, id } => {
            let Some(entry) = registry.model(model) else {
                lab.say(Severity::Error, format!("There is no reflection model “{model}” to copy."));
                return None;
            };
            let sources = match own::folder::sources_with(model, registry) {
                Ok(sources) => sources,
                Err(why) => {
                    let name = entry.declaration.name;
                    lab.say(Severity::Error, format!("{name} was not copied: {}.", why.message));
                    return None;
                }
            };
            match own::duplicate(entry, &sources, id) {
                Ok(text) => new_file(lab, registry, id, Some(model), &text),
                Err(why) => {
                    lab.say(Severity::Error, format!("{} was not copied: {why}.", entry.declaration.name));
                }
            }
        }
        Effect::ExportShaders(folder) => match assets::export(folder, registry) {
            Ok(exported) => {
                lab.say(Severity::Info, told(&exported, folder));
                return Some(folder.clone());
            }
            Err(why) => lab.say(Severity::Error, format!("The shaders were not written out: {why}.")),
        },
        _ => {}
    }
    None
}

/// Where own models are: where they are read from, else where they would be looked for.
fn models_folder(lab: &Lab, registry: &Registry) -> Option<PathBuf> {
    let known = lab.shaders.models.clone().or_else(|| registry.own_folder().map(Path::to_owned));
    known.or_else(|| Folders::find(None, None).ok()?.models)
}

fn new_file(lab: &mut Lab, registry: &Registry, id: &str, of: Option<&str>, text: &str) {
    let Some(folder) = models_folder(lab, registry) else {
        let why = "There is no folder for custom models: name one with `lcm --models FOLDER`.";
        return lab.say(Severity::Error, why);
    };
    let path = folder.join(format!("{id}.{}", own::EXTENSION));
    match write_new(&path, text) {
        Ok(()) => {
            lab.wanted_model = Some(id.to_owned());
            lab.say(
                Severity::Info,
                format!(
                    "{} was written. Open it in an editor (Ctrl+E), change it and save it: the picture follows.",
                    path.display()
                ),
            );
        }
        Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {
            // Asked again, with what was typed.
            lab.draft = Some(ModelDraft { of: of.map(str::to_owned), id: id.to_owned() });
            lab.say(
                Severity::Error,
                format!("{} exists already and was left as it is; choose another name.", path.display()),
            );
        }
        Err(e) => lab.say(Severity::Error, format!("{} could not be written: {e}.", path.display())),
    }
}

/// What an export did, in words.
fn told(exported: &Exported, folder: &Path) -> String {
    let count = |n: usize| if n == 1 { "1 file".to_owned() } else { format!("{n} files") };
    let mut text = match exported.written.len() {
        0 => format!("The shaders are in {} already", folder.display()),
        n => format!("{} of shaders and example models were written to {}", count(n), folder.display()),
    };
    if !exported.kept.is_empty() {
        text += &format!("; {} that differ were left as they are", count(exported.kept.len()));
    }
    format!(
        "{text}. Change one and save it: the picture follows. `lcm --assets {}` begins with them the next time.",
        folder.display()
    )
}
