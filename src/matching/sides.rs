//! The two views to compare: the models of their objects.

use std::sync::Arc;

use super::{MatchError, search::Given};
use crate::{
    optics::{TermSelection, colour::Encoding},
    parameter::Values,
    reflection::{ModelEntry, Surface},
    registry::Registry,
    scene::Scene,
};

/// Maximum number of materials whose lobes are compared; if there are more, a selection spread over the list
/// of objects.
const MOST: usize = 16;

/// A view, with the scene that it shows.
#[derive(Clone, Debug)]
pub(super) struct Side {
    pub(super) scene: Scene,
    pub(super) terms: TermSelection,
}

impl Side {
    /// A view of a scene; `None` if it does not exist.
    pub(super) fn seen(scene: &Scene, view: usize, registry: &Registry) -> Option<Self> {
        let (scene, terms) = scene.seen(view, registry)?;
        Some(Self { scene, terms })
    }

    /// Fails if the CPU cannot run one of the models, or found a function endless.
    pub(super) fn can_run(&self, registry: &Registry) -> Result<(), MatchError> {
        for model in self.models(registry) {
            if let Some(why) = model.not_on_cpu() {
                return Err(MatchError::NotOnCpu { model: model.declaration.id, why });
            }
        }
        Ok(())
    }

    /// The models of the visible objects, each once.
    pub(super) fn models<'r>(&self, registry: &'r Registry) -> Vec<&'r ModelEntry> {
        let mut models: Vec<&ModelEntry> = Vec::new();
        for model in self.scene.shown().filter_map(|object| registry.model(self.scene.model_of(object))) {
            if models.iter().all(|known| known.declaration.id != model.declaration.id) {
                models.push(model);
            }
        }
        models
    }
}

/// A material of an object in both views.
pub(super) struct Pair {
    /// The surface in view A.
    pub(super) wanted: Arc<dyn Surface>,
    /// The model in the other view.
    pub(super) model: ModelEntry,
    /// Parameters in the other view.
    own: Values,
    encoding: Encoding,
    /// True if rotation about the normal changes either of them.
    pub(super) anisotropic: bool,
    /// True if view A has a measurement that is the same at every azimuth.
    pub(super) turns: bool,
    /// True if view A has a measurement. It has no ambient term, so that of the model does not count.
    pub(super) is_measured: bool,
}

impl Pair {
    /// The materials of the visible objects, each once.
    pub(super) fn all([a, b]: [&Side; 2], registry: &Registry) -> Vec<Self> {
        let mut seen = Vec::new();
        let mut pairs = Vec::new();
        for (of_a, of_b) in a.scene.shown().zip(b.scene.shown()) {
            let models = [a.scene.model_of(of_a), b.scene.model_of(of_b)].map(|id| registry.model(id));
            let [Some(model_a), Some(model)] = models else { continue };
            let legal = [
                (model_a.declaration.id, of_a.material.legal(model_a.parameters)),
                (model.declaration.id, of_b.material.legal(model.parameters)),
            ];
            if seen.contains(&legal) {
                continue;
            }
            pairs.push(Self {
                wanted: model_a.instantiate(&of_a.material, a.scene.display.encoding),
                model: model.clone(),
                own: of_b.material.clone(),
                encoding: b.scene.display.encoding,
                anisotropic: model_a.declaration.anisotropic || model.declaration.anisotropic,
                turns: model_a.declaration.measured && !model_a.declaration.anisotropic,
                is_measured: model_a.declaration.measured,
            });
            seen.push(legal);
        }
        let each = pairs.len().div_ceil(MOST).max(1);
        pairs.into_iter().step_by(each).collect()
    }

    /// The other view's surface with these parameters.
    pub(super) fn with(&self, values: &Given) -> Arc<dyn Surface> {
        let mut all = self.own.clone();
        values.iter().for_each(|(name, value)| all.set(*name, value.clone()));
        self.model.instantiate(&all, self.encoding)
    }
}
