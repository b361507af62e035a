//! Directional albedo: how much of uniform light from everywhere a surface sends towards the viewer,
//! `E(v) = ∫ f_r(l, v) cos θ_l dω_l = (1/π) ∫ response dω_l`, over the hemisphere above the surface.
//!
//! [`directional`] integrates one model for one view to [`ACCURACY`]; [`AlbedoCurve`] is the same as a
//! function of the view, for pictures; [`LobeAlbedo`] is that of a specular lobe alone whose Fresnel
//! factor is 1, which compensation of multiple scattering needs.
//!
//! Twin: `assets/shaders/optics/albedo.wgsl` reads the curves, it does not calculate them.
//!
//! # Method
//!
//! The diffuse term is integrated over directions to the light in spherical coordinates, the specular
//! term over half vectors in spherical coordinates, `dω_l = 4 (v·h) dω_h`: in these a lobe around the
//! mirror direction is one around the normal, however oblique the view. The half vectors for which the
//! light is above the surface reach, in the azimuth φ from the plane of incidence, up to
//! `θ_max = (π/2 + atan2(sin θ_v cos φ, cos θ_v))/2`; so `θ_h = θ_max t⁴`, 0 ≤ t ≤ 1, meets the horizon
//! exactly, and gives narrow lobes as much room as wide ones. Both are rectangles, which are halved
//! where the estimated error is largest, by the rule of degree 7 with an embedded one of degree 5 of
//! A. C. Genz, A. A. Malik (1980), *Remarks on Algorithm 006: An Adaptive Algorithm for Numerical
//! Integration over an N-dimensional Rectangular Region*. Responses are asked for in batches, so that
//! a graphics card may answer; sums are in 64 bits.

use std::{convert::Infallible, f64::consts::PI};

use glam::{DVec3, Vec3};

use super::{Frame, Terms};

/// The largest absolute error of [`directional`].
pub const ACCURACY: f64 = 1e-4;

/// Nodes of a curve over `μ = n·v`, at `μ = (i/15)³`: closest where the view is grazing, since albedos
/// turn fastest there. With the cubic between them a lobe of F = 1 is met to 0.002 (GGX) and 0.003
/// (Beckmann) from α = 0.04 up, and to 0.005 at α = 0.01 (linear in √μ GGX would be 0.006 and 0.024 off).
pub const NODES: usize = 16;

/// The view of the node at μ = 0, where a response is zero by definition: close enough for the limit.
const GRAZING: f64 = 1e-6;

/// What rounding in a response makes of the value of a cell: a smaller part of it is no reason to halve
/// the cell.
const ROUNDING: f64 = 3e-5;

/// How an integral is divided, and when it is good enough.
#[derive(Clone, Debug)]
struct Plan {
    /// Azimuths of the first cells in half vectors and in lights, from that of the view.
    azimuths: Vec<f64>,
    /// Cells in t between two azimuths.
    rings: usize,
    /// 2 if the azimuths are one half of a symmetric circle.
    symmetry: f64,
    /// The sum of the estimated errors of the cells of an integral, diffuse and specular apart. The
    /// estimates are those of the lower rule, and far above the error of the higher.
    tolerance: f64,
    /// Most cells of an integral.
    cells: usize,
}

impl Plan {
    /// For one view of any model. Lobes that are narrow in one tangent direction and wide in the other
    /// are ridges along the tangent or the bitangent, so cells are narrow there.
    fn accurate(azimuth: f64) -> Self {
        let mut azimuths: Vec<f64> = [0.0, -azimuth]
            .iter()
            .flat_map(|axis| {
                (0..4).flat_map(move |quarter| {
                    [-0.1, -0.01, -0.001, 0.0, 0.001, 0.01, 0.1, PI / 4.0]
                        .map(|step| (axis + f64::from(quarter) * PI / 2.0 + step).rem_euclid(2.0 * PI))
                })
            })
            .collect();
        azimuths.sort_by(f64::total_cmp);
        azimuths.dedup_by(|a, b| *a - *b < 1e-9);
        azimuths.push(azimuths[0] + 2.0 * PI);
        Self { azimuths, rings: 6, symmetry: 1.0, tolerance: 0.3 * ACCURACY, cells: 6000 }
    }

    /// For curves of models that turning about the normal does not change.
    fn isotropic() -> Self {
        Self { azimuths: vec![0.0, PI / 2.0, PI], rings: 6, symmetry: 2.0, tolerance: 5e-4, cells: 100 }
    }

    /// For curves of models that it does.
    fn anisotropic() -> Self {
        Self {
            azimuths: (0..=8).map(|i| f64::from(i) * PI / 4.0).collect(),
            rings: 6,
            symmetry: 1.0,
            tolerance: 1e-3,
            cells: 400,
        }
    }
}

/// Which term a cell integrates, and in which coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// The diffuse term over (θ_l, φ_l).
    Diffuse,
    /// The specular term over (t, φ_h).
    Specular,
}

/// A rectangle of coordinates.
#[derive(Clone, Copy, Debug)]
struct Cell {
    part: Part,
    centre: [f64; 2],
    half: [f64; 2],
    value: DVec3,
    error: f64,
    /// The coordinate in which it is halved.
    axis: usize,
}

/// Points of the rule on [-1, 1]²: the centre; two pairs on each axis; the corners of two squares.
const POINTS: [[f64; 2]; 17] = {
    // √(9/70), √(9/10), √(9/19).
    const A: f64 = 0.358_568_582_800_318_1;
    const B: f64 = 0.948_683_298_050_513_8;
    const C: f64 = 0.688_247_201_611_685_3;
    [
        [0.0, 0.0],
        [-A, 0.0],
        [A, 0.0],
        [-B, 0.0],
        [B, 0.0],
        [0.0, -A],
        [0.0, A],
        [0.0, -B],
        [0.0, B],
        [-B, -B],
        [B, -B],
        [-B, B],
        [B, B],
        [-C, -C],
        [C, -C],
        [-C, C],
        [C, C],
    ]
};

/// Weights of a point in the rules of degree 7 and 5, by its place in [`POINTS`]; each sums to 1.
fn weights(point: usize) -> (f64, f64) {
    match point {
        0 => (-3816.0 / 19683.0, -971.0 / 729.0),
        1 | 2 | 5 | 6 => (980.0 / 6561.0, 245.0 / 486.0),
        3 | 4 | 7 | 8 => (1020.0 / 19683.0, 65.0 / 1458.0),
        9..=12 => (200.0 / 19683.0, 25.0 / 729.0),
        _ => (6859.0 / 78732.0, 0.0),
    }
}

impl Cell {
    fn new(part: Part, [a0, a1]: [f64; 2], [b0, b1]: [f64; 2]) -> Self {
        Self {
            part,
            centre: [0.5 * (a0 + a1), 0.5 * (b0 + b1)],
            half: [0.5 * (a1 - a0), 0.5 * (b1 - b0)],
            value: DVec3::ZERO,
            error: 0.0,
            axis: 0,
        }
    }

    /// The first cells of a view.
    fn first(v: DVec3, plan: &Plan) -> Vec<Self> {
        let theta_v = v.x.hypot(v.y).atan2(v.z);
        let mut cells = Vec::new();
        for phi in plan.azimuths.windows(2) {
            let phi = [phi[0], phi[1]];
            // Rough diffuse surfaces have an edge where light and view are equally oblique.
            for theta in [[0.0, theta_v], [theta_v, PI / 2.0]] {
                if theta[1] - theta[0] > 1e-3 {
                    cells.push(Self::new(Part::Diffuse, theta, phi));
                }
            }
            for ring in 0..plan.rings {
                let t = [ring, ring + 1].map(|r| r as f64 / plan.rings as f64);
                cells.push(Self::new(Part::Specular, t, phi));
            }
        }
        cells
    }

    /// The direction to the light at a point of the rule, and the area of the cell's coordinates there.
    fn light(&self, point: usize, view: &View) -> (Vec3, f64) {
        let [x, y] = POINTS[point];
        let (a, phi) = (self.centre[0] + self.half[0] * x, self.centre[1] + self.half[1] * y);
        let area = 4.0 * self.half[0] * self.half[1];
        let (sin_phi, cos_phi) = phi.sin_cos();
        let (l, area) = match self.part {
            Part::Diffuse => {
                let (sin, cos) = a.sin_cos();
                (DVec3::new(sin * cos_phi, sin * sin_phi, cos), area * sin)
            }
            Part::Specular => {
                let theta_max = 0.5 * (0.5 * PI + (view.sin * cos_phi).atan2(view.cos));
                let t3 = a * a * a;
                let (sin, cos) = (theta_max * t3 * a).sin_cos();
                let h = DVec3::new(sin * cos_phi, sin * sin_phi, cos);
                let v_h = view.sin * h.x + view.cos * h.z;
                let l = 2.0 * v_h * h - DVec3::new(view.sin, 0.0, view.cos);
                (l, area * sin * theta_max * 4.0 * t3 * 4.0 * v_h)
            }
        };
        // From the plane of incidence into the local frame.
        let turned = DVec3::new(
            l.x * view.cos_azimuth - l.y * view.sin_azimuth,
            l.x * view.sin_azimuth + l.y * view.cos_azimuth,
            l.z,
        );
        (turned.as_vec3(), area)
    }

    /// Takes the answers at the points of the rule.
    fn take(&mut self, values: &[DVec3; 17]) {
        let mut low = DVec3::ZERO;
        self.value = DVec3::ZERO;
        for (i, value) in values.iter().enumerate() {
            let (high_weight, low_weight) = weights(i);
            self.value += high_weight * value;
            low += low_weight * value;
        }
        let difference = (self.value - low).abs().max_element();
        self.error = (difference - ROUNDING * self.value.abs().max_element()).max(0.0);
        // The fourth difference along an axis: of the inner pair without what is quadratic.
        let bend = |first: usize| {
            let second = |i: usize| values[i] + values[i + 1] - 2.0 * values[0];
            (second(first) - second(first + 2) / 7.0).abs().max_element()
        };
        self.axis = usize::from(bend(5) > bend(1));
    }

    fn halves(mut self) -> [Self; 2] {
        self.half[self.axis] *= 0.5;
        let mut other = self;
        self.centre[self.axis] -= self.half[self.axis];
        other.centre[self.axis] += self.half[self.axis];
        [self, other]
    }
}

/// A view with what every point needs.
struct View {
    v: Vec3,
    sin: f64,
    cos: f64,
    sin_azimuth: f64,
    cos_azimuth: f64,
}

impl View {
    fn new(v: Vec3) -> Self {
        let d = v.as_dvec3().normalize_or_zero();
        let sin = d.x.hypot(d.y);
        let (cos_azimuth, sin_azimuth) = if sin > 0.0 { (d.x / sin, d.y / sin) } else { (1.0, 0.0) };
        Self { v, sin, cos: d.z, sin_azimuth, cos_azimuth }
    }
}

/// The albedos for views, with a plan for each.
fn integrate<E>(
    views: &[(Vec3, Plan)],
    mut ask: impl FnMut(&[(Vec3, Vec3)], &mut Vec<Terms>) -> Result<(), E>,
) -> Result<Vec<DVec3>, E> {
    struct Task<'a> {
        view: View,
        plan: &'a Plan,
        /// Those from `fresh` on have no answers yet.
        cells: Vec<Cell>,
        fresh: usize,
    }
    let mut tasks: Vec<_> = views
        .iter()
        .map(|(v, plan)| {
            let cells = if v.z > 0.0 { Cell::first(v.as_dvec3(), plan) } else { Vec::new() };
            Task { view: View::new(*v), plan, cells, fresh: 0 }
        })
        .collect();
    let (mut pairs, mut areas, mut answers) = (Vec::new(), Vec::new(), Vec::new());
    loop {
        pairs.clear();
        areas.clear();
        answers.clear();
        for task in &tasks {
            for cell in &task.cells[task.fresh..] {
                for point in 0..POINTS.len() {
                    let (l, area) = cell.light(point, &task.view);
                    pairs.push((l, task.view.v));
                    areas.push(area * task.plan.symmetry / PI);
                }
            }
        }
        if pairs.is_empty() {
            break;
        }
        ask(&pairs, &mut answers)?;
        let mut answered = answers.iter().zip(&areas);
        for task in &mut tasks {
            for cell in &mut task.cells[task.fresh..] {
                let values = std::array::from_fn(|_| {
                    answered.next().map_or(DVec3::ZERO, |(terms, area)| {
                        let term = match cell.part {
                            Part::Diffuse => terms.diffuse,
                            Part::Specular => terms.specular,
                        };
                        term.as_dvec3() * *area
                    })
                });
                cell.take(&values);
            }
            let mut error: f64 = task.cells.iter().map(|c| c.error).sum();
            if error <= task.plan.tolerance || task.cells.len() >= task.plan.cells {
                task.fresh = task.cells.len();
                continue;
            }
            // The fewest that hold all but half of the tolerable error, not more than there is room for.
            task.cells.sort_unstable_by(|a, b| a.error.total_cmp(&b.error));
            let room = task.plan.cells - task.cells.len();
            let mut halved = Vec::new();
            while error > 0.5 * task.plan.tolerance && halved.len() < 2 * room {
                let Some(cell) = task.cells.pop() else { break };
                error -= cell.error;
                halved.extend(cell.halves());
            }
            task.fresh = task.cells.len();
            task.cells.append(&mut halved);
        }
    }
    Ok(tasks.iter().map(|task| task.cells.iter().map(|c| c.value).sum()).collect())
}

/// The directional albedos for views in the local frame (normal +z, tangent +x), each to [`ACCURACY`],
/// of whatever answers: it is asked for the responses to pairs of directions, to the light and to the
/// viewer, in a few large batches. Zero for a viewer below the surface.
///
/// # Errors
/// What the asked one returns.
pub fn directional_in_batches<E>(
    views: &[Vec3],
    mut ask: impl FnMut(&[(Vec3, Vec3)]) -> Result<Vec<Terms>, E>,
) -> Result<Vec<DVec3>, E> {
    let views: Vec<_> =
        views.iter().map(|v| (*v, Plan::accurate(f64::from(v.y).atan2(f64::from(v.x))))).collect();
    integrate(&views, |pairs, answers| {
        *answers = ask(pairs)?;
        Ok(())
    })
}

/// The directional albedo for one view, to [`ACCURACY`]: diffuse and specular response to light from
/// everywhere. Zero for a viewer below the surface.
#[must_use]
pub fn directional(response: impl Fn(Vec3) -> Terms, v: Vec3, frame: &Frame) -> DVec3 {
    let local = Vec3::new(v.dot(frame.t), v.dot(frame.b), v.dot(frame.n));
    let Ok(albedos) = directional_in_batches(&[local], |pairs| {
        let room = |l: Vec3| l.x * frame.t + l.y * frame.b + l.z * frame.n;
        Ok::<_, Infallible>(pairs.iter().map(|(l, _)| response(room(*l))).collect())
    });
    albedos[0]
}

/// The view at a node of a curve in an azimuth.
fn node(i: usize, azimuth: f64) -> Vec3 {
    let mu = (i as f64 / (NODES - 1) as f64).powi(3).max(GRAZING);
    let sin = (1.0 - mu * mu).max(0.0).sqrt();
    DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), mu).as_vec3()
}

/// The albedos at the nodes in one azimuth of the view, as fast as a picture bears.
fn nodes(response: impl Fn(Vec3, Vec3) -> Terms, azimuth: f64, plan: &Plan) -> [DVec3; NODES] {
    let views: [_; NODES] = std::array::from_fn(|i| (node(i, azimuth), plan.clone()));
    let Ok(albedos) = integrate(&views, |pairs, answers| {
        answers.extend(pairs.iter().map(|(l, v)| response(*l, *v)));
        Ok::<_, Infallible>(())
    });
    std::array::from_fn(|i| albedos[i])
}

/// Weights of the nodes around μ in the cubic of E. Catmull, R. Rom (1974), *A Class of Local
/// Interpolating Splines*, over the cube root of μ; the first of the four nodes, which the curve is
/// continued for in a straight line at both ends.
fn spline(mu: f32) -> (usize, [f32; 4]) {
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

/// The directional albedo of a surface as a function of the view, from values at [`NODES`] nodes,
/// a cubic between them. For anisotropic models also of the azimuth of the view from the tangent:
/// `E(μ, φ) ≈ a₀(μ) + a₂(μ) cos 2φ + a₄(μ) cos 4φ`, from φ = 0°, 45° and 90°: to 0.001 for GGX lobes of
/// widths 3:2, 0.01 for 5:2; of widths 10:1 it smooths the azimuth by up to 0.1 at grazing views.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlbedoCurve {
    /// The coefficients a₀, a₂, a₄ at each node; of isotropic models only a₀ is not zero.
    pub harmonics: [[Vec3; NODES]; 3],
}

impl AlbedoCurve {
    /// The curve of a model by its response, in the local frame (normal +z, tangent +x).
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

/// The directional albedo `E(μ)` of a specular lobe alone, with F = 1, and its mean over the hemisphere
/// `2 ∫ E μ dμ`: what compensation of multiple scattering starts from (C. Kulla, A. Conty 2017, *Revisiting
/// Physically Based Shading at Imageworks*; E. Turquin 2019, *Practical Multiple Scattering Compensation
/// for Microfacet Models*). Of anisotropic lobes the mean over the azimuth. At most 1, since lobes that reflect
/// more than they receive have nothing to get back; by default 1.
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
    /// The albedo of an isotropic lobe by its response `π f_r(l, v) cos θ_l` with F = 1, in the local
    /// frame (normal +z, tangent +x).
    #[must_use]
    pub fn new(response: impl Fn(Vec3, Vec3) -> f32) -> Self {
        let response = |l, v| Terms { specular: Vec3::splat(response(l, v)), ..Terms::default() };
        Self::from_nodes(nodes(response, 0.0, &Plan::isotropic()).map(|e| e.x as f32))
    }

    /// The same of a lobe that turning about the normal changes.
    #[must_use]
    pub fn anisotropic(response: impl Fn(Vec3, Vec3) -> f32) -> Self {
        let response = |l, v| Terms { specular: Vec3::splat(response(l, v)), ..Terms::default() };
        Self::from_nodes(AlbedoCurve::new(response, true).harmonics[0].map(|e| e.x))
    }

    fn from_nodes(nodes: [f32; NODES]) -> Self {
        let mut lobe = Self { nodes, average: 0.0 };
        // 2 ∫ E μ dμ = 6 ∫ E x⁵ dx with x³ = μ; midpoints, of which many cost little.
        let n = 960;
        let x = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
        let sum: f64 = (0..n).map(|k| f64::from(lobe.at(x(k).powi(3) as f32)) * 6.0 * x(k).powi(5)).sum();
        lobe.average = (sum / f64::from(n)) as f32;
        lobe
    }

    /// `E(μ)`, μ the cosine between view and normal.
    #[must_use]
    pub fn at(&self, mu: f32) -> f32 {
        let (i, weights) = spline(mu);
        let sum: f32 = weights.iter().zip(&self.nodes[i..]).map(|(weight, node)| weight * node).sum();
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

    /// GGX with height-correlated Smith masking and F = 1 (B. Walter et al. 2007; E. Heitz 2014), by the
    /// forms that do not cancel.
    fn ggx(alpha: f32, correlated: bool) -> impl Fn(Vec3, Vec3) -> f32 {
        move |l, v| {
            if l.z <= 0.0 || v.z <= 0.0 {
                return 0.0;
            }
            let h = (l + v).normalize();
            let tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
            let a2 = alpha * alpha;
            let d = a2 / (std::f32::consts::PI * h.z.powi(4) * (a2 + tan2).powi(2));
            let lambda = |w: Vec3| 0.5 * ((1.0 + a2 * (w.x * w.x + w.y * w.y) / (w.z * w.z)).sqrt() - 1.0);
            let g = if correlated {
                1.0 / (1.0 + lambda(l) + lambda(v))
            } else {
                1.0 / ((1.0 + lambda(l)) * (1.0 + lambda(v)))
            };
            std::f32::consts::PI * d * g / (4.0 * v.z)
        }
    }

    fn specular(response: impl Fn(Vec3, Vec3) -> f32) -> impl Fn(Vec3, Vec3) -> Terms {
        move |l, v| Terms { specular: Vec3::splat(response(l, v)), ..Terms::default() }
    }

    fn view(mu: f32) -> Vec3 {
        Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu)
    }

    fn albedo(response: impl Fn(Vec3, Vec3) -> Terms, mu: f32) -> f64 {
        directional(|l| response(l, view(mu)), view(mu), &Frame::LOCAL).x
    }

    #[test]
    fn the_quadrature_gives_the_closed_forms() {
        let ln = |mu: f64| 1.0 - mu * (1.0 / mu).ln_1p();
        let mut twin = 0.0f64;
        for mu in [0.001, 0.02, 0.1, 0.5, 0.9, 1.0] {
            let m = f64::from(mu);
            let lambert = |l: Vec3, _: Vec3| Terms { diffuse: Vec3::splat(l.z), ..Terms::default() };
            assert!((albedo(lambert, mu) - 1.0).abs() < 3e-5);
            // GGX with α = 1 is the law of Lommel and Seeliger.
            let correlated = albedo(specular(ggx(1.0, true)), mu);
            assert!((correlated - ln(m)).abs() < 3e-5, "{mu}: {correlated} {}", ln(m));
            let separable = albedo(specular(ggx(1.0, false)), mu);
            let expected = 2.0 * (1.0 - 2f64.ln()) / (1.0 + m);
            assert!((separable - expected).abs() < 3e-5, "{mu}: {separable} {expected}");
            twin = twin.max((separable - correlated).abs());
        }
        assert!(twin > 1e-2);
    }

    #[test]
    fn narrow_lobes_keep_what_they_hold() {
        // Powers of the cosine to the mirror direction, from the angle, whose cosine has no digits left.
        let phong = |n: f64| {
            move |l: Vec3, v: Vec3| {
                let mirrored = v.as_dvec3() * DVec3::new(-1.0, -1.0, 1.0);
                let chord2 = (l.as_dvec3().normalize() - mirrored.normalize()).length_squared();
                let lobe = 0.5 * (n + 2.0) * (1.0 - 0.5 * chord2).max(0.0).powf(n);
                Terms { specular: Vec3::splat((lobe * f64::from(l.z)) as f32), ..Terms::default() }
            }
        };
        // As long as the horizon cuts nothing off, E = μ.
        for (n, mus) in [(1e3, &[0.3, 0.7, 1.0][..]), (1e5, &[0.02, 0.3, 1.0]), (1e6, &[0.01, 0.3, 0.8, 1.0])]
        {
            for &mu in mus {
                let e = albedo(phong(n), mu);
                assert!((e - f64::from(mu)).abs() < ACCURACY, "n {n} μ {mu}: {e}");
            }
        }
        // The exact normalisation of Blinn's lobe at normal incidence.
        for n in [16f64, 1e3, 1e6] {
            let norm = PI * (n + 2.0) * (n + 4.0) / (8.0 * PI * ((-0.5 * n).exp2() + n));
            let blinn = |l: Vec3, v: Vec3| {
                let h = (l.as_dvec3() + v.as_dvec3()).normalize();
                let power = (-0.5 * n * ((h.x * h.x + h.y * h.y) / (h.z * h.z)).ln_1p()).exp();
                Terms { specular: Vec3::splat((norm * power * f64::from(l.z)) as f32), ..Terms::default() }
            };
            let e = albedo(blinn, 1.0);
            assert!((e - 1.0).abs() < ACCURACY, "n {n}: {e}");
        }
    }

    #[test]
    fn the_smallest_roughness_loses_nothing_but_at_grazing_angles() {
        // B. Walter's lobe at α = 0.001: 1 − E is about α² / μ² and beyond.
        for (mu, at_least) in [(0.1, 0.9999), (0.5, 0.9999), (1.0, 0.9999)] {
            let e = albedo(specular(ggx(1e-3, true)), mu);
            assert!((at_least..=1.0 + ACCURACY).contains(&e), "{mu}: {e}");
        }
    }

    #[test]
    fn ridges_of_anisotropic_lobes_are_found_wherever_they_lie() {
        // A Gaussian of the slopes of facets, D, and the response π D cos θ_h / (4 v·h): the integral is
        // that of D cos θ_h over half vectors, which is 1.
        for (a, b) in [(0.2, 0.2), (0.3, 0.01), (0.003, 0.4), (0.001, 0.1)] {
            let response = |l: Vec3, v: Vec3| {
                let (l, v) = (l.as_dvec3(), v.as_dvec3());
                let h = (l + v).normalize();
                let slopes = (h.x / (h.z * a)).powi(2) + (h.y / (h.z * b)).powi(2);
                let d = (-slopes).exp() / (PI * a * b * h.z.powi(4));
                let jacobian = 4.0 * h.dot(v);
                Terms { specular: Vec3::splat((PI * d * h.z / jacobian) as f32), ..Terms::default() }
            };
            let e = albedo(response, 1.0);
            // What lies beyond the horizon: slopes above 1.
            let horizon = (-1.0 / (a.max(b) * a.max(b))).exp();
            assert!((e - 1.0).abs() < ACCURACY + horizon, "{a} {b}: {e}");
        }
    }

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
                        assert!((e - exact).abs() < tolerance, "α {alpha} μ {mu}: {e} is not {exact}");
                    }
                }
            }
        }
        // 4/3 (1 − ln 2), of Lommel and Seeliger.
        let average = LobeAlbedo::new(ggx(1.0, true)).average();
        assert!((f64::from(average) - 4.0 / 3.0 * (1.0 - 2f64.ln())).abs() < 5e-4, "{average}");
        assert_eq!((LobeAlbedo::default().at(0.3), LobeAlbedo::default().average()), (1.0, 1.0));
    }

    #[test]
    fn a_view_from_below_sees_nothing_and_every_frame_the_same() {
        let response = specular(ggx(0.3, true));
        assert_eq!(directional(|_| Terms::default(), Vec3::NEG_Z, &Frame::LOCAL), DVec3::ZERO);
        let v = Vec3::new(0.48, 0.6, 0.64);
        let turned = Frame::from_normal(Vec3::new(0.36, -0.48, 0.8));
        let local = |w: Vec3| Vec3::new(w.dot(turned.t), w.dot(turned.b), w.dot(turned.n));
        let room = |w: Vec3| w.x * turned.t + w.y * turned.b + w.z * turned.n;
        let e = directional(|l| response(local(l), local(room(v))), room(v), &turned);
        let straight = directional(|l| response(l, v), v, &Frame::LOCAL);
        assert!((e - straight).abs().max_element() < 1e-5);
    }
}
