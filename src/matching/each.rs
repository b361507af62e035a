//! Every model matched to view A: which one comes nearest?

use super::{Match, MatchError, Measure, Request, match_view, parameters};
use crate::{
    progress::Progress,
    reflection::ModelEntry,
    registry::Registry,
    scene::{Scene, Variant},
};

/// A model that was matched.
#[derive(Clone, Debug)]
pub struct Matched {
    /// Id of the model.
    pub model: &'static str,
    /// The parameters that come nearest, and the errors.
    pub found: Match,
}

/// The models that were matched, the nearest first, and the others.
#[derive(Clone, Debug, Default)]
pub struct Ranking {
    /// The models by the error that remains.
    pub matched: Vec<Matched>,
    /// Those that could not be matched, with the reason.
    pub left_out: Vec<(&'static str, MatchError)>,
    /// Those whose turn did not come, or did not end, before the user cancelled.
    pub unfinished: Vec<&'static str>,
}

/// Models that can be matched to a surface: of opaque surfaces, and with parameters rather than measurements.
pub fn candidates(registry: &Registry) -> impl Iterator<Item = &ModelEntry> {
    registry.models().iter().filter(|model| !model.declaration.measured && !model.declaration.transmits)
}

/// Matches models to view A, each with all its numbers and colours free, from its defaults: the other views do not matter.
/// If the user cancels, what was matched until then is the result.
pub fn match_each<'m>(
    scene: &Scene,
    models: impl IntoIterator<Item = &'m ModelEntry>,
    measure: Measure,
    registry: &Registry,
    progress: &Progress,
) -> Ranking {
    let models: Vec<_> = models.into_iter().collect();
    let mut ranking = Ranking::default();
    for (i, model) in models.iter().enumerate() {
        let id = model.declaration.id;
        let variant = Variant { reflection_model: Some(id.to_owned()), ..Variant::default() };
        let mut scene = Scene { variants: vec![variant], ..scene.clone() };
        // What view A has set is for its model.
        for p in model.parameters {
            scene.variants[0].material.set(p.name, p.default_value());
        }
        let free = parameters(&scene, 1, registry);
        let free: Vec<_> = free.into_iter().map(|(parameter, _)| parameter.name).collect();
        let request = Request { scene: &scene, view: 1, measure, parameters: &free };
        let name = |step: &str| format!("{}: {step}", model.declaration.name);
        let found =
            progress.part((i, models.len()), name, |progress| match_view(&request, registry, progress));
        match found {
            Ok(found) => ranking.matched.push(Matched { model: id, found }),
            Err(MatchError::Cancelled) => {
                ranking.unfinished = models[i..].iter().map(|model| model.declaration.id).collect();
                break;
            }
            Err(why) => ranking.left_out.push((id, why)),
        }
    }
    ranking.matched.sort_by(|a, b| a.found.after.total_cmp(&b.found.after));
    ranking
}
