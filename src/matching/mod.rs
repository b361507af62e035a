//! Matching: finds the parameters of one view that come closest to another.
//!
//! Suppose view A shows Blinn's model and view B Phong's: which exponent of the one gives the highlight of
//! the other? The search knows nothing about the models. It changes the free parameters of view B within
//! their legal ranges, and minimises the sum of squared differences between
//!
//! - [the lobes](What::Lobe): the responses of both models for about a thousand pairs of directions, by a [`Metric`],
//! - [the pictures](What::Picture): the light of both views, drawn small by the CPU renderer, or
//! - [the highlights](What::Highlight): their widths at half maximum, in the plane of incidence.
//!
//! ```
//! use lights_camera_models::{
//!     matching::{self, Request, What, match_view},
//!     parameter::Value,
//!     progress::Progress,
//!     registry::Registry,
//!     scene::{Scene, Variant},
//! };
//! let mut scene = Scene { reflection_model: "blinn_phong".to_owned(), ..Scene::default() };
//! scene.objects[0].material.set("alpha", Value::Integer(80));
//! scene.variants = vec![Variant { reflection_model: Some("phong".to_owned()), ..Variant::default() }];
//! let request = Request { scene: &scene, view: 1, measure: What::Highlight.into(), parameters: &["alpha"] };
//! let found = match_view(&request, &Registry::builtin(), &Progress::NONE).expect("both have a highlight");
//! // A quarter of the exponent: F. Fisher and A. Woo (1994).
//! assert_eq!(found.values, [("alpha", Value::Integer(20))]);
//! ```

use crate::{
    declared::ids,
    parameter::{Parameter, Value},
    progress::{Cancelled, Progress},
    reflection::usage::unused,
    registry::Registry,
    scene::{Scene, variant::LETTERS},
    text::{did_you_mean, listed, plural, quoted},
};

mod axis;
mod descent;
pub mod each;
mod highlight;
pub mod least_squares;
mod lobe;
mod metric;
mod picture;
mod search;
mod sides;

pub use highlight::highlight_width;
pub use lobe::directions;
pub use metric::{Measure, Metric};
pub use picture::{HEIGHT, WIDTH};

use axis::Axis;
use highlight::Highlight;
use lobe::Lobe;
use picture::Picture;
use search::{Found, Free, Search, Target};
use sides::Side;

/// Maximum number of evaluations of a search that compares lobes or highlights, and the additional ones for
/// each free number.
const MOST_LOBES: [usize; 2] = [2500, 250];
/// Maximum number of pictures of a search that compares pictures, and the additional ones for each free
/// number.
const MOST_PICTURES: [usize; 2] = [400, 250];
/// What the pictures of a search may cost together: the square of the number of the model's parameters for each, and as many times
/// that as there are [`USUAL`] responses in a picture.
const PICTURES: usize = 800_000;
/// Responses of the models in a picture of usual size: pixels times lights.
const USUAL: usize = 20_000;

ids! {
    /// The quantity that is compared.
    #[derive(Default)]
    What(
        /// One sentence about the comparison.
        summary,
        /// Meaning of the error, with its unit.
        unit
    ) {
        /// The responses of the models for many pairs of directions.
        #[default]
        Lobe = "lobe"
            "The reflected light, for all directions of light and viewer: independent of this scene’s lights and shapes."
            "RMS difference of the reflected light; 1 is a white matte surface lit head-on",
        /// The pictures of the views.
        Picture = "picture"
            "The light of the pictures, on the covered pixels: as near as it gets on this scene."
            "RMS difference in linear light over the covered pixels",
        /// The width of the highlights.
        Highlight = "highlight"
            "The width of the highlight where it has half its brightness, in the plane of incidence; its brightness is left alone."
            "RMS difference of the widths, as a logarithm: 0.1 is about 10 %",
    }
}

/// What ended a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ended {
    /// Nothing that it tried last came nearer.
    #[default]
    Itself,
    /// The maximum number of evaluations.
    Evaluations,
    /// The maximum duration.
    Time,
    /// The user, who cancelled it.
    Interrupted,
}

impl Ended {
    /// Name in JSON.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Itself => "search",
            Self::Evaluations => "evaluations",
            Self::Time => "time",
            Self::Interrupted => "interrupted",
        }
    }

    /// A sentence about the end, without a full stop; `None` if the search ended by itself.
    #[must_use]
    pub fn note(self) -> Option<&'static str> {
        match self {
            Self::Itself => None,
            Self::Evaluations => {
                Some("the search ended at its limit of evaluations: fewer free parameters may come nearer")
            }
            Self::Time => Some(
                "the search ended at its limit of time: fewer free parameters may come nearer, and a faster computer may find others",
            ),
            Self::Interrupted => Some("the search was interrupted: this is the nearest until then"),
        }
    }
}

/// A request to match a view.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The scene, which is valid.
    pub scene: &'a Scene,
    /// The view whose parameters are adjusted to match view A: 1 is view B.
    pub view: usize,
    /// The quantity to compare, and the metric.
    pub measure: Measure,
    /// Names of the free parameters.
    pub parameters: &'a [&'a str],
}

/// The result of a match.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Match {
    /// The values for the view, without parameters that hardly matter.
    pub values: Vec<(&'static str, Value)>,
    /// The free parameters that keep their values, since changing them hardly helps.
    pub kept: Vec<&'static str>,
    /// Those of the unchanged parameters of which no value that was tried made a difference.
    pub without_effect: Vec<&'static str>,
    /// The free parameters of which other values, changed together, come as near: but for a hundredth of what each changes, or within a hundredth of the
    /// error that remains.
    pub ambiguous: Vec<&'static str>,
    /// Number of times that the views were compared.
    pub evaluations: usize,
    /// What ended the search.
    pub ended: Ended,
    /// The error with the present values: see [`Measure::unit`].
    pub before: f64,
    /// The error with the matched values.
    pub after: f64,
}

impl Match {
    /// The match, if its search came to an end.
    ///
    /// # Errors
    /// Returns [`MatchError::Cancelled`] if the user cancelled it.
    pub fn unless_interrupted(self) -> Result<Self, MatchError> {
        if self.ended == Ended::Interrupted { Err(MatchError::Cancelled) } else { Ok(self) }
    }

    /// A sentence about the [ambiguous](Self::ambiguous) parameters, by their names or labels, without a full stop; `None` if there are
    /// none.
    #[must_use]
    pub fn ambiguity(&self, label: impl Fn(&'static str) -> &'static str) -> Option<String> {
        let names: Vec<&str> = self.ambiguous.iter().copied().map(label).collect();
        let names = (!names.is_empty()).then(|| listed(&names, "and"))?;
        Some(format!("other values of {names}, changed together, come as near"))
    }
}

/// The reason why a match failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MatchError {
    /// The view does not exist, or is view A.
    #[error("there is no view {view} to match; the scene has {}", views_in_words(*.views))]
    NoView {
        /// Letter of the view.
        view: String,
        /// Number of views.
        views: usize,
    },
    /// No parameter is free.
    #[error("no parameter is free; {}", remedy(.known))]
    NothingFree {
        /// Parameters that could be free.
        known: Vec<&'static str>,
    },
    /// The view's models lack a parameter.
    #[error("{} is free, but view {view} has no such parameter; {}{hint}", quoted(.name), remedy(.known))]
    NoParameter {
        /// Name as given.
        name: String,
        /// Letter of the view.
        view: &'static str,
        /// A suggested spelling.
        hint: String,
        /// Existing parameters.
        known: Vec<&'static str>,
    },
    /// The parameter is not numeric, so it cannot be searched.
    #[error("{name} is free, but it is a {kind}: only numbers and colours can be searched")]
    NoNumber {
        /// Name of the parameter.
        name: &'static str,
        /// Kind of the parameter.
        kind: &'static str,
    },
    /// The parameter has no effect at present.
    #[error("{name} is free, but it has no effect: {why}")]
    Unused {
        /// Name of the parameter.
        name: &'static str,
        /// The reason.
        why: String,
    },
    /// The view's models share the parameter, but their ranges do not overlap.
    #[error("{name} is free, but no value of it is valid for all models of view {view}")]
    NoRange {
        /// Name of the parameter.
        name: &'static str,
        /// Letter of the view.
        view: &'static str,
    },
    /// No object is visible, or none is in the picture.
    #[error("no object is visible, so there is nothing to compare")]
    NothingVisible,
    /// A view has no highlight to compare.
    #[error("view {view} has no highlight of measurable width: {why}")]
    NoHighlight {
        /// Letter of the view.
        view: &'static str,
        /// Models of the view.
        why: String,
    },
    /// The CPU cannot run a custom model.
    #[error("{model} cannot be matched, since the CPU cannot run it: {why}")]
    NotOnCpu {
        /// Id of the model.
        model: &'static str,
        /// The reason.
        why: String,
    },
    /// The user cancelled.
    #[error("the match was cancelled")]
    Cancelled,
}

impl From<Cancelled> for MatchError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

fn views_in_words(views: usize) -> String {
    match views {
        1 => "only view A".to_owned(),
        _ => format!("{}: {}", plural(views, "view"), listed(&LETTERS[..views.min(LETTERS.len())], "and")),
    }
}

fn remedy(known: &[&str]) -> String {
    match known {
        [] => "the view’s models have none that can be searched".to_owned(),
        _ => format!("free some of {}", listed(known, "and")),
    }
}

/// The relative difference of numbers that are equal but for the rounding of a search.
const EQUAL: f32 = 2e-4;

/// True if two values are equal, numbers but for the rounding of a search.
#[must_use]
pub fn nearly_equal(one: &Value, other: &Value) -> bool {
    let near = |a: f32, b: f32| (a - b).abs() <= EQUAL * a.abs().max(b.abs());
    match (one, other) {
        (Value::Number(a), Value::Number(b)) => near(*a, *b),
        (Value::Triple(a), Value::Triple(b)) => a.iter().zip(b).all(|(a, b)| near(*a, *b)),
        _ => one == other,
    }
}

/// A value with three significant digits, for people.
#[must_use]
pub fn rounded(value: &Value) -> Value {
    let short = |v: f32| format!("{v:.2e}").parse().unwrap_or(v);
    match value {
        Value::Number(v) => Value::Number(short(*v)),
        Value::Triple(all) => Value::Triple(all.map(short)),
        other => other.clone(),
    }
}

/// An error with a few digits.
#[must_use]
pub fn digits(error: f64) -> String {
    match error {
        0.0 => "0".to_owned(),
        1e-3.. => format!("{error:.4}"),
        _ => format!("{error:.1e}"),
    }
}

/// The parameters of a view that can be searched, each with true if it is free by default: numbers are,
/// colours and other triples only on request. If view A shows a measurement, which has no colours of a model to
/// begin with, all are free. Empty if the view does not exist.
#[must_use]
pub fn parameters(scene: &Scene, view: usize, registry: &Registry) -> Vec<(&'static Parameter, bool)> {
    let side = |view| Side::seen(scene, view, registry);
    let is_measured =
        || side(0).is_some_and(|a| a.models(registry).iter().any(|model| model.declaration.measured));
    let all = side(view).map_or_else(Vec::new, |side| known(&side, registry));
    let every = !all.is_empty() && is_measured();
    all.into_iter().map(|parameter| (parameter, every || parameter.kind.is_number())).collect()
}

fn known(side: &Side, registry: &Registry) -> Vec<&'static Parameter> {
    let mut all: Vec<&'static Parameter> = Vec::new();
    for parameter in side.models(registry).into_iter().flat_map(|model| model.parameters) {
        if parameter.kind.limits().is_some()
            && all.iter().all(|known| known.name != parameter.name)
            && reason_against(side, parameter, registry).is_none()
        {
            all.push(parameter);
        }
    }
    all
}

/// The reason why a parameter has no effect in a view; `None` if it affects any object.
fn reason_against(side: &Side, parameter: &Parameter, registry: &Registry) -> Option<String> {
    let mut reason = None;
    for object in side.scene.shown() {
        let Some(model) = registry.model(side.scene.model_of(object)) else { continue };
        let Some(own) = model.parameter(parameter.name) else { continue };
        reason = Some(unused(model.parameters, own, &object.material)?);
    }
    reason
}

/// Finds the parameters of a view that come nearest to view A. The search ends by itself, at a number of evaluations that depends
/// on what is free, or after ten minutes. If the user cancels, the nearest until then is the result.
///
/// # Errors
/// Returns an error if there is nothing to compare or search, if a model cannot be evaluated, or if the user
/// cancels before the views were compared once.
pub fn match_view(request: &Request, registry: &Registry, progress: &Progress) -> Result<Match, MatchError> {
    let scene = request.scene;
    let letter = LETTERS.get(request.view).copied().unwrap_or("?");
    let views = scene.variants.len() + 1;
    let side = |view| Side::seen(scene, view, registry).filter(|_| request.view > 0);
    let (Some(a), Some(b)) = (&side(0), &side(request.view)) else {
        return Err(MatchError::NoView { view: letter.to_owned(), views });
    };
    if b.models(registry).is_empty() {
        return Err(MatchError::NothingVisible);
    }
    let sides = [a, b];
    let can_run = || sides.iter().try_for_each(|side| side.can_run(registry));
    can_run()?;
    let free = frees(request, b, letter, registry)?;
    let found = match request.measure.what {
        What::Lobe => {
            search(&mut Lobe::new(sides, request.measure.metric, registry), &free, MOST_LOBES, progress)
        }
        What::Picture => {
            let mut picture = Picture::new(sides, registry).ok_or(MatchError::NothingVisible)?;
            let size = b.models(registry).iter().map(|model| model.parameters.len()).max().unwrap_or(1);
            let work = size * size * picture.responses().max(USUAL) / USUAL;
            let most = most(&free, MOST_PICTURES);
            let most = most.min((PICTURES / work).max(most / 8));
            Search::new(&mut picture, &free, most, progress).run()
        }
        What::Highlight => {
            let none = |i: usize| {
                let names: Vec<_> =
                    sides[i].models(registry).iter().map(|model| model.declaration.name).collect();
                let why = format!("{} does not fall to half its brightness", listed(&names, "and"));
                MatchError::NoHighlight { view: if i == 0 { LETTERS[0] } else { letter }, why }
            };
            search(&mut Highlight::new(sides, registry).map_err(none)?, &free, MOST_LOBES, progress)
        }
    };
    // An endless function is detected only when it runs.
    can_run()?;
    let Found { values, before, after, without_effect, ambiguous, evaluations, ended } = found?;
    let given = |name: &str| values.iter().any(|(known, _)| *known == name);
    let kept = free.iter().map(|free| free.parameter.name).filter(|name| !given(name)).collect();
    Ok(Match { values, kept, without_effect, ambiguous, evaluations, ended, before, after })
}

fn search(
    target: &mut impl Target,
    free: &[Free],
    limit: [usize; 2],
    progress: &Progress,
) -> Result<Found, Cancelled> {
    Search::new(target, free, most(free, limit), progress).run()
}

/// Maximum number of evaluations.
fn most(free: &[Free], [most, each]: [usize; 2]) -> usize {
    most + each * free.iter().map(|free| free.axes.len()).sum::<usize>()
}

/// The free parameters.
fn frees(
    request: &Request,
    side: &Side,
    view: &'static str,
    registry: &Registry,
) -> Result<Vec<Free>, MatchError> {
    let known: Vec<_> = known(side, registry).into_iter().map(|parameter| parameter.name).collect();
    if request.parameters.is_empty() {
        return Err(MatchError::NothingFree { known });
    }
    let mut frees: Vec<Free> = Vec::new();
    for name in request.parameters {
        let spelling = name.replace("color", "colour");
        let users: Vec<_> =
            side.models(registry).into_iter().filter_map(|model| model.parameter(&spelling)).collect();
        let Some(parameter) = users.first().copied() else {
            let spellings = known.iter().map(|name| (*name, *name));
            let hint = did_you_mean(&spelling, spellings);
            return Err(MatchError::NoParameter { name: (*name).to_owned(), view, hint, known });
        };
        if frees.iter().any(|free| free.parameter.name == parameter.name) {
            continue;
        }
        if let Some(why) = reason_against(side, parameter, registry) {
            return Err(MatchError::Unused { name: parameter.name, why });
        }
        let uses = |object: &&crate::scene::Object| {
            registry.model(side.scene.model_of(object)).is_some_and(|m| m.parameter(&spelling).is_some())
        };
        let object = side.scene.shown().find(uses);
        let now = object.map_or_else(|| parameter.default_value(), |object| object.material.get(parameter));
        let axes = Axis::of(&users, &now);
        if axes.is_empty() {
            return Err(match parameter.kind.limits() {
                None => MatchError::NoNumber { name: parameter.name, kind: parameter.kind.name() },
                Some(_) => MatchError::NoRange { name: parameter.name, view },
            });
        }
        let groups = side.models(registry).into_iter().flat_map(|model| model.groups);
        let group = groups
            .into_iter()
            .find(|group| group.parameters.contains(&parameter.name))
            .map(|group| group.name);
        frees.push(Free { parameter, axes, now, group });
    }
    Ok(frees)
}

#[cfg(test)]
mod tests;
