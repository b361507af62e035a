//! The split sum: B. Karis (2013), *Real Shading in Unreal Engine 4*.
//!
//! The integral of light times lobe is approximated by the mean of the light times the integral of the lobe.
//! The mean is that of the surroundings filtered about the mirror direction by a GGX lobe for a view along
//! the normal (n = v = r), with each direction weighted by its cosine. Here it is calculated for each pixel;
//! real-time programs read it from a map, which adds another error.

use glam::{Vec2, Vec3};

use crate::{
    light::{Emitter, LightRecord},
    optics::{
        Frame,
        lobes::{Lobe, Lobes},
        sampling::power_heuristic,
        sequence::Sequence,
    },
};

/// Number of points for the mean weight.
const FINE: u32 = 4096;

/// A lobe that averages light about an axis.
pub(super) struct Filter {
    lobes: Lobes,
    /// True if each direction is also weighted by its cosine to the axis.
    by_cosine: bool,
    /// Sample points for the directions of the lobe, and for those of the light.
    points: Vec<[Vec2; 2]>,
    /// Mean weight.
    norm: f32,
}

impl Filter {
    fn new(lobe: Lobe, by_cosine: bool, count: u32) -> Self {
        let sequences = [0, 1].map(|number| Sequence::new(2, number));
        let points = (0..count).map(|i| sequences.map(|s| s.point(i))).collect();
        let mut filter = Self { lobes: Lobes::new(&[(lobe, 1.0)]), by_cosine, points, norm: 1.0 };
        let sum: f32 =
            (0..FINE).map(|i| filter.weight(filter.lobes.sample(sequences[0].point(i), Vec3::Z))).sum();
        filter.norm = sum / FINE as f32;
        filter
    }

    /// The filter of split sums, for a roughness α.
    pub(super) fn ggx(alpha: f32, count: u32) -> Self {
        Self::new(Lobe::ggx(alpha), true, count)
    }

    /// The cosine filter: the mean is the irradiance divided by π.
    pub(super) fn cosine(count: u32) -> Self {
        Self::new(Lobe::Cosine, false, count)
    }

    /// The wrong twin: without the division by the mean weight.
    #[cfg(test)]
    pub(super) fn forget_norm(&mut self) {
        self.norm = 1.0;
    }

    /// The weight of a direction of the lobe.
    fn weight(&self, l: Vec3) -> f32 {
        match l.z > 0.0 {
            true if self.by_cosine => l.z,
            above => f32::from(u8::from(above)),
        }
    }

    /// The mean radiance about an axis, seen from a point.
    pub(super) fn mean(&self, (emitter, record): (&dyn Emitter, &LightRecord), p: Vec3, axis: Vec3) -> Vec3 {
        let frame = Frame::from_normal(axis);
        let mut sum = Vec3::ZERO;
        for [of_lobe, of_light] in &self.points {
            let l = self.lobes.sample(*of_lobe, Vec3::Z);
            let (weight, pdf) = (self.weight(l), self.lobes.pdf(l, Vec3::Z));
            if weight > 0.0 {
                let seen = emitter.seen(record, p, frame.t * l.x + frame.b * l.y + frame.n * l.z);
                sum += seen.radiance * (weight * power_heuristic(pdf, seen.pdf));
            }
            let sent = emitter.sample(record, p, *of_light);
            let l = frame.to_local(sent.l);
            let (weight, pdf) = (self.weight(l), self.lobes.pdf(l, Vec3::Z));
            if weight > 0.0 && sent.pdf > 0.0 {
                sum += sent.radiance * (weight * pdf / sent.pdf * power_heuristic(sent.pdf, pdf));
            }
        }
        sum * record.colour / (self.norm * self.points.len() as f32)
    }
}
