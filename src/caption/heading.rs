//! The heading of a view: its overrides, in one line.

use std::collections::BTreeSet;

use super::{
    order::merged,
    part::{Part, line},
    said::Said,
    words::{differing, exposure, groups, shadings, spread, terms_alone},
};
use crate::{
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::ParameterKind,
    registry::Registry,
    scene::{Scene, variant::LETTERS},
};

/// Ranks of the parts of a heading; those up to the model are never dropped.
pub const MODEL_RANK: u8 = 1;
const SHADING: u8 = 2;
const DIFFERS: u8 = 3;
const DISPLAY: u8 = DIFFERS + MOST + 1;
const SAME: u8 = DISPLAY + 5;
/// Maximum number of parameters with ranks of their own.
const MOST: u8 = 120;

/// The heading of a view in one line: "B · Phong, α 27". It gives every value that any view overrides, so
/// that all headings give the same ones, and "as A" for a view that overrides nothing. Empty if the view does
/// not exist.
#[must_use]
pub fn header(scene: &Scene, view: usize, registry: &Registry) -> String {
    line(&header_parts(scene, view, registry))
}

/// The heading of a view, in parts, of which none may be dropped.
#[must_use]
pub fn header_parts(scene: &Scene, view: usize, registry: &Registry) -> Vec<Part> {
    let letter = LETTERS.get(view).copied().unwrap_or_default();
    let terms = scene.overrides(view).and_then(|variant| variant.terms).unwrap_or_default();
    let parts = view_parts(scene, (view, terms), registry);
    let letter = (!parts.is_empty()).then(|| Part::new(0, letter));
    letter.into_iter().chain(parts.into_iter().map(|part| Part { rank: 0, ..part })).collect()
}

/// The heading of a view that shows these terms, without its letter. What differs between views comes first, and parts
/// about the same have the same rank in all headings.
#[must_use]
pub fn view_parts(scene: &Scene, view: (usize, TermSelection), registry: &Registry) -> Vec<Part> {
    parts_of(scene, view, &Said::in_heading(scene, view.0), registry)
}

/// The parts of the caption of a view that shows these terms, as selected by `said`.
pub(super) fn parts_of(
    scene: &Scene,
    (view, terms): (usize, TermSelection),
    said: &Said,
    registry: &Registry,
) -> Vec<Part> {
    let Some((seen, _)) = scene.seen(view, registry) else { return Vec::new() };
    let mut parts = Vec::new();
    let mut say = |rank, text: String| parts.push(Part::new(rank, text).continued());
    let groups = groups(&seen);
    let model =
        |id: &str| registry.model(id).map_or_else(|| id.to_owned(), |m| m.declaration.name.to_owned());
    let models = || match groups.as_slice() {
        [] => "nothing visible".to_owned(),
        [(id, _)] => model(id),
        several => format!("{} models", several.len()),
    };
    if said.over.reflection_model.is_some() {
        say(MODEL_RANK, models());
    }
    if said.over.shading_model.is_some()
        && let Some(names) = shadings(&seen, registry)
    {
        say(SHADING, format!("{names} shading"));
    }
    parts.extend(values(scene, &seen, said, registry));
    // Each has a rank of its own, so that one of them is said where there is no room for all.
    let mut say = |place: u8, text: String| parts.push(Part::new(DISPLAY + place, text).continued());
    if said.over.terms.is_some() {
        say(0, terms_alone(terms).map_or_else(|| "all terms".to_owned(), |part| part.text));
    }
    if said.over.tone_mapping.is_some() {
        let none = seen.display.tone_mapping == ToneMapping::None;
        say(1, if none { "no tone mapping" } else { seen.display.tone_mapping.name() }.to_owned());
    }
    if said.over.exposure.is_some() {
        say(2, exposure(seen.display.exposure));
    }
    if said.over.encoding.is_some() {
        let naive = seen.display.encoding == Encoding::Off;
        say(3, if naive { "gamma-naive" } else { "gamma-correct" }.to_owned());
    }
    if said.over.tessellation.is_some()
        && let Some(counts) = tessellation(&seen, registry)
    {
        say(4, format!("tessellation {counts}"));
    }
    if parts.is_empty() {
        parts.push(Part::new(0, if view == 0 { models() } else { "as A".to_owned() }));
    }
    parts.sort_by_key(|part| part.rank);
    parts[0].continues = false;
    let name = view.checked_sub(1).and_then(|i| scene.variants.get(i)?.name.clone());
    // A name that repeats the first words adds nothing.
    let said = line(&parts).to_lowercase();
    let name = name.filter(|name| !said.starts_with(&name.to_lowercase()));
    name.map(|name| Part::new(0, name)).into_iter().chain(parts).collect()
}

/// The names of the parameters of the models that the views show, in the order in which those declare them.
fn declared(scene: &Scene, registry: &Registry) -> Vec<&'static str> {
    let views = (0..=scene.variants.len()).flat_map(|view| scene.models_shown(view));
    let mut models: Vec<&str> = Vec::new();
    for id in views {
        if !models.contains(&id) {
            models.push(id);
        }
    }
    let models = models.into_iter().filter_map(|id| registry.model(id));
    merged(models.map(|model| model.parameters.iter().map(|p| p.name).collect()).collect())
}

/// The names of the parameters whose values in the scene are no defaults of a model that some view shows.
fn unusual(scene: &Scene, said: &Said, registry: &Registry) -> BTreeSet<&'static str> {
    let overrides = (1..=scene.variants.len()).filter_map(|view| scene.overrides(view)?.reflection_model);
    let overrides: BTreeSet<_> = overrides.collect();
    let shown: Vec<_> = scene.shown().collect();
    let everywhere = overrides.iter().map(|id| (id.as_str(), shown.clone()));
    let mut names = BTreeSet::new();
    for (id, objects) in groups(scene).into_iter().chain(everywhere) {
        let Some(model) = registry.model(id) else { continue };
        let colour = |kind: &ParameterKind| matches!(kind, ParameterKind::Colour(_));
        let own = differing(model, &objects).filter(|(p, _)| said.colours || !colour(&p.kind));
        names.extend(own.map(|(p, _)| p.name));
    }
    names
}

/// The values in a heading, ranked in the order in which models declare them: those of the same parameters in all headings,
/// as far as their models have them.
fn values(scene: &Scene, seen: &Scene, said: &Said, registry: &Registry) -> Vec<Part> {
    if said.over.material.0.is_empty() && !said.values {
        return Vec::new();
    }
    let order = declared(scene, registry);
    let own = if said.values { unusual(scene, said, registry) } else { BTreeSet::new() };
    let mut parts: Vec<Part> = Vec::new();
    for (id, objects) in groups(seen) {
        let Some(model) = registry.model(id) else { continue };
        for parameter in model.parameters {
            let is_over = said.over.material.0.contains_key(parameter.name);
            if !is_over && !own.contains(parameter.name) {
                continue;
            }
            let part = spread(model, parameter, &objects).and_then(|spread| spread.part(parameter, ""));
            let at = order.iter().position(|name| *name == parameter.name);
            let least = if is_over { DIFFERS } else { SAME };
            let rank = least + at.map_or(MOST, |at| at.min(MOST.into()) as u8);
            let part = part.map(|part| Part { rank, ..part.continued() });
            // Several models may share a parameter.
            parts.extend(part.filter(|part| !parts.contains(part)));
        }
    }
    parts
}

/// The tessellation of the visible objects that have one: "16", "16 to 64".
fn tessellation(seen: &Scene, registry: &Registry) -> Option<String> {
    let counts =
        || seen.shown().filter_map(|o| Some(registry.shape(&o.object_type)?.tessellation(o.tessellation)));
    let (least, most) = (counts().min()?, counts().max()?);
    Some(if least == most { least.to_string() } else { format!("{least} to {most}") })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        parameter::{Value, Values},
        scene::{Display, Variant},
    };

    fn headers(scene: &Scene) -> Vec<String> {
        (0..=scene.variants.len()).map(|view| header(scene, view, &Registry::builtin())).collect()
    }

    fn values<const N: usize>(all: [(&'static str, Value); N]) -> Values {
        Values(all.into_iter().map(|(name, value)| (name.into(), value)).collect())
    }

    #[test]
    fn a_heading_says_what_the_view_overrides_and_a_says_its_own() {
        let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        assert_eq!(headers(&scene), ["A · Phong"]);
        scene.objects[0].material = values([("alpha", Value::Integer(20))]);
        let other = Variant {
            reflection_model: Some("blinn_phong".to_owned()),
            material: values([("alpha", Value::Integer(27)), ("roughness", Value::Number(0.1))]),
            ..Variant::default()
        };
        scene.variants = vec![other, Variant::default()];
        assert_eq!(headers(&scene), ["A · Phong, α 20", "B · Blinn–Phong, α 27", "C · as A"]);
        assert_eq!(header(&scene, 3, &Registry::builtin()), "");
        // A name comes first, unless it adds nothing.
        scene.variants[0].name = Some("Matched".to_owned());
        assert_eq!(headers(&scene)[1], "B · Matched · Blinn–Phong, α 27");
        scene.variants[0].name = Some("Blinn–Phong".to_owned());
        assert_eq!(headers(&scene)[1], "B · Blinn–Phong, α 27");
    }

    #[test]
    fn everything_that_can_be_overridden_is_said_in_order() {
        let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        let all = Variant {
            name: None,
            based_on: None,
            reflection_model: Some("blinn_phong".to_owned()),
            shading_model: Some("flat".to_owned()),
            material: values([("k_d", Value::Number(0.5))]),
            terms: Some(TermSelection::Diffuse),
            tone_mapping: Some(ToneMapping::AgX),
            exposure: Some(2.0),
            encoding: Some(Encoding::Off),
            tessellation: Some(12),
        };
        let back = Variant {
            terms: Some(TermSelection::All),
            tone_mapping: Some(ToneMapping::None),
            exposure: Some(0.0),
            encoding: Some(Encoding::Srgb),
            ..Variant::default()
        };
        scene.variants = vec![all, back];
        scene.display = Display {
            tone_mapping: ToneMapping::Aces,
            exposure: -1.0,
            encoding: Encoding::Srgb,
            ..Display::default()
        };
        assert_eq!(
            headers(&scene),
            [
                "A · Phong, Gouraud shading, k_d 0.8, all terms, ACES (fitted), −1 EV, gamma-correct, tessellation 32",
                "B · Blinn–Phong, Flat shading, k_d 0.5, diffuse term alone, AgX, +2 EV, gamma-naive, tessellation 12",
                "C · Phong, Gouraud shading, k_d 0.8, all terms, no tone mapping, 0 EV, gamma-correct, tessellation 32",
            ]
        );
    }

    #[test]
    fn values_have_the_order_of_their_declaration_and_are_the_same_in_all_headings() {
        let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
        let all = [("alpha", Value::Integer(9)), ("k_d", Value::Number(0.5)), ("k_a", Value::Number(0.3))];
        scene.variants = vec![Variant { material: values(all), ..Variant::default() }];
        for heading in headers(&scene) {
            let at = ["k_a", "k_d", "α"].map(|symbol| heading.find(symbol).expect("it differs"));
            assert!(at.is_sorted(), "{heading}");
        }
        // Those of the model with most parameters, also where the other one is A.
        scene.reflection_model = "lambert".to_owned();
        scene.variants[0].reflection_model = Some("phong".to_owned());
        let b = header(&scene, 1, &Registry::builtin());
        assert!(b.contains("k_a") && b.find("k_a") < b.find("k_d") && b.find("k_d") < b.find('α'), "{b}");
        // What one model has by default, and the other one has not, is said of both.
        scene.reflection_model = "disney".to_owned();
        scene.objects[0].material = values([("roughness", Value::Number(0.3))]);
        scene.variants[0] = Variant {
            reflection_model: Some("openpbr".to_owned()),
            material: values([("metallic", Value::Number(1.0))]),
            ..Variant::default()
        };
        for heading in headers(&scene) {
            assert!(heading.contains(" 0.3"), "{heading}");
        }
    }

    #[test]
    fn a_value_that_the_model_does_not_use_changes_nothing() {
        let other = Variant { material: values([("alpha", Value::Integer(9))]), ..Variant::default() };
        let scene = Scene { variants: vec![other], ..Scene::default() };
        assert_eq!(headers(&scene), ["A · Lambert", "B · as A"]);
    }
}
