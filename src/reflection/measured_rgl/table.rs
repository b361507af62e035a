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

use arrayvec::ArrayVec;
use glam::{Vec2, Vec3};

use super::slice::{Grid, Slice, bilinear, value, warped};
use crate::optics::{
    colour::luminance,
    lobes::{Lobe, Lobes},
};

/// The numbers before the azimuths.
const HEADER: usize = 16;

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
    pub(super) numbers: &'a [f32],
    counts: [usize; 2],
    sizes: [[usize; 2]; 4],
    /// The first numbers of azimuths, angles, distribution, area, density, both integrals and values.
    pub(super) at: [usize; 8],
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
        let size = |i: usize| [head[i] as u32 as usize, head[i + 1] as u32 as usize];
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

    /// True if values are relative to the density.
    pub(super) fn is_relative(&self) -> bool {
        self.numbers[11] != 0.0
    }

    /// What makes an azimuth one as the file has it, by its symmetry: a factor, and what is added. `seen` is that of the
    /// viewer.
    pub(super) fn azimuths(&self, seen: f32) -> [f32; 2] {
        match self.reduction() {
            0 => [1.0, -seen],
            1 => [1.0, 0.0],
            2 => [1.0, if seen >= 0.0 { -PI } else { 0.0 }],
            _ => {
                let up = if seen >= 0.0 { -1.0 } else { 1.0 };
                // Mirrored where the viewer is on the side of the tangent.
                if seen.abs() <= FRAC_PI_2 { [-up, -PI] } else { [up, 0.0] }
            }
        }
    }

    /// The azimuth (0) or angle (1) of the file before one in radians, and the fraction of the way to the next.
    #[inline]
    fn place(&self, axis: usize, angle: f32) -> (usize, f32) {
        let all = &self.numbers[self.at[axis]..][..self.counts[axis]];
        if all.len() == 1 {
            return (0, 0.0);
        }
        let first = all.partition_point(|known| *known <= angle).clamp(1, all.len() - 1) - 1;
        (first, ((angle - all[first]) / (all[first + 1] - all[first])).clamp(0.0, 1.0))
    }

    /// The arrays for one of the directions of the viewer.
    #[inline]
    fn slice(&self, i: usize, weight: f32) -> Slice {
        let [density, values] = [area(self.sizes[0]), 3 * area(self.sizes[1])];
        let [_, _, _, _, first, along, rows, colours] = self.at;
        Slice {
            weight,
            density: first + i * density,
            along: along + i * density,
            rows: rows + i * self.sizes[0][1],
            values: colours + i * values,
        }
    }

    /// The arrays around a direction: for two angles at each of two azimuths, or at the only one.
    #[inline]
    pub(super) fn near(&self, phi: f32, theta: f32) -> ArrayVec<Slice, 4> {
        let [azimuths, angles] = self.counts;
        let [(i, x), (j, y)] = [self.place(0, phi), self.place(1, theta)];
        let next = (j + 1).min(angles - 1);
        let slice = |i: usize, j: usize, weight: f32| self.slice(i * angles + j, weight);
        let mut near =
            ArrayVec::from_iter([slice(i, j, (1.0 - x) * (1.0 - y)), slice(i, next, (1.0 - x) * y)]);
        if azimuths > 1 {
            near.extend([slice(i + 1, j, x * (1.0 - y)), slice(i + 1, next, x * y)]);
        }
        near
    }

    /// One of the grids: of the density, the values, the distribution or the area.
    pub(super) fn grid(&self, i: usize) -> Grid {
        Grid::new(self.sizes[i])
    }

    /// The distribution of normals, for a normal in the unit square.
    pub(super) fn distribution(&self, point: [f32; 2]) -> f32 {
        bilinear(self.numbers, self.at[2], &self.grid(2).cell(point))
    }

    /// The projected area of the facets for a viewer in the unit square.
    pub(super) fn projected(&self, point: [f32; 2]) -> f32 {
        bilinear(self.numbers, self.at[3], &self.grid(3).cell(point))
    }

    /// A quantity of the equation; azimuths are in turns, angles in right angles.
    pub(super) fn quantity(&self, symbol: &str, arguments: &[f32]) -> Option<Vec3> {
        let get = |i: usize| arguments.get(i).copied();
        let turns = 2.0 * PI;
        Some(match symbol {
            "n_φ" => Vec3::splat(self.counts[0] as f32),
            "n_θ" => Vec3::splat(self.counts[1] as f32),
            "j" => Vec3::splat(self.numbers[11]),
            "A" => {
                let [factor, shift] = self.azimuths(get(0)? * turns);
                Vec3::splat((factor * get(1)? * turns + shift) / turns)
            }
            "P_φ" | "P_θ" => {
                let (axis, unit) = if symbol == "P_φ" { (0, turns) } else { (1, FRAC_PI_2) };
                let (first, part) = self.place(axis, get(0)? * unit);
                Vec3::splat(first as f32 + part)
            }
            "D" => Vec3::splat(self.distribution([get(0)?, get(1)?])),
            "Σ" => Vec3::splat(self.projected([get(0)?, get(1)?])),
            "X" | "Y" => {
                let near = self.near(get(0)? * turns, get(1)? * FRAC_PI_2);
                let place = warped(self.numbers, &near, &self.grid(0).cell([get(2)?, get(3)?]));
                Vec3::splat(if symbol == "X" { place[0] } else { place[1] })
            }
            "ρ" => {
                let within = |x: f32, count: usize| (x.max(0.0) as usize).min(count - 1);
                let slice =
                    within(get(0)?, self.counts[0]) * self.counts[1] + within(get(1)?, self.counts[1]);
                value(self.numbers, &[self.slice(slice, 1.0)], &self.grid(1).cell([get(2)?, get(3)?]))
            }
            _ => return None,
        })
    }

    /// The point of the unit square that is warped to a place, for one pair of directions: by bisection.
    pub(super) fn point(&self, slice: usize, place: [f32; 2]) -> [f32; 2] {
        let near = [self.slice(slice, 1.0)];
        let mut point = [0.5, 0.5];
        for axis in [1, 0] {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..24 {
                point[axis] = 0.5 * (low + high);
                if warped(self.numbers, &near, &self.grid(0).cell(point))[axis] < place[axis] {
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
