//! The light loop: the sum over all lights, common to all models.

use std::{
    f32::consts::PI,
    sync::atomic::{AtomicBool, AtomicU32, Ordering},
};

use glam::Vec3;

use super::{
    Shot,
    extended::{Extended, Integral, LightSamples},
    through::{Body, Through, Viewed},
};
use crate::{
    light::{AT_ONCE, Emitters, Factor, Incident, LightRecord},
    optics::{
        Frame, TermSelection, Terms, lobes::Lobes, radiometry::Arriving, sampling::power_heuristic,
        sequence::pixel_seed,
    },
    reflection::Surface,
    registry::Registry,
    scene::{Light, Scene, emitter, record},
    shading::Lighting,
};

/// The light of all models is limited to these bounds, so that interpolation and sums give neither infinity
/// nor NaN.
const BRIGHTEST: f32 = 1e30;

/// Light limited to these bounds; NaN becomes dark.
pub(crate) fn within_bounds(light: Vec3) -> Vec3 {
    light.map(|c| if c.is_nan() { 0.0 } else { c.clamp(-BRIGHTEST, BRIGHTEST) })
}

/// All lights of a scene, ready for calculation.
#[derive(Default)]
pub(super) struct Lights {
    /// Consecutive lights of one type together, in the order of the scene.
    groups: Vec<Box<dyn Emitters>>,
    /// Lights with extent.
    extended: Extended,
    observer: Vec3,
    terms: TermSelection,
    /// True if NaN and excessive values are kept.
    raw: bool,
    /// True once a sum was not finite.
    odd: AtomicBool,
}

impl Lights {
    pub(super) fn new(scene: &Scene, registry: &Registry, terms: TermSelection) -> Self {
        let encoding = scene.display.encoding;
        let known: Vec<_> =
            scene.shining().filter_map(|light| Some((registry.light(&light.light_type)?, light))).collect();
        let (mut groups, mut extended, mut first) = (Vec::new(), Extended::default(), 0);
        for lights in known.chunk_by(|(a, _), (b, _)| a.index == b.index) {
            let entry = lights[0].0;
            let lights: Vec<_> =
                lights.iter().map(|(_, l)| (&l.parameters, record(l, registry, encoding))).collect();
            let group = (entry.group)(&lights, encoding);
            if entry.declaration.extent {
                extended.add(group, first);
            } else {
                groups.push(group);
            }
            first += lights.len() as u32;
        }
        let observer = scene.observer.position;
        Self { groups, extended, observer, terms, ..Self::default() }
    }

    /// Sets the samples of lights with extent.
    pub(super) fn sampled(mut self, samples: LightSamples) -> Self {
        self.extended.samples = samples;
        self
    }

    /// Keeps NaN and excessive values.
    pub(super) fn raw(self) -> Self {
        Self { raw: true, ..self }
    }

    /// True if any sum was not finite so far.
    pub(super) fn was_odd(&self) -> bool {
        self.odd.load(Ordering::Relaxed)
    }

    /// The lights shining on one surface, which may be that of a solid body.
    pub(super) fn on<'a>(
        &'a self,
        surface: &'a dyn Surface,
        lobes: Lobes,
        body: Option<&'a Body>,
    ) -> LightsOn<'a> {
        LightsOn { lights: self, surface, lobes, body, seed: AtomicU32::new(0) }
    }

    /// The response to uniform light at a point.
    fn uniform(&self, p: Vec3) -> Vec3 {
        let mut arriving = [Arriving::default(); AT_ONCE];
        let firsts = |group: &dyn Emitters| (0..group.count()).step_by(AT_ONCE);
        let all = self.groups.iter().flat_map(|group| firsts(&**group).map(move |first| (group, first)));
        all.map(|(group, first)| group.arrive(first, p, &mut arriving).1).sum()
    }

    /// The light of a ray that leaves a body without spreading.
    pub(super) fn from_direction(&self, p: Vec3, l: Vec3) -> Vec3 {
        PI * self.extended.seen(p, l) + self.uniform(p)
    }

    /// The light of a ray that leaves a body in a direction chosen with this density.
    pub(super) fn from_lobe(&self, p: Vec3, l: Vec3, pdf: f32) -> Vec3 {
        PI * self.extended.weighted(p, l, pdf) + self.uniform(p)
    }

    /// The light that a rough boundary with this response and density lets through, by lights without extent and by a
    /// sample of each with extent.
    pub(super) fn sampled_at(
        &self,
        p: Vec3,
        at: (u32, u32),
        response: &impl Fn(Vec3) -> f32,
        pdf: &impl Fn(Vec3) -> f32,
    ) -> Vec3 {
        let mut sum = Vec3::ZERO;
        let mut arriving = [Arriving::default(); AT_ONCE];
        for group in &self.groups {
            for first in (0..group.count()).step_by(AT_ONCE) {
                let (count, _) = group.arrive(first, p, &mut arriving);
                sum += arriving[..count].iter().map(|at| response(at.l) * at.light).sum::<Vec3>();
            }
        }
        self.extended.towards(p, at, |l, light, density| {
            let response = response(l);
            if response > 0.0 {
                sum += response * power_heuristic(density, pdf(l)) * light;
            }
        });
        sum
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

    /// What comes through the body.
    pub(super) fn through(&self, position: Vec3, view: Vec3, frame: &Frame) -> Through {
        self.body.map_or_else(Through::default, |body| {
            let from = Viewed { position, view, frame, seed: self.seed.load(Ordering::Relaxed) };
            body.through(self.lights, self.lights.extended.samples, &from)
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
    /// The light's part of the sum, with the selected terms.
    pub(crate) contribution: Vec3,
    /// For a light with extent: the integral of the response over the light.
    pub(crate) integral: Option<Integral>,
}

/// The light loop at a point, light by light: each contribution equals the result of the loop for that light
/// alone, up to rounding.
pub(crate) fn light_by_light(
    Shot { scene, registry, settings }: Shot,
    (surface, body): (&dyn Surface, Option<&Body>),
    point: &Point,
) -> Loop {
    let terms = settings.terms;
    let all = Lights::new(scene, registry, terms);
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
        let (response, contribution, integral) = if entry.declaration.extent {
            let mut extended = Extended::default();
            extended.add(group, number as u32);
            let mut integral =
                extended.integral((&*emitter, &record), surface, point.position, v, &frame, point.seed);
            let alone = Lights { extended, observer: all.observer, terms, ..Lights::default() };
            let on = alone.on(surface, lobes, body).seeded(point.seed);
            integral.terms.transmitted += on.through(point.position, v, &frame).light;
            (integral.terms, integral.terms.select(terms), Some(integral))
        } else {
            let alone = Lights { groups: vec![group], observer: all.observer, terms, ..Lights::default() };
            let response = match incident {
                Incident::From { l, .. } => surface.response(l, v, &frame),
                Incident::Uniform { .. } => {
                    Terms { ambient: surface.ambient_response(v, &frame), ..Terms::default() }
                }
            };
            let on = alone.on(surface, lobes, body).seeded(point.seed);
            (response, on.sum(point.position, v, &frame), None)
        };
        let factors = emitter.factors(&record, point.position);
        Some(LitBy { index, record, incident, factors, response, contribution, integral })
    };
    Loop {
        eye,
        v,
        frame,
        lights: known.filter_map(lit_by).collect(),
        sum: lights.sum(point.position, v, &frame),
    }
}
