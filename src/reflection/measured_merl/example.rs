//! The table that is shown until a file is chosen: rough copper, calculated.

use glam::{Vec2, Vec3};

use crate::optics::{
    distribution::ggx,
    fresnel::schlick,
    geometry::half_vector,
    half_difference::{directions, middles, with_gaps},
    masking::{height_correlated, smith_ggx},
};

/// The name of the shipped file.
pub(super) const NAME: &str = "calculated.binary";
/// Fewer than in a file, which a lobe of this width does not need.
const COUNTS: [usize; 3] = [24, 12, 16];

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
    with_gaps(counts, entries.collect())
}

pub(super) fn numbers() -> Vec<f32> {
    table(COUNTS, copper)
}
