//! Interpolation of samples at any angles.

use glam::{Vec3, Vec4};
use rayon::prelude::*;

use crate::optics::half_difference::{angles, middles, numbers};

/// The numbers of entries of the table along θ_h, θ_d and φ_d.
pub const COUNTS: [usize; 3] = [32, 16, 16];
/// The distance up to which an entry counts as measured.
pub const NEAR: f32 = 0.1;
/// The number of samples for an entry.
const NEIGHBOURS: usize = 8;

/// A sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Direction to the light, in the local frame.
    pub(super) l: Vec3,
    /// Direction to the viewer.
    pub(super) v: Vec3,
    /// The BRDF in sr⁻¹, from 0 on.
    pub(super) value: Vec3,
    /// Its standard uncertainty in sr⁻¹.
    pub(super) sigma: f32,
}

/// A place in which distances are measured.
fn place([theta_h, theta_d, phi_d]: [f32; 3]) -> Vec4 {
    let quarter = std::f32::consts::FRAC_PI_2;
    let (sine, cosine) = (2.0 * phi_d).sin_cos();
    let across = 0.25 * theta_h.sin() * theta_d.sin();
    Vec4::new((theta_h / quarter).sqrt(), theta_d / quarter, across * cosine, across * sine)
}

/// The value and its uncertainty at a place, and the distance to the nearest sample.
fn value(at: Vec4, samples: &[(Vec4, Vec4)]) -> (Vec4, f32) {
    // The nearest, by squared distance.
    let mut nearest = [(f32::INFINITY, Vec4::ZERO); NEIGHBOURS + 1];
    for (place, value) in samples {
        let squared = at.distance_squared(*place);
        if squared < nearest[NEIGHBOURS].0 {
            let to = nearest.partition_point(|(known, _)| *known <= squared);
            nearest[to..].rotate_right(1);
            nearest[to] = (squared, *value);
        }
    }
    let least = nearest[0].0.sqrt();
    let last = nearest.iter().rev().find(|(squared, _)| squared.is_finite()).map_or(0.0, |(d, _)| d.sqrt());
    // With few samples, none lies on the edge.
    let radius = if nearest[NEIGHBOURS].0.is_finite() { last } else { 2.0 * last + 1.0 };
    let (mut sum, mut weights) = (Vec4::ZERO, 0.0);
    for (squared, value) in nearest.into_iter().filter(|(squared, _)| squared.is_finite()) {
        // Samples at the place itself have nearly all the weight.
        let d = squared.sqrt().max(1e-4);
        let weight = ((radius - d).max(0.0) / (radius * d).max(1e-12)).powi(2);
        (sum, weights) = (sum + weight * value, weights + weight);
    }
    // All as far away as the ninth.
    let mean = if weights > 0.0 { sum / weights } else { nearest_mean(samples, at, last) };
    (mean, least)
}

/// The mean of the samples up to a distance.
fn nearest_mean(samples: &[(Vec4, Vec4)], at: Vec4, distance: f32) -> Vec4 {
    let within = samples.iter().filter(|(place, _)| at.distance(*place) <= distance * 1.000_1);
    let (sum, count) = within.fold((Vec4::ZERO, 0.0), |(sum, n), (_, value)| (sum + *value, n + 1.0));
    if count > 0.0 { sum / count } else { Vec4::ZERO }
}

/// The numbers of the table of some samples; `sigma` is their mean relative uncertainty.
pub(super) fn table(samples: &[Sample], sigma: f32) -> Vec<f32> {
    let placed = samples
        .iter()
        .map(|sample| (place(angles(sample.l, sample.v, Vec3::Z)), sample.value.extend(sample.sigma)));
    let placed: Vec<_> = placed.collect();
    let middles: Vec<_> = middles(COUNTS).collect();
    let entry = |middle: &[f32; 3]| {
        let (value, distance) = value(place(*middle), &placed);
        (value, distance <= NEAR)
    };
    let entries: Vec<_> = middles.par_iter().map(entry).collect();
    let mut table = numbers(COUNTS, entries.iter().map(|(entry, near)| (entry.truncate(), *near)), sigma);
    if sigma > 0.0 {
        table.extend(entries.iter().map(|(entry, _)| entry.w));
    }
    table
}
