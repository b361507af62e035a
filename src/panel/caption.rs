//! The picture in words, so that a screenshot says what it shows.

use std::collections::BTreeSet;

use super::state::Lab;
use crate::document::limits::number;
use crate::{
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::{Parameter, Value},
    reflection::usage,
    registry::Registry,
    scene::Object,
};

/// More values would be a list, not a caption.
const VALUES: usize = 4;

/// The models, the shading and the display of the picture; with one object, its key values.
#[must_use]
pub fn caption_text(lab: &Lab, registry: &Registry) -> String {
    let scene = &lab.document;
    let models: BTreeSet<_> = scene.shown().map(|o| scene.model_of(o)).collect();
    let modes: BTreeSet<_> = scene.shown().map(|o| scene.mode_of(o)).collect();
    let mut parts = Vec::new();
    match single(&models) {
        Some(id) => parts.push(registry.model(id).map_or(id, |m| m.declaration.name).to_owned()),
        None if models.is_empty() => parts.push("nothing visible".to_owned()),
        None => parts.push(format!("{} models", models.len())),
    }
    match single(&modes) {
        Some(id) => match registry.mode(id) {
            Some(mode) => {
                let d = mode.declaration;
                parts.push(format!("{} shading", d.name));
                parts.push(format!("computed {}", d.stage.phrase()));
            }
            None => parts.push(format!("{id} shading")),
        },
        None if modes.is_empty() => {}
        None => parts.push(format!("{} shading models", modes.len())),
    }
    let mut objects = scene.shown();
    if let (Some(object), None) = (objects.next(), objects.next()) {
        parts.extend(key_values(object, scene.model_of(object), registry));
    }
    match lab.view.terms {
        TermSelection::All => {}
        other => parts.push(format!("{} term alone", other.id())),
    }
    match scene.display.exposure {
        0.0 => {}
        ev => parts.push(format!("{}{} EV", if ev > 0.0 { "+" } else { "" }, number(f64::from(ev)))),
    }
    match scene.display.tone_mapping {
        ToneMapping::None => {}
        tone => parts.push(tone.name().to_owned()),
    }
    if scene.display.encoding == Encoding::Off {
        parts.push("gamma-naive".to_owned());
    }
    parts.join(" · ")
}

fn single<'a>(all: &BTreeSet<&'a str>) -> Option<&'a str> {
    all.first().copied().filter(|_| all.len() == 1)
}

/// The numbers of the material: all of them where they are few, else those that are not the defaults. The equation ends
/// with what shapes the highlight, so the last ones come first.
fn key_values(object: &Object, model: &str, registry: &Registry) -> Vec<String> {
    let Some(model) = registry.model(model) else { return Vec::new() };
    let value = |p: &Parameter| match object.material.get(p) {
        Value::Number(v) => Some(number(f64::from(v))),
        Value::Integer(v) => Some(v.to_string()),
        _ => None,
    };
    let used = |p: &&Parameter| usage::unused(model.parameters, p, &object.material).is_none();
    let numbers: Vec<_> =
        model.parameters.iter().rev().filter(used).filter_map(|p| Some((p, value(p)?))).collect();
    let few = numbers.len() <= VALUES;
    numbers
        .into_iter()
        .filter(|(p, _)| few || object.material.get(p) != p.default_value())
        .take(VALUES)
        .map(|(p, value)| format!("{} {value}", p.symbol))
        .collect()
}
