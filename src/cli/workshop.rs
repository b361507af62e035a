//! Shaders and own models on disk: where commands find them, and what is said of those that are wrong.

use std::{collections::BTreeSet, path::PathBuf};

use clap::Args;

use super::{Failure, Outcome, complain};
use crate::{
    assets::{self, Folders},
    capture::gpu::GpuError,
    reflection::{ModelEntry, own},
    registry::Registry,
    scene::Scene,
    shader::{
        check::{self, ShaderProblem},
        compose::{compose, compose_evaluation},
        report::annotated,
        whole::validate_drawing,
    },
    shading::Stage,
};

/// Where shaders and own models are.
#[derive(Args, Clone, Debug)]
pub(super) struct Places {
    /// Read shaders from FOLDER/shaders instead of using the built-in ones, and own models from FOLDER/models
    #[arg(long, global = true, value_name = "FOLDER")]
    assets: Option<PathBuf>,
    /// Read own models from this folder
    #[arg(long, global = true, value_name = "FOLDER")]
    models: Option<PathBuf>,
}

/// What is known, and where it was read from.
pub(super) struct Workshop {
    pub registry: Registry,
    pub folders: Folders,
}

impl Places {
    /// The folders.
    pub(super) fn folders(&self) -> Result<Folders, Failure> {
        Folders::find(self.assets.as_deref(), self.models.as_deref())
            .map_err(|e| Failure::Usage(e.to_string()))
    }

    /// Reads everything. Own models that are wrong are told of and left out; shaders that cannot be read are an
    /// error.
    pub(super) fn open(&self) -> Result<Workshop, Failure> {
        if let Some(named) = self.models.as_deref().filter(|m| !m.exists()) {
            return Err(Failure::Usage(format!(
                "--models is {}, but there is no such folder",
                named.display()
            )));
        }
        self.open_for_writing()
    }

    /// As [`open`](Self::open), for commands that make the folder of own models if it is not there.
    pub(super) fn open_for_writing(&self) -> Result<Workshop, Failure> {
        let folders = self.folders()?;
        let mut registry = Registry::builtin();
        if let Some(shaders) = &folders.shaders {
            assets::read_shaders(shaders, &mut registry)
                .map_err(|problems| Failure::Invalid(all_annotated(&problems)))?;
        }
        if let Some(models) = &folders.models {
            tell(&own::read_folder(models, &mut registry, false));
        }
        Ok(Workshop { registry, folders })
    }

    /// Reads what a window starts with: own models, those that are wrong as a stand-in. Nothing that is wrong keeps
    /// the window from opening.
    pub(super) fn open_for_window(&self) -> Result<Workshop, Failure> {
        let folders = self.folders()?;
        let mut registry = Registry::builtin();
        if let Some(shaders) = &folders.shaders {
            registry.set_shader_folder(shaders);
        }
        if let Some(models) = &folders.models {
            // The window itself tells of what is wrong.
            let _ = own::read_folder(models, &mut registry, true);
        }
        Ok(Workshop { registry, folders })
    }
}

/// Tells of files that are wrong.
fn tell(problems: &[(PathBuf, ShaderProblem)]) {
    if !problems.is_empty() {
        complain(all_annotated(problems));
    }
}

/// Problems one below the other.
pub(super) fn all_annotated(problems: &[(PathBuf, ShaderProblem)]) -> String {
    let mut each: Vec<_> = problems
        .iter()
        .map(|(path, problem)| {
            // A model may be wrong because of a file that it shares with others.
            let own = path.ends_with(problem.file.rsplit('/').next().unwrap_or_default());
            annotated(problem, &if own { path.display().to_string() } else { problem.file.clone() })
        })
        .collect();
    each.dedup();
    each.join("\n")
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::Invalid(problem) => Self::Invalid(annotated(&problem, &problem.file)),
            other => Self::NoRenderer(other.to_string()),
        }
    }
}

/// That the CPU cannot run a model, and what can.
pub(super) fn not_on_cpu(model: &ModelEntry, why: &str, instead: &str) -> String {
    format!(
        "{} cannot be run on the CPU, which interprets own models: {why}; with {instead} the graphics card runs it",
        model.declaration.id
    )
}

/// The file on disk that a source was read from, for messages.
fn on_disk(registry: &Registry, file: &str) -> String {
    registry.path_on_disk(file).map_or_else(|| file.to_owned(), |path| path.display().to_string())
}

/// Whether the shader of a model is valid as the files on disk have it. What is built in is.
pub(super) fn valid(registry: &Registry, model: &ModelEntry) -> Outcome {
    if registry.sources().edited().next().is_none() {
        return Ok(());
    }
    check::validate(&compose_evaluation(registry.sources(), model))
        .map(drop)
        .map_err(|problem| invalid(registry, &problem))
}

/// That a shader is not valid.
pub(super) fn invalid(registry: &Registry, problem: &ShaderProblem) -> Failure {
    Failure::Invalid(annotated(problem, &on_disk(registry, &problem.file)))
}

/// Whether everything that draws a scene is valid as the files on disk have it.
pub(super) fn drawable(registry: &Registry, scene: &Scene) -> Outcome {
    if registry.sources().edited().next().is_none() {
        return Ok(());
    }
    let pairs: BTreeSet<_> = scene.objects.iter().map(|o| (scene.model_of(o), scene.mode_of(o))).collect();
    for (model, mode) in pairs {
        let (Some(model), Some(mode)) = (registry.model(model), registry.mode(mode)) else { continue };
        let composed = compose(registry.sources(), model, mode, registry.lights());
        let faces = mode.declaration.stage == Stage::Polygon;
        validate_drawing(&composed, faces).map_err(|problem| invalid(registry, &problem))?;
    }
    Ok(())
}
