//! The folder of custom models. A model is known by the name of its file alone, by its declaration, or whole; only
//! as much is read as somebody needs, so that neither many files nor a bad one are in the way of the others.
//!
//! [`read_model`] reads one model whole, [`declare_rest`] the declarations of all others, many at a time. The
//! registry keeps what was read; a file that did not change since is not read again.

use std::{
    collections::{HashMap, HashSet},
    fs, io,
    mem::discriminant,
    path::{Path, PathBuf},
};

use rayon::prelude::*;

use super::{EXTENSION, declare, file, id_of, is_id, is_model, named, read, source_path};
use crate::{
    registry::{CustomModel, Registry},
    shader::{
        check::ShaderProblem,
        compose::{Sources, imports_of},
    },
    watch::Print,
};

/// How the paths of the sources begin that are files of the folder.
const PREFIX: &str = "models/";

/// Problems, each with the file that it is about.
pub type Problems = Vec<(PathBuf, ShaderProblem)>;

/// The outcome of [`read_model`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reading {
    /// The model was known already, all of it.
    Known,
    /// The folder has no model of that id.
    Missing,
    /// The model was read, and the registry knows it.
    Read,
    /// It has mistakes. Why is kept in the registry (see [`Registry::broken_model`]); what was known of the model
    /// stays as it was.
    Broken(Problems),
}

/// The outcome of [`declare_rest`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Declared {
    /// The number of files that were read.
    pub files: usize,
    /// Problems of declarations, of files that cannot be read, and of the folder, in the order of the names.
    pub problems: Problems,
}

/// The WGSL files in a folder, by name; none where there is no folder.
///
/// # Errors
/// When the folder cannot be read.
pub fn files_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(e) => return Err(e),
    };
    let mut files = Vec::new();
    for entry in entries {
        let path = entry?.path();
        let hidden = path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
        if path.extension().is_some_and(|e| e == EXTENSION) && !hidden && path.is_file() {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// Reads the model of that id whole, with the files that it imports, if the folder of the registry has it and the
/// registry does not.
pub fn read_model(id: &str, registry: &mut Registry) -> Reading {
    if registry.model(id).is_some() && registry.unread_file(id).is_none() {
        return Reading::Known;
    }
    let Some(path) = registry.unread_file(id).map(Path::to_owned).or_else(|| file_of(id, registry)) else {
        return Reading::Missing;
    };
    // What is found to be bad is not declared later.
    if let Some(print) = Print::of(&path) {
        registry.note_seen(&path, print);
    }
    let text = match file::read(&path, &named(&path)) {
        Ok(text) => text,
        Err(problem) => return broken(id, vec![(path, problem)], registry),
    };
    if !is_model(&text) && registry.model(id).is_none() {
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

/// The texts of shaders and models with that of one more model, of which so far only the declaration was read.
///
/// # Errors
/// When its file cannot be read.
pub fn sources_with(id: &str, registry: &Registry) -> Result<Sources, ShaderProblem> {
    let mut sources = registry.sources().clone();
    if let Some(path) = registry.unread_file(id) {
        sources.edit(source_path(id), file::read(path, &named(path))?);
    }
    Ok(sources)
}

/// The file of a model that the registry does not know.
fn file_of(id: &str, registry: &Registry) -> Option<PathBuf> {
    let file = registry.custom_folder()?.join(id).with_extension(EXTENSION);
    (is_id(id) && file.is_file()).then_some(file)
}

/// Notes why a file gives no model.
fn broken(id: &str, problems: Problems, registry: &mut Registry) -> Reading {
    if let Some((path, problem)) = problems.first() {
        let place = format!("{}:{}:{}", path.display(), problem.line, problem.column);
        registry.mark_broken(id, format!("{place}: {}", problem.message));
    }
    Reading::Broken(problems)
}

/// Reads the files of the folder that edited shaders import, since shaders may do that too.
pub fn import_for_shaders(registry: &mut Registry) -> Problems {
    let sources = registry.sources().clone();
    let edited = sources.edited().filter(|path| !path.starts_with(PREFIX));
    edited.flat_map(|path| import(path, sources.get(path).unwrap_or_default(), registry)).collect()
}

/// Reads the files of the folder that a text imports, and those that these import, unless they are known.
fn import(path: &str, text: &str, registry: &mut Registry) -> Problems {
    let mut problems = Vec::new();
    let mut looked_at = HashSet::from([path.to_owned()]);
    let mut wanted: Vec<_> = imports_of(path, text).collect();
    while let Some(source) = wanted.pop() {
        let name = source.strip_prefix(PREFIX).filter(|name| !name.contains('/') && !name.starts_with('.'));
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

/// A file whose declaration was looked for.
enum Found {
    /// A model.
    Model(Box<CustomModel>),
    /// A model with mistakes.
    Broken(Vec<ShaderProblem>),
    /// Functions that models share.
    Shared(String),
}

/// Reads the declarations of all models in a folder, which is that of the registry from now on.
pub fn declare_folder(folder: &Path, registry: &mut Registry) -> Declared {
    registry.set_custom_folder(folder);
    declare_rest(registry)
}

/// Reads the declarations of the models that the registry does not know, from its folder, with what models share.
/// Files that were read before are passed over if they did not change, and so are models that are known whole.
pub fn declare_rest(registry: &mut Registry) -> Declared {
    let Some(folder) = registry.custom_folder() else { return Declared::default() };
    let paths = match files_in(folder) {
        Ok(paths) => paths,
        Err(e) => {
            let problem = ShaderProblem {
                file: "models".to_owned(),
                line: 1,
                column: 1,
                source: String::new(),
                message: format!("the folder could not be read: {e}"),
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
    let mut problems = Vec::new();
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
                // Each was read as if it were alone; what they must agree on is the types of parameters.
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
    Declared { files, problems }
}

/// Looks for a declaration in a file.
fn look(path: &Path, registry: &Registry) -> Found {
    match file::read(path, &named(path)) {
        Err(problem) => Found::Broken(vec![problem]),
        Ok(text) if is_model(&text) => match declare(path, &text, registry) {
            Ok(model) => Found::Model(Box::new(model)),
            Err(problems) => Found::Broken(problems),
        },
        Ok(text) => Found::Shared(text),
    }
}
