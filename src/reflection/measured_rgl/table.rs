//! The table of a measurement by J. Dupuy and W. Jakob (2018), the twin of `measured_rgl.wgsl`.
//!
//! In numbers it is
//!
//! 1. the numbers of azimuths and angles of the viewer, then columns and rows of the density of visible normals, of the values, of
//!    the distribution of normals and of its projected area;
//! 2. the parts of a turn that the azimuths cover (0: isotropic), and 1 if values are relative to the density;
//! 3. for sampling, the widths of the highlight and the albedo, and one number more;
//! 4. the azimuths and angles in radians, distribution, area, then for each pair the density, its integral along each row, the
//!    integral of the rows, and the values in red, green and blue.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Vec2, Vec3};

use crate::optics::{
    colour::luminance,
    lobes::{Lobe, Lobes},
};

/// The numbers before the azimuths.
const HEADER: usize = 16;
/// Minimum density and area, below which a value is 0.
const LEAST: f32 = 1e-12;

/// The arrays of a file, the last index fastest; values have their colours together.
#[derive(Clone, Debug, Default)]
pub(super) struct Arrays {
    pub(super) phi: Vec<f32>,
    pub(super) theta: Vec<f32>,
    /// Columns and rows of the density, the values, the distribution and the area.
    pub(super) sizes: [[usize; 2]; 4],
    pub(super) reduction: usize,
    pub(super) jacobian: bool,
    pub(super) ndf: Vec<f32>,
    pub(super) sigma: Vec<f32>,
    pub(super) vndf: Vec<f32>,
    pub(super) values: Vec<Vec3>,
}

/// A table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Data<'a> {
    numbers: &'a [f32],
    counts: [usize; 2],
    sizes: [[usize; 2]; 4],
    /// The first numbers of azimuths, angles, distribution, area, density, both integrals and values.
    at: [usize; 8],
}

/// The directions among those of a file: indices and the weights of the second ones.
#[derive(Clone, Copy, Debug)]
struct Neighbours {
    slices: [usize; 4],
    weights: [f32; 4],
}

fn area([columns, rows]: [usize; 2]) -> usize {
    columns * rows
}

/// The numbers of a table before its arrays, and its offsets.
fn offsets(counts: [usize; 2], sizes: [[usize; 2]; 4]) -> ([usize; 8], usize) {
    let slices = area(counts);
    let lengths = [
        counts[0],
        counts[1],
        area(sizes[2]),
        area(sizes[3]),
        slices * area(sizes[0]),
        slices * area(sizes[0]),
        slices * sizes[0][1],
        3 * slices * area(sizes[1]),
    ];
    let mut next = HEADER;
    let at = lengths.map(|length| {
        next += length;
        next - length
    });
    (at, next)
}

impl<'a> Data<'a> {
    /// The table in the numbers of a file; `None` if they are none.
    pub(super) fn new(numbers: &'a [f32]) -> Option<Self> {
        let head = numbers.get(..HEADER)?;
        let size = |i: usize| [head[i] as usize, head[i + 1] as usize];
        let (counts, sizes) = (size(0), [size(2), size(4), size(6), size(8)]);
        let (at, length) = offsets(counts, sizes);
        let is_whole = numbers.len() == length && area(counts) > 0;
        (is_whole && sizes.iter().flatten().all(|n| *n > 1)).then_some(Self { numbers, counts, sizes, at })
    }

    /// The lobes for sampling: as wide as the distribution of normals.
    pub(super) fn lobes(&self) -> Lobes {
        let [x, y, albedo] = [self.numbers[12], self.numbers[13], self.numbers[14]];
        Lobes::diffuse_and(Lobe::wide(Vec2::new(x, y)), Vec3::splat(0.2 * albedo), Vec3::splat(0.8 * albedo))
    }

    fn reduction(&self) -> usize {
        self.numbers[10] as usize
    }

    /// The azimuth of a direction in radians as the file has it, by its symmetry; `seen` is that of the viewer.
    fn azimuth(&self, seen: f32, phi: f32) -> f32 {
        match self.reduction() {
            0 => phi - seen,
            1 => phi,
            2 => phi - if seen >= 0.0 { PI } else { 0.0 },
            _ => {
                let up = if seen >= 0.0 { -phi } else { phi };
                // Mirrored where the viewer is on the side of the tangent.
                if seen.abs() <= FRAC_PI_2 { -PI - up } else { up }
            }
        }
    }

    /// The place of an angle among ascending ones.
    fn place(&self, axis: usize, angle: f32) -> f32 {
        let all = &self.numbers[self.at[axis]..][..self.counts[axis]];
        let next = all.partition_point(|known| *known <= angle);
        if next == 0 || all.len() == 1 {
            return 0.0;
        }
        let first = (next - 1).min(all.len() - 2);
        first as f32 + ((angle - all[first]) / (all[first + 1] - all[first])).clamp(0.0, 1.0)
    }

    fn neighbours(&self, phi: f32, theta: f32) -> Neighbours {
        let [(i, a), (j, b)] = [(0, phi), (1, theta)].map(|(axis, angle)| {
            let place = self.place(axis, angle);
            let first = (place as usize).min(self.counts[axis].saturating_sub(2));
            (first, place - first as f32)
        });
        let slice = |di: usize, dj: usize| {
            (i + di).min(self.counts[0] - 1) * self.counts[1] + (j + dj).min(self.counts[1] - 1)
        };
        Neighbours {
            slices: [slice(0, 0), slice(0, 1), slice(1, 0), slice(1, 1)],
            weights: [(1.0 - a) * (1.0 - b), (1.0 - a) * b, a * (1.0 - b), a * b],
        }
    }

    /// A number of an array with one part for each pair of directions, between the neighbours.
    fn mixed(&self, array: usize, size: usize, i: usize, near: &Neighbours) -> f32 {
        let pairs = near.slices.iter().zip(near.weights);
        pairs.map(|(slice, weight)| weight * self.numbers[self.at[array] + slice * size + i]).sum()
    }

    /// The place of a point of the unit square in a grid: column and row, and the fractions beyond them.
    fn cell([columns, rows]: [usize; 2], [u, v]: [f32; 2]) -> ([usize; 2], [f32; 2]) {
        let along = |t: f32, count: usize| {
            let t = t.clamp(0.0, 1.0) * (count - 1) as f32;
            let i = (t as usize).min(count - 2);
            (i, t - i as f32)
        };
        let [(i, x), (j, y)] = [along(u, columns), along(v, rows)];
        ([i, j], [x, y])
    }

    /// Bilinear interpolation in a grid.
    fn bilinear(&self, array: usize, size: [usize; 2], point: [f32; 2]) -> f32 {
        let ([i, j], [x, y]) = Self::cell(size, point);
        let row = |j: usize| {
            let at = self.at[array] + j * size[0] + i;
            (1.0 - x) * self.numbers[at] + x * self.numbers[at + 1]
        };
        (1.0 - y) * row(j) + y * row(j + 1)
    }

    /// The distribution of normals, for a normal in the unit square.
    pub(super) fn distribution(&self, point: [f32; 2]) -> f32 {
        self.bilinear(2, self.sizes[2], point)
    }

    /// The projected area of the facets for a viewer in the unit square.
    pub(super) fn projected(&self, point: [f32; 2]) -> f32 {
        self.bilinear(3, self.sizes[3], point)
    }

    /// The place of a normal in the unit square by the density of visible normals: first its share of the row, then that
    /// of the rows before it.
    fn warped(&self, near: &Neighbours, point: [f32; 2]) -> [f32; 2] {
        let [columns, rows] = self.sizes[0];
        let ([i, j], [x, y]) = Self::cell([columns, rows], point);
        let (size, first) = (columns * rows, j * columns);
        let between = |array: usize, i: usize| {
            let [a, b] = [i, i + columns].map(|i| self.mixed(array, size, i, near));
            (1.0 - y) * a + y * b
        };
        let [left, right] = [between(4, first + i), between(4, first + i + 1)];
        let whole = between(5, first + columns - 1);
        let [low, high] =
            [first + columns - 1, first + 2 * columns - 1].map(|i| self.mixed(5, size, i, near));
        let across = between(5, first + i) + x * (left + 0.5 * x * (right - left));
        let up = self.mixed(6, rows, j, near) + y * (low + 0.5 * y * (high - low));
        [if whole > LEAST { across / whole } else { 0.0 }, up]
    }

    /// The value at a place for one pair of directions.
    fn value(&self, slice: usize, point: [f32; 2]) -> Vec3 {
        let size = self.sizes[1];
        let ([i, j], [x, y]) = Self::cell(size, point);
        let cell = |i: usize, j: usize| {
            let at = self.at[7] + 3 * (slice * area(size) + j * size[0] + i);
            Vec3::new(self.numbers[at], self.numbers[at + 1], self.numbers[at + 2])
        };
        cell(i, j).lerp(cell(i + 1, j), x).lerp(cell(i, j + 1).lerp(cell(i + 1, j + 1), x), y)
    }

    /// f_r N·L in sr⁻¹ for directions above the surface in the local frame.
    pub(super) fn response(&self, l: Vec3, v: Vec3) -> Vec3 {
        let m = l + v;
        let polar = |d: Vec3| d.truncate().length().atan2(d.z);
        let around = |d: Vec3| if d.truncate().length() < 1e-7 { 0.0 } else { d.y.atan2(d.x) };
        let seen = around(v);
        let (phi, theta) = (self.azimuth(seen, seen), polar(v));
        let turn = |phi: f32| {
            let t = phi / (2.0 * PI) + 0.5;
            t - t.floor()
        };
        let point = [(polar(m) / FRAC_PI_2).sqrt(), turn(self.azimuth(seen, around(m)))];
        let near = self.neighbours(phi, theta);
        let place = self.warped(&near, point);
        let mut sum = Vec3::ZERO;
        for (slice, weight) in near.slices.into_iter().zip(near.weights) {
            sum += weight * self.value(slice, place);
        }
        if self.numbers[11] == 0.0 {
            return sum;
        }
        let projected = self.projected([(theta / FRAC_PI_2).sqrt(), turn(phi)]);
        if projected > LEAST { sum * (self.distribution(point) / (4.0 * projected)) } else { Vec3::ZERO }
    }

    /// A quantity of the equation; azimuths are in turns, angles in right angles.
    pub(super) fn quantity(&self, symbol: &str, arguments: &[f32]) -> Option<Vec3> {
        let get = |i: usize| arguments.get(i).copied();
        let turns = 2.0 * PI;
        Some(match symbol {
            "n_φ" => Vec3::splat(self.counts[0] as f32),
            "n_θ" => Vec3::splat(self.counts[1] as f32),
            "j" => Vec3::splat(self.numbers[11]),
            "A" => Vec3::splat(self.azimuth(get(0)? * turns, get(1)? * turns) / turns),
            "P_φ" => Vec3::splat(self.place(0, get(0)? * turns)),
            "P_θ" => Vec3::splat(self.place(1, get(0)? * FRAC_PI_2)),
            "D" => Vec3::splat(self.distribution([get(0)?, get(1)?])),
            "Σ" => Vec3::splat(self.projected([get(0)?, get(1)?])),
            "X" | "Y" => {
                let near = self.neighbours(get(0)? * turns, get(1)? * FRAC_PI_2);
                let place = self.warped(&near, [get(2)?, get(3)?]);
                Vec3::splat(if symbol == "X" { place[0] } else { place[1] })
            }
            "ρ" => {
                let within = |x: f32, count: usize| (x.max(0.0) as usize).min(count - 1);
                let slice =
                    within(get(0)?, self.counts[0]) * self.counts[1] + within(get(1)?, self.counts[1]);
                self.value(slice, [get(2)?, get(3)?])
            }
            _ => return None,
        })
    }

    /// The point of the unit square that is warped to a place, for one pair of directions: by bisection.
    pub(super) fn point(&self, slice: usize, place: [f32; 2]) -> [f32; 2] {
        let near = Neighbours { slices: [slice; 4], weights: [1.0, 0.0, 0.0, 0.0] };
        let mut point = [0.5, 0.5];
        for axis in [1, 0] {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..24 {
                point[axis] = 0.5 * (low + high);
                if self.warped(&near, point)[axis] < place[axis] {
                    low = point[axis];
                } else {
                    high = point[axis];
                }
            }
        }
        point
    }
}

/// The integrals of a density on a grid, each normalised to 1: the density, that along each row, and that of the rows.
fn integrals(density: &[f32], [columns, _]: [usize; 2]) -> [Vec<f32>; 3] {
    let mut along = Vec::with_capacity(density.len());
    let (mut rows, mut whole, mut before) = (Vec::new(), 0.0f64, None);
    for row in density.chunks_exact(columns) {
        let mut sum = 0.0f64;
        along.push(0.0);
        for pair in row.windows(2) {
            sum += 0.5 * (f64::from(pair[0]) + f64::from(pair[1]));
            along.push(sum);
        }
        whole += before.map_or(0.0, |before: f64| 0.5 * (before + sum));
        rows.push(whole);
        before = Some(sum);
    }
    let scale = if whole > 0.0 { 1.0 / whole } else { 0.0 };
    let scaled = |all: Vec<f64>| all.into_iter().map(|x| (x * scale) as f32).collect();
    [density.iter().map(|x| (f64::from(*x) * scale) as f32).collect(), scaled(along), scaled(rows)]
}

/// The numbers of a table.
pub(super) fn numbers(arrays: &Arrays) -> Vec<f32> {
    let Arrays { phi, theta, sizes, reduction, jacobian, ndf, sigma, vndf, values } = arrays;
    let counts = [phi.len(), theta.len()];
    let (_, length) = offsets(counts, *sizes);
    let mut numbers = Vec::with_capacity(length);
    let head = counts.iter().chain(sizes.as_flattened()).chain([reduction]);
    numbers.extend(head.map(|count| *count as f32));
    numbers.extend([if *jacobian { 1.0 } else { 0.0 }]);
    numbers.resize(HEADER, 0.0);
    for array in [phi, theta, ndf, sigma] {
        numbers.extend(array);
    }
    let parts: Vec<_> =
        vndf.chunks_exact(area(sizes[0]).max(1)).map(|density| integrals(density, sizes[0])).collect();
    for k in 0..3 {
        parts.iter().for_each(|part| numbers.extend(&part[k]));
    }
    numbers.extend(values.iter().flat_map(|value| value.to_array()));
    if let Some(data) = Data::new(&numbers) {
        let lobe = fitted(&data, values);
        numbers[12..15].copy_from_slice(&lobe);
    }
    numbers
}

/// The widths of a GGX lobe along tangent and bitangent, read off the distribution of normals at half its height, and the albedo
/// for the steepest viewer, the mean of its values.
fn fitted(data: &Data<'_>, values: &[Vec3]) -> [f32; 3] {
    /// tan θ/α where GGX's distribution has half its height, √(√2 − 1).
    const HALF: f32 = 0.643_594_3;
    const STEPS: usize = 256;
    let width = |v: f32| {
        let at = |i: usize| data.distribution([i as f32 / STEPS as f32, v]);
        let top = (0..STEPS / 2).map(at).fold(0.0, f32::max);
        let below = (0..STEPS).skip_while(|i| at(*i) < 0.5 * top).find(|i| at(*i) < 0.5 * top);
        let theta = FRAC_PI_2 * (below.unwrap_or(STEPS) as f32 / STEPS as f32).powi(2);
        (theta.min(1.5).tan() / HALF).clamp(1e-3, 1.0)
    };
    let [x, y] = if data.reduction() == 0 { [width(0.5); 2] } else { [width(0.5), width(0.75)] };
    let first = &values[..area(data.sizes[1]).min(values.len())];
    let mean = first.iter().map(|value| luminance(*value)).sum::<f32>() / first.len().max(1) as f32;
    let albedo = if data.numbers[11] == 0.0 { 0.5 } else { mean };
    [x, y, albedo.clamp(0.01, 1.0)]
}
