//! Filters over a tile of a picture, first across and then down. Everything is inlined into its caller, so that it is
//! compiled for the caller's instructions; closures of the standard library would not be.

use std::{
    array::from_fn,
    ops::{Deref, DerefMut},
    sync::LazyLock,
};

use fearless_simd::Level;

/// The instruction set of this machine.
pub(super) static LEVEL: LazyLock<Level> = LazyLock::new(Level::new);
/// The side of a tile, pixels.
pub const TILE: usize = 64;
/// The number of pixels beside a tile that its filters need: the radius of the widest one.
pub(super) const REACH: usize = 10;
/// The side of a tile with its surroundings.
pub(super) const SIDE: usize = TILE + 2 * REACH;
/// The number of pixels filtered at a time: their sums stay in registers.
const LANES: usize = 16;

/// A tile with its surroundings.
pub(super) type Padded = [[f32; SIDE]; SIDE];
/// A tile filtered across, with the rows above and below it.
pub(super) type Rows = [[f32; TILE]; SIDE];
/// The numbers of the pixels of a tile.
pub type Tile = [[f32; TILE]; TILE];

/// Numbers on the heap: together they are too many for the stack of a thread.
pub(super) struct Plane<T>(Box<T>);

impl<const W: usize, const H: usize> Default for Plane<[[f32; W]; H]> {
    fn default() -> Self {
        Self(Box::new([[0.0; W]; H]))
    }
}

impl<T> Deref for Plane<T> {
    type Target = T;

    #[inline(always)]
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> DerefMut for Plane<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}

/// The weights of a filter: that of the centre, and those of the pixels at distances 1, 2, … On the other
/// side, they are equal for even filters, and negated for odd ones.
pub(super) type Weights<const N: usize> = [f32; N];

/// Weights by distance from the centre, divided by the sum over both sides.
pub(super) fn normalised<const N: usize>(weight: impl Fn(f64) -> f64) -> Weights<N> {
    let sum: f64 = (0..N).map(|i| weight(i as f64) * if i == 0 { 1.0 } else { 2.0 }).sum();
    from_fn(|i| (weight(i as f64) / sum) as f32)
}

#[inline(always)]
fn lanes(row: &[f32], at: usize) -> &[f32; LANES] {
    row[at..].first_chunk().unwrap_or(&[0.0; LANES])
}

/// Filters across with even and odd filters of a radius of `N` − 1 pixels, including the rows above and below
/// the tile that filters of this radius need.
#[inline(always)]
pub(super) fn across<const N: usize, const E: usize, const O: usize>(
    from: &Padded,
    even: [&Weights<N>; E],
    odd: [&Weights<N>; O],
    to_even: [&mut Rows; E],
    to_odd: [&mut Rows; O],
) {
    for y in REACH + 1 - N..SIDE - REACH + N - 1 {
        let row = &from[y];
        for at in (0..TILE).step_by(LANES) {
            let pixels = |t: usize| [lanes(row, at + REACH - t), lanes(row, at + REACH + t)];
            let (sums, differences) = filtered(even, odd, pixels);
            for k in 0..E {
                to_even[k][y][at..at + LANES].copy_from_slice(&sums[k]);
            }
            for k in 0..O {
                to_odd[k][y][at..at + LANES].copy_from_slice(&differences[k]);
            }
        }
    }
}

/// Filters down with even and odd filters.
#[inline(always)]
pub(super) fn down<const N: usize, const E: usize, const O: usize>(
    from: &Rows,
    even: [&Weights<N>; E],
    odd: [&Weights<N>; O],
    to_even: [&mut Tile; E],
    to_odd: [&mut Tile; O],
) {
    for y in 0..TILE {
        for at in (0..TILE).step_by(LANES) {
            let pixels = |t: usize| [lanes(&from[y + REACH - t], at), lanes(&from[y + REACH + t], at)];
            let (sums, differences) = filtered(even, odd, pixels);
            for k in 0..E {
                to_even[k][y][at..at + LANES].copy_from_slice(&sums[k]);
            }
            for k in 0..O {
                to_odd[k][y][at..at + LANES].copy_from_slice(&differences[k]);
            }
        }
    }
}

/// Filters some pixels; `pixels` returns those at a distance on both sides.
#[inline(always)]
fn filtered<'a, const N: usize, const E: usize, const O: usize>(
    even: [&Weights<N>; E],
    odd: [&Weights<N>; O],
    pixels: impl Fn(usize) -> [&'a [f32; LANES]; 2],
) -> ([[f32; LANES]; E], [[f32; LANES]; O]) {
    let (mut sums, mut differences) = ([[0.0; LANES]; E], [[0.0; LANES]; O]);
    let [centre, _] = pixels(0);
    for k in 0..E {
        for i in 0..LANES {
            sums[k][i] = even[k][0] * centre[i];
        }
    }
    for t in 1..N {
        let [before, after] = pixels(t);
        for k in 0..E {
            for i in 0..LANES {
                sums[k][i] += even[k][t] * (after[i] + before[i]);
            }
        }
        for k in 0..O {
            for i in 0..LANES {
                differences[k][i] += odd[k][t] * (after[i] - before[i]);
            }
        }
    }
    (sums, differences)
}
