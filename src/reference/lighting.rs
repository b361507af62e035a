//! The light loop: the sum over all lights, common to all models.

use glam::Vec3;

use crate::{
    light::{AT_ONCE, Emitters},
    optics::{Frame, TermSelection, radiometry::Arriving},
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
    /// Neighbours of one type together, in the order of the scene.
    groups: Vec<Box<dyn Emitters>>,
    observer: Vec3,
    terms: TermSelection,
}

impl Lights {
    pub(super) fn new(scene: &Scene, registry: &Registry, terms: TermSelection) -> Self {
        let encoding = scene.display.encoding;
        let known: Vec<_> =
            scene.shining().filter_map(|light| Some((registry.light(&light.light_type)?, light))).collect();
        let groups = known
            .chunk_by(|(a, _), (b, _)| a.index == b.index)
            .map(|lights| {
                let group = lights[0].0.group;
                let lights: Vec<_> =
                    lights.iter().map(|(_, l)| (&l.parameters, record(l, registry, encoding))).collect();
                group(&lights, encoding)
            })
            .collect();
        Self { groups, observer: scene.observer.position, terms }
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
        let (mut sum, mut uniform) = (Vec3::ZERO, Vec3::ZERO);
        let mut arriving = [Arriving::default(); AT_ONCE];
        for group in &self.lights.groups {
            for first in (0..group.count()).step_by(AT_ONCE) {
                let (count, everywhere) = group.arrive(first, position, &mut arriving);
                uniform += everywhere;
                if count > 0 {
                    sum += self.surface.lit_by(&arriving[..count], v, &frame, terms);
                }
            }
        }
        if uniform != Vec3::ZERO && matches!(terms, TermSelection::All | TermSelection::Ambient) {
            sum += self.surface.ambient_response(v, &frame) * uniform;
        }
        sum.map(|c| if c.is_nan() { 0.0 } else { c.clamp(-BRIGHTEST, BRIGHTEST) })
    }
}
