//! SSIM: the similarity of structures. Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli (2004), *Image Quality
//! Assessment: From Error Visibility to Structural Similarity*, IEEE Transactions on Image Processing 13(4).
//!
//! SSIM of luma in a window of 11 × 11 pixels around each pixel, weighted by a Gaussian of 1.5 pixels: (2 μ_A
//! μ_B + C₁)(2 σ_AB + C₂) / ((μ_A² + μ_B² + C₁)(σ_A² + σ_B² + C₂)), C₁ = 0.01², C₂ = 0.03².
//!
//! The code is our own, since the crate image-compare takes SSIM over blocks of 8 × 8 pixels instead of this window.

use std::sync::LazyLock;

use fearless_simd::dispatch;

use super::{
    InWindow, Metric, Pixels, Place, Way,
    filter::{LEVEL, Padded, Plane, REACH, Rows, SIDE, Tile, Weights, across, down, normalised},
};
use crate::optics::colour::LUMINANCE;

pub(super) static METRIC: Metric = Metric {
    id: "ssim",
    of_likeness: true,
    way: Way::Pixels(&PIXELS, |sum, pixels| sum / pixels),
    shown: Some(InWindow {
        place: 2,
        name: "SSIM",
        // What is not equal is not 1.
        text: |number| match format!("{number:.3}") {
            text if number < 1.0 && text == "1.000" => "> 0.999".to_owned(),
            text => text,
        },
        help: |_, everywhere| {
            format!(
                "Structural similarity (Wang et al. 2004): 1 for equal pictures, over the pixels that objects cover; \
                 over all pixels {everywhere:.3}."
            )
        },
    }),
    row: Some(["structural similarity", "−1 to 1", "1"]),
};

static PIXELS: Pixels = Pixels {
    where_equal: Some(1.0),
    measure: || {
        let mut scratch = Scratch::default();
        Box::new(move |place, out| dispatch!(*LEVEL, _simd => tile(place, &mut scratch, out)))
    },
};

/// The radius of the window, pixels.
const RADIUS: usize = 5;
/// The standard deviation of the window's weights, pixels.
const DEVIATION: f64 = 1.5;
/// The constant that keeps the quotient of means finite.
const C1: f32 = 0.01 * 0.01;
/// The constant that keeps the quotient of deviations finite.
const C2: f32 = 0.03 * 0.03;
/// The constant subtracted from luma before squaring, so that the squares are small; variances do not change.
const CENTRE: f32 = 0.5;

static WINDOW: LazyLock<Weights<{ RADIUS + 1 }>> =
    LazyLock::new(|| normalised(|x| (-x * x / (2.0 * DEVIATION * DEVIATION)).exp()));

/// The memory of the calculation of a tile.
#[derive(Default)]
struct Scratch {
    luma: [Plane<Padded>; 2],
    squares: Plane<Padded>,
    products: Plane<Padded>,
    rows: Plane<Rows>,
    means: [Plane<Tile>; 2],
    square: Plane<Tile>,
    product: Plane<Tile>,
}

/// SSIM at the pixels of a tile.
#[inline(always)]
fn tile(place: &Place<'_>, scratch: &mut Scratch, out: &mut Tile) {
    let window = &*WINDOW;
    let Scratch { luma, squares, products, rows, means, square, product } = scratch;
    for (picture, luma) in luma.iter_mut().enumerate() {
        for y in 0..SIDE {
            for (luma, codes) in luma[y].iter_mut().zip(place.padded(picture, y)) {
                let (r, g, b) = (f32::from(codes[0]), f32::from(codes[1]), f32::from(codes[2]));
                *luma = (LUMINANCE.x * r + LUMINANCE.y * g + LUMINANCE.z * b) / 255.0 - CENTRE;
            }
        }
    }
    let [a, b] = &*luma;
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
