//! A rough boundary between two transparent media: microfacets that reflect and refract.
//!
//! B. Walter, S. Marschner, H. Li, K. Torrance (2007), *Microfacet Models for Refraction through Rough Surfaces*, with
//! the facets' exact reflectance (A. Fresnel 1823) and Smith's masking of both directions independently.
//!
//! Twin: `assets/shaders/optics/interface.wgsl`. All directions are in the local frame (outer normal z, tangent x), on
//! either side, and point away from the surface: `l` to the light, `v` to the viewer. Both functions are zero where a
//! direction lies in the surface, and for facets that one of the two sees from behind.
//!
//! **Radiance**, not flux, is what a viewer sees: it is scaled by the square of the refractive index on the viewer's side
//! over that on the light's (a wide beam narrows as it enters the denser medium). So `f_t(l, v)/η_v²` is symmetric rather
//! than `f_t`, and of a light's energy ∫ f |cos θ_v| dω_v ≤ 1 arrives.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{
    distribution::{self, MINIMUM_ALPHA},
    fresnel::dielectric,
    masking::{separable, smith_beckmann, smith_ggx},
    refraction::{across, is_matched, refracted, refracting_reflectance, relative_index},
};

/// The distribution of the facets' normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facets {
    /// Trowbridge and Reitz's, [`ggx`](distribution::ggx).
    Ggx,
    /// [Beckmann](distribution::beckmann)'s.
    Beckmann,
}

/// A rough boundary of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    facets: Facets,
    alpha: Vec2,
    ior: f32,
}

impl Interface {
    /// A boundary with the roughness `alpha` along tangent and bitangent, at least [`MINIMUM_ALPHA`], and the refractive
    /// index of the body divided by that outside.
    #[must_use]
    pub fn new(facets: Facets, alpha: Vec2, ior: f32) -> Self {
        Self { facets, alpha: alpha.max(Vec2::splat(MINIMUM_ALPHA)), ior }
    }

    /// True if inside and outside have the same refractive index: nothing is reflected, and all light goes straight on,
    /// which no function of directions describes. Both functions are zero then.
    #[must_use]
    pub fn is_invisible(&self) -> bool {
        is_matched(self.ior)
    }

    /// The fraction of the light from outside that a facet reflects, for the cosine to its normal.
    #[must_use]
    pub fn reflectance(&self, cosine: f32) -> f32 {
        dielectric(self.ior, cosine)
    }

    /// The distribution of facet normals, in sr⁻¹.
    #[must_use]
    pub fn distribution(&self, h: Vec3) -> f32 {
        match self.facets {
            Facets::Ggx => distribution::ggx(h, self.alpha),
            Facets::Beckmann => distribution::beckmann(h, self.alpha),
        }
    }

    /// `cos θ · Λ` of Smith's theory for a direction on either side.
    fn lambda(&self, d: Vec3) -> f32 {
        let above = d.with_z(d.z.abs());
        match self.facets {
            Facets::Ggx => smith_ggx(above, self.alpha),
            Facets::Beckmann => smith_beckmann(above, self.alpha),
        }
    }

    /// `G/(4 |cos θ_l cos θ_v|)`.
    #[must_use]
    pub fn visibility(&self, l: Vec3, v: Vec3) -> f32 {
        separable(l.z.abs(), v.z.abs(), self.lambda(l), self.lambda(v))
    }

    /// The BSDF in sr⁻¹: reflected light if `l` and `v` are on the same side, transmitted light otherwise.
    #[must_use]
    pub fn bsdf(&self, l: Vec3, v: Vec3) -> f32 {
        if l.z * v.z > 0.0 { self.reflected(l, v) } else { self.transmitted(l, v) }
    }

    /// The BRDF `f_r = D F G/(4 |cos θ_l cos θ_v|)` for two directions on the same side.
    #[must_use]
    pub fn reflected(&self, l: Vec3, v: Vec3) -> f32 {
        self.reflecting(l, v).map_or(0.0, |h| {
            let f = dielectric(relative_index(self.ior, v.z), h.dot(v).abs());
            f * self.distribution(h) * self.visibility(l, v)
        })
    }

    /// The normal of the facet that reflects `l` to `v`, z ≥ 0.
    fn reflecting(&self, l: Vec3, v: Vec3) -> Option<Vec3> {
        let sum = if v.z < 0.0 { -(l + v) } else { l + v };
        (l.z * v.z > 0.0 && !self.is_invisible()).then(|| sum.normalize_or_zero())
    }

    /// The BTDF of radiance, for directions on different sides:
    /// `f_t = |v·h| |l·h|/|cos θ_l cos θ_v| · (1 − F) D G/(v·h + η l·h)²`, η from the side of `v`.
    #[must_use]
    pub fn transmitted(&self, l: Vec3, v: Vec3) -> f32 {
        let Some(facet) = self.refracting(l, v) else { return 0.0 };
        let f = refracting_reflectance(facet.cos_l, facet.cos_v, facet.eta);
        let jacobian = facet.cos_l * facet.cos_v / facet.squared;
        4.0 * (1.0 - f) * self.distribution(facet.h) * self.visibility(l, v) * jacobian
    }

    /// The facet that refracts from `l` to `v`; `None` if there is none, or one of the two sees its back.
    fn refracting(&self, l: Vec3, v: Vec3) -> Option<Refracting> {
        if l.z * v.z >= 0.0 || self.is_invisible() {
            return None;
        }
        let eta = relative_index(self.ior, v.z);
        let sum = across(l, v, eta);
        let squared = sum.length_squared();
        // Both unit vectors times v + η l, without the cancellation in 1 + v·l = (v + l)²/2.
        let bend = 0.5 * (l + v).length_squared();
        let [along_v, along_l] = [bend + (eta - 1.0) * (bend - 1.0), bend + (eta - 1.0)];
        // The facet separates the two, and each sees the side that it is on.
        if along_v * along_l >= 0.0 || sum.dot(v) * v.z <= 0.0 {
            return None;
        }
        let length = squared.sqrt();
        let [cos_l, cos_v] = [along_l, along_v].map(|along| (along.abs() / length).min(1.0));
        Some(Refracting { h: sum / length, cos_l, cos_v, eta, squared })
    }

    /// A direction to the light for three numbers from 0 to 1, with the density of [`pdf`](Self::pdf): a facet that the
    /// viewer sees, chosen as for GGX by the first two, reflects or refracts as the third decides. `None` where that leads
    /// to the wrong side of the surface, for a viewer in the surface, and for an
    /// [invisible](Self::is_invisible) one.
    ///
    /// E. Heitz (2018), *Sampling the GGX Distribution of Visible Normals*; J. Dupuy, A. Benyoub (2023), *Sampling Visible
    /// GGX Normals with Spherical Caps*.
    #[must_use]
    pub fn sample(&self, u: Vec3, v: Vec3) -> Option<Vec3> {
        if v.z == 0.0 || self.is_invisible() {
            return None;
        }
        // From inside, in the mirror image of the surface.
        let seen = v.with_z(v.z.abs());
        let h = visible_normal(u.truncate(), seen, self.alpha);
        let eta = relative_index(self.ior, v.z);
        let cosine = h.dot(seen).clamp(0.0, 1.0);
        let (l, right) = if u.z < dielectric(eta, cosine) {
            let l = 2.0 * cosine * h - seen;
            (l, l.z > 0.0)
        } else {
            let l = refracted(seen, h, eta)?;
            (l, l.z < 0.0)
        };
        right.then(|| l.with_z(v.z.signum() * l.z))
    }

    /// The density per solid angle with which [`sample`](Self::sample) returns a direction to the light. The integral
    /// is 1 less the fraction of samples without a direction.
    #[must_use]
    pub fn pdf(&self, l: Vec3, v: Vec3) -> f32 {
        if let Some(facet) = self.refracting(l, v) {
            let f = refracting_reflectance(facet.cos_l, facet.cos_v, facet.eta);
            let jacobian = facet.eta * facet.eta * facet.cos_l / facet.squared;
            return (1.0 - f) * self.visible(facet.h, v) * facet.cos_v * jacobian;
        }
        self.reflecting(l, v).map_or(0.0, |h| {
            let f = dielectric(relative_index(self.ior, v.z), h.dot(v).abs());
            f * self.visible(h, v) / 4.0
        })
    }

    /// The density of the GGX facets that a viewer sees, divided by V·H: `D G₁/|N·V|`.
    fn visible(&self, h: Vec3, v: Vec3) -> f32 {
        let above = v.with_z(v.z.abs());
        distribution::ggx(h, self.alpha) / (above.z + smith_ggx(above, self.alpha))
    }
}

/// The normal of a GGX facet that is visible from `v`, above the surface.
fn visible_normal(u: Vec2, v: Vec3, alpha: Vec2) -> Vec3 {
    let wide = (v * alpha.extend(1.0)).normalize();
    let (sin, cos) = (2.0 * PI * u.x).sin_cos();
    let z = (1.0 - u.y) * (1.0 + wide.z) - wide.z;
    let sine = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    let cap = Vec3::new(sine * cos, sine * sin, z) + wide;
    (cap * alpha.extend(1.0)).with_z(cap.z.max(0.0)).normalize_or_zero()
}

/// A facet that refracts one direction to another.
struct Refracting {
    /// The normal of the facet, z ≥ 0.
    h: Vec3,
    /// The cosines between the directions and its normal, without sign.
    cos_l: f32,
    cos_v: f32,
    /// The index on the side of the light divided by that on the side of the viewer.
    eta: f32,
    /// `(v·h + η l·h)²`.
    squared: f32,
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::optics::{
        chi_squared::{chi_squared, passes},
        geometry::direction,
        refraction::critical_angle,
        sequence::Sequence,
    };

    /// A row of the golden values: the boundary, the directions, the value.
    struct Row {
        interface: Interface,
        l: Vec3,
        v: Vec3,
        f: f64,
    }

    /// 90 values of another program, over both sides; see tests/data/README.md.
    fn rows() -> Vec<Row> {
        let text = include_str!("../../tests/data/golden/transmission_values.csv");
        let row = |line: &str| {
            let cells: Vec<_> = line.split(',').collect();
            let number = |i: usize| cells[i].parse::<f64>().expect("a number");
            let widths: Vec<f32> = cells[1].split(' ').filter_map(|x| x.parse().ok()).collect();
            let facets = if cells[0] == "ggx" { Facets::Ggx } else { Facets::Beckmann };
            let alpha = Vec2::new(widths[0], widths[widths.len() - 1]);
            Row {
                interface: Interface::new(facets, alpha, number(2) as f32),
                l: direction(number(3), number(4)),
                v: direction(number(5), number(6)),
                f: number(7),
            }
        };
        text.lines().skip(1).map(row).collect()
    }

    /// The share of Beckmann facets that is visible by the rational approximation of B. Walter et al. (2007), equation
    /// 27, which that program uses, divided by the exact share.
    fn approximation(interface: &Interface, d: Vec3) -> f64 {
        if interface.facets == Facets::Ggx {
            return 1.0;
        }
        let (root, z) = (f64::from((interface.alpha * d.truncate()).length()), f64::from(d.z.abs()));
        let a = z / root;
        let seen = (3.535 * a + 2.181 * a * a) / (1.0 + 2.276 * a + 2.577 * a * a);
        let exact = z / (z + f64::from(interface.lambda(d)));
        (if a < 1.6 { seen } else { 1.0 }) / exact
    }

    fn same(found: f64, expected: f64, tolerance: f64) -> bool {
        (found - expected).abs() <= (tolerance * expected.abs()).max(1e-6)
    }

    #[test]
    fn both_sides_have_the_values_of_another_program() {
        let rows = rows();
        assert_eq!(rows.len(), 90);
        let mut wrong = [0; 4];
        for Row { interface, l, v, f } in rows {
            let exact = f64::from(interface.bsdf(l, v));
            let found = exact * approximation(&interface, l) * approximation(&interface, v);
            assert!(same(found, f, 1e-4), "{interface:?} {l} {v}: {found} is not {f}");
            assert!(same(exact, f, 6e-3), "{interface:?} {l} {v}: {exact} is far from {f}");
            // What a facet turned away reflects or refracts is nothing, not little.
            assert!(f != 0.0 || exact < 1e-6);
            if l.z * v.z < 0.0 {
                let eta = f64::from(relative_index(interface.ior, v.z));
                let h = across(l, v, eta as f32).normalize().as_dvec3();
                let [along_l, along_v] = [l, v].map(|d| d.as_dvec3().dot(h));
                // Wrong twins: flux instead of radiance; the Jacobian of the other direction; of a reflection.
                let swapped = ((along_v + eta * along_l) / (eta * along_v + along_l)).powi(2);
                let reflection = (along_v + eta * along_l).powi(2) / (4.0 * (along_v * along_l).abs());
                for (count, factor) in
                    wrong.iter_mut().zip([eta * eta, 1.0 / (eta * eta), swapped, reflection])
                {
                    *count += usize::from(!same(found * factor, f, 1e-4));
                }
            }
        }
        assert!(wrong.iter().all(|count| *count > 10), "wrong twins pass: {wrong:?}");
    }

    fn interfaces() -> Vec<Interface> {
        let of = |facets, x, y, ior| Interface::new(facets, Vec2::new(x, y), ior);
        vec![
            of(Facets::Ggx, 0.3, 0.3, 1.5),
            of(Facets::Ggx, 0.2, 0.5, 1.33),
            of(Facets::Ggx, 0.8, 0.8, 2.4),
            of(Facets::Beckmann, 0.3, 0.3, 1.5),
            of(Facets::Beckmann, 0.5, 0.2, 1.8),
            // A bubble: the body is thinner than what surrounds it.
            of(Facets::Ggx, 0.4, 0.4, 0.75),
        ]
    }

    const VIEWS: [(f64, f64); 6] =
        [(0.0, 0.0), (35.0, 70.0), (80.0, 200.0), (100.0, 10.0), (150.0, 300.0), (180.0, 0.0)];

    /// `∫ f dω` over the sphere by the midpoint rule.
    fn integral(f: impl Fn(Vec3) -> f32) -> f64 {
        let (rows, columns) = (400, 128);
        let mut sum = 0.0;
        for i in 0..rows {
            let (sin, cos) = (PI * (f64::from(i) + 0.5) / f64::from(rows)).sin_cos();
            for j in 0..columns {
                let (y, x) = (TAU * (f64::from(j) + 0.5) / f64::from(columns)).sin_cos();
                let d = Vec3::new((sin * x) as f32, (sin * y) as f32, cos as f32);
                sum += f64::from(f(d)) * sin;
            }
        }
        sum * PI / f64::from(rows) * TAU / f64::from(columns)
    }

    #[test]
    fn no_more_light_leaves_than_arrives() {
        for interface in interfaces() {
            for (theta, phi) in VIEWS {
                let l = direction(theta, phi);
                // The light of one direction, wherever it goes.
                let all = integral(|v| interface.bsdf(l, v) * v.z.abs());
                assert!(all < 1.002, "{interface:?} {theta}°: {all}");
                // Only light that facets mask or scatter twice is lost.
                let inside = relative_index(interface.ior, l.z) < 1.0;
                assert!(all > if inside { 0.3 } else { 0.55 }, "{interface:?} {theta}°: {all}");
                // Radiance is not flux: seen from the thinner side it is less, by the square of the index.
                let eta = f64::from(relative_index(interface.ior, l.z));
                let gained = integral(|v| interface.transmitted(l, v) * v.z.abs());
                let seen = integral(|v| interface.transmitted(v, l) * v.z.abs());
                assert!((seen * eta * eta / gained - 1.0).abs() < 0.02, "{theta}°: {seen} {gained}");
            }
        }
    }

    #[test]
    fn light_takes_the_same_path_both_ways() {
        let mut compared = 0;
        for interface in interfaces() {
            for i in 0..2000u32 {
                let random =
                    |k: u32| f64::from(crate::optics::sequence::hash(4 * i + k) >> 8) / f64::from(1 << 24);
                let d =
                    |k: u32| direction((2.0 * random(k) - 1.0).acos().to_degrees(), 360.0 * random(k + 1));
                let (l, v) = (d(0), d(2));
                let [there, back] = [interface.bsdf(l, v), interface.bsdf(v, l)];
                let squared = |d: Vec3| if d.z < 0.0 { interface.ior * interface.ior } else { 1.0 };
                let [there, back] = [there / squared(v), back / squared(l)];
                let large = there.max(back);
                assert!(
                    (there - back).abs() <= 2e-3 * large.max(1e-3),
                    "{interface:?} {l} {v}: {there} {back}"
                );
                compared += usize::from(large > 1e-3 && l.z * v.z < 0.0);
            }
        }
        assert!(compared > 500, "{compared} pairs through the surface");
    }

    #[test]
    fn a_smooth_boundary_bends_light_by_snells_angle() {
        for (facets, ior) in [(Facets::Ggx, 1.5f32), (Facets::Beckmann, 1.33), (Facets::Ggx, 2.4)] {
            let interface = Interface::new(facets, Vec2::splat(0.002), ior);
            for theta in [10.0, 45.0, 70.0] {
                for from_inside in [false, true] {
                    let expected = if from_inside {
                        (f64::from(ior) * f64::to_radians(0.5 * theta).sin()).asin().to_degrees()
                    } else {
                        (f64::to_radians(theta).sin() / f64::from(ior)).asin().to_degrees()
                    };
                    if expected.is_nan() {
                        continue;
                    }
                    let v = if from_inside {
                        direction(180.0 - 0.5 * theta, 20.0)
                    } else {
                        direction(theta, 20.0)
                    };
                    let beyond =
                        |angle: f64| direction(if from_inside { angle } else { 180.0 - angle }, 200.0);
                    let brightness = |step: &i32| {
                        let l = beyond(expected + 0.01 * f64::from(*step));
                        interface.transmitted(l, v) * l.z.abs()
                    };
                    let brightest =
                        (-300..=300).max_by(|a, b| brightness(a).total_cmp(&brightness(b))).expect("some");
                    assert!(brightest.abs() <= 3, "{ior} {theta} {from_inside}: off by {brightest}/100°");
                }
            }
        }
    }

    #[test]
    fn beyond_the_critical_angle_everything_is_reflected() {
        let interface = Interface::new(Facets::Ggx, Vec2::splat(0.002), 1.5);
        let critical = f64::from(critical_angle(1.5)).to_degrees();
        let outside = |theta: f64| {
            let v = direction(180.0 - theta, 0.0);
            let [mut through, mut all] = [0; 2];
            let sequence = Sequence::new(3, 0);
            for i in 0..1000u32 {
                let u = sequence.point(i).extend((i as f32 + 0.5) / 1000.0);
                let Some(l) = interface.sample(u, v) else { continue };
                all += 1;
                through += usize::from(l.z > 0.0);
            }
            assert!(all > 900, "{theta}°: {all}");
            through
        };
        assert_eq!(outside(critical + 3.0), 0);
        assert!(outside(critical - 3.0) > 500);
        // A mirror then: all light comes back.
        let v = direction(180.0 - critical - 3.0, 0.0);
        let mirrored = Vec3::new(-v.x, -v.y, v.z);
        let peak = interface.distribution(Vec3::Z) * interface.visibility(mirrored, v);
        assert!((interface.reflected(mirrored, v) / peak - 1.0).abs() < 1e-3);
    }

    #[test]
    fn samples_have_their_density() {
        for interface in [0, 1, 5].map(|i| interfaces()[i]) {
            for (theta, phi) in VIEWS.into_iter().skip(1) {
                let v = direction(theta, phi);
                let sample = |random: &mut dyn FnMut() -> f32| {
                    interface.sample(Vec3::new(random(), random(), random()), v)
                };
                let found = chi_squared(sample, |l| interface.pdf(l, v));
                assert!(passes(found), "{interface:?} {theta}°: {found:?}");
                let narrower = Interface { alpha: 0.8 * interface.alpha, ..interface };
                let found = chi_squared(sample, |l| narrower.pdf(l, v));
                assert!(!passes(found), "narrower, {interface:?} {theta}°: {found:?}");
                let denser = Interface { ior: 1.1 * interface.ior, ..interface };
                let found = chi_squared(sample, |l| denser.pdf(l, v));
                assert!(!passes(found), "denser, {interface:?} {theta}°: {found:?}");
            }
        }
    }

    #[test]
    fn weighted_samples_give_the_integral() {
        for interface in interfaces() {
            for (theta, phi) in VIEWS {
                let v = direction(theta, phi);
                let expected = integral(|l| interface.bsdf(l, v) * l.z.abs());
                let (sequence, count) = (Sequence::new(7, 0), 1 << 13);
                let weight = |i: u32| {
                    let third = crate::optics::sequence::hash(i) as f32 / 4_294_967_296.0;
                    let l = interface.sample(sequence.point(i).extend(third.min(0.999_999)), v);
                    l.map_or(0.0, |l| {
                        f64::from(interface.bsdf(l, v) * l.z.abs()) / f64::from(interface.pdf(l, v))
                    })
                };
                let found = (0..count).map(weight).sum::<f64>() / f64::from(count);
                assert!((found / expected - 1.0).abs() < 0.03, "{interface:?} {theta}°: {found} {expected}");
            }
        }
    }

    #[test]
    fn equal_indices_smooth_surfaces_and_grazing_directions_give_finite_values() {
        let mut ends = vec![Vec3::ZERO, Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::NEG_X, Vec3::Y];
        for lift in [1e-45, 1e-38, 1e-20, 1e-7, 1e-4, -1e-7, -1e-20, -1e-4, -0.0] {
            ends.extend([Vec3::new(1.0, 0.0, lift), Vec3::new(-1.0, 0.0, lift), Vec3::new(0.0, -1.0, lift)]);
        }
        for facets in [Facets::Ggx, Facets::Beckmann] {
            for alpha in [0.0, 1e-3, 1.0] {
                for ior in [1.0, 1.000_9, 1.001_1, 1.5, 3.0, 0.3] {
                    let interface = Interface::new(facets, Vec2::splat(alpha), ior);
                    for (l, v) in ends.iter().flat_map(|l| ends.iter().map(move |v| (*l, *v))) {
                        let values = [interface.bsdf(l, v), interface.pdf(l, v)];
                        let fine = values.iter().all(|x| x.is_finite() && *x >= 0.0);
                        assert!(fine, "{interface:?} {l} {v}: {values:?}");
                        assert!(!interface.is_invisible() || values == [0.0; 2]);
                        for u in [Vec3::ZERO, Vec3::splat(0.5), Vec3::splat(0.999_999)] {
                            assert!(
                                interface.sample(u, v).is_none_or(Vec3::is_finite),
                                "{interface:?} {v} {u}"
                            );
                        }
                    }
                }
            }
        }
    }
}
