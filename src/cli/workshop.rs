//! Shaders and own models on disk: where commands find them, and what is said of those that are wrong.

use std::{collections::BTreeSet, path::PathBuf};

use clap::Args;

use super::{Failure, Outcome, complain};
use crate::{
    assets::{self, Folders},
    capture::gpu::GpuError,
    reflection::{Family, ModelEntry, own},
    registry::Registry,
    scene::Scene,
    shader::{
        check::{self, ShaderProblem},
        compose::{Part, compose, compose_evaluation, files},
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

/// A word as a shell takes it.
fn pasted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/:._-+,@".contains(c) || cfg!(windows) && c == '\\';
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// What is known, and where it was read from.
pub(super) struct Workshop {
    pub registry: Registry,
    pub folders: Folders,
}

impl Places {
    /// The folders as the command line named them, to be repeated in another: each with a space before it.
    pub(super) fn flags(&self) -> String {
        [("--assets", &self.assets), ("--models", &self.models)]
            .into_iter()
            .filter_map(|(flag, folder)| {
                Some(format!(" {flag} {}", pasted(&folder.as_ref()?.to_string_lossy())))
            })
            .collect()
    }

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
            GpuError::Endless(_) => Self::Invalid(error.to_string()),
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

/// The edited shaders that a scene is drawn with on the graphics card and not on the CPU. There everything is Rust
/// but own models, with what they import and the functions that they share.
pub(super) fn not_followed_on_cpu(registry: &Registry, scene: &Scene) -> BTreeSet<String> {
    if registry.sources().edited().all(|path| path.starts_with("models/")) {
        return BTreeSet::new();
    }
    let pairs: BTreeSet<_> = scene.objects.iter().map(|o| (scene.model_of(o), scene.mode_of(o))).collect();
    let known = pairs.into_iter().filter_map(|(m, n)| Some((registry.model(m)?, registry.mode(n)?)));
    known
        .flat_map(|(model, mode)| {
            let own = model.declaration.family == Family::Own;
            files(registry.sources(), model, mode, registry.lights())
                .into_iter()
                .filter(move |file| file.edited && !(own && file.part == Part::Vocabulary))
                .map(|file| file.path)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_repeated_so_that_a_shell_takes_them() {
        let flags = |assets: Option<&str>, models: Option<&str>| {
            Places { assets: assets.map(PathBuf::from), models: models.map(PathBuf::from) }.flags()
        };
        assert_eq!(flags(None, None), "");
        assert_eq!(flags(Some("assets"), None), " --assets assets");
        assert_eq!(flags(Some("../a b"), Some("Mira's")), r" --assets '../a b' --models 'Mira'\''s'");
    }

    #[test]
    fn the_cpu_follows_no_edited_shader_of_what_is_built_in() {
        let mut registry = Registry::builtin();
        let scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        assert!(not_followed_on_cpu(&registry, &scene).is_empty());
        for path in ["models/mine.wgsl", "reflection/lambert.wgsl", "reflection/phong.wgsl", "loop.wgsl"] {
            registry.sources_mut().edit(path, "// mine");
        }
        let found = not_followed_on_cpu(&registry, &scene);
        assert_eq!(found.into_iter().collect::<Vec<_>>(), ["loop.wgsl", "reflection/phong.wgsl"]);
    }
}
