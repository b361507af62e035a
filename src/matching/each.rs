//! Every model matched to view A: which one comes nearest?

use super::{Match, MatchError, Request, What, match_view, parameters};
use crate::{
    progress::{Cancelled, Progress},
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

/// All models that were matched, the nearest first, and the others with the reason.
#[derive(Clone, Debug, Default)]
pub struct Ranking {
    /// The models by the error that remains.
    pub matched: Vec<Matched>,
    /// Those that could not be matched.
    pub left_out: Vec<(&'static str, MatchError)>,
}

/// Models that can be matched to a surface: of opaque surfaces, and with parameters rather than measurements.
pub fn candidates(registry: &Registry) -> impl Iterator<Item = &ModelEntry> {
    registry.models().iter().filter(|model| !model.declaration.measured && !model.declaration.transmits)
}

/// Matches models to view A, each with all its numbers and colours free, from its defaults: the other views do not matter.
///
/// # Errors
/// Returns an error if the user cancels.
pub fn match_each<'m>(
    scene: &Scene,
    models: impl IntoIterator<Item = &'m ModelEntry>,
    what: What,
    registry: &Registry,
    progress: &Progress,
) -> Result<Ranking, Cancelled> {
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
        let request = Request { scene: &scene, view: 1, what, parameters: &free };
        let name = |step: &str| format!("{}: {step}", model.declaration.name);
        let found =
            progress.part((i, models.len()), name, |progress| match_view(&request, registry, progress));
        match found {
            Ok(found) => ranking.matched.push(Matched { model: id, found }),
            Err(MatchError::Cancelled) => return Err(Cancelled),
            Err(why) => ranking.left_out.push((id, why)),
        }
    }
    ranking.matched.sort_by(|a, b| a.found.after.total_cmp(&b.found.after));
    Ok(ranking)
}
