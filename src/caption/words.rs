//! The words for models, values and display.

use std::collections::BTreeSet;

use super::{part::Part, said::Said};
use crate::{
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::{Parameter, Value},
    reflection::{ModelEntry, usage},
    registry::Registry,
    scene::{Display, Object, Scene, limits::number},
    text::listed,
};

/// Longest list of object names, in characters; longer ones do not suit a caption.
const NAMES: usize = 30;

/// The rank of parts, which decides what is dropped first where space is short.
pub(super) const VALUES: u8 = 3;
const FURTHER_MODELS: u8 = 2;

/// The reflection and shading models of the visible objects, and the non-default values. Facts shared by all
/// models are given once, at the end; facts `said` elsewhere are omitted.
pub(super) fn surfaces(scene: &Scene, said: &Said, registry: &Registry) -> Vec<Part> {
    // Other models have other values.
    let is_said = said.over.reflection_model.is_some();
    let groups = if is_said { Vec::new() } else { groups(scene) };
    let values = |(id, objects): &(&str, Vec<&Object>)| -> Vec<Part> {
        let Some(model) = registry.model(id) else { return Vec::new() };
        let values = differing(model, objects).filter(|(p, _)| !said.over.material.0.contains_key(p.name));
        values.filter_map(|(p, spread)| spread.part(p, "= ")).collect()
    };
    let mut values: Vec<_> = groups.iter().map(values).collect();
    let shared = |part: &Part| values.iter().all(|of_model| of_model.contains(part));
    let mut common: Vec<_> =
        values.first().into_iter().flatten().filter(|part| shared(part)).cloned().collect();
    let mut parts = Vec::new();
    for (i, ((id, objects), values)) in groups.iter().zip(&mut values).enumerate() {
        let name = registry.model(id).map_or(*id, |m| m.declaration.name);
        // Object names that repeat their model's name add nothing.
        let names = names(objects).filter(|names| groups.len() > 1 && !names.contains(name));
        let text = names.map_or_else(|| name.to_owned(), |names| format!("{name} ({names})"));
        parts.push(Part::new(if i == 0 { 0 } else { FURTHER_MODELS }, text));
        values.retain(|part| !common.contains(part));
        parts.extend(values.drain(..).map(Part::continued));
    }
    if groups.is_empty() && !is_said {
        parts.push(Part::new(0, "nothing visible"));
    }
    let shading = shadings(scene, registry).filter(|_| said.over.shading_model.is_none());
    parts.extend(shading.map(|names| Part::new(1, format!("{names} shading"))));
    common.iter_mut().skip(1).for_each(|part| part.continues = true);
    parts.extend(common);
    parts
}

/// The visible objects of each reflection model, in the order of the scene.
pub(super) fn groups(scene: &Scene) -> Vec<(&str, Vec<&Object>)> {
    let mut groups: Vec<(&str, Vec<&Object>)> = Vec::new();
    for object in scene.shown() {
        let id = scene.model_of(object);
        match groups.iter_mut().find(|(model, _)| *model == id) {
            Some((_, objects)) => objects.push(object),
            None => groups.push((id, vec![object])),
        }
    }
    groups
}

/// The names of the shading models of the visible objects: "Gouraud", "Gouraud and Flat".
pub(super) fn shadings(scene: &Scene, registry: &Registry) -> Option<String> {
    let ids: BTreeSet<_> = scene.shown().map(|object| scene.shading_model_of(object)).collect();
    let mut ids: Vec<_> = ids.into_iter().collect();
    // The scene's own shading model comes first.
    ids.sort_by_key(|id| *id != scene.shading_model);
    let name = |id: &&'_ str| {
        registry.shading_model(id).map_or_else(|| (*id).to_owned(), |m| m.declaration.name.to_owned())
    };
    let names: Vec<_> = ids.iter().map(name).collect();
    (!names.is_empty()).then(|| listed(&names, "and"))
}

/// The names of objects, if all have one and they are short.
fn names(objects: &[&Object]) -> Option<String> {
    let name = |object: &&Object| object.name.clone().filter(|name| !name.trim().is_empty());
    // More names would be longer than that.
    let names: Option<Vec<_>> = objects.iter().take(NAMES).map(name).collect();
    names.map(|names| names.join(", ")).filter(|all| objects.len() < NAMES && all.chars().count() <= NAMES)
}

/// The values of a parameter on several objects.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Spread {
    /// All have one value.
    One(Value),
    /// All have numbers from the first to the second.
    Range(Value, Value),
    /// Values differ otherwise.
    Several,
}

impl Spread {
    /// The values as a part, with a prefix for numbers: "= 27", "= 20 to 80"; `None` if the value has no
    /// name.
    pub(super) fn part(&self, parameter: &'static Parameter, before: &str) -> Option<Part> {
        let (symbol, text) = match self {
            Self::Several => return None,
            Self::One(one) => value(parameter, one)?,
            Self::Range(from, to) => {
                let (symbol, from) = value(parameter, from)?;
                (symbol, format!("{from} to {}", value(parameter, to)?.1))
            }
        };
        let unit = parameter.suffix();
        let text = match symbol {
            "" if !is_named(parameter) => format!("{} {before}{text}{unit}", parameter.label),
            _ if !is_named(parameter) => format!("{before}{text}{unit}"),
            // A name with a comma would look like two.
            _ if text.contains(',') => format!("“{text}”"),
            _ => text,
        };
        Some(Part { symbol, ..Part::new(VALUES, text) })
    }
}

/// The values of a parameter on the objects that use it; `None` if none does.
pub(super) fn spread(model: &ModelEntry, parameter: &Parameter, objects: &[&Object]) -> Option<Spread> {
    let used = |object: &&&Object| usage::unused(model.parameters, parameter, &object.material).is_none();
    let size = |value: &Value| parameter.kind.number_of(value);
    let mut values = objects.iter().filter(used).map(|object| object.material.get(parameter));
    let first = values.next()?;
    let (mut least, mut most, mut same) = (first.clone(), first.clone(), true);
    for value in values {
        same &= value == first;
        if size(&value) < size(&least) {
            least = value;
        } else if size(&value) > size(&most) {
            most = value;
        }
    }
    Some(match size(&first) {
        _ if same => Spread::One(first),
        Some(_) => Spread::Range(least, most),
        None => Spread::Several,
    })
}

/// The non-default values, in the order of their declaration.
pub(super) fn differing<'a>(
    model: &'a ModelEntry,
    objects: &'a [&Object],
) -> impl Iterator<Item = (&'static Parameter, Spread)> + 'a {
    model.parameters.iter().filter_map(move |parameter| {
        let spread = spread(model, parameter, objects)?;
        (spread != Spread::One(parameter.default_value())).then_some((parameter, spread))
    })
}

/// True if the values of a parameter have names, which need no symbol: choices and files.
fn is_named(parameter: &Parameter) -> bool {
    !parameter.kind.options().is_empty() || parameter.kind.format().is_some()
}

/// The symbol of a parameter and its value in words.
pub(crate) fn value(parameter: &'static Parameter, value: &Value) -> Option<(&'static str, String)> {
    let text = parameter.kind.caption(parameter.label, value)?;
    Some((if is_named(parameter) { "" } else { parameter.symbol }, text))
}

/// A value in words as a part of its own: with its symbol, or with its name where the words alone do not say what they
/// are about, as numbers, and yes and no.
pub(crate) fn said(label: &str, symbol: &'static str, shown: String) -> Part {
    let starts = |c: char| c.is_numeric() || "(-−".contains(c);
    let is_bare = symbol.is_empty() && (shown.starts_with(starts) || shown.parse::<bool>().is_ok());
    Part { symbol, ..Part::new(0, if is_bare { format!("{label} {shown}") } else { shown }) }
}

/// The term, if a single one is shown.
pub(crate) fn terms_alone(terms: TermSelection) -> Option<Part> {
    (terms != TermSelection::All).then(|| Part::new(1, format!("{} term alone", terms.id())))
}

/// Tone mapping, exposure and encoding where they differ from the defaults.
pub(crate) fn display(display: Display) -> Vec<Part> {
    let mut parts = Vec::new();
    if display.tone_mapping != ToneMapping::None {
        parts.push(Part::new(1, display.tone_mapping.name()));
    }
    if display.exposure != 0.0 {
        parts.push(Part::new(1, exposure(display.exposure)));
    }
    if display.encoding == Encoding::Off {
        parts.push(Part::new(1, "gamma-naive"));
    }
    parts
}

/// "+1 EV".
pub(crate) fn exposure(ev: f32) -> String {
    let sign = if ev > 0.0 { "+" } else { "" };
    format!("{sign}{} EV", number(f64::from(ev)))
}

/// The only one of a set.
pub(crate) fn single<'a>(all: &BTreeSet<&'a str>) -> Option<&'a str> {
    all.first().copied().filter(|_| all.len() == 1)
}
