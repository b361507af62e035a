//! Reads the grids of a table: here most of the time of a picture is spent.

use glam::{Vec3, Vec4, Vec4Swizzles as _};

/// Minimum density and area, below which a value is 0.
pub(super) const LEAST: f32 = 1e-12;

/// The first numbers of the arrays for one direction of the viewer, and the weight of that direction among others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slice {
    pub(super) weight: f32,
    pub(super) density: usize,
    /// The integral of the density along each row.
    pub(super) along: usize,
    /// The integral of the rows.
    pub(super) rows: usize,
    pub(super) values: usize,
}

/// The columns of a grid over the unit square, and the last column and row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    columns: usize,
    last: [f32; 2],
}

/// The places of four points in a grid.
pub(super) struct Cells {
    /// Columns and rows, and the fractions beyond them.
    along: [([f32; 4], [f32; 4]); 2],
    columns: usize,
}

/// A place in a grid: its column and row, the fractions beyond them, and the number of columns.
pub(super) struct Cell {
    at: [usize; 2],
    beyond: [f32; 2],
    columns: usize,
}

/// From here to twice as much, floats are whole numbers, whose last bits are those of the integer.
const WHOLE: f32 = 8_388_608.0;

impl Grid {
    pub(super) fn new(size: [usize; 2]) -> Self {
        Self { columns: size[0], last: size.map(|count| (count - 1) as i32 as f32) }
    }

    /// The place of a point.
    #[inline]
    pub(super) fn cell(&self, [u, v]: [f32; 2]) -> Cell {
        self.cells([Vec4::splat(u), Vec4::splat(v)]).cell(0)
    }

    /// The places of four points at once.
    #[inline(always)]
    pub(super) fn cells(&self, [u, v]: [Vec4; 2]) -> Cells {
        let along = |t: Vec4, last: f32| {
            // NaN becomes 0.
            let t = Vec4::select(t.cmpgt(Vec4::ZERO), t.min(Vec4::ONE), Vec4::ZERO) * last;
            let nearest = (t + WHOLE) - WHOLE;
            let below = nearest - Vec4::select(nearest.cmpgt(t), Vec4::ONE, Vec4::ZERO);
            let first = below.min(Vec4::splat(last - 1.0));
            ((first + WHOLE).to_array(), (t - first).to_array())
        };
        Cells { along: [along(u, self.last[0]), along(v, self.last[1])], columns: self.columns }
    }
}

impl Cells {
    #[inline(always)]
    pub(super) fn cell(&self, k: usize) -> Cell {
        let [(i, x), (j, y)] = &self.along;
        let index = |x: f32| (x.to_bits() & 0x7f_ffff) as usize;
        Cell { at: [index(i[k]), index(j[k])], beyond: [x[k], y[k]], columns: self.columns }
    }
}

/// Bilinear interpolation in a grid.
#[inline(always)]
pub(super) fn bilinear(numbers: &[f32], first: usize, cell: &Cell) -> f32 {
    let Cell { at: [i, j], beyond: [x, y], columns } = *cell;
    let all = &numbers[first + j * columns + i..][..columns + 2];
    let row = |at: usize| (1.0 - x) * all[at] + x * all[at + 1];
    (1.0 - y) * row(0) + y * row(columns)
}

/// The place of a normal in the unit square by the density of visible normals: first its share of the row, then that
/// of the rows before it. All numbers of a direction are added at once, which is faster.
#[inline(always)]
pub(super) fn warped(numbers: &[f32], near: &[Slice], cell: &Cell) -> [f32; 2] {
    let Cell { at: [i, j], beyond: [x, y], columns } = *cell;
    let (row, last) = (j * columns, columns - 1);
    let (mut density, mut sums, mut below) = (Vec4::ZERO, Vec4::ZERO, 0.0);
    for slice in near {
        let all = &numbers[slice.density + row + i..][..columns + 2];
        density += slice.weight * Vec4::new(all[0], all[1], all[columns], all[columns + 1]);
        let all = &numbers[slice.along + row..][..2 * columns];
        sums += slice.weight * Vec4::new(all[i], all[last], all[columns + i], all[columns + last]);
        below += slice.weight * numbers[slice.rows + j];
    }
    let between = |a: f32, b: f32| (1.0 - y) * a + y * b;
    let [left, right] = [between(density.x, density.z), between(density.y, density.w)];
    let (low, high) = (sums.y, sums.w);
    let whole = between(low, high);
    let across = between(sums.x, sums.z) + x * (left + 0.5 * x * (right - left));
    let up = below + y * (low + 0.5 * y * (high - low));
    [if whole > LEAST { across / whole } else { 0.0 }, up]
}

/// The value at a place between directions.
#[inline(always)]
pub(super) fn value(numbers: &[f32], near: &[Slice], cell: &Cell) -> Vec3 {
    let Cell { at: [i, j], beyond: [x, y], columns } = *cell;
    let at = 3 * (j * columns + i);
    let mut sum = Vec4::ZERO;
    for slice in near {
        // Of six numbers the first three and the last three, four at a time.
        let row = |at: usize| {
            let all = &numbers[slice.values + at..][..6];
            let next = Vec4::new(all[2], all[3], all[4], all[5]);
            Vec4::new(all[0], all[1], all[2], all[3]).lerp(next.yzww(), x)
        };
        sum += slice.weight * row(at).lerp(row(at + 3 * columns), y);
    }
    sum.truncate()
}
