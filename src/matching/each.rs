//! Every model matched to view A: which one comes nearest?

use super::{Match, MatchError, Measure, Request, match_view, parameters};
use crate::{
    parameter::{Parameter, Value, Values},
    progress::Progress,
    reflection::{ModelEntry, usage::unused},
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

/// Models that can be matched to a surface: opaque with their default values, and with parameters rather than
/// measurements.
pub fn candidates(registry: &Registry) -> impl Iterator<Item = &ModelEntry> {
    let opaque = |model: &&ModelEntry| !model.passage(&defaults(model)).transmits;
    registry.models().iter().filter(|model| !model.declaration.measured).filter(opaque)
}

/// The default values of a model, whatever a scene has set for another.
fn defaults(model: &ModelEntry) -> Values {
    let mut values = Values::default();
    for p in model.parameters {
        values.set(p.name, p.default_value());
    }
    values
}

/// True if the surface stays opaque, whatever the value of a parameter.
pub(super) fn keeps_opaque(model: &ModelEntry, parameter: &Parameter) -> bool {
    parameter.ends().into_iter().all(|end| {
        let mut values = defaults(model);
        values.set(parameter.name, end);
        !model.passage(&values).transmits
    })
}

/// Matches models to view A, each with all its numbers, colours and choices free, from its defaults: the other views do not
/// matter. Parameters that would make a surface transmit light stay as they are. If the user cancels, what was matched until then is the result.
pub fn match_each<'m>(
    scene: &Scene,
    models: impl IntoIterator<Item = &'m ModelEntry>,
    measure: Measure,
    registry: &Registry,
    progress: &Progress,
) -> Ranking {
    let models: Vec<_> = models.into_iter().collect();
    let whole: f32 = models.iter().map(|model| effort(model)).sum();
    let mut ranking = Ranking::default();
    let mut done = 0.0;
    for (i, model) in models.iter().enumerate() {
        let id = model.declaration.id;
        let name = |step: &str| format!("{}: {step}", model.declaration.name);
        let stretch = [done, done + effort(model)].map(|done| done / whole);
        done += effort(model);
        let found = progress
            .stretch(stretch, name, |progress| match_model(scene, model, measure, registry, progress));
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

/// The choices of a model that are tried, each with its parameter. Flags are not: an opaque body does
/// not show that it is thin.
fn choices(model: &ModelEntry) -> impl Iterator<Item = (&'static Parameter, Value)> {
    let of =
        |p: &'static Parameter| p.kind.options().iter().map(move |(id, _)| (p, Value::Choice((*id).into())));
    model.parameters.iter().filter(|p| !p.costly && !p.kind.is_flag()).flat_map(of)
}

/// How long a model takes, beside others: it grows with its choices, and with its parameters.
fn effort(model: &ModelEntry) -> f32 {
    ((1 + choices(model).count()) * (10 + model.parameters.len())) as f32
}

/// Matches a model with its default choices, then with every other choice, one after the other: one that comes nearer
/// stays.
fn match_model(
    scene: &Scene,
    model: &ModelEntry,
    measure: Measure,
    registry: &Registry,
    progress: &Progress,
) -> Result<Match, MatchError> {
    /// The part of the error that must be left for a choice to stay, and that of the first error that counts as none.
    const NEARER: f64 = 0.99;
    const NOTHING: f64 = 1e-4;
    /// Maximum number of times that each choice is tried.
    const ROUNDS: usize = 3;
    let mut material = defaults(model);
    let attempt = |material: &Values, progress: &Progress| {
        let id = model.declaration.id.to_owned();
        let variant =
            Variant { reflection_model: Some(id), material: material.clone(), ..Variant::default() };
        let scene = Scene { variants: vec![variant], ..scene.clone() };
        let free = parameters(&scene, 1, registry);
        let free = free.into_iter().map(|(parameter, _)| parameter).filter(|p| keeps_opaque(model, p));
        let free: Vec<_> = free.map(|parameter| parameter.name).collect();
        match_view(&Request { scene: &scene, view: 1, measure, parameters: &free }, registry, progress)?
            .unless_interrupted()
    };
    let choices: Vec<_> = choices(model).collect();
    let count = 1 + ROUNDS * choices.len();
    let mut best = progress.part((0, count), str::to_owned, |progress| attempt(&material, progress))?;
    // A choice may come nearer only beside another one, so they are tried again until none does.
    for round in 0..ROUNDS {
        let before = best.after;
        for (i, (p, value)) in choices.iter().enumerate() {
            let is_new = material.get(p) != *value && unused(model.parameters, p, &material).is_none();
            if !is_new || best.after <= NOTHING * best.before {
                continue;
            }
            let mut other = material.clone();
            other.set(p.name, value.clone());
            let part = (1 + round * choices.len() + i, count);
            match progress.part(part, str::to_owned, |progress| attempt(&other, progress)) {
                Ok(found) if found.after < NEARER * best.after => {
                    (best, material) = (Match { before: best.before, ..found }, other);
                }
                Err(MatchError::Cancelled) => return Err(MatchError::Cancelled),
                _ => {}
            }
        }
        if best.after >= before {
            break;
        }
    }
    let chosen = model.parameters.iter().filter(|p| !p.kind.options().is_empty());
    let chosen = chosen.map(|p| (p.name, material.get(p), p.default_value()));
    let chosen = chosen.filter(|(_, now, default)| now != default).map(|(name, now, _)| (name, now));
    best.values.splice(0..0, chosen);
    Ok(best)
}
