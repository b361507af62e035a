//! SSIM: the similarity of structures. Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli (2004), *Image Quality
//! Assessment: From Error Visibility to Structural Similarity*, IEEE Transactions on Image Processing 13(4).
//!
//! SSIM of luma in a window of 11 × 11 pixels around each pixel, weighted by a Gaussian of 1.5 pixels: (2 μ_A
//! μ_B + C₁)(2 σ_AB + C₂) / ((μ_A² + μ_B² + C₁)(σ_A² + σ_B² + C₂)), C₁ = 0.01², C₂ = 0.03².

use std::sync::LazyLock;

use super::filter::{Padded, Plane, REACH, Rows, SIDE, Tile, Weights, across, down, normalised};

/// The radius of the window, pixels.
const RADIUS: usize = 5;
/// The standard deviation of the window's weights, pixels.
const DEVIATION: f64 = 1.5;
/// The constant that keeps the quotient of means finite.
const C1: f32 = 0.01 * 0.01;
/// The constant that keeps the quotient of deviations finite.
const C2: f32 = 0.03 * 0.03;
/// The constant subtracted from luma before squaring, so that the squares are small; variances do not change.
pub(super) const CENTRE: f32 = 0.5;

static WINDOW: LazyLock<Weights<{ RADIUS + 1 }>> =
    LazyLock::new(|| normalised(|x| (-x * x / (2.0 * DEVIATION * DEVIATION)).exp()));

/// The memory of the calculation of a tile.
#[derive(Default)]
pub(super) struct Scratch {
    squares: Plane<Padded>,
    products: Plane<Padded>,
    rows: Plane<Rows>,
    means: [Plane<Tile>; 2],
    square: Plane<Tile>,
    product: Plane<Tile>,
}

/// SSIM at the pixels of a tile, from the luma of both pictures minus [`CENTRE`].
#[inline(always)]
pub(super) fn tile([a, b]: &[Plane<Padded>; 2], scratch: &mut Scratch, out: &mut Tile) {
    let window = &*WINDOW;
    let Scratch { squares, products, rows, means, square, product } = scratch;
    for y in REACH - RADIUS..SIDE - REACH + RADIUS {
        for x in 0..SIDE {
            squares[y][x] = a[y][x] * a[y][x] + b[y][x] * b[y][x];
            products[y][x] = a[y][x] * b[y][x];
        }
    }
    let [mean_a, mean_b] = means;
    for (from, to) in
        [(a, &mut *mean_a), (b, &mut *mean_b), (&*squares, &mut *square), (&*products, &mut *product)]
    {
        across(from, [window], [], [&mut *rows], []);
        down(rows, [window], [], [to], []);
    }
    for (y, row) in out.iter_mut().enumerate() {
        for (x, out) in row.iter_mut().enumerate() {
            let (a, b) = (mean_a[y][x], mean_b[y][x]);
            let variances = square[y][x] - (a * a + b * b);
            let covariance = product[y][x] - a * b;
            let (a, b) = (a + CENTRE, b + CENTRE);
            let means = (2.0 * (a * b) + C1) / (a * a + b * b + C1);
            *out = means * ((2.0 * covariance + C2) / (variances + C2));
        }
    }
}
