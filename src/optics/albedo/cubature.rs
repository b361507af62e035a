//! The integral over the directions to the light, over cells that are halved where the error is largest.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use crate::optics::Terms;

/// Maximum absolute error of [`directional`](super::directional).
pub const ACCURACY: f64 = 1e-4;

/// The relative error that rounding in a response causes in the value of a cell: a smaller error is no reason to halve
/// the cell.
const ROUNDING: f64 = 3e-5;

/// The initial cells of an integral, and its tolerance.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    /// Azimuths of the initial cells in half vectors and in lights, relative to that of the view.
    azimuths: Vec<f64>,
    /// Cells in t between two azimuths.
    rings: usize,
    /// 2 if the azimuths are one half of a symmetric circle.
    symmetry: f64,
    /// The sum of the estimated errors of all cells of an integral, diffuse and specular separately. The
    /// estimates are those of the lower-degree rule, and far above the error of the higher.
    tolerance: f64,
    /// Maximum number of cells of an integral.
    cells: usize,
}

impl Plan {
    /// For one view of any model. Lobes that are narrow in one tangent direction and wide in the other
    /// are ridges along the tangent or the bitangent, so cells are narrow there.
    pub(super) fn accurate(azimuth: f64) -> Self {
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

    /// For curves of isotropic models.
    pub(super) fn isotropic() -> Self {
        Self { azimuths: vec![0.0, PI / 2.0, PI], rings: 6, symmetry: 2.0, tolerance: 5e-4, cells: 100 }
    }

    /// For curves of anisotropic models.
    pub(super) fn anisotropic() -> Self {
        Self {
            azimuths: (0..=8).map(|i| f64::from(i) * PI / 4.0).collect(),
            rings: 6,
            symmetry: 1.0,
            tolerance: 1e-3,
            cells: 400,
        }
    }
}

/// The term that a cell integrates, and its coordinates.
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
    /// The coordinate along which the cell is halved.
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

/// Weights of a point in the rules of degree 7 and 5, by its index in [`POINTS`]; each sums to 1.
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

    /// The initial cells of a view.
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

    /// Stores the responses at the points of the rule.
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
        // The fourth difference along an axis: the inner pair without its quadratic part.
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

/// A view, with the sines and cosines that every point needs.
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

/// The albedos for views, each with a plan.
pub(super) fn integrate<E>(
    views: &[(Vec3, Plan)],
    mut ask: impl FnMut(&[(Vec3, Vec3)], &mut Vec<Terms>) -> Result<(), E>,
) -> Result<Vec<DVec3>, E> {
    struct Task<'a> {
        view: View,
        plan: &'a Plan,
        /// The cells; those from `fresh` on have no responses yet.
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
            // The fewest cells with all but half of the tolerable error, within the available space.
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
