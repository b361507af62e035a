//! The lights of a scene, ready for calculation.

use std::{
    f32::consts::PI,
    sync::atomic::{AtomicBool, Ordering},
};

use glam::Vec3;

use super::extended::{Extended, LightSamples};
use crate::{
    light::{AT_ONCE, Emitters},
    optics::{TermSelection, radiometry::Arriving, sampling::power_heuristic},
    registry::Registry,
    scene::{Scene, record},
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
    pub(super) groups: Vec<Box<dyn Emitters>>,
    /// Lights with extent.
    pub(super) extended: Extended,
    pub(super) observer: Vec3,
    pub(super) terms: TermSelection,
    /// True if NaN and excessive values are kept.
    pub(super) raw: bool,
    /// True if the light that remains inside solid bodies takes the place of the light.
    pub(super) remaining: bool,
    /// True once a sum was not finite.
    pub(super) odd: AtomicBool,
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

    /// Replaces the light of surfaces by the light that remains inside solid bodies.
    pub(super) fn remaining(self) -> Self {
        Self { remaining: true, ..self }
    }

    /// True if any sum was not finite so far.
    pub(super) fn was_odd(&self) -> bool {
        self.odd.load(Ordering::Relaxed)
    }

    /// The response to uniform light at a point.
    fn uniform(&self, p: Vec3) -> Vec3 {
        let mut arriving = [Arriving::default(); AT_ONCE];
        let firsts = |group: &dyn Emitters| (0..group.count()).step_by(AT_ONCE);
        let all = self.groups.iter().flat_map(|group| firsts(&**group).map(move |first| (group, first)));
        all.map(|(group, first)| group.arrive(first, p, &mut arriving).1).sum()
    }

    /// The light of a ray that leaves a body without spreading.
    pub(super) fn along(&self, p: Vec3, l: Vec3) -> Vec3 {
        PI * self.extended.seen(p, l) + self.uniform(p)
    }

    /// The light of a ray that leaves a body in a direction chosen with this density.
    pub(super) fn along_lobe(&self, p: Vec3, l: Vec3, pdf: f32) -> Vec3 {
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
