//! The table that is shown until a file is chosen: rough copper, calculated.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Vec2, Vec3};

use super::grid;
use crate::optics::{
    distribution::ggx,
    fresnel::schlick,
    geometry::half_vector,
    masking::{height_correlated, smith_ggx},
};

/// The name of the shipped file.
pub(super) const NAME: &str = "calculated.binary";
/// Fewer than in a file, which a lobe of this width does not need.
const COUNTS: [usize; 3] = [24, 12, 16];

/// Directions to light and viewer in the local frame for three angles in radians.
pub(super) fn directions([theta_h, theta_d, phi_d]: [f32; 3]) -> (Vec3, Vec3) {
    let [(sine_h, cosine_h), (sine_d, cosine_d), (sine, cosine)] =
        [theta_h, theta_d, phi_d].map(f32::sin_cos);
    let h = Vec3::new(sine_h, 0.0, cosine_h);
    let down = Vec3::new(cosine_h, 0.0, -sine_h);
    let l = cosine_d * h + sine_d * (cosine * down + sine * Vec3::Y);
    (l, 2.0 * l.dot(h) * h - l)
}

/// The angles in the middles of the bins, φ_d fastest.
pub(super) fn middles(counts: [usize; 3]) -> impl Iterator<Item = [f32; 3]> {
    let [n_h, n_d, n_phi] = counts;
    let middle = |i: usize, count: usize| (i as f32 + 0.5) / count as f32;
    (0..n_h * n_d * n_phi).map(move |i| {
        let (h, d, phi) = (i / (n_d * n_phi), i / n_phi % n_d, i % n_phi);
        [FRAC_PI_2 * middle(h, n_h).powi(2), FRAC_PI_2 * middle(d, n_d), PI * middle(phi, n_phi)]
    })
}

/// The BRDF of rough copper in sr⁻¹: GGX with Smith's height-correlated masking and Schlick's Fresnel term.
fn copper(l: Vec3, v: Vec3) -> Vec3 {
    const ALPHA: Vec2 = Vec2::splat(0.25);
    const F_0: Vec3 = Vec3::new(0.955, 0.638, 0.538);
    let h = half_vector(l, v);
    let masking = height_correlated(l.z, v.z, smith_ggx(l, ALPHA), smith_ggx(v, ALPHA));
    ggx(h, ALPHA) * masking * schlick(F_0, l.dot(h))
}

/// The table of a BRDF in sr⁻¹.
pub(super) fn table(counts: [usize; 3], brdf: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<f32> {
    let entries = middles(counts).map(|angles| {
        let (l, v) = directions(angles);
        (l.z > 0.0 && v.z > 0.0).then(|| brdf(l, v))
    });
    grid::numbers(counts, entries.collect())
}

pub(super) fn numbers() -> Vec<f32> {
    table(COUNTS, copper)
}
