//! The light loop: the sum over all lights, common to all models.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec3;

use super::{
    Shot,
    extended::{Extended, Integral, LightSamples, PARTS, part_seed, standard_error},
    lights::{Lights, within_bounds},
    through::{Body, Through, Viewed},
};
use crate::{
    light::{AT_ONCE, Factor, Incident, LightRecord},
    optics::{Frame, TermSelection, Terms, lobes::Lobes, radiometry::Arriving, sequence::pixel_seed},
    reflection::Surface,
    scene::{Light, emitter},
    shading::Lighting,
};

impl Lights {
    /// The lights shining on one surface, which may be that of a solid body.
    pub(super) fn on<'a>(
        &'a self,
        surface: &'a dyn Surface,
        lobes: Lobes,
        body: Option<&'a Body>,
    ) -> LightsOn<'a> {
        LightsOn { lights: self, surface, lobes, body, seed: AtomicU32::new(0) }
    }
}

/// The lights of a scene and the surface on which they shine.
pub(super) struct LightsOn<'a> {
    lights: &'a Lights,
    surface: &'a dyn Surface,
    lobes: Lobes,
    /// The body behind the surface, if it is solid.
    body: Option<&'a Body>,
    /// The seed of the pixel, or that of all vertices and polygons: with one seed neighbours get the same points, so that what
    /// is interpolated between them is smooth, and every corner of a polygon the same colour.
    seed: AtomicU32,
}

impl LightsOn<'_> {
    /// The seed of the current pixel, or of vertices.
    pub(super) fn seed(&self) -> u32 {
        self.seed.load(Ordering::Relaxed)
    }

    /// Sets the seed.
    fn seeded(self, seed: u32) -> Self {
        self.seed.store(seed, Ordering::Relaxed);
        self
    }

    /// The direction to the viewer, and the direction passed to the model for it.
    fn view(&self, position: Vec3, normal: Vec3) -> [Vec3; 2] {
        // An interpolated normal may face away from a viewer who can still see the surface: the viewer is
        // then mirrored in the surface; otherwise rims would be black.
        let eye = (self.lights.observer - position).normalize_or_zero();
        [eye, eye - 2.0 * normal.dot(eye).min(0.0) * normal]
    }

    /// The unmodified sum over the lights.
    fn sum(&self, position: Vec3, v: Vec3, frame: &Frame) -> Vec3 {
        if self.lights.remaining {
            return self.through(position, v, frame).remaining;
        }
        let terms = self.lights.terms;
        let (mut sum, mut uniform) = (Vec3::ZERO, Vec3::ZERO);
        let mut arriving = [Arriving::default(); AT_ONCE];
        for group in &self.lights.groups {
            for first in (0..group.count()).step_by(AT_ONCE) {
                let (count, everywhere) = group.arrive(first, position, &mut arriving);
                uniform += everywhere;
                if count > 0 {
                    sum += self.surface.lit_by(&arriving[..count], v, frame, terms);
                }
            }
        }
        if uniform != Vec3::ZERO && matches!(terms, TermSelection::All | TermSelection::Ambient) {
            sum += self.surface.ambient_response(v, frame) * uniform;
        }
        if !self.lights.extended.is_empty() {
            let seed = self.seed.load(Ordering::Relaxed);
            sum += self.lights.extended.sum((self.surface, self.lobes), position, v, frame, terms, seed);
        }
        if matches!(terms, TermSelection::All | TermSelection::Transmitted) {
            sum += self.through(position, v, frame).light;
        }
        sum
    }

    /// The light transmitted through the body.
    pub(super) fn through(&self, position: Vec3, view: Vec3, frame: &Frame) -> Through {
        let from = Viewed { position, view, frame, seed: self.seed() };
        self.through_by(self.lights.extended.samples, &from)
    }

    /// The standard error of the light that comes through a rough body, from independent parts of the ways.
    fn error_of_through(&self, position: Vec3, view: Vec3, frame: &Frame) -> Vec3 {
        let samples = LightSamples { first: 0, count: (self.lights.extended.samples.count / PARTS).max(1) };
        let parts: [Vec3; PARTS as usize] = std::array::from_fn(|part| {
            let from = Viewed { position, view, frame, seed: part_seed(self.seed(), part as u32) };
            self.through_by(samples, &from).light
        });
        standard_error(parts.into_iter())
    }

    fn through_by(&self, samples: LightSamples, from: &Viewed) -> Through {
        self.body.map_or_else(Through::default, |body| {
            let through = body.through(self.lights, samples, from);
            let enters = self.surface.entering(from.view, from.frame);
            Through { light: enters * through.light, remaining: enters * through.remaining }
        })
    }
}

impl Lighting for LightsOn<'_> {
    fn begin_pixel(&self, x: u32, y: u32) {
        self.seed.store(pixel_seed(x, y), Ordering::Relaxed);
    }

    fn colour(&self, position: Vec3, normal: Vec3, tangent: Vec3) -> Vec3 {
        let [_, v] = self.view(position, normal);
        let sum = self.sum(position, v, &Frame::new(normal, tangent));
        if self.lights.raw {
            return sum;
        }
        if !sum.is_finite() {
            self.lights.odd.store(true, Ordering::Relaxed);
        }
        within_bounds(sum)
    }
}

/// A point at which the light loop runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub(crate) position: Vec3,
    pub(crate) normal: Vec3,
    pub(crate) tangent: Vec3,
    /// The result of the loop.
    pub(crate) colour: Vec3,
    /// The seed of the point's samples of lights with extent.
    pub(crate) seed: u32,
}

/// The light loop at one point, light by light.
pub(crate) struct Loop {
    /// The direction to the observer.
    pub(crate) eye: Vec3,
    /// The direction to the observer as passed to the model: mirrored in the surface if the normal faces
    /// away.
    pub(crate) v: Vec3,
    pub(crate) frame: Frame,
    pub(crate) lights: Vec<LitBy>,
    /// The sum before NaN and excessive values are replaced.
    pub(crate) sum: Vec3,
}

/// One light at one point.
pub(crate) struct LitBy {
    /// Index among the lights of the scene.
    pub(crate) index: usize,
    pub(crate) record: LightRecord,
    pub(crate) incident: Incident,
    pub(crate) factors: Vec<Factor>,
    /// The response of the model to light of unit intensity.
    pub(crate) response: Terms,
    /// The part of the contribution of a light without extent that comes through the body.
    pub(crate) through: Vec3,
    /// The light's part of the sum, with the selected terms.
    pub(crate) contribution: Vec3,
    /// For a light with extent: the integral of the response over the light.
    pub(crate) integral: Option<Integral>,
}

/// The light loop at a point, light by light: each contribution equals the result of the loop for that light
/// alone, up to rounding.
pub(crate) fn light_by_light(
    Shot { scene, registry, settings, samples }: Shot,
    (surface, body): (&dyn Surface, Option<&Body>),
    point: &Point,
) -> Loop {
    let terms = settings.terms;
    let all = Lights::new(scene, registry, terms).sampled(samples);
    let lobes = surface.lobes();
    let lights = all.on(surface, lobes, body).seeded(point.seed);
    let [eye, v] = lights.view(point.position, point.normal);
    let frame = Frame::new(point.normal, point.tangent);
    let encoding = scene.display.encoding;
    let shining = scene.lights.iter().enumerate().filter(|(_, light)| light.enabled);
    // The index of a light among the active, known ones selects its sequence.
    let known = shining.filter(|(_, light)| registry.light(&light.light_type).is_some()).enumerate();
    let lit_by = |(number, (index, light)): (usize, (usize, &Light))| {
        let (entry, emitter, record) = emitter(light, registry, encoding)?;
        let incident = emitter.incident(&record, point.position);
        let group = (entry.group)(&[(&light.parameters, record)], encoding);
        let mut through = Vec3::ZERO;
        let (response, contribution, integral) = if entry.declaration.extent {
            let mut extended = Extended::with(samples);
            extended.add(group, number as u32);
            let mut integral =
                extended.integral((&*emitter, &record), surface, point.position, v, &frame, point.seed);
            let alone = Lights { extended, observer: all.observer, terms, ..Lights::default() };
            let on = alone.on(surface, lobes, body).seeded(point.seed);
            integral.terms.transmitted += on.through(point.position, v, &frame).light;
            if body.is_some_and(Body::leads_by_chance) {
                integral.add_error(on.error_of_through(point.position, v, &frame));
            }
            (integral.terms, integral.terms.select(terms), Some(integral))
        } else {
            let alone = Lights { groups: vec![group], observer: all.observer, terms, ..Lights::default() }
                .sampled(samples);
            let response = match incident {
                Incident::From { l, .. } => surface.response(l, v, &frame),
                Incident::Uniform { .. } => {
                    Terms { ambient: surface.ambient_response(v, &frame), ..Terms::default() }
                }
            };
            let on = alone.on(surface, lobes, body).seeded(point.seed);
            through = on.through(point.position, v, &frame).light;
            (response, on.sum(point.position, v, &frame), None)
        };
        let factors = emitter.factors(&record, point.position);
        let through = Terms::through(through).select(terms);
        Some(LitBy { index, record, incident, factors, response, through, contribution, integral })
    };
    Loop {
        eye,
        v,
        frame,
        lights: known.filter_map(lit_by).collect(),
        sum: lights.sum(point.position, v, &frame),
    }
}
