//! The folder of custom models. A model is known by its file name alone, by its declaration, or completely.
//! Files are read only as far as needed, so that neither many files nor a bad one affects the others.
//!
//! [`read_model`] reads one complete model, [`declare_rest`] the declarations of all others at once. The
//! registry keeps the results; unchanged files are not read again.

use std::{
    collections::{HashMap, HashSet},
    io,
    path::{Path, PathBuf},
};

use rayon::prelude::*;

use super::{EXTENSION, declare, file, id_of, is_id, is_model, named, problem, read, source_path};
use crate::files::{self, Shown as _, words};
use crate::{
    parameter::Parameter,
    platform::fs,
    registry::{CustomModel, MODELS, Registry},
    shader::{
        check::ShaderProblem,
        compose::{Sources, imports_of},
        limits,
    },
    watch::Print,
};

/// Problems, each with its file.
pub type Problems = Vec<(PathBuf, ShaderProblem)>;

/// The outcome of [`read_model`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reading {
    /// The model was already completely known.
    Known,
    /// The folder has no model with this id.
    Missing,
    /// The model was read and is now in the registry.
    Read,
    /// The model has errors. The registry records them (see [`Registry::broken_model`]) and keeps what it
    /// knew of the model.
    Broken(Problems),
}

/// The outcome of [`declare_rest`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Declared {
    /// The number of files read.
    pub files: usize,
    /// Problems in declarations, unreadable files and the folder, sorted by name.
    pub problems: Problems,
}

/// The WGSL files in a folder, sorted by name; empty if the folder does not exist.
///
/// # Errors
/// Returns an error if the folder cannot be read.
pub fn files_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    Ok(names_in(folder)?.into_iter().filter(|path| fs::is_file(path)).collect())
}

/// Like [`files_in`], but includes everything with a matching name: folders, pipes, dangling links.
fn names_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    files::listed(folder, EXTENSION, usize::MAX).map(|(names, _)| names)
}

/// Reads the complete model with this id and the files that it imports, if it is in the registry's folder but
/// not yet known completely.
pub fn read_model(id: &str, registry: &mut Registry) -> Reading {
    if registry.model(id).is_some() && registry.unread_file(id).is_none() {
        return Reading::Known;
    }
    let Some(path) = registry.unread_file(id).map(Path::to_owned).or_else(|| file_of(id, registry)) else {
        return Reading::Missing;
    };
    // A broken model is not declared later.
    if let Some(print) = Print::of(&path) {
        registry.note_seen(&path, print);
    }
    let text = match file::read_model(&path, &named(&path)) {
        Ok(text) => text,
        Err(problem) => return broken(id, vec![(path, problem)], registry),
    };
    if !is_model(&text) && registry.model(id).is_none() {
        if is_empty(&text) {
            let problem = empty(&path, &text);
            return broken(id, vec![(path, problem)], registry);
        }
        registry.sources_mut().edit(named(&path), text);
        return Reading::Missing;
    }
    if let Err(wrong) = agrees_with_earlier(&path, &text, registry) {
        let problems = wrong.into_iter().map(|problem| (path.clone(), problem)).collect();
        return broken(id, problems, registry);
    }
    let unread = import(&source_path(id), &text, registry);
    if !unread.is_empty() {
        return broken(id, unread, registry);
    }
    match read(&path, &text, registry) {
        Ok(model) => {
            registry.put_custom_model(model);
            Reading::Read
        }
        Err(found) => {
            let problems = found.into_iter().map(|problem| (path.clone(), problem)).collect();
            broken(id, problems, registry)
        }
    }
}

/// Checks that a model's parameters agree with those of the files before it in the folder, known or not. Of two files that
/// contradict each other the later one is refused, whichever of them a command names.
fn agrees_with_earlier(path: &Path, text: &str, registry: &Registry) -> Result<(), Vec<ShaderProblem>> {
    // Other errors are found when the model is read.
    let Ok(model) = declare(path, text, registry) else { return Ok(()) };
    // Those of built-in models were compared just now.
    let is_built_in = |name: &str| {
        let mut users = registry.material_users().filter(|(id, _)| registry.custom_file(id).is_none());
        users.any(|(_, all)| all.iter().any(|p| p.name == name))
    };
    let own = |model: &CustomModel| {
        model.entry.parameters.iter().map(|p| p.name).filter(|name| !is_built_in(name)).collect::<Vec<_>>()
    };
    let mut names = own(&model);
    if names.is_empty() {
        return Ok(());
    }
    let files = registry.custom_folder().and_then(|folder| files_in(folder).ok()).unwrap_or_default();
    // Backwards, since earlier files decide about these too.
    let mut deciding = Vec::new();
    for file in files.iter().rev() {
        if file.file_name() >= path.file_name() || registry.files_seen().contains_key(file) {
            continue;
        }
        let Ok(text) = file::read_model(file, &named(file)) else { continue };
        if names.iter().any(|name| text.contains(&format!("\"{name}\"")))
            && let Ok(model) = declare(file, &text, registry)
        {
            names.extend(own(&model));
            deciding.push(model);
        }
    }
    let mut known = registry.clone();
    for earlier in deciding.into_iter().rev() {
        if let Ok(earlier) = declare(&earlier.path, &earlier.text, &known) {
            known.put_declared(earlier);
        }
    }
    declare(path, text, &known).map(drop)
}

/// The shader and model sources, plus one model of which only the declaration was known.
///
/// # Errors
/// Returns an error if its file cannot be read.
pub fn sources_with(id: &str, registry: &Registry) -> Result<Sources, ShaderProblem> {
    let mut sources = registry.sources().clone();
    if let Some(path) = registry.unread_file(id) {
        sources.edit(source_path(id), file::read_model(path, &named(path))?);
    }
    Ok(sources)
}

/// The path that the file of an unknown model would have, if it exists; it may not be a regular file.
fn file_of(id: &str, registry: &Registry) -> Option<PathBuf> {
    let file = registry.custom_folder()?.join(id).with_extension(EXTENSION);
    (is_id(id) && fs::symlink_metadata(&file).is_ok()).then_some(file)
}

/// True if a text is empty: neither a model nor shared functions.
fn is_empty(text: &str) -> bool {
    text.trim().is_empty()
}

/// The problem with an empty file.
fn empty(path: &Path, text: &str) -> ShaderProblem {
    let message = "the file is empty; a model begins with a comment /* lcm … */ and defines fn response";
    problem(path, text, (0, message.to_owned()))
}

/// The problem with a file that declares nothing: neither a model nor anything that models could share. Notes in comments
/// are none.
fn useless(path: &Path, text: &str) -> Option<ShaderProblem> {
    const DECLARE: [&str; 7] = ["fn", "const", "struct", "alias", "var", "define", "import"];
    let declares = text.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| DECLARE.contains(&word));
    let message = "this file is no model: it neither begins with a comment /* lcm … */ nor defines fn response; it has no \
                   functions that models could share either";
    (!declares && !limits::is_empty(text)).then(|| problem(path, text, (0, message.to_owned())))
}

/// The file of a problem that was found in a model's file: that one, or one that it shares with others, beside it.
#[must_use]
pub fn file_with(problem: &ShaderProblem, path: &Path) -> PathBuf {
    match problem.file.strip_prefix(MODELS) {
        Some(name) => files::folder_of(path).join(name),
        // The folder itself, or a file given to the command.
        None if problem.file == MODELS.trim_end_matches('/') || path.ends_with(&problem.file) => {
            path.to_owned()
        }
        None => PathBuf::from(&problem.file),
    }
}

/// Records why a file does not contain a valid model.
fn broken(id: &str, problems: Problems, registry: &mut Registry) -> Reading {
    if let Some((path, problem)) = problems.first() {
        let file = file_with(problem, path);
        let place = problem.place(file.shown());
        registry.mark_broken(id, format!("{place}: {}", problem.message));
    }
    Reading::Broken(problems)
}

/// Reads the files in the folder that edited shaders import, and the imports of those files.
pub fn import_for_shaders(registry: &mut Registry) -> Problems {
    let sources = registry.sources().clone();
    let edited = sources.edited().filter(|path| !path.starts_with(MODELS));
    edited.flat_map(|path| import(path, sources.get(path).unwrap_or_default(), registry)).collect()
}

/// Reads the files in the folder that a text imports, and their imports, unless already known.
fn import(path: &str, text: &str, registry: &mut Registry) -> Problems {
    let mut problems = Vec::new();
    let mut visited = HashSet::from([path.to_owned()]);
    let mut wanted: Vec<_> = imports_of(path, text).collect();
    while let Some(source) = wanted.pop() {
        let name = source.strip_prefix(MODELS).filter(|name| !name.contains('/') && !name.starts_with('.'));
        let file = name.zip(registry.custom_folder()).map(|(name, folder)| folder.join(name));
        let Some(file) = file.filter(|file| file.extension().is_some_and(|e| e == EXTENSION)) else {
            continue;
        };
        if registry.sources().get(&source).is_some() || !visited.insert(source.clone()) {
            continue;
        }
        if fs::symlink_metadata(&file).is_err() {
            continue;
        }
        match file::read_model(&file, &source) {
            Ok(text) => {
                wanted.extend(imports_of(&source, &text));
                registry.sources_mut().edit(source, text);
            }
            Err(problem) => problems.push((file, problem)),
        }
    }
    problems
}

/// The result of searching a file for a declaration.
enum Found {
    /// A model.
    Model(Box<CustomModel>),
    /// A model with errors.
    Broken(Vec<ShaderProblem>),
    /// Functions shared by models.
    Shared(String),
}

/// Reads the declarations of all models in a folder, and makes it the registry's folder.
pub fn declare_folder(folder: &Path, registry: &mut Registry) -> Declared {
    registry.set_custom_folder(folder);
    declare_rest(registry)
}

/// Reads shared files and the declarations of unknown models in the registry's folder. Skips unchanged files
/// and completely known models.
pub fn declare_rest(registry: &mut Registry) -> Declared {
    let Some(folder) = registry.custom_folder() else { return Declared::default() };
    let (paths, others): (Vec<_>, Vec<_>) = match names_in(folder) {
        Ok(paths) => paths.into_iter().partition(|path| fs::is_file(path)),
        Err(e) => {
            let problem = ShaderProblem {
                file: "models".to_owned(),
                line: 0,
                column: 0,
                source: String::new(),
                message: format!("the folder could not be read: {}", words(&e)),
            };
            return Declared { files: 0, problems: vec![(folder.to_owned(), problem)] };
        }
    };
    let known = &*registry;
    let found: Vec<_> = paths
        .into_par_iter()
        .filter(|path| {
            let more = |id| known.custom_file(id) == Some(path) && known.unread_file(id).is_none();
            !id_of(path).is_some_and(more)
        })
        .filter_map(|path| {
            let print = Print::of(&path)?;
            (known.files_seen().get(&path) != Some(&print)).then(|| {
                let found = examined(&path, known);
                (path, print, found)
            })
        })
        .collect();
    let files = found.len();
    let mut problems = Problems::new();
    for path in others {
        let Err(problem) = file::read_model(&path, &named(&path)) else { continue };
        problems.push((path.clone(), problem.clone()));
        if let Some(id) = id_of(&path) {
            broken(id, vec![(path.clone(), problem)], registry);
        }
    }
    let mut agreed: HashMap<_, _> = registry.material_parameters().map(|p| (p.name, p)).collect();
    for (path, print, found) in found {
        registry.note_seen(&path, print);
        let wrong = match found {
            Found::Shared(text) => {
                problems.extend(useless(&path, &text).map(|problem| (path.clone(), problem)));
                if let Some(id) = id_of(&path).filter(|id| registry.custom_file(id) == Some(&path)) {
                    registry.remove_model(id);
                }
                registry.sources_mut().edit(named(&path), text);
                continue;
            }
            Found::Broken(wrong) => wrong,
            Found::Model(model) => {
                // Each file was checked on its own; together they must agree on the types and units of parameters.
                let fits = |p: &Parameter| agreed.get(p.name).is_none_or(|other| p.clash(other).is_none());
                let agrees = model.entry.parameters.iter().all(fits);
                let model = if agrees { Ok(*model) } else { declare(&path, &model.text, registry) };
                match model {
                    Ok(model) => {
                        agreed.extend(model.entry.parameters.iter().map(|p| (p.name, p)));
                        registry.put_declared(model);
                        continue;
                    }
                    Err(wrong) => wrong,
                }
            }
        };
        let wrong: Problems = wrong.into_iter().map(|problem| (path.clone(), problem)).collect();
        problems.extend(wrong.clone());
        if let Some(id) = id_of(&path) {
            broken(id, wrong, registry);
        }
    }
    registry.sort_custom_models();
    problems.sort_by(|(a, _), (b, _)| a.cmp(b));
    Declared { files, problems }
}

/// Searches a file for a declaration.
fn examined(path: &Path, registry: &Registry) -> Found {
    match file::read_model(path, &named(path)) {
        Err(problem) => Found::Broken(vec![problem]),
        Ok(text) if is_model(&text) => match declare(path, &text, registry) {
            Ok(model) => Found::Model(Box::new(model)),
            Err(problems) => Found::Broken(problems),
        },
        // The file was a model before, and no longer is.
        Ok(text) if is_empty(&text) && id_of(path).is_none_or(|id| registry.model(id).is_none()) => {
            Found::Broken(vec![empty(path, &text)])
        }
        Ok(text) => Found::Shared(text),
    }
}
