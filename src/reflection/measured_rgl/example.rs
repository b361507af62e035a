//! The table that is shown until a file is chosen: a brushed metal, calculated.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Vec2, Vec3};

use super::table::{self, Arrays, Data};
use crate::optics::{
    distribution::ggx,
    fresnel::schlick,
    masking::{height_correlated, smith_ggx},
};

/// The name of the shipped file.
pub(super) const NAME: &str = "calculated.bsdf";
/// The widths along tangent and bitangent.
pub(super) const BRUSHED: Vec2 = Vec2::new(0.4, 0.2);

/// The BRDF of a metal in sr⁻¹: GGX with Smith's height-correlated masking and Schlick's Fresnel term.
pub(super) fn metal(l: Vec3, v: Vec3, alpha: Vec2) -> Vec3 {
    let h = (l + v).normalize();
    let masking = height_correlated(l.z, v.z, smith_ggx(l, alpha), smith_ggx(v, alpha));
    ggx(h, alpha) * masking * schlick(Vec3::new(0.91, 0.78, 0.52), l.dot(h))
}

/// A direction in the unit square: azimuth from the tangent.
fn direction(u: f32, v: f32) -> Vec3 {
    let (theta, phi) = (FRAC_PI_2 * u * u, PI * (2.0 * v - 1.0));
    let (sine, cosine) = theta.sin_cos();
    Vec3::new(sine * phi.cos(), sine * phi.sin(), cosine)
}

fn grid(columns: usize, rows: usize) -> impl Iterator<Item = [f32; 2]> {
    let at = |i: usize, count: usize| i as f32 / (count - 1) as f32;
    (0..rows).flat_map(move |j| (0..columns).map(move |i| [at(i, columns), at(j, rows)]))
}

/// The table of [`metal`] for directions of the viewer, with grids of the density and of the values of these sides. With one
/// azimuth it is isotropic; with more they cover a quarter of a turn.
pub(super) fn arrays(alpha: Vec2, [phis, thetas]: [usize; 2], density: [usize; 2], side: usize) -> Arrays {
    let isotropic = phis == 1;
    let part = |i: usize, count: usize| i as f32 / (count - 1).max(1) as f32;
    let azimuth = |i: usize| if isotropic { 0.0 } else { PI * (0.5 * part(i, phis) - 1.0) };
    let phi: Vec<f32> = (0..phis).map(azimuth).collect();
    let theta: Vec<f32> = (0..thetas).map(|i| 1.5 * part(i, thetas)).collect();
    let area = |d: Vec3| 0.5 * (d.z + Vec3::new(alpha.x * d.x, alpha.y * d.y, d.z).length());
    let all = || grid(density[0], density[1]).map(|[u, v]| (u, direction(u, v)));
    let mut arrays = Arrays {
        sizes: [density, [side; 2], density, density],
        reduction: if isotropic { 0 } else { 4 },
        jacobian: true,
        ndf: all().map(|(_, m)| ggx(m, alpha)).collect(),
        sigma: all().map(|(_, d)| area(d)).collect(),
        ..Arrays::default()
    };
    let viewers: Vec<Vec3> = phi
        .iter()
        .flat_map(|phi| {
            let seen = |theta: &f32| Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            theta.iter().map(seen).collect::<Vec<_>>()
        })
        .collect();
    for v in &viewers {
        // Solid angle in the square is as u sin θ.
        let seen = |(u, m): (f32, Vec3)| u * m.truncate().length() * ggx(m, alpha) * v.dot(m).max(0.0);
        arrays.vndf.extend(all().map(seen));
    }
    (arrays.phi, arrays.theta) = (phi, theta);
    // The values lie at places that the density makes, which needs a table without them.
    arrays.values = vec![Vec3::ZERO; viewers.len() * side * side];
    let numbers = table::numbers(&arrays);
    if let Some(data) = Data::new(&numbers) {
        let value = |(slice, v): (usize, Vec3), place: [f32; 2]| {
            let point = data.point(slice, place);
            let m = direction(point[0], point[1]);
            let l = 2.0 * v.dot(m) * m - v;
            let seen =
                [(v.truncate().length().atan2(v.z) / FRAC_PI_2).sqrt(), v.y.atan2(v.x) / (2.0 * PI) + 0.5];
            let density = data.distribution(point) / (4.0 * data.projected(seen));
            if l.z > 0.0 && density > 0.0 { metal(l, v, alpha) * l.z / density } else { Vec3::ZERO }
        };
        let of_viewer = |viewer| grid(side, side).map(move |place| (viewer, place));
        let places = viewers.into_iter().enumerate().flat_map(of_viewer);
        arrays.values = places.map(|(viewer, place)| value(viewer, place)).collect();
    }
    arrays
}

pub(super) fn numbers() -> Vec<f32> {
    table::numbers(&arrays(BRUSHED, [3, 5], [14, 28], 12))
}
