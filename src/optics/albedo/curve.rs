//! Albedos as functions of the view, from values at a few nodes.

use std::{convert::Infallible, f64::consts::PI};

use glam::{DVec3, Vec3};

use super::cubature::{Plan, integrate};
use crate::optics::{Frame, Terms};

/// Nodes of a curve over `μ = n·v`, at `μ = (i/15)³`: closest at grazing views, where albedos change fastest. The cubic
/// between them reproduces a lobe of F = 1 to 0.002 (GGX) and 0.003 (Beckmann) from α = 0.04 up, and to 0.005 at α =
/// 0.01 (linear in √μ, GGX would be off by 0.006 and 0.024).
pub const NODES: usize = 16;

/// The view of the node at μ = 0, where a response is zero by definition: close enough for the limit.
const GRAZING: f64 = 1e-6;

/// The view at a node of a curve in an azimuth.
fn node(i: usize, azimuth: f64) -> Vec3 {
    let mu = (i as f64 / (NODES - 1) as f64).powi(3).max(GRAZING);
    let sin = (1.0 - mu * mu).max(0.0).sqrt();
    DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), mu).as_vec3()
}

/// The albedos at the nodes for one azimuth of the view, accurate enough for pictures.
pub(super) fn nodes(response: impl Fn(Vec3, Vec3) -> Terms, azimuth: f64, plan: &Plan) -> [DVec3; NODES] {
    let views: [_; NODES] = std::array::from_fn(|i| (node(i, azimuth), plan.clone()));
    let Ok(albedos) = integrate(&views, |pairs, answers| {
        answers.extend(pairs.iter().map(|(l, v)| response(*l, *v)));
        Ok::<_, Infallible>(())
    });
    std::array::from_fn(|i| albedos[i])
}

/// Weights of the nodes around μ in the cubic of E. Catmull, R. Rom (1974), *A Class of Local Interpolating Splines*,
/// over the cube root of μ; and the first of the four nodes. At both ends the curve is extrapolated linearly.
pub(super) fn spline(mu: f32) -> (usize, [f32; 4]) {
    let x = mu.clamp(0.0, 1.0).cbrt() * (NODES - 1) as f32;
    let i = (x as usize).min(NODES - 2);
    let f = x - i as f32;
    let g = 1.0 - f;
    let [a, b, c, d] =
        [-0.5 * f * g * g, 1.0 + f * f * (1.5 * f - 2.5), 1.0 + g * g * (1.5 * g - 2.5), -0.5 * g * f * f];
    if i == 0 {
        (0, [b + 2.0 * a, c - a, d, 0.0])
    } else if i == NODES - 2 {
        (NODES - 4, [0.0, a, b - d, c + 2.0 * d])
    } else {
        (i - 1, [a, b, c, d])
    }
}

/// The coefficients a₀, a₂, a₄ of the values at φ = 0°, 45° and 90°.
fn harmonics_of([e0, e45, e90]: [Vec3; 3]) -> [Vec3; 3] {
    [0.25 * (e0 + 2.0 * e45 + e90), 0.5 * (e0 - e90), 0.25 * (e0 - 2.0 * e45 + e90)]
}

/// The directional albedo of a surface as a function of the view, from values at [`NODES`] nodes, cubic between them.
/// For anisotropic models, also of the azimuth of the view from the tangent: `E(μ, φ) ≈ a₀(μ) + a₂(μ) cos 2φ + a₄(μ)
/// cos 4φ`, from φ = 0°, 45° and 90°: to 0.001 for GGX lobes of widths 3:2, 0.01 for 5:2; for widths 10:1 it smooths
/// the azimuth by up to 0.1 at grazing views.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlbedoCurve {
    /// The coefficients a₀, a₂, a₄ at each node; for isotropic models only a₀ is not zero.
    pub harmonics: [[Vec3; NODES]; 3],
}

impl AlbedoCurve {
    /// The curve of a model from its response, in the local frame (normal +z, tangent +x).
    #[must_use]
    pub fn new(response: impl Fn(Vec3, Vec3) -> Terms, anisotropic: bool) -> Self {
        let mut harmonics = [[Vec3::ZERO; NODES]; 3];
        if anisotropic {
            let plan = Plan::anisotropic();
            let [e0, e45, e90] = [0.0, PI / 4.0, PI / 2.0].map(|azimuth| nodes(&response, azimuth, &plan));
            for i in 0..NODES {
                let (e0, e45, e90) = (e0[i], e45[i], e90[i]);
                harmonics[0][i] = (0.25 * (e0 + 2.0 * e45 + e90)).as_vec3();
                harmonics[1][i] = (0.5 * (e0 - e90)).as_vec3();
                harmonics[2][i] = (0.25 * (e0 - 2.0 * e45 + e90)).as_vec3();
            }
        } else {
            harmonics[0] = nodes(&response, 0.0, &Plan::isotropic()).map(|e| e.as_vec3());
        }
        Self { harmonics }
    }

    /// The curve with `more` added to the albedo of each view, in the local frame.
    #[must_use]
    pub fn with(mut self, more: impl Fn(Vec3) -> Vec3, anisotropic: bool) -> Self {
        let at = |i, azimuth| more(node(i, azimuth));
        for i in 0..NODES {
            let mut add = |coefficients: [Vec3; 3]| {
                self.harmonics.iter_mut().zip(coefficients).for_each(|(harmonic, c)| harmonic[i] += c);
            };
            if anisotropic {
                add(harmonics_of([0.0, PI / 4.0, PI / 2.0].map(|azimuth| at(i, azimuth))));
            } else {
                add([at(i, 0.0), Vec3::ZERO, Vec3::ZERO]);
            }
        }
        self
    }

    /// The albedo for a view from above.
    #[must_use]
    pub fn at(&self, v: Vec3, frame: &Frame) -> Vec3 {
        let (i, weights) = spline(frame.n.dot(v));
        let (x, y) = (frame.t.dot(v), frame.b.dot(v));
        // Along the normal there is no azimuth, and nothing depends on it.
        let cos_2 = (x * x - y * y) / (x * x + y * y).max(f32::MIN_POSITIVE);
        let cos_4 = 2.0 * cos_2 * cos_2 - 1.0;
        let [a_0, a_2, a_4] = self
            .harmonics
            .each_ref()
            .map(|a| weights.iter().zip(&a[i..]).map(|(weight, node)| *weight * *node).sum::<Vec3>());
        (a_0 + a_2 * cos_2 + a_4 * cos_4).max(Vec3::ZERO)
    }
}

/// The directional albedo `E(μ)` of a specular lobe alone, with F = 1, and its mean over the hemisphere `2 ∫ E μ dμ`:
/// the basis for compensation of multiple scattering (C. Kulla, A. Conty 2017, *Revisiting Physically Based Shading at
/// Imageworks*; E. Turquin 2019, *Practical Multiple Scattering Compensation for Microfacet Models*). For anisotropic
/// lobes, the mean over the azimuth. At most 1, since lobes that reflect more than they receive need no compensation;
/// by default 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LobeAlbedo {
    /// The albedo at each node.
    pub nodes: [f32; NODES],
    average: f32,
}

impl Default for LobeAlbedo {
    fn default() -> Self {
        Self { nodes: [1.0; NODES], average: 1.0 }
    }
}

impl LobeAlbedo {
    /// The albedo of an isotropic lobe from its response `π f_r(l, v) cos θ_l` with F = 1, in the local frame (normal
    /// +z, tangent +x).
    #[must_use]
    pub fn new(response: impl Fn(Vec3, Vec3) -> f32) -> Self {
        let response = |l, v| Terms { specular: Vec3::splat(response(l, v)), ..Terms::default() };
        Self::from_nodes(nodes(response, 0.0, &Plan::isotropic()).map(|e| e.x as f32))
    }

    /// The albedo of an anisotropic lobe from its response with F = 1.
    #[must_use]
    pub fn anisotropic(response: impl Fn(Vec3, Vec3) -> f32) -> Self {
        let response = |l, v| Terms { specular: Vec3::splat(response(l, v)), ..Terms::default() };
        Self::from_nodes(AlbedoCurve::new(response, true).harmonics[0].map(|e| e.x))
    }

    /// The curve through these values at μ = (i/15)³.
    #[must_use]
    pub fn from_nodes(nodes: [f32; NODES]) -> Self {
        let mut lobe = Self { nodes, average: 0.0 };
        // 2 ∫ E μ dμ = 6 ∫ E x⁵ dx with x³ = μ, by the midpoint rule, whose points cost little.
        let n = 960;
        let x = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
        let sum: f64 = (0..n).map(|k| f64::from(lobe.at(x(k).powi(3) as f32)) * 6.0 * x(k).powi(5)).sum();
        lobe.average = (sum / f64::from(n)) as f32;
        lobe
    }

    /// `E(μ)`, μ being the cosine between view and normal.
    #[must_use]
    pub fn at(&self, mu: f32) -> f32 {
        let (i, weights) = spline(mu);
        let sum: f32 = weights.iter().zip(&self.nodes[i..]).map(|(weight, node)| weight * node).sum();
        sum.clamp(0.0, 1.0)
    }

    /// `1 − E(μ)`, with all digits where E is nearly 1.
    #[must_use]
    pub fn loss(&self, mu: f32) -> f32 {
        let (i, weights) = spline(mu);
        let sum: f32 = weights.iter().zip(&self.nodes[i..]).map(|(weight, node)| weight * (1.0 - node)).sum();
        sum.clamp(0.0, 1.0)
    }

    /// `2 ∫ E μ dμ`.
    #[must_use]
    pub fn average(&self) -> f32 {
        self.average
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::albedo::tests::{albedo, ggx, specular, view};

    #[test]
    fn curves_are_the_quadrature() {
        for (alpha, tolerance, grazing) in
            [(0.01, 1e-3, 6e-3), (0.04, 1e-3, 2e-3), (0.2, 1e-3, 1e-3), (0.5, 1e-3, 2e-3), (1.0, 1e-3, 3e-3)]
        {
            for correlated in [true, false] {
                let lobe = ggx(alpha, correlated);
                let curve = AlbedoCurve::new(specular(&lobe), false);
                let albedos = LobeAlbedo::new(&lobe);
                for k in 1..=40 {
                    let mu = (k as f32 / 40.0).powi(3);
                    let exact = albedo(specular(&lobe), mu);
                    let of_curve = f64::from(curve.at(view(mu), &Frame::LOCAL).x);
                    let tolerance = if mu < 0.1 { grazing } else { tolerance };
                    for e in [of_curve, f64::from(albedos.at(mu))] {
                        assert!((e - exact).abs() < tolerance, "α {alpha} μ {mu}: {e} instead of {exact}");
                    }
                }
            }
        }
        // 4/3 (1 − ln 2), for Lommel and Seeliger.
        let average = LobeAlbedo::new(ggx(1.0, true)).average();
        assert!((f64::from(average) - 4.0 / 3.0 * (1.0 - 2f64.ln())).abs() < 5e-4, "{average}");
        assert_eq!((LobeAlbedo::default().at(0.3), LobeAlbedo::default().average()), (1.0, 1.0));
    }
}
