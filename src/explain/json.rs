//! Explanations as JSON.

use glam::Vec3;
use serde_json::{Value as Json, json};

use super::{
    Brightest, Explanation, Geometry, Influence, Inside, Integral, Line, Lit, Model, Part, Place, Refraction,
    Seen, Setting, Spot, Turn, angle,
};
use crate::{light::Factor, optics::Terms, parameter, text::number as finite};

/// Digits of substituted numbers: all that 32 bits have.
const FULL: usize = 9;

/// A number; non-finite values, which JSON does not have, become strings: `"NaN"`, `"Infinity"`,
/// `"-Infinity"`.
fn number(v: f32) -> Json {
    match v {
        v if v.is_finite() => finite(v),
        v if v.is_nan() => "NaN".into(),
        v if v > 0.0 => "Infinity".into(),
        _ => "-Infinity".into(),
    }
}

/// A 64-bit number, with the digits of 32 bits where those suffice.
fn exact(v: f64) -> Json {
    match v as f32 {
        short if f64::from(short) == v || !v.is_finite() => number(short),
        _ => v.into(),
    }
}

fn triple(v: Vec3) -> Json {
    v.to_array().into_iter().map(number).collect()
}

fn part(part: &Part) -> Json {
    json!({ "index": part.index, "name": part.name, "type": part.id })
}

impl Explanation {
    /// The explanation as JSON, with every number. Non-finite numbers become the strings `"NaN"`,
    /// `"Infinity"` and `"-Infinity"`.
    #[must_use]
    pub fn to_json(&self) -> Json {
        let steps = &self.steps;
        json!({
            "pixel": self.pixel,
            "size": self.size,
            "terms": self.terms.id(),
            "code": self.code(),
            "background": self.seen.is_none() && self.lamp.is_none(),
            "light_seen": self.lamp.as_ref().map(|lamp| json!({
                "lights": lamp.lights.iter().map(part).collect::<Json>(),
                "radiance": triple(lamp.radiance),
                "light": triple(lamp.light),
            })),
            "seen": self.seen.as_ref().map(Seen::to_json),
            "display": {
                "light": triple(steps.light),
                "coverage": number(steps.coverage),
                "exposure": number(self.display.exposure),
                "exposure_factor": number(steps.exposure),
                "exposed": triple(steps.exposed),
                "encoding": self.display.encoding.id(),
                "curve_input": triple(steps.input),
                "tone_mapping": self.display.tone_mapping.id(),
                "mapped": triple(steps.mapped),
                "encoded": triple(steps.encoded),
                "code": steps.codes,
            },
        })
    }
}

impl Influence {
    /// The influence as JSON.
    #[must_use]
    pub fn to_json(&self) -> Json {
        json!({
            "symbol": self.symbol,
            "label": self.label,
            "unit": self.unit,
            "value": exact(self.value),
            "tried": self.tried.map(exact),
            "light": self.light.map(triple),
            "derivative": triple(self.derivative()),
            "effect": number(self.effect()),
        })
    }
}

impl Seen {
    fn to_json(&self) -> Json {
        let corner = |corner: &super::Corner| {
            json!({
                "vertex": corner.vertex,
                "position": triple(corner.position),
                "weight": number(corner.weight),
                "colour": triple(corner.colour),
            })
        };
        let spot = |spot: &Spot| spot.to_json(&self.model);
        json!({
            "object": part(&self.object),
            "label": self.label,
            "polygon": self.polygon,
            "position": triple(self.position),
            "face_normal": triple(self.face_normal),
            "interpolated_normal": triple(self.interpolated_normal),
            "reflection_model": self.model.to_json(),
            "shading_model": { "id": self.shading.id, "name": self.shading.name, "stage": self.shading.stage.phrase() },
            "corners": self.corners.iter().map(corner).collect::<Json>(),
            "spots": self.spots.iter().map(spot).collect::<Json>(),
            "light": triple(self.light),
            "per_pixel": self.per_pixel.as_ref().map(spot),
        })
    }
}

impl Model {
    fn to_json(&self) -> Json {
        let setting = |setting: &Setting| {
            json!({
                "name": setting.parameter.name,
                "symbol": setting.parameter.symbol,
                "value": parameter::json(&setting.value),
                "linear": setting.linear.map(triple),
            })
        };
        let equation = self.equation.iter().map(|part| part.text);
        json!({
            "id": self.id,
            "name": self.declaration.name,
            "equation": equation.collect::<Json>(),
            "parameters": self.settings.iter().map(setting).collect::<Json>(),
            "interpreted": self.interpreted,
            "trouble": self.trouble,
        })
    }
}

impl Spot {
    fn to_json(&self, model: &Model) -> Json {
        let (place, vertex, weight) = match self.place {
            Place::Polygon => ("polygon", None, None),
            Place::Vertex { vertex, weight } => ("vertex", Some(vertex), Some(number(weight))),
            Place::Pixel => ("pixel", None, None),
        };
        json!({
            "place": place,
            "vertex": vertex,
            "weight": weight,
            "position": triple(self.position),
            "N": triple(self.normal),
            "eye": triple(self.eye),
            "V": triple(self.view),
            "distance": number(self.distance),
            "refraction": self.refraction.as_ref().map(Refraction::to_json),
            "lights": self.brightest().into_iter().map(|lit| lit.to_json(model)).collect::<Json>(),
            "sum": triple(self.sum),
            "colour": triple(self.colour),
        })
    }
}

/// The scalar products at a point by name, mapped by `of`, for instance to angles.
fn cosines(geometry: &Geometry, of: impl Fn(f32) -> f32) -> Json {
    geometry.cosines.into_iter().map(|(name, c)| (name.to_owned(), number(of(c)))).collect()
}

impl Refraction {
    fn to_json(&self) -> Json {
        let turn = |turn: &Turn| {
            json!({
                "position": triple(turn.position),
                "length": number(turn.length),
                "angle": number(angle(turn.cosine)),
                "reflectance": number(turn.reflectance),
                "from": turn.leaves.map(|(direction, _)| triple(direction)),
                "part": turn.leaves.map(|(_, part)| triple(part)),
            })
        };
        let (inside, turns, remaining) = match &self.inside {
            None => (None, None, None),
            Some(Inside::Pane(_)) => (Some("pane"), None, None),
            Some(Inside::Chance) => (Some("rough"), None, None),
            Some(Inside::Ways(turns, remaining)) => {
                (Some("solid"), Some(turns.iter().map(turn).collect::<Json>()), Some(triple(*remaining)))
            }
        };
        json!({
            "index": number(self.index),
            "incidence": number(self.incidence),
            "refracted": self.refracted.map(number),
            "critical": number(self.critical),
            "reflectance": number(self.reflectance),
            "inside": inside,
            "turns": turns,
            "remaining": remaining,
        })
    }
}

/// The terms; the transmitted one of models that light passes through alone.
fn terms(Terms { ambient, diffuse, specular, transmitted }: &Terms, model: &Model) -> Json {
    let mut all =
        json!({ "ambient": triple(*ambient), "diffuse": triple(*diffuse), "specular": triple(*specular) });
    if model.surface.0.transmits() {
        all["transmitted"] = triple(*transmitted);
    }
    all
}

fn lines(lines: &[Line]) -> Json {
    let line = |line: &Line| {
        json!({
            "term": line.symbol(),
            "text": line.text,
            "numbers": line.numbers,
            "value": line.value.map(|value| value.rgb.map(exact)),
            "error": line.error.map(triple),
            "defines": line.defines(),
            "unit": line.value.map(|value| if value.degrees == 1 { "°" } else { "" }),
            "quantity": line.quantity.map(|quantity| quantity.label),
            "source": line.quantity.map(|quantity| quantity.source),
        })
    };
    lines.iter().map(line).collect()
}

impl Integral {
    fn json(self, model: &Model) -> Json {
        let brightest = |brightest: &Brightest| {
            let geometry = &brightest.geometry;
            json!({
                "L": triple(geometry.l),
                "H": triple(geometry.h),
                "R": triple(geometry.r),
                "cosines": cosines(geometry, |c| c),
                "angles": cosines(geometry, angle),
                "luminance": triple(brightest.luminance),
                "response": terms(&brightest.response, model),
                "lines": lines(&brightest.lines(model, FULL)),
            })
        };
        let [solid_angle, solid_angle_error] = self.solid_angle.map(number);
        json!({
            "samples": { "light": self.samples, "lobes": self.samples },
            "errors": terms(&self.errors, model),
            "error": triple(self.error),
            "solid_angle": solid_angle,
            "solid_angle_error": solid_angle_error,
            "brightest": self.brightest.as_ref().map(brightest),
        })
    }
}

impl Lit {
    fn to_json(&self, model: &Model) -> Json {
        let one = self.integral.is_none();
        let factor = |factor: &Factor| {
            let from = factor.from.iter().map(
                |(symbol, value, unit)| json!({ "symbol": symbol, "value": number(*value), "unit": unit }),
            );
            json!({
                "symbol": factor.symbol,
                "meaning": factor.meaning,
                "value": triple(factor.value),
                "unit": factor.unit,
                "from": from.collect::<Json>(),
            })
        };
        json!({
            "light": part(&self.light),
            "position": self.position.map(triple),
            "distance": self.distance.map(number),
            "L": self.geometry.map(|g| triple(g.l)),
            "H": self.geometry.map(|g| triple(g.h)),
            "R": self.geometry.map(|g| triple(g.r)),
            "cosines": self.geometry.map(|g| cosines(&g, |c| c)),
            "angles": self.geometry.map(|g| cosines(&g, angle)),
            "equation": one.then_some(self.equation),
            "factors": self.factors.iter().map(factor).collect::<Json>(),
            "intensity": one.then(|| triple(self.intensity)),
            "colour": triple(self.colour),
            "arriving": one.then(|| triple(self.arriving)),
            "response": terms(&self.response, model),
            "integral": self.integral.map(|integral| integral.json(model)),
            "lines": lines(&self.rounded_lines(model, FULL)),
            "through": (self.through != Vec3::ZERO).then(|| triple(self.through)),
            "contribution": triple(self.contribution),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_not_finite_are_not_hidden() {
        assert_eq!(
            triple(Vec3::new(f32::NAN, f32::INFINITY, f32::NEG_INFINITY)),
            json!(["NaN", "Infinity", "-Infinity"])
        );
        assert_eq!(triple(Vec3::new(0.1, 1.0, -2.5)), json!([0.1, 1, -2.5]));
    }
}
