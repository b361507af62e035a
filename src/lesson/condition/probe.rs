//! Quantities of the pinned pixel, from its explanation.

use crate::{
    explain::{Explanation, Geometry, Lit, Place, Seen, Spot, angle as degrees},
    lesson::Situation,
    optics::colour::luminance,
    reference::brightest_vertex as brightest,
    text::plural,
};

/// Minimum weight of a vertex near which a pixel lies.
const NEAR: f32 = 0.6;
/// Fraction of the highest brightness at which a vertex counts as brightest.
const ALMOST: f32 = 0.999;

/// The explanation of the pinned pixel.
pub(super) fn pinned<'a>(s: &Situation<'a>) -> Result<&'a Explanation, String> {
    let explanation: Option<&'a Explanation> = s.probe;
    match explanation {
        Some(explanation) if s.pinned => Ok(explanation),
        None if s.pinned => Err("the pinned pixel is not explained yet".to_owned()),
        _ => Err("nothing is pinned".to_owned()),
    }
}

/// The object at the pinned pixel.
pub(super) fn seen<'a>(s: &Situation<'a>) -> Result<&'a Seen, String> {
    pinned(s)?.seen.as_ref().ok_or_else(|| "there is no object at the pinned pixel".to_owned())
}

pub(super) fn object(s: &Situation) -> Result<String, String> {
    let part = &seen(s)?.object;
    Ok(part.name.clone().unwrap_or_else(|| format!("object {}", part.index + 1)))
}

/// The point visible at the pixel, wherever the shading model evaluates the equation.
fn point<'a>(s: &Situation<'a>) -> Result<&'a Spot, String> {
    let seen = seen(s)?;
    seen.per_pixel.as_ref().or(seen.spots.first()).ok_or_else(|| "the pinned pixel has no light".to_owned())
}

/// The brightest light at that point for which `of` returns a value.
fn light<'a, T>(s: &Situation<'a>, of: impl Fn(&'a Lit) -> Option<T>) -> Result<T, String> {
    let lights = point(s)?.brightest();
    lights.into_iter().find_map(of).ok_or_else(|| "no light with a direction shines there".to_owned())
}

pub(super) fn cosine(s: &Situation, name: &str) -> Result<f64, String> {
    if name == "N·V" {
        let spot = point(s)?;
        return Ok(f64::from(spot.normal.dot(spot.view)));
    }
    light(s, |lit| lit.geometry.map(|geometry: Geometry| f64::from(geometry.cosine(name))))
}

pub(super) fn angle(s: &Situation, name: &str) -> Result<f64, String> {
    cosine(s, name).map(|cosine| f64::from(degrees(cosine as f32)))
}

pub(super) fn light_distance(s: &Situation) -> Result<f64, String> {
    light(s, |lit| lit.distance.map(f64::from))
        .map_err(|_| "no light with a position shines there".to_owned())
}

/// True if the specular term is brighter than the diffuse term at the evaluated points, by weight.
pub(super) fn is_highlight(s: &Situation) -> Result<bool, String> {
    let seen = seen(s)?;
    let mut sums = [0.0f32; 2];
    for spot in &seen.spots {
        let weight = spot.place.weight();
        for lit in &spot.lights {
            let terms = [lit.response.diffuse, lit.response.specular];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += weight * luminance(term * lit.arriving);
            }
        }
    }
    let [diffuse, specular] = sums;
    Ok(specular > diffuse)
}

pub(super) fn brightest_vertex(s: &Situation) -> Result<bool, String> {
    let seen = seen(s)?;
    let vertices: Vec<_> =
        seen.spots.iter().filter(|spot| matches!(spot.place, Place::Vertex { .. })).collect();
    let Some(eye) = vertices.first().map(|spot| spot.position + spot.distance * spot.eye) else {
        let (points, name) = (plural(seen.spots.len(), "point"), seen.shading.name);
        return Err(format!("the equation is not evaluated at vertices but at {points} under {name}"));
    };
    let terms = pinned(s)?.terms;
    let most = brightest(s.scene, s.registry, terms, seen.object.index, eye);
    let Some(most) = most else { return Err("the object has no vertex that is lit".to_owned()) };
    Ok(seen.corners.iter().any(|corner| corner.weight >= NEAR && luminance(corner.colour) >= ALMOST * most))
}
