//! The explanation in one sentence: which light contributes most to the pixel, and by which term.

use std::collections::BTreeMap;

use glam::Vec3;

use super::{Explanation, Lamp, Seen, dark_glass::WHY};
use crate::{
    optics::{TERMS, TermSelection, Terms, colour::luminance},
    text::listed,
};

/// Fraction above which a term counts as all of a lamp's light.
const ALL: f64 = 0.995;

/// The terms, in words.
const NAMES: [&str; TERMS] = ["ambient", "diffuse", "specular", "transmitted"];

/// The contributions of lights to a pixel as luminances, by index of the light: the sum, and the
/// terms. With Gouraud shading, it is the weighted light of the vertices.
fn given(seen: &Seen) -> BTreeMap<usize, [f64; 1 + TERMS]> {
    let mut lights = BTreeMap::new();
    for spot in &seen.spots {
        let weight = f64::from(spot.place.weight());
        for lit in &spot.lights {
            let sums: &mut [f64; 1 + TERMS] = lights.entry(lit.light.index).or_default();
            let reflected = lit.response.each().map(|term| term * lit.arriving);
            let through = Terms::through(lit.through).each();
            let terms: [Vec3; TERMS] = std::array::from_fn(|i| reflected[i] + through[i]);
            let all = [lit.contribution].into_iter().chain(terms);
            for (sum, light) in sums.iter_mut().zip(all) {
                *sum += weight * brightness(light);
            }
        }
    }
    lights
}

/// The luminance of light, exact for grey; `NaN` if any component is not finite.
fn brightness(light: Vec3) -> f64 {
    match light {
        light if light.x == light.y && light.y == light.z => light.x.into(),
        light if !light.is_finite() => f64::NAN,
        light => luminance(light).into(),
    }
}

/// The term that contributes most of a lamp's light, in words.
fn by_term(terms: [f64; TERMS]) -> Option<String> {
    let sum: f64 = terms.iter().sum();
    let parts = terms.map(|term| term / sum);
    let (most, name) = parts
        .into_iter()
        .zip(NAMES)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|_| parts.iter().all(|part| part.is_finite() && *part >= 0.0))?;
    match most {
        m if m >= ALL => Some(format!(", by the {name} term")),
        m if m > 0.5 => Some(format!(", mostly by the {name} term")),
        _ => None,
    }
}

/// The terms of the model that are not finite, of those that are shown.
fn not_finite(seen: &Seen, terms: TermSelection) -> String {
    let lights = seen.spots.iter().flat_map(|spot| &spot.lights);
    let responses: Vec<_> = lights.map(|lit| lit.response.only(terms).each()).collect();
    let is_odd = |i: &usize| responses.iter().any(|each| !each[*i].is_finite());
    let odd: Vec<_> = (0..TERMS).filter(is_odd).map(|i| NAMES[i]).collect();
    match &odd[..] {
        // The light itself.
        [] => "some of its light is not a finite number".to_owned(),
        [one] => format!("the {one} term of its model is not a finite number"),
        all => format!("the {} terms of its model are not finite numbers", listed(all, "and")),
    }
}

/// The share of the brightest lamp.
fn most(seen: &Seen, terms: TermSelection, name: &dyn Fn(usize) -> String) -> String {
    let given = given(seen);
    if given.is_empty() {
        return if seen.spots.is_empty() {
            "the shading model did not evaluate the reflection model".to_owned()
        } else {
            "no light is switched on".to_owned()
        };
    }
    if given.values().any(|sums| !sums[0].is_finite()) {
        return not_finite(seen, terms);
    }
    if given.values().any(|sums| sums[0] < 0.0) {
        return "some light has a value below 0, so the parts of the lights have no meaning".to_owned();
    }
    let sum: f64 = given.values().map(|sums| sums[0]).sum();
    let brightest = given.iter().max_by(|a, b| a.1[0].total_cmp(&b.1[0]));
    let Some((index, sums)) = brightest.filter(|_| sum > 0.0) else {
        return match terms {
            TermSelection::All => "no light leaves this point towards the observer".to_owned(),
            terms => format!("the {} term gives no light here", terms.id()),
        };
    };
    let part = sums[0] / sum;
    let alone = given.values().filter(|sums| sums[0] > 0.0).count() == 1;
    let part = match part {
        _ if alone => "all of its light".to_owned(),
        part if part >= ALL => "nearly all of its light".to_owned(),
        part => format!("{:.0} % of its light", 100.0 * part),
    };
    let by = match terms {
        TermSelection::All => by_term([sums[1], sums[2], sums[3], sums[4]]).unwrap_or_default(),
        terms => format!(", by the {} term, the only one shown", terms.id()),
    };
    format!("{} gives {part}{by}", name(*index))
}

/// The explanation in a few sentences: the colour of the pixel, the light that contributes most, and by
/// which term. It begins with `subject`, such as "This pixel is". `name` gives the name of the light with
/// that index in the scene.
///
/// ```
/// use lights_camera_models::{explain, reference::Settings, registry::Registry, scene::Scene};
/// let settings = Settings { width: 640, height: 360, ..Settings::default() };
/// let explained = explain::pixel(&Scene::default(), &Registry::builtin(), &settings, [320, 180]).unwrap();
/// let said = explain::sentence(&explained, "This pixel is", &|light| format!("Lamp {light}"));
/// assert!(said.starts_with("This pixel is ("), "{said}");
/// assert!(said.contains("Lamp 0 gives"), "{said}");
/// ```
#[must_use]
pub fn sentence(explanation: &Explanation, subject: &str, name: &dyn Fn(usize) -> String) -> String {
    let [r, g, b] = explanation.code();
    if let Some(Lamp { lights, .. }) = &explanation.lamp {
        let names: Vec<_> = lights.iter().map(|light| name(light.index)).collect();
        let names = names.join(" with ");
        return format!("{subject} ({r}, {g}, {b}): no object is here; {names} itself is seen.");
    }
    let Some(seen) = &explanation.seen else {
        return format!("{subject} ({r}, {g}, {b}): no object is here, and the background shows.");
    };
    let mapped = explanation.steps.mapped;
    let end = match () {
        () if mapped.is_nan() => " Its light is not a number, and shown as 0.",
        () if mapped.max_element() > 1.0 => " It is brighter than the display can show, and clipped.",
        () => "",
    };
    let glass = match seen.dark_glass && explanation.terms == TermSelection::All {
        true => format!(" It is smooth glass: {WHY}."),
        false => String::new(),
    };
    format!("{subject} ({r}, {g}, {b}): {}.{end}{glass}", most(seen, explanation.terms, name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{explain::pixel, reference::Settings, registry::Registry, scene::Scene};

    #[test]
    fn terms_that_are_not_finite_are_named() {
        let settings = Settings { width: 640, height: 360, ..Settings::default() };
        let mut explained =
            pixel(&Scene::default(), &Registry::builtin(), &settings, [320, 180]).expect("the sphere");
        let mut said = |change: fn(&mut Terms)| {
            for spot in explained.seen.iter_mut().flat_map(|seen| &mut seen.spots) {
                for lit in &mut spot.lights {
                    change(&mut lit.response);
                    lit.contribution = Vec3::NAN;
                }
            }
            sentence(&explained, "This pixel is", &|light| format!("Lamp {light}"))
        };
        let light = said(|_| ());
        assert!(light.contains(": some of its light is not a finite number."), "{light}");
        let one = said(|terms| terms.specular.x = f32::NAN);
        assert!(one.contains(": the specular term of its model is not a finite number."), "{one}");
        let two = said(|terms| terms.diffuse = Vec3::INFINITY);
        assert!(
            two.contains(": the diffuse and specular terms of its model are not finite numbers."),
            "{two}"
        );
    }

    #[test]
    fn the_term_is_named_that_gives_the_most() {
        assert_eq!(by_term([0.0, 0.0, 2.0, 0.0]).as_deref(), Some(", by the specular term"));
        assert_eq!(by_term([0.1, 0.7, 0.2, 0.0]).as_deref(), Some(", mostly by the diffuse term"));
        assert_eq!(by_term([0.1, 0.0, 0.1, 0.8]).as_deref(), Some(", mostly by the transmitted term"));
        assert_eq!(by_term([0.3, 0.3, 0.4, 0.0]), None);
        assert_eq!(
            (by_term([0.0; 4]), by_term([f64::NAN, 1.0, 0.0, 0.0]), by_term([-1.0, 3.0, 0.0, 0.0])),
            (None, None, None)
        );
    }
}
