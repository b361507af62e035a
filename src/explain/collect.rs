//! Explanations collected from the renderer's own calculation.

use std::{f32::consts::PI, sync::Arc};

use super::{
    Asked, Brightest, Geometry, Integral, Lamp, Lit, Model, Part, Place, Refraction, Seen, Setting, Spot,
    dark_glass::is_dark_glass,
};
use glam::Vec3;

use crate::{
    caption::label_of,
    light::Incident,
    optics::{TermSelection, colour::Encoding},
    parameter::{Parameter, Value, Values},
    reference::{
        Shot,
        probe::{Body, LitBy, Loop, Point, Probe, light_loop},
        visible::Shown,
    },
    reflection::{EquationPart, ModelEntry, Surface},
    scene::Light,
    shading::Stage,
};

impl Shot<'_> {
    /// The explanation of the object that a probe found.
    pub(super) fn seen(&self, found: Probe) -> Option<Seen> {
        let object = self.scene.objects.get(found.object)?;
        let model = self.registry.model(self.scene.model_of(object))?;
        let shading = self.registry.shading_model(self.scene.shading_model_of(object))?;
        let type_name = self.registry.shape(&object.object_type).map(|entry| entry.declaration.name);
        let corners = found.corners;
        let spot =
            |place: Place, point: &Point| self.spot(place, point, (&*found.surface, found.body.as_ref()));
        let of_corner = |corner: usize| match found.stage {
            Stage::Polygon => Place::Polygon,
            _ => Place::Vertex { vertex: corners[corner].vertex, weight: corners[corner].weight },
        };
        let at_corners = found.at_corners.iter().map(|(corner, point)| spot(of_corner(*corner), point));
        let at_pixel = found.at_pixel.iter().map(|point| spot(Place::Pixel, point));
        Some(Seen {
            object: part(found.object, &object.name, &object.object_type, type_name),
            label: label_of(self.scene, found.object, self.registry),
            shading: shading.declaration,
            position: found.varying.position,
            polygon: found.polygon,
            outline: found.outline,
            face_normal: found.face_normal,
            interpolated_normal: found.varying.normal,
            corners,
            spots: at_corners.chain(at_pixel).collect(),
            per_pixel: found.phong.as_ref().map(|point| spot(Place::Pixel, point)),
            light: found.light.truncate(),
            dark_glass: is_dark_glass(self.scene, object, self.registry),
            // Checked last: an endless function is detected only when it runs.
            model: Model::of(model, &object.material, self.scene.display.encoding, found.surface.clone()),
        })
    }

    fn light(&self, index: usize, light: &Light) -> Part {
        let entry = self.registry.light(&light.light_type);
        part(index, &light.name, &light.light_type, entry.map(|entry| entry.declaration.name))
    }

    /// The lights that are visible at a pixel.
    pub(super) fn lamp(&self, shown: &Shown) -> Lamp {
        let lights = shown.lights.iter().filter_map(|i| Some(self.light(*i, self.scene.lights.get(*i)?)));
        Lamp { lights: lights.collect(), radiance: shown.light / PI, light: shown.light }
    }

    fn spot(&self, place: Place, point: &Point, of: (&dyn Surface, Option<&Body>)) -> Spot {
        let run = light_loop(*self, of, point);
        let lit = |by: &LitBy| Some(self.lit(self.scene.lights.get(by.index)?, by, point, &run));
        Spot {
            place,
            position: point.position,
            normal: point.normal,
            frame: run.frame,
            eye: run.eye,
            view: run.v,
            distance: self.scene.observer.position.distance(point.position),
            refraction: Refraction::of(of.0, of.1, point.position, run.v, &run.frame),
            lights: run.lights.iter().filter_map(lit).collect(),
            sum: run.sum,
            colour: point.colour,
        }
    }

    fn lit(&self, light: &Light, by: &LitBy, point: &Point, run: &Loop) -> Lit {
        let declaration = self.registry.light(&light.light_type).map(|entry| entry.declaration);
        let position = declaration.filter(|d| d.has_position).map(|_| by.record.position);
        let (intensity, geometry) = match by.incident {
            Incident::From { l, intensity } => (intensity, Some(Geometry::of(l, run.v, run.frame))),
            Incident::Uniform { intensity } => (intensity, None),
        };
        let integral = by.integral.map(|integral| Integral {
            errors: integral.errors,
            error: match self.settings.terms {
                TermSelection::All => integral.error,
                terms => integral.errors.select(terms),
            },
            samples: integral.samples,
            solid_angle: integral.solid_angle,
            brightest: integral.brightest.map(|brightest| Brightest {
                geometry: Geometry::of(brightest.l, run.v, run.frame),
                luminance: brightest.radiance,
                response: brightest.response,
            }),
        });
        let extends = integral.is_some();
        Lit {
            light: self.light(by.index, light),
            equation: declaration.map_or("", |d| d.equation),
            position,
            distance: position.map(|p| p.distance(point.position)),
            factors: if extends { Vec::new() } else { by.factors.clone() },
            intensity,
            colour: by.record.colour,
            arriving: if extends { Vec3::ONE } else { intensity * by.record.colour },
            geometry: geometry.filter(|_| !extends),
            response: by.response,
            integral,
            through: by.through,
            contribution: by.contribution,
        }
    }
}

/// A light or an object with this index, name and type.
fn part(index: usize, name: &Option<String>, id: &str, type_name: Option<&'static str>) -> Part {
    Part { index, name: name.clone(), id: id.to_owned(), type_name: type_name.unwrap_or_default() }
}

impl Model {
    /// A model with an object's parameters, and its surface.
    #[must_use]
    pub fn of(entry: &ModelEntry, values: &Values, encoding: Encoding, surface: Arc<dyn Surface>) -> Self {
        let setting = |parameter: &'static Parameter| {
            let value = values.get(parameter);
            let linear = parameter.kind.linear(&value, encoding);
            Setting { parameter, value, linear }
        };
        Self {
            id: entry.declaration.id,
            declaration: entry.declaration,
            equation: entry.declaration.equation_of(entry.passage(values)),
            settings: entry.parameters.iter().map(setting).collect(),
            surface: Asked(surface),
            interpreted: entry.is_interpreted(),
            trouble: entry.not_on_cpu(),
        }
    }

    /// The parts of the equation. Those of light along a path in a body are only there for surfaces that have an inside.
    pub(super) fn parts(&self) -> impl Iterator<Item = &EquationPart> {
        let outside = self.declaration.solid && self.surface.0.interior().is_none();
        self.equation.iter().filter(move |part| !(part.along_path && outside))
    }

    /// True if the parameter with this name has one of these choices.
    pub(super) fn chooses(&self, name: &str, ids: &[&str]) -> bool {
        let setting = self.settings.iter().find(|setting| setting.parameter.name == name);
        setting.is_some_and(|setting| matches!(&setting.value, Value::Choice(id) if ids.contains(&&**id)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{reflection::Term, registry::Registry};

    #[test]
    fn the_equation_of_an_opaque_surface_has_no_transmitted_term() {
        let registry = Registry::builtin();
        let entry = registry.model("openpbr").expect("built in");
        for weight in [0.0, 1.0] {
            let mut values = Values::default();
            values.set("transmission_weight", Value::Number(weight));
            let surface = entry.instantiate(&values, Encoding::Srgb);
            let model = Model::of(entry, &values, Encoding::Srgb, surface);
            let named = model.parts().any(|part| part.text.contains(Term::Transmitted.symbol()));
            assert_eq!(named, weight > 0.0, "{:?}", model.equation);
        }
    }
}
