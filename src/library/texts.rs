//! The texts of files: read when they change, and passed to the registry when they are valid.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use web_time::Instant;

use super::{
    assets::{built_in_sources, shipped},
    problem::Problem,
    reading::{Done, Job, Reader},
    status::Reloaded,
};
use crate::{
    custom,
    platform::fs,
    reflection::{Ambient, ModelEntry},
    registry::{CustomModel, Extent, MODELS, Registry, compose::compose_evaluation},
    shader::{
        check::ShaderProblem,
        compose::{Composed, Sources},
    },
};

/// The texts of shader files and custom models as they change.
///
/// The text of a shader file goes into the registry at once, and the shaders that contain it are tried. A
/// custom model is read, then tried by the renderer, and goes into the registry when it is valid: parameters
/// and text together.
#[derive(Default)]
pub struct Library {
    /// The last valid text of each file.
    good: Sources,
    /// The texts of custom models that are being read, wait to be tried, or have errors.
    pending: Sources,
    reader: Reader,
    /// Custom models that were read and must still be tried.
    arriving: Vec<CustomModel>,
    /// Unreadable files and custom models with errors, by source path.
    unusable: BTreeMap<String, Problem<Vec<ShaderProblem>>>,
    /// The file that changed last, and the time of the notification.
    change: Option<(String, Instant)>,
    /// True if the unusable files have changed since the last [`take_news`](Self::take_news).
    news: bool,
}

impl Library {
    /// Reads a file that may have changed; others than shaders are passed over. Returns the source path of a shader
    /// file, or of one that models share, if it has another text now. `drawn` tells by id which models were drawn.
    pub fn reread(
        &mut self,
        file: &Path,
        registry: &mut Registry,
        drawn: impl Fn(&str) -> bool,
    ) -> Option<String> {
        let source = registry.folders().source_of(file)?;
        let of_extension = || registry.folders().extensions.iter().any(|folder| file.starts_with(folder));
        let of_lab = || registry.folders().shaders.as_ref().is_some_and(|folder| file.starts_with(folder));
        if of_extension() && !of_lab() && shipped(registry).contains(source.as_str()) {
            return None;
        }
        let in_folder = source.strip_prefix(MODELS).is_some_and(|name| !name.contains('/'));
        let id = custom::id_of(file).filter(|_| in_folder);
        let registered = id.is_some_and(|id| registry.custom_file(id).is_some());
        let read = if source.starts_with(MODELS) { custom::file::read_model } else { custom::file::read };
        let text = match read(file, &source) {
            Ok(text) => text,
            Err(problem) => {
                self.pending.forget(&source);
                let used = registered || registry.sources().get(&source).is_some();
                if used || built_in(registry, &source).is_some() {
                    self.cannot_use(&source, vec![problem]);
                } else {
                    // Nothing was made of it, so nothing is missed.
                    self.mend(&source);
                }
                return None;
            }
        };
        if id.is_none() || !custom::is_model(&text) {
            self.pending.forget(&source);
            return self.change(source, text, registry, drawn);
        }
        let unusable = self.unusable.contains_key(&source);
        let in_use = registered && registry.sources().get(&source) == Some(text.as_str());
        if !unusable && self.pending.get(&source) == Some(text.as_str()) {
            // It is being read or tried.
        } else if !unusable && in_use {
            self.pending.forget(&source);
            self.arriving.retain(|model| model.entry.declaration.wgsl.path != source);
        } else {
            self.pending.edit(source.clone(), text);
            self.read_pending(&source, registry);
        }
        None
    }

    /// Stores a changed text of a file in the registry. Returns its source path if it differs from the known
    /// text.
    fn change(
        &mut self,
        source: String,
        text: String,
        registry: &mut Registry,
        drawn: impl Fn(&str) -> bool,
    ) -> Option<String> {
        self.mend(&source);
        let built_in = built_in(registry, &source);
        if registry.sources().get(&source).or(built_in) == Some(text.as_str()) {
            return None;
        }
        if built_in == Some(text.as_str()) {
            registry.sources_mut().forget(&source);
        } else {
            registry.sources_mut().edit(source.clone(), text);
        }
        self.read_again(&source, registry, drawn);
        self.change = Some((source.clone(), Instant::now()));
        Some(source)
    }

    /// Reads the custom models again that a change of another file may fix or alter. Models that only share
    /// its functions need it if the CPU calculates their response to uniform light, and they were drawn.
    fn read_again(&mut self, changed: &str, registry: &mut Registry, drawn: impl Fn(&str) -> bool) {
        let concerned = |model: &ModelEntry| {
            let composed = compose_evaluation(registry.sources(), model);
            composed.imports.contains(changed)
                || (model.declaration.ambient == Ambient::Albedo
                    && composed.depends_on(changed)
                    && drawn(model.declaration.id))
        };
        let again: BTreeSet<_> = registry
            .custom_models()
            .map(|(model, _)| model)
            .filter(|model| {
                let source = model.declaration.wgsl.path;
                let whole = registry.extent(model.declaration.id) == Some(Extent::Whole)
                    && registry.sources().get(source).is_some_and(custom::is_model);
                let known = whole && !self.unusable.contains_key(source);
                source != changed && (known || self.pending.get(source).is_some()) && concerned(model)
            })
            .map(|model| model.declaration.wgsl.path.to_owned())
            .chain(self.pending.edited().filter(|s| self.unusable.contains_key(*s)).map(str::to_owned))
            .collect();
        for source in again {
            if self.pending.get(&source).is_none() {
                self.pending.copy_from(registry.sources(), &source);
            }
            self.read_pending(&source, registry);
        }
    }

    /// Reads a custom model. Errors leave the known version unchanged.
    fn read_pending(&mut self, source: &str, registry: &mut Registry) {
        let Some((file, text)) = registry.folders().file_of(source).zip(self.pending.get(source)) else {
            return;
        };
        let job = Job {
            source: source.to_owned(),
            file,
            text: text.to_owned(),
            registry: registry.clone(),
            lenient: self.lenient(registry),
        };
        self.arriving.retain(|model| model.entry.declaration.wgsl.path != source);
        if let Some(done) = self.reader.read(job) {
            self.take_read(done, registry);
        }
    }

    /// Handles the result of reading a custom model, unless its file has changed again.
    fn take_read(&mut self, done: Done, registry: &mut Registry) {
        if self.pending.get(&done.source) != Some(done.text.as_str()) {
            return;
        }
        match done.result {
            Ok(model) => {
                self.change = Some((done.source, Instant::now()));
                self.arriving.push(model);
            }
            Err(problems) => self.refuse(&done.source, problems, registry),
        }
    }

    /// Handles the results of the thread that reads custom models.
    pub fn take_finished(&mut self, registry: &mut Registry) {
        for done in self.reader.finished() {
            self.take_read(done, registry);
        }
    }

    /// The files of used models of which only the declaration is known, except those being read or with
    /// errors.
    pub fn wanted<'a>(&self, used: impl Iterator<Item = &'a str>, registry: &Registry) -> Vec<PathBuf> {
        let is_new = |file: &Path| {
            let source = registry.folders().source_of(file);
            source.is_some_and(|source| self.pending.get(&source).is_none())
        };
        let used: BTreeSet<_> = used.collect();
        registry.wants_reading(used).filter(|file| is_new(file)).map(Path::to_owned).collect()
    }

    /// The next custom models to try, up to this number. Each must then be [adopted](Self::adopt),
    /// [refused](Self::refuse) or [kept for later](Self::try_later).
    pub fn next_arriving(&mut self, most: usize) -> Vec<CustomModel> {
        self.arriving.drain(..most.min(self.arriving.len())).collect()
    }

    /// Accepts a custom model that is valid.
    pub fn adopt(&mut self, model: CustomModel, registry: &mut Registry) {
        let source = model.entry.declaration.wgsl.path;
        self.mend(source);
        self.pending.forget(source);
        registry.put_custom_model(model);
    }

    /// Rejects a custom model with errors. A new model with a valid declaration can still be selected, and is
    /// drawn with the fallback.
    pub fn refuse(&mut self, source: &str, problems: Vec<ShaderProblem>, registry: &mut Registry) {
        if let Some((file, text)) = registry.folders().file_of(source).zip(self.pending.get(source))
            && custom::id_of(&file).is_some_and(|id| registry.custom_file(id).is_none())
            && let Ok(model) = custom::declare(&file, text, registry)
        {
            registry.put_stand_in(model);
        }
        self.cannot_use(source, problems);
    }

    /// Keeps a custom model that cannot be tried yet.
    pub fn try_later(&mut self, model: CustomModel) {
        self.arriving.push(model);
    }

    /// True while a model known only by its declaration is being read or tried.
    #[must_use]
    pub fn is_arriving(&self, model: &ModelEntry, registry: &Registry) -> bool {
        let source = model.declaration.wgsl.path;
        registry.unread_file(model.declaration.id).is_some()
            && self.pending.get(source).is_some()
            && !self.unusable.contains_key(source)
    }

    /// Moves the reading of custom models to a separate thread, which calls `wake`.
    pub fn read_apart(&mut self, wake: impl Fn() + Send + 'static) {
        self.reader = Reader::apart(wake);
    }

    /// True while a thread reads custom models, and will call `wake`.
    #[must_use]
    pub fn is_reading(&self) -> bool {
        self.reader.is_reading()
    }

    /// True while custom models are read or wait to be tried.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.reader.is_busy() || !self.arriving.is_empty()
    }

    /// The text of a custom model that is not in use.
    pub(super) fn pending(&self, source: &str) -> Option<&str> {
        self.pending.get(source)
    }

    /// Records that the files of a composed source are valid.
    pub fn note_good(&mut self, composed: &Composed, registry: &Registry) {
        composed.map.files().for_each(|source| self.good.copy_from(registry.sources(), source));
    }

    /// The last valid texts.
    #[must_use]
    pub fn good(&self) -> &Sources {
        &self.good
    }

    /// The present texts, but with the last valid version of shared files.
    #[must_use]
    pub fn lenient(&self, registry: &Registry) -> Sources {
        let mut sources = registry.sources().clone();
        for source in registry.sources().edited().filter(|source| !source.starts_with(MODELS)) {
            sources.copy_from(&self.good, source);
        }
        sources
    }

    /// True if a composed source contains only texts shipped with this crate, which are covered by tests.
    #[must_use]
    pub fn is_built_in(&self, composed: &Composed, registry: &Registry) -> bool {
        let edited =
            |source: &str| registry.sources().get(source).is_some() || self.good.get(source).is_some();
        let tried = |source: &str| !edited(source) && !registry.is_foreign(source);
        composed.map.files().all(tried) && composed.problem.is_none()
    }

    /// The source path of the file that changed last.
    #[must_use]
    pub fn changed(&self) -> Option<&str> {
        self.change.as_ref().map(|(source, _)| source.as_str())
    }

    /// The last change, marked as having taken effect now.
    #[must_use]
    pub fn reloaded(&self) -> Option<Reloaded> {
        let (file, since) = self.change.as_ref()?;
        Some(Reloaded { file: file.clone(), milliseconds: since.elapsed().as_secs_f32() * 1e3 })
    }

    /// The unusable files, by source path.
    pub fn unusable(&self) -> impl Iterator<Item = (&str, &Problem<Vec<ShaderProblem>>)> {
        self.unusable.iter().map(|(source, problem)| (source.as_str(), problem))
    }

    /// The source paths of unusable files that are neither on disk nor built in.
    pub fn gone(&self, registry: &Registry) -> impl Iterator<Item = &str> {
        let is_gone =
            |source: &str| registry.folders().file_of(source).is_some_and(|file| !fs::is_there(file));
        self.unusable
            .keys()
            .map(String::as_str)
            .filter(move |source| is_gone(source) && built_in(registry, source).is_none())
    }

    /// Forgets a missing file, and the model in it.
    pub fn forget(&mut self, source: &str, registry: &mut Registry) {
        registry.remove_model(model_of(source).unwrap_or_default());
        registry.sources_mut().forget(source);
        self.mend(source);
    }

    /// True if the unusable files have changed since the last call.
    pub fn take_news(&mut self) -> bool {
        std::mem::take(&mut self.news)
    }

    /// True if [`take_news`](Self::take_news) would return true.
    #[must_use]
    pub fn has_news(&self) -> bool {
        self.news
    }

    fn cannot_use(&mut self, source: &str, problems: Vec<ShaderProblem>) {
        let before = self.unusable.get(source);
        self.news |= before.is_none_or(|before| before.what != problems);
        let problem = Problem::after(before, problems);
        self.unusable.insert(source.to_owned(), problem);
    }

    fn mend(&mut self, source: &str) {
        self.news |= self.unusable.remove(source).is_some();
    }
}

/// The id of the custom model with this source path.
#[must_use]
pub(crate) fn model_of(source: &str) -> Option<&str> {
    custom::id_of(Path::new(source)).filter(|_| source.starts_with(MODELS))
}

/// The built-in text with this source path.
fn built_in(registry: &Registry, source: &str) -> Option<&'static str> {
    built_in_sources(registry).into_iter().find(|s| s.path == source).map(|s| s.text)
}
