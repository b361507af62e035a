//! Shaders and custom models on disk: where commands find them, and messages about errors in them.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::Arc,
};

use clap::Args;

use super::{Options, Outcome, complain};
use crate::files::Shown as _;
use crate::{
    custom::folder::{self, Reading},
    export::payload::{Payload, PayloadError},
    failure::Failure,
    library::assets::{self, Folders},
    program::{HAS_WINDOW, without_window},
    reflection::ModelEntry,
    registry::{Registry, check::wgsl, compose::compose},
    scene::{
        Scene,
        error::LoadError,
        load::{self, Defaults, Loaded},
    },
    shader::{check::ShaderProblem, report::annotated, whole::validate_drawing},
    shading::Stage,
};

/// The folders of shaders and custom models.
#[derive(Args, Clone, Debug)]
pub(super) struct Places {
    /// Read shaders from FOLDER/shaders instead of the built-in ones, and custom models from FOLDER/models
    #[arg(long, global = true, value_name = "FOLDER")]
    assets: Option<PathBuf>,
    /// Read custom models from this folder
    #[arg(long, global = true, value_name = "FOLDER")]
    models: Option<PathBuf>,
    /// The scene inside this program, and what it needs.
    #[arg(skip)]
    inside: Option<Arc<Payload>>,
}

/// A word quoted for a shell.
fn pasted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/:._-+,@".contains(c) || cfg!(windows) && c == '\\';
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// The known models and shaders, and their sources. The folder of custom models is read only as far as a
/// command needs.
pub(super) struct Workshop {
    pub registry: Registry,
    /// The scene inside this program.
    pub inside: Option<Arc<Payload>>,
    pub(super) options: Options,
    /// True for a window, which draws broken models with the fallback, and reports them itself.
    for_window: bool,
    /// The ids whose files were read, or do not exist.
    tried: BTreeSet<String>,
}

impl Workshop {
    /// Reads the model with this id. If it does not exist, the declarations of all are read, so that messages
    /// can list them.
    pub(super) fn need(&mut self, id: &str) {
        self.read(id);
        if self.registry.model(id).is_none() && self.registry.broken_model(id).is_none() {
            self.declare_rest();
        }
    }

    /// Reads the model with this id, unless read before. True if more is known now.
    fn read(&mut self, id: &str) -> bool {
        if !self.tried.insert(id.to_owned()) {
            return false;
        }
        match folder::read_model(id, &mut self.registry) {
            Reading::Known | Reading::Missing => false,
            Reading::Read => {
                let file = self.registry.custom_file(id).unwrap_or(Path::new(id));
                self.options.detail(format_args!("read {}", file.shown()));
                true
            }
            Reading::Broken(_) if self.for_window => false,
            Reading::Broken(problems) => {
                complain(all_annotated(&problems));
                self.registry.remove_model(id);
                // The problems have been reported by now; their position is as good as a name.
                if let Some((path, first)) = problems.first() {
                    let file = folder::file_with(first, path);
                    self.registry.mark_broken(id, first.place(file.shown()));
                }
                true
            }
        }
    }

    /// Reads the declarations of all models not yet known. Returns whether there were any, and the problems
    /// of files. An unreadable folder is reported at once.
    fn declare_rest(&mut self) -> (bool, folder::Problems) {
        let found = folder::declare_rest(&mut self.registry);
        let is_folder = |path: &Path| Some(path) == self.registry.custom_folder();
        let (of_folder, of_files): (Vec<_>, Vec<_>) =
            found.problems.into_iter().partition(|(path, _)| is_folder(path));
        report(&of_folder);
        if found.files > 0 {
            self.options.detail(format_args!("looked for declarations in {} files", found.files));
        }
        (found.files > 0, of_files)
    }

    /// Reads all declarations for a command that needs them, and reports their problems.
    pub(super) fn list(&mut self) -> &Registry {
        report(&self.declare_rest().1);
        &self.registry
    }

    /// Reads the declarations of all custom models, and reports their problems. True if there are any.
    pub(super) fn declare_all(&mut self) -> bool {
        report(&folder::declare_rest(&mut self.registry).problems)
    }

    /// Reads all custom models completely, and reports their problems; if there are very many, only their
    /// declarations. True if there are any.
    pub(super) fn read_all(&mut self) -> bool {
        /// Maximum number; each takes about 15 ms.
        const MOST: usize = 64;
        let ids: Vec<_> = self.registry.custom_models().map(|(model, _)| model.declaration.id).collect();
        if ids.len() > MOST {
            self.options.tell(format_args!(
                "only the declarations of {} custom models were read; `lcm models check ID` checks a whole model",
                ids.len()
            ));
            return false;
        }
        for id in &ids {
            self.read(id);
        }
        self.registry.custom_models().count() < ids.len()
    }

    /// Reads a scene from the contents of a file, with the custom models that it names. The declarations of
    /// others are read only if there are problems: the scene may have parameters that they declare, and
    /// messages list them.
    pub(super) fn load(&mut self, bytes: &[u8], name: &str, defaults: Defaults) -> Result<Loaded, LoadError> {
        self.load_in(bytes, (name, Path::new(name).parent().unwrap_or(Path::new(""))), defaults)
    }

    /// Like [`load`](Self::load), with the folder of the files named in the scene.
    pub(super) fn load_in(
        &mut self,
        bytes: &[u8],
        (name, folder): (&str, &Path),
        defaults: Defaults,
    ) -> Result<Loaded, LoadError> {
        loop {
            let how = defaults.allowing(self.options.outside());
            let loaded = load::in_folder(bytes, (name, folder), &self.registry, how);
            let named: BTreeSet<String> = match &loaded {
                Ok(loaded) => loaded.scene.models().into_iter().map(str::to_owned).collect(),
                Err(LoadError::Invalid { .. } | LoadError::Missing { .. }) => {
                    load::models_named(bytes, name, &self.registry)
                }
                Err(_) => return loaded,
            };
            // Each is read, even if the first brings something new.
            let read = named.iter().filter(|id| self.read(id)).count() > 0;
            let rest = || matches!(loaded, Err(LoadError::Invalid { .. }));
            let more = read || rest() && self.declare_rest().0;
            if !more {
                return loaded;
            }
        }
    }
}

impl Places {
    /// The folders as given on the command line, to be repeated in another: each with a space before it.
    pub(super) fn flags(&self) -> String {
        [("--assets", &self.assets), ("--models", &self.models)]
            .into_iter()
            .filter_map(|(flag, folder)| {
                Some(format!(" {flag} {}", pasted(&folder.as_ref()?.to_string_lossy())))
            })
            .collect()
    }

    /// The folders, in a program with a scene inside.
    pub(super) fn with(self, inside: Option<Payload>) -> Self {
        Self { inside: inside.map(Arc::new), ..self }
    }

    /// The folders. In a program that carries a scene, its shaders and models take the place of `--assets`.
    pub(super) fn folders(&self) -> Result<Folders, Failure> {
        let find = |assets: Option<&Path>| {
            Folders::find(assets, self.models.as_deref()).map_err(|e| Failure::Usage(e.to_string()))
        };
        let (None, Some(inside)) = (self.assets.as_deref(), &self.inside) else {
            return find(self.assets.as_deref());
        };
        let carried = files_inside(inside)?;
        let below = |name: &str| carried.as_ref().map(|folder| folder.join(name)).filter(|f| f.is_dir());
        let usual = || assets::data_folder().map(|data| data.join("models"));
        let models = self.models.clone().or_else(|| below("models")).or_else(usual);
        Ok(Folders { shaders: below("shaders"), models, extensions: Vec::new() })
    }

    /// Reads the shaders, for a registry that knows everything except custom models; an unreadable shader is
    /// an error. Custom models are read when they are needed.
    pub(super) fn open(&self, options: Options, known: Registry) -> Result<Workshop, Failure> {
        if let Some(named) = self.models.as_deref().filter(|m| !m.exists()) {
            return Err(Failure::Usage(format!("there is no folder {} for --models", named.shown())));
        }
        self.open_for_writing(options, known)
    }

    /// Like [`open`](Self::open), for commands that create the folder of custom models.
    pub(super) fn open_for_writing(
        &self,
        options: Options,
        mut registry: Registry,
    ) -> Result<Workshop, Failure> {
        let folders = self.folders()?;
        if let Some(models) = &folders.models {
            registry.set_custom_folder(models);
        }
        if let Some(shaders) = &folders.shaders {
            assets::read_shaders(shaders, &mut registry)
                .map_err(|problems| Failure::Invalid(all_annotated(&problems)))?;
            report(&folder::import_for_shaders(&mut registry));
        }
        assets::read_extensions(&mut registry)
            .map_err(|problems| Failure::Invalid(all_annotated(&problems)))?;
        Ok(self.workshop(registry, options, false))
    }

    fn workshop(&self, registry: Registry, options: Options, for_window: bool) -> Workshop {
        let inside = self.inside.clone();
        Workshop { registry, inside, options, for_window, tried: BTreeSet::new() }
    }

    /// Reads what a window needs at the start: the declarations of all custom models, since it lists them.
    /// Models that its scene does not use are drawn with the fallback until they are read, and so are broken
    /// ones. No problem prevents the window from opening.
    pub(super) fn open_for_window(
        &self,
        options: Options,
        mut registry: Registry,
    ) -> Result<Workshop, Failure> {
        let folders = self.folders()?;
        if let Some(shaders) = &folders.shaders {
            registry.set_shader_folder(shaders);
        }
        if let Some(models) = &folders.models {
            // The window reports problems itself.
            let _ = folder::declare_folder(models, &mut registry);
        }
        Ok(self.workshop(registry, options, true))
    }
}

/// The folder of the files carried by this program; `None` if there are none.
pub(super) fn files_inside(inside: &Payload) -> Result<Option<PathBuf>, Failure> {
    let within = assets::data_folder().map_or_else(std::env::temp_dir, |data| data.join("inside"));
    inside.folder(&within).map_err(|error| match error {
        PayloadError::Packed { .. } => {
            Failure::Write(format!("{error}; set {} to use another folder", assets::DATA_VARIABLE))
        }
        error => Failure::Invalid(error.to_string()),
    })
}

/// Prints problems. True if there are any.
fn report(problems: &[(PathBuf, ShaderProblem)]) -> bool {
    if !problems.is_empty() {
        complain(all_annotated(problems));
    }
    !problems.is_empty()
}

/// Problems, one below the other.
pub(super) fn all_annotated(problems: &[(PathBuf, ShaderProblem)]) -> String {
    let mut each: Vec<_> = problems
        .iter()
        .map(|(path, problem)| annotated(problem, &folder::file_with(problem, path).shown().to_string()))
        .collect();
    each.dedup();
    each.join("\n")
}

/// The failure for a model that the CPU cannot run, with an alternative.
pub(super) fn not_on_cpu(model: &ModelEntry, why: &str, instead: &str) -> Failure {
    let id = model.declaration.id;
    if model.runs_too_long() {
        // The GPU would not be asked to run it either.
        return Failure::Invalid(format!("{id} cannot be run: {why}"));
    }
    let remedy = if HAS_WINDOW { format!("use {instead}") } else { without_window("the GPU could run it") };
    Failure::NoRenderer(format!(
        "{id} cannot be run on the CPU, which interprets custom models: {why}; {remedy}"
    ))
}

/// The file on disk from which a source was read, for messages.
pub(super) fn on_disk(registry: &Registry, file: &str) -> String {
    registry.path_on_disk(file).map_or_else(|| file.to_owned(), |path| path.shown().to_string())
}

/// Fails if the shader of a model, from files on disk or from another crate, is invalid. Shipped shaders are
/// valid.
pub(super) fn valid(registry: &Registry, model: &ModelEntry) -> Outcome {
    if registry.sources().edited().next().is_none() && !registry.is_foreign(model.declaration.wgsl.path) {
        return Ok(());
    }
    wgsl::model(registry.sources(), model).map(drop).map_err(|problem| invalid(registry, &problem))
}

/// The failure for an invalid shader.
pub(super) fn invalid(registry: &Registry, problem: &ShaderProblem) -> Failure {
    Failure::Invalid(annotated(problem, &on_disk(registry, &problem.file)))
}

/// Fails if a shader for a scene, from files on disk or from another crate, is invalid.
pub(super) fn drawable(registry: &Registry, scene: &Scene) -> Outcome {
    match shader_problems(registry, scene).into_iter().next() {
        Some((_, problem)) => Err(invalid(registry, &problem)),
        None => Ok(()),
    }
}

/// The problems of the shaders for a scene, each with the first object drawn with it.
pub(super) fn shader_problems(registry: &Registry, scene: &Scene) -> Vec<(usize, ShaderProblem)> {
    if registry.sources().edited().next().is_none() && !registry.has_foreign() {
        return Vec::new();
    }
    let lights = registry.lights_in(scene.light_types(registry));
    let mut pairs = BTreeMap::new();
    for (i, object) in scene.objects.iter().enumerate() {
        let id = scene.model_of(object);
        let passage = registry.model(id).map(|model| model.passage(&object.material));
        pairs.entry((id, passage.unwrap_or_default(), scene.shading_model_of(object))).or_insert(i);
    }
    let mut problems: Vec<(usize, ShaderProblem)> = Vec::new();
    for ((model, passage, shading), i) in pairs {
        let (Some(model), Some(shading)) = (registry.model(model), registry.shading_model(shading)) else {
            continue;
        };
        let composed = compose(registry.sources(), (model, passage), shading, &lights);
        let faces = shading.declaration.stage == Stage::Polygon;
        if let Err(problem) = validate_drawing(&composed, faces) {
            let problem = wgsl::blamed(problem, registry, model, shading, &lights);
            // The same model has it under several shading models.
            if !problems.iter().any(|(_, known)| *known == *problem) {
                problems.push((i, *problem));
            }
        }
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_repeated_so_that_a_shell_takes_them() {
        let flags = |assets: Option<&str>, models: Option<&str>| {
            Places { assets: assets.map(PathBuf::from), models: models.map(PathBuf::from), inside: None }
                .flags()
        };
        assert_eq!(flags(None, None), "");
        assert_eq!(flags(Some("assets"), None), " --assets assets");
        assert_eq!(flags(Some("../a b"), Some("Mira's")), r" --assets '../a b' --models 'Mira'\''s'");
    }

    #[test]
    fn wrong_wgsl_of_another_crate_fails_with_file_and_line() {
        use crate::{
            optics::{Frame, Terms},
            parameters,
            reflection::{Declaration, ReflectionModel},
            registry::Register as _,
            shader::Source,
        };
        parameters! {
            struct Guest {}
        }
        impl ReflectionModel for Guest {
            const DECLARATION: Declaration =
                Declaration::new("guest", "Guest", Source::new("guest.wgsl", "// mine\nfn respond() {}\n"));
            fn response(&self, _: glam::Vec3, _: glam::Vec3, _: &Frame) -> Terms {
                Terms::default()
            }
        }
        let mut registry = Registry::builtin();
        registry.add_reflection_model::<Guest>();
        let scene = |id: &str| Scene { reflection_model: id.to_owned(), ..Scene::default() };
        assert!(drawable(&registry, &scene("phong")).is_ok(), "it is not used");
        let guest = registry.model("guest").expect("registered");
        for outcome in [drawable(&registry, &scene("guest")), valid(&registry, guest)] {
            let Err(Failure::Invalid(said)) = outcome else { panic!("{outcome:?}") };
            assert!(said.contains("guest.wgsl:2:4"), "{said}");
            assert!(said.contains("the function response is missing"), "{said}");
        }
    }
}
