//! The files from which the registry was read: folders, custom models, and how much of each file was read.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{Folders, MODELS, Registry, put};
use crate::{platform::fs, reflection::ModelEntry, watch::Print};

/// A model from a file.
#[derive(Clone, Debug)]
pub struct CustomModel {
    /// The entry. The [`Source`](crate::shader::Source) is `models/ID.wgsl`; the text built into that is a
    /// fallback, drawn as long as the file has no valid version.
    pub entry: ModelEntry,
    /// The file.
    pub path: PathBuf,
    /// The text, including the declaration, so that line numbers match the file.
    pub text: Arc<str>,
}

/// The part of a custom model that was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The declaration. The rest is read when the model is used; until then a fallback is drawn.
    Declaration,
    /// The declaration. The rest is invalid: the last valid text is drawn, or a fallback.
    StandIn,
    /// The whole file.
    Whole,
}

/// The file of a custom model.
#[derive(Clone, Debug)]
struct CustomSource {
    path: PathBuf,
    extent: Extent,
}

/// The files of shaders and custom models.
#[derive(Clone, Debug, Default)]
pub(super) struct Files {
    pub(super) folders: Folders,
    /// The source paths of WGSL compiled into other crates.
    pub(super) foreign: BTreeSet<&'static str>,
    /// The files of custom models, by id.
    custom: BTreeMap<&'static str, CustomSource>,
    /// The errors of files without a valid model, by id.
    broken: BTreeMap<String, String>,
    /// The state of each file when its declaration was looked for.
    seen: BTreeMap<PathBuf, Print>,
}

impl Registry {
    /// The folders from which shaders and custom models are read.
    #[must_use]
    pub fn folders(&self) -> &Folders {
        &self.files.folders
    }

    /// Sets the folder from which shaders are read.
    pub fn set_shader_folder(&mut self, folder: &Path) {
        self.files_mut().folders.shaders = Some(folder.to_owned());
    }

    /// True if other crates compiled in WGSL.
    #[must_use]
    pub fn has_foreign(&self) -> bool {
        !self.files.foreign.is_empty()
    }

    /// True if the WGSL of a source path was compiled in by another crate, and is not covered by this crate's
    /// tests.
    #[must_use]
    pub fn is_foreign(&self, source: &str) -> bool {
        self.files.foreign.contains(source)
    }

    /// The existing file for a source path.
    #[must_use]
    pub fn path_on_disk(&self, source: &str) -> Option<PathBuf> {
        let custom = self
            .custom_models()
            .find(|(m, _)| m.declaration.wgsl.path == source)
            .map(|(_, path)| path.to_owned());
        let below_shaders = || Some(self.folders().shaders.as_ref()?.join(source));
        custom.or_else(|| {
            let files = [self.folders().file_of(source), below_shaders()];
            files.into_iter().flatten().find(|file| fs::is_file(file))
        })
    }

    /// The files from which the registry was read: custom models and edited shaders.
    pub fn files_on_disk(&self) -> impl Iterator<Item = PathBuf> {
        let models = self.custom_models().map(|(_, path)| path.to_owned());
        // Searching all files for each of many models would take a while.
        let shaders = self.sources().edited().filter_map(|source| match source.strip_prefix(MODELS) {
            Some(file) => Some(self.custom_folder()?.join(file)),
            None => self.path_on_disk(source),
        });
        models.chain(shaders)
    }

    /// Adds a model from a file, with its text. A model with the same id is replaced in its place.
    pub fn put_custom_model(&mut self, model: CustomModel) {
        self.sources.edit(model.entry.declaration.wgsl.path, model.text.clone());
        self.put_custom(model, Extent::Whole);
    }

    /// Adds a model from a file without a valid text: a known text is kept; otherwise a fallback is drawn.
    pub fn put_stand_in(&mut self, model: CustomModel) {
        self.put_custom(model, Extent::StandIn);
    }

    /// Adds a model from a file of which only the declaration was read. A fallback is drawn until the rest is
    /// read, which [`wants_reading`](Self::wants_reading) requests.
    pub fn put_declared(&mut self, model: CustomModel) {
        self.sources.forget(model.entry.declaration.wgsl.path);
        self.put_custom(model, Extent::Declaration);
    }

    fn put_custom(&mut self, model: CustomModel, extent: Extent) {
        let id = model.entry.declaration.id;
        let files = self.files_mut();
        files.broken.remove(id);
        files.custom.insert(id, CustomSource { path: model.path, extent });
        put(Arc::make_mut(&mut self.models), model.entry, |m| m.declaration.id);
    }

    /// Sorts the custom models by id, whatever the order of reading.
    pub(crate) fn sort_custom_models(&mut self) {
        let is_custom = |m: &ModelEntry| self.files.custom.contains_key(m.declaration.id);
        let places: Vec<_> = (0..self.models.len()).filter(|i| is_custom(&self.models[*i])).collect();
        let mut custom: Vec<_> = places.iter().map(|i| self.models[*i].clone()).collect();
        custom.sort_by_key(|m| m.declaration.id);
        for (place, model) in places.into_iter().zip(custom) {
            Arc::make_mut(&mut self.models)[place] = model;
        }
    }

    pub(super) fn files_mut(&mut self) -> &mut Files {
        Arc::make_mut(&mut self.files)
    }

    /// Removes a model, and its text if it came from a file.
    pub fn remove_model(&mut self, id: &str) {
        let Some(at) = self.models.iter().position(|m| m.declaration.id == id) else { return };
        let model = Arc::make_mut(&mut self.models).remove(at);
        if self.files_mut().custom.remove(id).is_some() {
            self.sources.forget(model.declaration.wgsl.path);
        }
    }

    /// The file of a custom model.
    #[must_use]
    pub fn custom_file(&self, id: &str) -> Option<&Path> {
        self.files.custom.get(id).map(|custom| custom.path.as_path())
    }

    /// The part of a custom model's file that was read.
    #[must_use]
    pub fn extent(&self, id: &str) -> Option<Extent> {
        self.files.custom.get(id).map(|custom| custom.extent)
    }

    /// The file of a model of which only the declaration was read.
    #[must_use]
    pub fn unread_file(&self, id: &str) -> Option<&Path> {
        self.custom_file(id).filter(|_| self.extent(id) == Some(Extent::Declaration))
    }

    /// The files to read now that these models are used, because only their declarations are known. See
    /// [`custom::read`](crate::custom::read).
    pub fn wants_reading<'a>(
        &'a self,
        used: impl IntoIterator<Item = &'a str>,
    ) -> impl Iterator<Item = &'a Path> {
        used.into_iter().filter_map(|id| self.unread_file(id))
    }

    /// The state of each file when its declaration was looked for.
    pub(crate) fn files_seen(&self) -> &BTreeMap<PathBuf, Print> {
        &self.files.seen
    }

    /// Records the state of a file whose declaration is looked for.
    pub(crate) fn note_seen(&mut self, file: &Path, print: Print) {
        self.files_mut().seen.insert(file.to_owned(), print);
    }

    /// The models from files, each with its file.
    pub fn custom_models(&self) -> impl Iterator<Item = (&ModelEntry, &Path)> {
        self.models.iter().filter_map(|m| Some((m, self.custom_file(m.declaration.id)?)))
    }

    /// Sets the folder from which custom models are read.
    pub fn set_custom_folder(&mut self, folder: &Path) {
        self.files_mut().folders.models = Some(folder.to_owned());
    }

    /// The folder from which custom models are read, if any.
    #[must_use]
    pub fn custom_folder(&self) -> Option<&Path> {
        self.folders().models.as_deref()
    }

    /// Records the reason why the file with this id contains no valid model.
    pub fn mark_broken(&mut self, id: &str, why: String) {
        self.files_mut().broken.insert(id.to_owned(), why);
    }

    /// The reason why the file with this id contains no valid model: position and error.
    #[must_use]
    pub fn broken_model(&self, id: &str) -> Option<&str> {
        self.files.broken.get(id).map(String::as_str)
    }
}
