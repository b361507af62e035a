//! The lobes of a model: the directions in which it reflects most, for importance sampling.
//!
//! They affect how fast a picture with lights with extent becomes free of noise, never the result.

use std::f32::consts::PI;

use arrayvec::ArrayVec;
use glam::{Vec2, Vec3, Vec4};

use super::{equivalence::alpha_of_exponent, sampling};

/// Maximum number of lobes of a model.
pub const MAX_LOBES: usize = 3;

/// Minimum width of sampled GGX lobes; below, the maximum exponent of sampled power lobes.
const NARROWEST: f32 = 1e-3;
const STEEPEST: f32 = 1e6;

/// The kind of the lobes of refraction in the shaders' rows, to which their index is added.
const BELOW: f32 = 4.0;

/// The cosine between light and facet at which reflectances are compared for the shares of lobes: lobes are
/// the same for all views, so it lies between normal incidence and grazing angles, at which surfaces become
/// mirrors.
pub const OBLIQUE: f32 = 0.25;

/// A distribution of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lobe {
    /// Proportional to the cosine to the normal.
    Cosine,
    /// Reflection in the visible facets of a GGX surface with these widths along tangent and bitangent: E.
    /// Heitz (2018), *Sampling the GGX Distribution of Visible Normals*; J. Dupuy, A. Benyoub (2023),
    /// *Sampling Visible GGX Normals with Spherical Caps*.
    Ggx {
        /// Width along the tangent.
        alpha_x: f32,
        /// Width along the bitangent.
        alpha_y: f32,
    },
    /// Proportional to a power of the cosine to the mirror direction of the viewer.
    Power {
        /// The exponent.
        exponent: f32,
    },
    /// Proportional to the cosine to the normal, below the surface.
    CosineBelow,
    /// Refraction in the visible facets of a GGX surface: B. Walter, S. Marschner, H. Li, K. Torrance (2007),
    /// *Microfacet Models for Refraction through Rough Surfaces*.
    GgxBelow {
        /// Width of the distribution of facets along the tangent.
        alpha_x: f32,
        /// Width along the bitangent.
        alpha_y: f32,
        /// Refractive index below the surface divided by that above it. 1 stands for a thin sheet, which transmits the
        /// lobe that it reflects, mirrored in the surface.
        eta: f32,
    },
}

/// The lobes of a model, with their shares of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobes([(Lobe, f32); MAX_LOBES]);

impl Default for Lobes {
    /// A cosine lobe and a wide GGX lobe: correct for every model, if not efficient for glossy ones.
    fn default() -> Self {
        Self::new(&[(Lobe::Cosine, 0.5), (Lobe::ggx(0.4), 0.5)])
    }
}

impl Lobe {
    /// A GGX lobe of equal width in all directions.
    #[must_use]
    pub fn ggx(alpha: f32) -> Self {
        Self::Ggx { alpha_x: alpha, alpha_y: alpha }
    }

    /// A GGX lobe with these widths along tangent and bitangent.
    #[must_use]
    pub fn wide(alpha: Vec2) -> Self {
        Self::Ggx { alpha_x: alpha.x, alpha_y: alpha.y }
    }

    /// Refraction in facets with these widths along tangent and bitangent.
    #[must_use]
    pub fn refracted(alpha: Vec2, eta: f32) -> Self {
        Self::GgxBelow { alpha_x: alpha.x, alpha_y: alpha.y, eta }
    }

    /// A GGX lobe about as wide as the brightest part of the generalised distribution (GTR): wider for γ
    /// below 2, where the tails are longer, and narrower above.
    #[must_use]
    pub fn of_gtr(alpha: Vec2, gamma: f32) -> Self {
        let same = |alpha: f32| {
            if gamma < 2.0 { alpha.powf(0.3 + 0.35 * gamma) } else { alpha / (gamma - 1.0).sqrt() }
        };
        Self::wide(alpha.map(same))
    }

    /// A GGX lobe about as wide as a lobe of half vectors by a power of the cosine, with exponents along
    /// tangent and bitangent.
    #[must_use]
    pub fn of_half_vectors(along: f32, across: f32) -> Self {
        Self::wide(Vec2::new(along, across).map(alpha_of_exponent))
    }

    /// The kind and the numbers, in the shaders' layout.
    fn row(self) -> [f32; 3] {
        match self {
            Self::Cosine => [0.0, 0.0, 0.0],
            Self::Ggx { alpha_x, alpha_y } => [1.0, alpha_x, alpha_y],
            Self::Power { exponent } => [2.0, exponent, 0.0],
            Self::CosineBelow => [3.0, 0.0, 0.0],
            // The index is part of the kind: a row has no other number left.
            Self::GgxBelow { alpha_x, alpha_y, eta } => [BELOW + eta, alpha_x, alpha_y],
        }
    }

    /// The lobe within the limits of arithmetic.
    fn clamped(self) -> Self {
        let width = |alpha: f32| if alpha >= NARROWEST { alpha.min(1.0) } else { NARROWEST };
        match self {
            Self::Cosine | Self::CosineBelow => self,
            Self::GgxBelow { alpha_x, alpha_y, eta } => {
                Self::GgxBelow { alpha_x: width(alpha_x), alpha_y: width(alpha_y), eta: eta.clamp(0.1, 10.0) }
            }
            Self::Ggx { alpha_x, alpha_y } => Self::Ggx { alpha_x: width(alpha_x), alpha_y: width(alpha_y) },
            Self::Power { exponent } => {
                Self::Power { exponent: if exponent >= 0.0 { exponent.min(STEEPEST) } else { 0.0 } }
            }
        }
    }

    /// A direction in the local frame (normal z, tangent x).
    fn sample(self, u: Vec2, v: Vec3) -> Vec3 {
        match self {
            Self::Cosine => sampling::cosine(u),
            Self::Ggx { alpha_x, alpha_y } => {
                let h = visible_normal(u, v, alpha_x, alpha_y);
                2.0 * v.dot(h) * h - v
            }
            Self::Power { exponent } => {
                let cosine = u.x.powf(1.0 / (exponent + 1.0));
                let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
                let phi = 2.0 * PI * u.y;
                let local = Vec3::new(sine * phi.cos(), sine * phi.sin(), cosine);
                sampling::about(Vec3::new(-v.x, -v.y, v.z), local)
            }
            Self::CosineBelow => -sampling::cosine(u),
            Self::GgxBelow { alpha_x, alpha_y, eta } => {
                let h = visible_normal(u, v, alpha_x, alpha_y);
                let cosine = v.dot(h);
                if eta == 1.0 {
                    let l = 2.0 * cosine * h - v;
                    return Vec3::new(l.x, l.y, -l.z);
                }
                let squared = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
                // Without a density if the facet reflects all light.
                if squared <= 0.0 { Vec3::ZERO } else { (cosine / eta - squared.sqrt()) * h - v / eta }
            }
        }
    }

    /// The density per solid angle for a direction in the local frame.
    fn pdf(self, l: Vec3, v: Vec3) -> f32 {
        match self {
            Self::Cosine => l.z.max(0.0) / PI,
            Self::Ggx { alpha_x, alpha_y } => facets(l + v, v, alpha_x, alpha_y) / 4.0,
            Self::CosineBelow => (-l.z).max(0.0) / PI,
            Self::GgxBelow { alpha_x, alpha_y, eta: 1.0 } => {
                facets(Vec3::new(l.x, l.y, -l.z) + v, v, alpha_x, alpha_y) / 4.0
            }
            Self::GgxBelow { alpha_x, alpha_y, eta } => {
                let sum = v + eta * l;
                let h = sum.normalize_or_zero() * if sum.z < 0.0 { -1.0 } else { 1.0 };
                let (towards_v, towards_l) = (v.dot(h), l.dot(h));
                if towards_v <= 0.0 || towards_l >= 0.0 {
                    return 0.0;
                }
                // The facets' density times the Jacobian of refraction.
                let across = towards_v + eta * towards_l;
                facets(h, v, alpha_x, alpha_y) * towards_v * eta * eta * -towards_l
                    / (across * across).max(1e-12)
            }
            Self::Power { exponent } => {
                let cosine = (v.z * l.z - v.x * l.x - v.y * l.y).min(1.0);
                if cosine <= 0.0 {
                    return 0.0;
                }
                (exponent + 1.0) / (2.0 * PI) * cosine.powf(exponent)
            }
        }
    }
}

/// A GGX facet seen from `v`.
fn visible_normal(u: Vec2, v: Vec3, alpha_x: f32, alpha_y: f32) -> Vec3 {
    let wide = Vec3::new(v.x * alpha_x, v.y * alpha_y, v.z).normalize();
    let phi = 2.0 * PI * u.x;
    let z = (1.0 - u.y) * (1.0 + wide.z) - wide.z;
    let sine = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    let cap = Vec3::new(sine * phi.cos(), sine * phi.sin(), z) + wide;
    Vec3::new(cap.x * alpha_x, cap.y * alpha_y, cap.z.max(0.0)).normalize_or_zero()
}

/// The density of visible GGX facets with a normal along `h`, of any length, divided by V·H: D(h) G₁(v) / N·V, with
/// G₁/(N·V) = 2/(N·V + √(…)).
fn facets(h: Vec3, v: Vec3, alpha_x: f32, alpha_y: f32) -> f32 {
    let squared = h.length_squared();
    if h.z <= 0.0 || squared <= 0.0 {
        return 0.0;
    }
    let stretched = (h.x / alpha_x).powi(2) + (h.y / alpha_y).powi(2) + h.z * h.z;
    let d = squared * squared / (PI * alpha_x * alpha_y * stretched * stretched);
    let seen = ((alpha_x * v.x).powi(2) + (alpha_y * v.y).powi(2) + v.z * v.z).sqrt();
    2.0 * d / (v.z + seen)
}

impl Lobes {
    /// At most [`MAX_LOBES`] lobes, with weights of any sum: brighter lobes have larger weights. Negative
    /// weights and NaN count as zero; if none is positive, returns the default.
    #[must_use]
    pub fn new(lobes: &[(Lobe, f32)]) -> Self {
        let mut out = [(Lobe::Cosine, 0.0); MAX_LOBES];
        let mut sum = 0.0;
        for (to, (lobe, weight)) in out.iter_mut().zip(lobes) {
            let weight = if *weight > 0.0 { weight.min(1e6) } else { 0.0 };
            *to = (lobe.clamped(), weight);
            sum += weight;
        }
        if sum <= 0.0 {
            return Self::default();
        }
        out.iter_mut().for_each(|(_, share)| *share /= sum);
        Self(out)
    }

    /// The lobes below the surface; without any, a cosine.
    #[must_use]
    pub fn below(&self) -> Self {
        let is_below = |lobe: &Lobe| matches!(lobe, Lobe::CosineBelow | Lobe::GgxBelow { .. });
        let below: ArrayVec<_, MAX_LOBES> =
            self.0.into_iter().filter(|(lobe, share)| is_below(lobe) && *share > 0.0).collect();
        if below.is_empty() { Self::new(&[(Lobe::CosineBelow, 1.0)]) } else { Self::new(&below) }
    }

    /// The default of models that light passes through: the other default, and a cosine below the surface.
    #[must_use]
    pub fn of_both_sides() -> Self {
        Self::new(&[(Lobe::Cosine, 0.25), (Lobe::ggx(0.4), 0.25), (Lobe::CosineBelow, 0.5)])
    }

    /// The cosine lobe alone, for checks.
    #[must_use]
    pub fn cosine() -> Self {
        Self::new(&[(Lobe::Cosine, 1.0)])
    }

    /// One diffuse and one specular lobe with their reflectances; where the latter depends on the angle, at
    /// [`OBLIQUE`].
    #[must_use]
    pub fn diffuse_and(specular: Lobe, diffuse: Vec3, reflectance: Vec3) -> Self {
        Self::coated((specular, 0.0), specular, diffuse, reflectance)
    }

    /// The lobes of a coated surface, with the coat's lobe and reflectance. Diffuse and base lobes get at
    /// least an eighth of the samples each, so that no direction is missed where the others are dark or the
    /// angle differs.
    #[must_use]
    pub fn coated(coat: (Lobe, f32), base: Lobe, diffuse: Vec3, reflectance: Vec3) -> Self {
        let (diffuse, reflectance) = (diffuse.element_sum() / 3.0, reflectance.element_sum() / 3.0);
        let least = (0.125 * (diffuse + reflectance + coat.1)).max(1e-6);
        Self::new(&[(Lobe::Cosine, diffuse.max(least)), (base, reflectance.max(least)), coat])
    }

    /// The lobes with their shares, which sum to 1.
    #[must_use]
    pub fn all(&self) -> &[(Lobe, f32); MAX_LOBES] {
        &self.0
    }

    /// True if no lobe has different widths along and across the tangent. Such lobes are sampled in the frame
    /// of the normal alone, so that samples do not depend on a tangent that the model does not use, and that
    /// a renderer may omit.
    #[must_use]
    pub fn are_isotropic(&self) -> bool {
        self.0.iter().all(|(lobe, _)| match lobe {
            Lobe::Ggx { alpha_x, alpha_y } | Lobe::GgxBelow { alpha_x, alpha_y, .. } => alpha_x == alpha_y,
            _ => true,
        })
    }

    /// The lobes in the shaders' layout: for each its kind (0 cosine, 1 GGX, 2 power; 3 cosine below, 4 plus the
    /// refractive index GGX below), its numbers, its share.
    #[must_use]
    pub fn rows(&self) -> [Vec4; MAX_LOBES] {
        self.0.map(|(lobe, share)| {
            let [kind, a, b] = lobe.row();
            Vec4::new(kind, a, b, share)
        })
    }

    /// The rows as bytes.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        self.rows().iter().flat_map(|row| row.to_array()).flat_map(f32::to_le_bytes).collect()
    }

    /// A direction in the local frame (normal z, tangent x) for a viewer above the surface; it may be below.
    #[must_use]
    pub fn sample(&self, u: Vec2, v: Vec3) -> Vec3 {
        let v = above(v);
        let mut x = u.x;
        for (i, (lobe, share)) in self.0.iter().enumerate() {
            if x < *share || i + 1 == MAX_LOBES {
                // The rest of the number is uniformly distributed too.
                let rest = if *share > 0.0 { (x / share).min(BELOW_ONE) } else { 0.5 };
                return lobe.sample(Vec2::new(rest, u.y), v);
            }
            x -= share;
        }
        Vec3::Z
    }

    /// The density per solid angle with which [`sample`](Self::sample) returns a direction.
    #[must_use]
    pub fn pdf(&self, l: Vec3, v: Vec3) -> f32 {
        let v = above(v);
        self.0.iter().filter(|(_, share)| *share > 0.0).map(|(lobe, share)| share * lobe.pdf(l, v)).sum()
    }
}

/// The largest number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// A viewer above the surface: at the horizon, rounding may have moved it below.
fn above(v: Vec3) -> Vec3 {
    if v.z >= 1e-4 { v } else { Vec3::new(v.x, v.y, 1e-4).normalize() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::{
        chi_squared::{chi_squared, passes},
        geometry::direction,
        sequence::Sequence,
    };

    fn all() -> [Lobes; 13] {
        [
            Lobes::cosine(),
            Lobes::default(),
            Lobes::new(&[(Lobe::ggx(0.1), 1.0)]),
            Lobes::new(&[(Lobe::Ggx { alpha_x: 0.5, alpha_y: 0.15 }, 1.0)]),
            Lobes::new(&[(Lobe::ggx(1.0), 1.0)]),
            Lobes::new(&[(Lobe::Power { exponent: 20.0 }, 1.0)]),
            Lobes::new(&[(Lobe::Power { exponent: 0.0 }, 1.0)]),
            Lobes::new(&[(Lobe::Cosine, 1.0), (Lobe::ggx(0.3), 2.0), (Lobe::Power { exponent: 50.0 }, 1.0)]),
            Lobes::new(&[(Lobe::CosineBelow, 1.0)]),
            Lobes::new(&[(Lobe::refracted(Vec2::splat(0.3), 1.0), 1.0)]),
            Lobes::new(&[(Lobe::refracted(Vec2::new(0.7, 0.3), 1.5), 1.0)]),
            Lobes::new(&[(Lobe::refracted(Vec2::splat(0.5), 2.4), 1.0)]),
            Lobes::new(&[(Lobe::ggx(0.4), 1.0), (Lobe::refracted(Vec2::splat(0.4), 2.4), 2.0)]),
        ]
    }

    const VIEWS: [(f64, f64); 4] = [(0.0, 0.0), (40.0, 70.0), (75.0, 200.0), (89.0, 10.0)];

    #[test]
    fn samples_of_all_lobes_have_their_density() {
        for (i, lobes) in all().into_iter().enumerate() {
            for (theta, phi) in VIEWS {
                let v = direction(theta, phi);
                let sample =
                    |random: &mut dyn FnMut() -> f32| Some(lobes.sample(Vec2::new(random(), random()), v));
                let found = chi_squared(sample, |l| lobes.pdf(l, v));
                assert!(passes(found), "{i} from {theta}°: {found:?}");
                // Wrong twins: half the width, another share, a missing cosine.
                let wrong = match lobes.0[0].0 {
                    Lobe::Cosine => Lobes::new(&[(Lobe::Power { exponent: 0.0 }, 1.0)]),
                    Lobe::Ggx { alpha_x, alpha_y } => {
                        Lobes::new(&[(Lobe::Ggx { alpha_x: 0.8 * alpha_x, alpha_y: 0.8 * alpha_y }, 1.0)])
                    }
                    Lobe::Power { exponent } => {
                        Lobes::new(&[(Lobe::Power { exponent: exponent + 2.0 }, 1.0)])
                    }
                    Lobe::CosineBelow => Lobes::cosine(),
                    Lobe::GgxBelow { alpha_x, alpha_y, eta } => {
                        Lobes::new(&[(Lobe::refracted(0.8 * Vec2::new(alpha_x, alpha_y), eta), 1.0)])
                    }
                };
                let found = chi_squared(sample, |l| wrong.pdf(l, v));
                assert!(!passes(found), "wrong twin of {i} from {theta}°: {found:?}");
            }
        }
    }

    #[test]
    fn weighted_by_their_density_samples_integrate_anything() {
        // ∫ cos θ dω over the hemisphere is π, with any lobe that covers all of it.
        for lobes in [Lobes::cosine(), Lobes::default(), all()[7]] {
            for (theta, phi) in VIEWS {
                let v = direction(theta, phi);
                let sequence = Sequence::new(5, 0);
                let count = 1 << 14;
                let sum: f64 = (0..count)
                    .map(|i| {
                        let l = lobes.sample(sequence.point(i), v);
                        f64::from(l.z.max(0.0)) / f64::from(lobes.pdf(l, v))
                    })
                    .sum();
                assert!(
                    (sum / f64::from(count) / std::f64::consts::PI - 1.0).abs() < 1e-2,
                    "{lobes:?} {theta}"
                );
            }
        }
    }

    #[test]
    fn hostile_numbers_give_finite_directions_and_densities() {
        let odd = [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e30];
        for a in odd {
            for b in odd {
                let lobes = Lobes::new(&[
                    (Lobe::Ggx { alpha_x: a, alpha_y: b }, 1.0),
                    (Lobe::Power { exponent: a }, b),
                    (Lobe::Cosine, a),
                ]);
                let sum: f32 = lobes.all().iter().map(|(_, share)| share).sum();
                assert!((sum - 1.0).abs() < 1e-5);
                for v in [Vec3::Z, Vec3::X, Vec3::NEG_Z, Vec3::new(0.6, 0.0, 0.8)] {
                    for u in [Vec2::ZERO, Vec2::splat(0.5), Vec2::splat(BELOW_ONE)] {
                        let l = lobes.sample(u, v);
                        assert!(l.is_finite() && lobes.pdf(l, v).is_finite(), "{a} {b} {v} {u}");
                    }
                }
            }
        }
        assert_eq!(Lobes::new(&[]), Lobes::default());
        assert_eq!(Lobes::new(&[(Lobe::Cosine, 0.0)]), Lobes::default());
    }

    #[test]
    fn no_direction_is_missed_where_one_part_is_dark() {
        for (diffuse, specular) in [(0.0, 1.0), (1.0, 0.0), (0.0, 0.0)] {
            let lobes = Lobes::diffuse_and(Lobe::ggx(0.1), Vec3::splat(diffuse), Vec3::splat(specular));
            assert!(lobes.all()[..2].iter().all(|(_, share)| *share > 0.09));
        }
    }
}
