//! Shaders that only the GPU renderer draws: edited ones, and those of models that the CPU cannot run.

use std::collections::BTreeSet;

use crate::{
    reflection::{Family, ModelEntry},
    registry::{
        Registry,
        compose::{Part, files},
    },
    scene::{Object, Scene},
};

/// The paths of the edited shaders that a scene uses on the GPU, but not on the CPU, where everything is Rust
/// except custom models, with their imports and shared functions.
#[must_use]
pub fn ignored_edits(registry: &Registry, scene: &Scene) -> BTreeSet<String> {
    if registry.sources().edited().all(|path| path.starts_with("models/")) {
        return BTreeSet::new();
    }
    let lights = &registry.lights_in(scene.light_types(registry));
    let passage = |o: &Object| {
        let model = registry.model(scene.model_of(o));
        model.map(|model| model.passage(&o.material)).unwrap_or_default()
    };
    let all: BTreeSet<_> =
        scene.objects.iter().map(|o| (scene.model_of(o), passage(o), scene.shading_model_of(o))).collect();
    let known = all
        .into_iter()
        .filter_map(|(m, passage, n)| Some(((registry.model(m)?, passage), registry.shading_model(n)?)));
    known
        .flat_map(|((model, passage), shading)| {
            let own = model.declaration.family == Family::Custom;
            files(registry.sources(), (model, passage), shading, lights)
                .into_iter()
                .filter(move |file| file.edited && !(own && file.part == Part::Vocabulary))
                .map(|file| file.path)
        })
        .collect()
}

/// The first model of a scene that the CPU cannot run, and why. An endless function of a custom model is known only after it
/// ran.
#[must_use]
pub fn not_on_cpu<'r>(scene: &Scene, registry: &'r Registry) -> Option<(&'r ModelEntry, String)> {
    let mut models = scene.objects.iter().filter_map(|object| registry.model(scene.model_of(object)));
    models.find_map(|model| Some((model, model.not_on_cpu()?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cpu_follows_no_edited_shader_of_what_is_built_in() {
        let mut registry = Registry::builtin();
        let scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        assert!(ignored_edits(&registry, &scene).is_empty());
        for path in ["models/mine.wgsl", "reflection/lambert.wgsl", "reflection/phong.wgsl", "loop.wgsl"] {
            registry.sources_mut().edit(path, "// mine");
        }
        let found = ignored_edits(&registry, &scene);
        assert_eq!(found.into_iter().collect::<Vec<_>>(), ["loop.wgsl", "reflection/phong.wgsl"]);
    }
}
