//! The folder of custom models. A model is known by its file name alone, by its declaration, or completely; only as
//! much is read as is needed, so that neither many files nor a bad one affect the others.
//!
//! [`read_model`] reads one complete model, [`declare_rest`] the declarations of all others, many at a time. The
//! registry keeps the results; an unchanged file is not read again.

use std::{
    collections::{HashMap, HashSet},
    fs, io,
    mem::discriminant,
    path::{Path, PathBuf},
};

use rayon::prelude::*;

use super::{EXTENSION, declare, file, id_of, is_id, is_model, named, problem, read, source_path};
use crate::files::{Shown as _, words};
use crate::{
    registry::{CustomModel, MODELS, Registry},
    shader::{
        check::ShaderProblem,
        compose::{Sources, imports_of},
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
    /// The folder has no model with that id.
    Missing,
    /// The model was read, and the registry knows it.
    Read,
    /// It has errors. The registry keeps them (see [`Registry::broken_model`]), and keeps its earlier knowledge of the
    /// model.
    Broken(Problems),
}

/// The outcome of [`declare_rest`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Declared {
    /// The number of files read.
    pub files: usize,
    /// Problems of declarations, of unreadable files, and of the folder, in the order of the names.
    pub problems: Problems,
}

/// The WGSL files in a folder, by name; none if there is no folder.
///
/// # Errors
/// If the folder cannot be read.
pub fn files_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    Ok(names_in(folder)?.into_iter().filter(|path| path.is_file()).collect())
}

/// The same with what only has such a name: folders, pipes, links to nothing.
fn names_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(e) => return Err(e),
    };
    let mut names = Vec::new();
    for entry in entries {
        let path = entry?.path();
        let hidden = path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
        if path.extension().is_some_and(|e| e == EXTENSION) && !hidden {
            names.push(path);
        }
    }
    names.sort();
    Ok(names)
}

/// Reads the complete model with that id, and the files that it imports, if the registry's folder has it and the
/// registry does not.
pub fn read_model(id: &str, registry: &mut Registry) -> Reading {
    if registry.model(id).is_some() && registry.unread_file(id).is_none() {
        return Reading::Known;
    }
    let Some(path) = registry.unread_file(id).map(Path::to_owned).or_else(|| file_of(id, registry)) else {
        return Reading::Missing;
    };
    // A model found to be bad is not declared later.
    if let Some(print) = Print::of(&path) {
        registry.note_seen(&path, print);
    }
    let text = match file::read(&path, &named(&path)) {
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
    let mut problems = import(&source_path(id), &text, registry);
    match read(&path, &text, registry) {
        Ok(model) => {
            registry.put_custom_model(model);
            Reading::Read
        }
        Err(found) => {
            problems.extend(found.into_iter().map(|problem| (path.clone(), problem)));
            broken(id, problems, registry)
        }
    }
}

/// The texts of shaders and models, plus one more model of which only the declaration was read so far.
///
/// # Errors
/// If its file cannot be read.
pub fn sources_with(id: &str, registry: &Registry) -> Result<Sources, ShaderProblem> {
    let mut sources = registry.sources().clone();
    if let Some(path) = registry.unread_file(id) {
        sources.edit(source_path(id), file::read(path, &named(path))?);
    }
    Ok(sources)
}

/// What has the name of the file of a model unknown to the registry; it may be no file.
fn file_of(id: &str, registry: &Registry) -> Option<PathBuf> {
    let file = registry.custom_folder()?.join(id).with_extension(EXTENSION);
    (is_id(id) && fs::symlink_metadata(&file).is_ok()).then_some(file)
}

/// True if a text says nothing: it is no model, and nothing that models share.
fn is_empty(text: &str) -> bool {
    text.trim().is_empty()
}

/// What is wrong with an empty file.
fn empty(path: &Path, text: &str) -> ShaderProblem {
    let message = "the file is empty; a model begins with a comment /* lcm … */ and defines fn response";
    problem(path, text, (0, message.to_owned()))
}

/// Notes why a file gives no model.
fn broken(id: &str, problems: Problems, registry: &mut Registry) -> Reading {
    if let Some((path, problem)) = problems.first() {
        // It may be in a file that the model imports.
        let other = (problem.file != source_path(id)).then_some(&problem.file);
        let file = other.map_or(path.shown().to_string(), |source| {
            registry.path_on_disk(source).map_or(source.clone(), |path| path.shown().to_string())
        });
        let place = format!("{file}:{}:{}", problem.line, problem.column);
        registry.mark_broken(id, format!("{place}: {}", problem.message));
    }
    Reading::Broken(problems)
}

/// Reads the files in the folder imported by edited shaders, which may do so too.
pub fn import_for_shaders(registry: &mut Registry) -> Problems {
    let sources = registry.sources().clone();
    let edited = sources.edited().filter(|path| !path.starts_with(MODELS));
    edited.flat_map(|path| import(path, sources.get(path).unwrap_or_default(), registry)).collect()
}

/// Reads the files in the folder imported by a text, and their imports, unless they are known.
fn import(path: &str, text: &str, registry: &mut Registry) -> Problems {
    let mut problems = Vec::new();
    let mut looked_at = HashSet::from([path.to_owned()]);
    let mut wanted: Vec<_> = imports_of(path, text).collect();
    while let Some(source) = wanted.pop() {
        let name = source.strip_prefix(MODELS).filter(|name| !name.contains('/') && !name.starts_with('.'));
        let file = name.zip(registry.custom_folder()).map(|(name, folder)| folder.join(name));
        let Some(file) = file.filter(|file| file.extension().is_some_and(|e| e == EXTENSION)) else {
            continue;
        };
        if registry.sources().get(&source).is_some() || !looked_at.insert(source.clone()) || !file.is_file() {
            continue;
        }
        match file::read(&file, &source) {
            Ok(text) => {
                wanted.extend(imports_of(&source, &text));
                registry.sources_mut().edit(source, text);
            }
            Err(problem) => problems.push((file, problem)),
        }
    }
    problems
}

/// A file that was searched for a declaration.
enum Found {
    /// A model.
    Model(Box<CustomModel>),
    /// A model with errors.
    Broken(Vec<ShaderProblem>),
    /// Functions shared by models.
    Shared(String),
}

/// Reads the declarations of all models in a folder, which becomes the registry's folder.
pub fn declare_folder(folder: &Path, registry: &mut Registry) -> Declared {
    registry.set_custom_folder(folder);
    declare_rest(registry)
}

/// Reads the declarations of models in the registry's folder that are still unknown, with shared files. Unchanged files
/// read before are skipped, and so are completely known models.
pub fn declare_rest(registry: &mut Registry) -> Declared {
    let Some(folder) = registry.custom_folder() else { return Declared::default() };
    let (paths, others): (Vec<_>, Vec<_>) = match names_in(folder) {
        Ok(paths) => paths.into_iter().partition(|path| path.is_file()),
        Err(e) => {
            let problem = ShaderProblem {
                file: "models".to_owned(),
                line: 1,
                column: 1,
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
                let found = look(&path, known);
                (path, print, found)
            })
        })
        .collect();
    let files = found.len();
    let mut problems = Problems::new();
    for path in others {
        let Err(problem) = file::read(&path, &named(&path)) else { continue };
        problems.push((path.clone(), problem.clone()));
        if let Some(id) = id_of(&path) {
            broken(id, vec![(path.clone(), problem)], registry);
        }
    }
    let mut kinds: HashMap<_, _> =
        registry.material_parameters().map(|p| (p.name, discriminant(&p.kind))).collect();
    for (path, print, found) in found {
        registry.note_seen(&path, print);
        let wrong = match found {
            Found::Shared(text) => {
                if let Some(id) = id_of(&path).filter(|id| registry.custom_file(id) == Some(&path)) {
                    registry.remove_model(id);
                }
                registry.sources_mut().edit(named(&path), text);
                continue;
            }
            Found::Broken(wrong) => wrong,
            Found::Model(model) => {
                // Each was read as if alone; they must agree on the types of parameters.
                let agrees = model.entry.parameters.iter().all(|p| {
                    let kind = discriminant(&p.kind);
                    *kinds.entry(p.name).or_insert(kind) == kind
                });
                let model = if agrees { Ok(*model) } else { declare(&path, &model.text, registry) };
                match model {
                    Ok(model) => {
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
fn look(path: &Path, registry: &Registry) -> Found {
    match file::read(path, &named(path)) {
        Err(problem) => Found::Broken(vec![problem]),
        Ok(text) if is_model(&text) => match declare(path, &text, registry) {
            Ok(model) => Found::Model(Box::new(model)),
            Err(problems) => Found::Broken(problems),
        },
        // One that was a model is none any more.
        Ok(text) if is_empty(&text) && id_of(path).is_none_or(|id| registry.model(id).is_none()) => {
            Found::Broken(vec![empty(path, &text)])
        }
        Ok(text) => Found::Shared(text),
    }
}
