//! The lobe of a model at a point: the BRDF over the hemisphere of viewers, as a surface; for models that light passes
//! through, over the whole sphere.
//!
//! The polar plot ([`Kind::Polar`]) is the section of this surface with the plane of incidence: it has the
//! same quantity on the same axis.

use std::collections::{HashMap, HashSet};

use glam::Vec3;

use super::{
    Channel, Kind,
    angles::{GRAZING, from_surface},
    draw::Axis,
    sheet::span,
};
use crate::{
    optics::{Frame, TermSelection, geometry::direction},
    progress::{Cancelled, Progress},
    reflection::{Surface, brdf_of},
};

/// The number of steps around the normal.
const AROUND: usize = 32;
/// The angles from the normal at which the surface begins, degrees.
const DOWN: [f64; 11] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 78.0, 84.0, 88.0, GRAZING];
/// An angle closer than this to that of the mirror direction is replaced by it, degrees.
const CLEAR: f64 = 4.0;
/// Maximum number of passes that halve edges.
const PASSES: usize = 14;
/// Maximum number of directions.
const MOST: usize = 2500;
/// The largest distance of an edge from the surface, for a lobe of length 1.
const TOLERANCE: f64 = 0.008;
/// The precision with which the edge of a gap is found, radians.
const GAP: f32 = 0.05;

/// The BRDF of the displayed terms, for one light, towards all viewers.
#[derive(Clone, Debug, PartialEq)]
pub struct Lobe {
    /// The directions to the viewers: unit vectors, denser where the surface bends.
    pub ways: Vec<Vec3>,
    /// The luminance of `f` in sr⁻¹ in each direction, as calculated: it may not be finite.
    pub values: Vec<f64>,
    /// The triangles between the directions, three indices each. A non-finite value makes a gap.
    pub triangles: Vec<[u32; 3]>,
}

/// The BSDF of the displayed terms, in sr⁻¹. The ambient term has none. Of light from below, only what comes out above is
/// known.
#[must_use]
pub fn value(surface: &dyn Surface, l: Vec3, v: Vec3, frame: &Frame, terms: TermSelection) -> Vec3 {
    if surface.transmits() && frame.n.dot(v) < 0.0 {
        let through = matches!(terms, TermSelection::All | TermSelection::Transmitted);
        let through = through && frame.n.dot(l) > 0.0;
        return if through { surface.behind(l, v, frame) } else { Vec3::ZERO };
    }
    brdf_of(surface.response(l, v, frame).only(terms), l, v, frame)
}

impl Lobe {
    /// The lobe at a point with a frame, for light from `l`; all vectors are in the coordinates of the room.
    ///
    /// # Errors
    /// Returns [`Cancelled`] if the user cancels.
    pub fn new(
        surface: &dyn Surface,
        l: Vec3,
        frame: &Frame,
        terms: TermSelection,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let value = |v: Vec3| Channel::Luminance.of(value(surface, l, v, frame, terms));
        let mut lobe = Self::coarse(l, frame, surface.transmits(), &value);
        let mut settled = HashSet::new();
        for pass in 0..PASSES {
            progress.step(pass as f32 / PASSES as f32, "")?;
            if !lobe.refine(&value, &mut settled) {
                break;
            }
        }
        lobe.triangles.retain(|corners| corners.iter().all(|i| lobe.values[*i as usize].is_finite()));
        Ok(lobe)
    }

    /// Rings around the normal, one of them through the mirror direction, which is itself one of the
    /// directions; `around` the whole sphere, the rings below are those above, mirrored.
    fn coarse(l: Vec3, frame: &Frame, around: bool, value: &impl Fn(Vec3) -> f64) -> Self {
        let local = frame.to_local(l);
        let theta_i = from_surface(f64::from(local.z.clamp(-1.0, 1.0).acos()).to_degrees());
        let phi_i = f64::from(local.y.atan2(local.x)).to_degrees();
        let mut down: Vec<_> = DOWN.iter().copied().filter(|a| (a - theta_i).abs() > CLEAR).collect();
        if (CLEAR..GRAZING).contains(&theta_i) {
            down.push(theta_i);
        }
        // The rim belongs to the surface however near the mirror direction is.
        down.push(GRAZING);
        down.sort_by(f64::total_cmp);
        down.dedup();
        if around {
            let below: Vec<_> = down.iter().rev().map(|angle| 180.0 - angle).collect();
            down.extend(below);
        }
        let room = |local: Vec3| frame.t * local.x + frame.b * local.y + frame.n * local.z;
        let mut ways = vec![frame.n];
        for theta in &down {
            let phi = |k: usize| phi_i + 360.0 * k as f64 / AROUND as f64;
            ways.extend((0..AROUND).map(|k| room(direction(*theta, phi(k)))));
        }
        let at = |ring: usize, k: usize| (1 + ring * AROUND + k % AROUND) as u32;
        let mut triangles = Vec::new();
        for k in 0..AROUND {
            triangles.push([0, at(0, k), at(0, k + 1)]);
            for ring in 1..down.len() {
                let [a, b] = [at(ring - 1, k), at(ring - 1, k + 1)];
                let [c, d] = [at(ring, k), at(ring, k + 1)];
                // Both sides of the plane of incidence are treated alike.
                triangles.extend(if k < AROUND / 2 {
                    [[a, c, d], [a, d, b]]
                } else {
                    [[a, c, b], [b, c, d]]
                });
            }
        }
        if around {
            let bottom = ways.len() as u32;
            ways.push(-frame.n);
            let last = down.len() - 1;
            triangles.extend((0..AROUND).map(|k| [bottom, at(last, k + 1), at(last, k)]));
        }
        let values = ways.iter().map(|way| value(*way)).collect();
        Self { ways, values, triangles }
    }

    /// The largest value; 0 if none is positive.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.values.iter().copied().filter(|v| v.is_finite()).fold(0.0, f64::max)
    }

    /// True if some value is not finite, so the surface has a gap.
    #[must_use]
    pub fn has_gaps(&self) -> bool {
        self.values.iter().any(|v| !v.is_finite())
    }

    /// True if a value is below 0, which cannot be shown as a length.
    #[must_use]
    pub fn is_negative(&self) -> bool {
        self.values.iter().any(|v| *v < 0.0)
    }

    /// Halves the edges that deviate from the surface on either scale. Returns false if there are none, or if
    /// there are enough directions.
    fn refine(&mut self, value: &impl Fn(Vec3) -> f64, settled: &mut HashSet<[u32; 2]>) -> bool {
        let largest = self.largest();
        let log = span(Kind::Polar, true, true, &[largest]);
        let log = Axis { from: log.to / 1e4, ..log };
        let lengths = |v: f64| {
            let linear = if largest > 0.0 { v.max(0.0) / largest } else { 0.0 };
            [linear, log.place(v).max(0.0)]
        };
        let mut halves: HashMap<[u32; 2], u32> = HashMap::new();
        for corners in self.triangles.clone() {
            for edge in edges(corners) {
                let [a, b] = edge.map(|i| i as usize);
                if settled.contains(&edge) || halves.contains_key(&edge) {
                    continue;
                }
                let ends = [self.ways[a], self.ways[b]];
                let Some(way) = (ends[0] + ends[1]).try_normalize() else { continue };
                let found = value(way);
                let of_ends = [self.values[a], self.values[b]];
                let finite = of_ends.map(f64::is_finite);
                let bent = if finite == [true; 2] && found.is_finite() {
                    let [from, to, middle] = [of_ends[0], of_ends[1], found].map(lengths);
                    (0..2).any(|scale| {
                        let chord = 0.5 * (ends[0] * from[scale] as f32 + ends[1] * to[scale] as f32);
                        f64::from(chord.distance(way * middle[scale] as f32)) > TOLERANCE
                    })
                } else {
                    (finite != [found.is_finite(); 2]) && ends[0].distance(ends[1]) > GAP
                };
                if bent {
                    halves.insert(edge, self.ways.len() as u32);
                    self.ways.push(way);
                    self.values.push(found);
                } else {
                    settled.insert(edge);
                }
            }
        }
        let split = std::mem::take(&mut self.triangles);
        for corners in split {
            self.split(corners, &halves);
        }
        !halves.is_empty() && self.ways.len() < MOST
    }

    /// Adds a triangle to the surface, or the parts into which its halved edges divide it.
    fn split(&mut self, [a, b, c]: [u32; 3], halves: &HashMap<[u32; 2], u32>) {
        let half = |a: u32, b: u32| halves.get(&[a.min(b), a.max(b)]).copied();
        let mut parts = |all: &[[u32; 3]]| self.triangles.extend_from_slice(all);
        match [half(a, b), half(b, c), half(c, a)] {
            [None, None, None] => parts(&[[a, b, c]]),
            [Some(d), Some(e), Some(f)] => parts(&[[a, d, f], [d, b, e], [f, e, c], [d, e, f]]),
            [Some(d), None, None] => parts(&[[a, d, c], [d, b, c]]),
            [Some(d), Some(e), None] => parts(&[[d, b, e], [a, d, c], [d, e, c]]),
            _ => self.split([b, c, a], halves),
        }
    }
}

/// The edges of a triangle, each with the smaller index first, so that two triangles agree on a common edge.
#[must_use]
pub fn edges([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// The common scale of several lobes: from 0, or on a logarithmic scale from the smallest value, at most six
/// powers of ten below the largest.
#[must_use]
pub fn scale(lobes: &[&Lobe], log: bool) -> Axis {
    let values = lobes.iter().flat_map(|lobe| &lobe.values).copied().filter(|v| v.is_finite());
    span(Kind::Polar, log, true, &values.collect::<Vec<_>>())
}

/// The end of a scale that does not depend on the surface: white Lambert, 1/π sr⁻¹, or on a logarithmic scale
/// 10 sr⁻¹.
const FULL: [f64; 2] = [std::f64::consts::FRAC_1_PI, 10.0];
/// The start of a logarithmic scale that does not depend on the surface, sr⁻¹.
const LEAST: f64 = 0.001;

/// The scale of lobes that are compared over time: a darker surface has a smaller lobe, as it should. It ends at the BRDF of
/// white Lambert, 1/π, or runs from 0.001 to 10 sr⁻¹ if it is logarithmic; only a taller lobe raises its end, and `kept`, an
/// end that it had before.
#[must_use]
pub fn steady(lobes: &[&Lobe], log: bool, kept: Option<f64>) -> Axis {
    let own = scale(lobes, log);
    let least = FULL[usize::from(log)];
    // Rounding must not make white exceed its own scale.
    let taller = lobes.iter().any(|lobe| lobe.largest() > least * (1.0 + 1e-4));
    let end = if taller { own.to } else { least };
    let to = end.max(least).max(kept.unwrap_or(0.0));
    let from = if log { LEAST } else { 0.0 };
    Axis { from, to, ..own }
}

/// The length of a value on a scale: 1 at its end, 0 at its start and below.
#[must_use]
pub fn length(scale: &Axis, value: f64) -> f32 {
    scale.place(value).clamp(0.0, 1.0) as f32
}

#[cfg(test)]
mod tests;
