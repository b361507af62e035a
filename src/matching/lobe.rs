//! Lobes: the response of two models at many pairs of directions.

use glam::{Quat, Vec3};
use rayon::prelude::*;

use super::{
    Metric,
    search::{Given, Target},
    sides::{Pair, Side},
};
use crate::{
    optics::{Frame, TermSelection, geometry::direction},
    reflection::Surface,
    registry::Registry,
};

/// Maximum angle of directions from the normal, in degrees.
const LARGEST_ANGLE: f64 = 80.0;
/// Azimuths of the half vector for anisotropic surfaces, in degrees.
static AZIMUTHS: [f64; 4] = [0.0, 45.0, 90.0, 135.0];

/// Pairs of directions to the light and to the viewer, dense around the mirror direction, parametrised by the
/// half vector and the difference between light and half vector: S. Rusinkiewicz (1998), *A New Change of
/// Variables for Efficient BRDF Representation*. `azimuth` is that of the half vectors, `largest` the maximum
/// angle of the directions from the normal, both in degrees.
#[must_use]
pub fn directions(azimuth: f64, largest: f64) -> Vec<(Vec3, Vec3)> {
    let mut pairs = Vec::new();
    let least = largest.to_radians().cos() as f32;
    let around = Quat::from_rotation_z(azimuth.to_radians() as f32);
    for i in 0..26u8 {
        let theta_h = 80.0 * (f32::from(i) / 25.0).powi(2);
        // From the normal to the half vector, about y.
        let (s, c) = theta_h.to_radians().sin_cos();
        let turn = |d: Vec3| Vec3::new(c * d.x + s * d.z, d.y, c * d.z - s * d.x).normalize();
        let h = direction(theta_h.into(), 0.0);
        for j in 0..8u8 {
            for k in 0..7u8 {
                let (theta_d, phi_d) = (f32::from(j) * 10.0, f32::from(k) * 30.0);
                let l = turn(direction(theta_d.into(), phi_d.into()));
                let v = (2.0 * l.dot(h) * h - l).normalize();
                if l.z >= least && v.z >= least {
                    pairs.push(if azimuth == 0.0 { (l, v) } else { (around * l, around * v) });
                }
            }
        }
    }
    pairs
}

/// The azimuths of half vectors that are compared. What is the same at every azimuth needs no model at more than two: a model with two
/// widths that fits along and across the tangent has equal ones.
fn azimuths(pair: &Pair) -> impl Iterator<Item = f64> + use<> {
    let count = if pair.anisotropic { AZIMUTHS.len() } else { 1 };
    let step = if pair.turns { 2 } else { 1 };
    AZIMUTHS[..count].iter().copied().step_by(step)
}

/// The pairs of directions at which a surface was measured, instead of those between: interpolation would count as a difference, and
/// so would entries that are missing.
fn measured(surface: &dyn Surface, all: Vec<(Vec3, Vec3)>) -> Vec<(Vec3, Vec3)> {
    let least = LARGEST_ANGLE.to_radians().cos() as f32;
    let near = all.iter().filter_map(|(l, v)| surface.measured_near(*l, *v));
    let own: Vec<_> = near.filter(|(l, v)| l.z >= least && v.z >= least).collect();
    if own.is_empty() { all } else { own }
}

/// The lobes of the objects' materials.
pub(super) struct Lobe {
    /// Each with its pairs of directions and the wanted numbers of the metric.
    lobes: Vec<(Pair, Vec<(Vec3, Vec3)>, Vec<f64>)>,
    metric: Metric,
    terms: TermSelection,
}

/// The number of a metric for each pair of directions, three each; with the ambient term or without it.
fn numbers(
    surface: &dyn Surface,
    directions: &[(Vec3, Vec3)],
    (metric, terms, ambient): (Metric, TermSelection, bool),
    to: &mut [f64],
) {
    /// Minimum number of pairs that justifies a separate task.
    const AT_ONCE: usize = 128;
    to.par_chunks_mut(3 * AT_ONCE).zip(directions.par_chunks(AT_ONCE)).for_each(|(to, directions)| {
        for (to, (l, v)) in to.as_chunks_mut::<3>().0.iter_mut().zip(directions) {
            let mut response = surface.response(*l, *v, &Frame::LOCAL);
            if !ambient {
                response.ambient = Vec3::ZERO;
            }
            *to = response.select(terms).to_array().map(|own| metric.of(own.into()));
        }
    });
}

impl Lobe {
    /// The lobes of the visible objects.
    pub(super) fn new([a, b]: [&Side; 2], metric: Metric, registry: &Registry) -> Self {
        let lobe = |pair: Pair| {
            let azimuths = azimuths(&pair);
            let all: Vec<_> = azimuths.flat_map(|azimuth| directions(azimuth, LARGEST_ANGLE)).collect();
            let all = if pair.is_measured { measured(&*pair.wanted, all) } else { all };
            let mut wanted = vec![0.0; 3 * all.len()];
            numbers(&*pair.wanted, &all, (metric, a.terms, !pair.is_measured), &mut wanted);
            (pair, all, wanted)
        };
        let lobes = Pair::all([a, b], registry).into_iter().map(lobe).collect();
        Self { lobes, metric, terms: b.terms }
    }
}

impl Target for Lobe {
    fn count(&self) -> usize {
        self.lobes.iter().map(|(_, _, wanted)| wanted.len()).sum()
    }

    fn differences(&mut self, values: &Given, mut to: &mut [f64]) {
        for (pair, directions, wanted) in &self.lobes {
            let (own, rest) = to.split_at_mut(wanted.len());
            let how = (self.metric, self.terms, !pair.is_measured);
            numbers(&*pair.with(values), directions, how, own);
            own.iter_mut().zip(wanted).for_each(|(to, wanted)| *to -= wanted);
            to = rest;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_dense_about_the_mirror_direction_and_above_the_surface() {
        let all = directions(0.0, 80.0);
        assert!(all.len() > 800, "{}", all.len());
        let near = all.iter().filter(|(l, v)| ((*l + *v).normalize().z) > 10f32.to_radians().cos()).count();
        // Half vectors within 10 of the 80 degrees belong to about half of all pairs.
        assert!(near * 5 > all.len() * 2, "{near} of {}", all.len());
        for (l, v) in &all {
            assert!(l.is_normalized() && v.is_normalized() && l.z > 0.17 && v.z > 0.17);
        }
        // Rotated, the half vectors lie across the tangent.
        for (l, v) in directions(90.0, 80.0) {
            let h = l + v;
            assert!(h.x.abs() < 1e-4 && h.y > -1e-4, "{h}");
        }
    }
}
