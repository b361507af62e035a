//! Arrival and removal of custom models.

use bevy::ecs::prelude::*;

use super::{
    super::trial::Verdict, CurrentScene, LiveShaders, Overrides, Registry, Visible, composed, lights_of,
};
use crate::{library::model_of, parameter::Values};

/// Number of custom models tried at the same time.
const ARRIVING: usize = 16;

impl LiveShaders {
    /// Reads the models that a scene uses and of which only the declaration is known.
    pub(super) fn read_wanted(&mut self, world: &mut World) {
        let Some(scene) = world.get_resource::<CurrentScene>() else { return };
        let overridden = world.try_query::<&Overrides>();
        let overridden = overridden.iter().flat_map(|query| query.iter_manual(world));
        let models = overridden.filter_map(|o| o.reflection_model.as_deref()).chain(scene.0.models());
        for file in self.library.wanted(models, world.resource::<Registry>()) {
            self.reread(&file, world.resource_mut::<Registry>().bypass_change_detection());
        }
    }

    /// Tries the custom models that were read, and registers the valid ones: parameters, text and shader are
    /// exchanged together or not at all.
    pub(super) fn adopt(&mut self, world: &mut World, visible: &Visible) {
        for model in self.library.next_arriving(ARRIVING) {
            let registry = world.resource::<Registry>().clone();
            let lights = lights_of(world, &registry);
            let (id, source) = (model.entry.declaration.id, model.entry.declaration.wgsl.path);
            let shown = registry.shading_models().iter().filter(|shading| visible.shows(id, shading));
            let mut shadings: Vec<_> = shown.collect();
            if shadings.is_empty() {
                shadings.extend(registry.shading_models().first());
            }
            let mut current = registry.sources().clone();
            current.edit(source, model.text.clone());
            let mut lenient = self.library.lenient(&registry);
            lenient.edit(source, model.text.clone());
            let mut verdict = Verdict::Good;
            // All are started, so that another process tries them at the same time.
            for shading in shadings {
                let mut tried = Verdict::Good;
                for sources in [&current, &lenient] {
                    let entry = &model.entry;
                    let parts = (entry, entry.passage(&Values::default()), shading, lights);
                    tried = self.try_out(world, &composed(sources, parts, &registry), parts);
                    if !matches!(tried, Verdict::Bad(_)) {
                        break;
                    }
                }
                if verdict == Verdict::Good {
                    verdict = tried;
                }
            }
            match verdict {
                Verdict::Good => {
                    self.mark_due(source);
                    self.library.adopt(model, &mut world.resource_mut::<Registry>());
                }
                Verdict::Bad(problem) => {
                    self.library.refuse(source, vec![*problem], &mut world.resource_mut::<Registry>());
                }
                Verdict::NotYet => self.library.try_later(model),
            }
        }
    }

    /// Forgets missing files that nothing is made of.
    pub(super) fn forget_gone(&mut self, world: &mut World, visible: &Visible) {
        let registry = world.resource::<Registry>();
        let scene = world.get_resource::<CurrentScene>().map(|scene| &scene.0);
        let drawn =
            |source: &str| self.shaders.iter().any(|(k, l)| visible.has(k) && l.shown.depends_on(source));
        let used = |source: &str| {
            let id = model_of(source).unwrap_or_default();
            scene.is_some_and(|scene| {
                scene.reflection_model == id || scene.objects.iter().any(|o| scene.model_of(o) == id)
            })
        };
        let gone = self.library.gone(registry).filter(|source| !drawn(source) && !used(source));
        for source in gone.map(str::to_owned).collect::<Vec<_>>() {
            self.library.forget(&source, &mut world.resource_mut::<Registry>());
        }
    }
}
