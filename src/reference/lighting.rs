//! The light loop: the sum over all lights, common to all models.

use glam::Vec3;

use crate::{
    light::{Emitter, Incident, LightRecord},
    optics::{Frame, TermSelection},
    reflection::Surface,
    registry::Registry,
    scene::{Scene, record},
    shading::Lighting,
};

/// The light of any model is kept within these bounds, so that interpolating and adding it gives no infinity and no
/// NaN.
const BRIGHTEST: f32 = 1e30;

/// All lights of a scene, ready for calculation.
pub(super) struct Lights {
    lights: Vec<(Box<dyn Emitter>, LightRecord)>,
    observer: Vec3,
    terms: TermSelection,
}

impl Lights {
    pub(super) fn new(scene: &Scene, registry: &Registry, terms: TermSelection) -> Self {
        let lights = scene
            .shining()
            .filter_map(|light| {
                let encoding = scene.display.encoding;
                let entry = registry.light(&light.light_type)?;
                let emitter = (entry.instantiate)(&light.parameters, encoding);
                Some((emitter, record(light, registry, encoding)))
            })
            .collect();
        Self { lights, observer: scene.observer.position, terms }
    }

    /// The lights as they shine on one surface.
    pub(super) fn on<'a>(&'a self, surface: &'a dyn Surface) -> LightsOn<'a> {
        LightsOn { lights: self, surface }
    }
}

/// The lights of a scene and the surface that they shine on.
pub(super) struct LightsOn<'a> {
    lights: &'a Lights,
    surface: &'a dyn Surface,
}

impl Lighting for LightsOn<'_> {
    fn colour(&self, position: Vec3, normal: Vec3, tangent: Vec3) -> Vec3 {
        // An interpolated normal may face away from a viewer who still sees the surface: the viewer is then mirrored in
        // the surface, or rims would be black.
        let eye = (self.lights.observer - position).normalize_or_zero();
        let v = eye - 2.0 * normal.dot(eye).min(0.0) * normal;
        let frame = Frame::new(normal, tangent);
        let terms = self.lights.terms;
        let mut sum = Vec3::ZERO;
        for (emitter, light) in &self.lights.lights {
            match emitter.incident(light, position) {
                Incident::From { l, intensity } => {
                    // Outside a cone there is nothing to calculate.
                    if intensity != Vec3::ZERO {
                        let response = self.surface.response(l, v, &frame).select(terms);
                        sum += response * intensity * light.colour;
                    }
                }
                Incident::Uniform { intensity } => {
                    if matches!(terms, TermSelection::All | TermSelection::Ambient) {
                        sum += self.surface.ambient_response(v, &frame) * intensity * light.colour;
                    }
                }
            }
        }
        sum.map(|c| if c.is_nan() { 0.0 } else { c.clamp(-BRIGHTEST, BRIGHTEST) })
    }
}
