//! ꟻLIP: how different two pictures look to someone who flips between them. P. Andersson, J. Nilsson,
//! T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild (2020), *ꟻLIP: A Difference Evaluator for Alternating
//! Images*, Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), with the separable filters
//! of its later implementations. The code is our own, since the crate nv-flip builds C++.
//!
//! Two differences of each pixel are joined. The difference of colour: both pictures are blurred as the eye does from
//! this distance (contrast sensitivity of an achromatic, a red–green and a blue–yellow channel), and compared in
//! CIELAB, whose chroma grows with lightness (Hunt), by the distance HyAB. The difference of features: edges and
//! points, the first and second derivatives of lightness. ꟻLIP is c^(1 − f), from 0 to 1.

use std::sync::LazyLock;

use fearless_simd::dispatch;

use super::{
    InWindow, Metric, Pixels, Place, Way,
    filter::{LEVEL, Padded, Plane, Rows, SIDE, TILE, Tile, Weights, across, down, normalised},
    in_thousandths,
    power::{cube_root, power},
};
use crate::optics::colour::Encoding;

pub(super) static METRIC: Metric = Metric {
    id: "flip",
    of_likeness: false,
    way: Way::Pixels(&PIXELS, |sum, pixels| sum / pixels),
    shown: Some(InWindow {
        place: 1,
        name: "FLIP",
        text: in_thousandths,
        help: |_, everywhere| {
            format!(
                "Mean FLIP (Andersson et al. 2020): the difference that people see when they flip between the \
                 pictures, 0 for none to 1, over the pixels that objects cover; over all pixels {everywhere:.3}."
            )
        },
    }),
    row: Some(["ꟻLIP", "0 to 1", "0"]),
};

static PIXELS: Pixels = Pixels {
    where_equal: Some(0.0),
    measure: || {
        let mut scratch = Scratch::default();
        Box::new(move |place, out| dispatch!(*LEVEL, _simd => tile(place, &mut scratch, out)))
    },
};

/// Linear light of each display code.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| Encoding::Srgb.decode([code as u8; 3]).x));

/// Pixels per degree of the field of view: a screen of 3840 pixels on 0.7 m, seen from 0.7 m, as the authors assume.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;

/// The exponent q_c of colour differences.
const COLOUR_EXPONENT: f32 = 0.7;
/// The difference p_c, as a fraction of the largest one, that is mapped to p_t.
const BEND: f32 = 0.4;
/// The value p_t to which it is mapped: larger differences add little.
const BEND_VALUE: f32 = 0.95;
/// The width w of edges and points, degrees.
const FEATURE_WIDTH: f64 = 0.082;

/// The radius of the blur of the achromatic and the red–green channel, pixels; weights beyond it are below 1e-6.
const NARROW: usize = 6;
/// The radius of the blur of the blue–yellow channel, pixels.
const WIDE: usize = 10;
/// The radius of the filters for features: three standard deviations, rounded up.
const FEATURE: usize = 9;

/// Linear Rec. 709 to X, Y and Z, each divided by that of white.
const TO_XYZ: [[f32; 3]; 3] = [
    [0.433_895_4, 0.376_242_37, 0.189_862_24],
    [0.212_636_82, 0.715_183, 0.072_180_2],
    [0.017_752_424, 0.109_465_63, 0.872_781_93],
];

/// The weights of all filters.
struct Kernels {
    achromatic: Weights<{ NARROW + 1 }>,
    red_green: Weights<{ NARROW + 1 }>,
    /// The blur of the blue–yellow channel is the sum of two.
    blue_yellow: [Weights<{ WIDE + 1 }>; 2],
    smooth: Weights<{ FEATURE + 1 }>,
    edge: Weights<{ FEATURE + 1 }>,
    point: Weights<{ FEATURE + 1 }>,
    from_xyz: [[f32; 3]; 3],
    /// The largest colour difference, that between green and blue, to the power of q_c.
    largest: f32,
}

static KERNELS: LazyLock<Kernels> = LazyLock::new(Kernels::new);

impl Kernels {
    fn new() -> Self {
        use std::f64::consts::PI;
        // The contrast sensitivity a √(π/b) exp(−π² x² / b), x in degrees.
        let sensitivity = |a: f64, b: f64| {
            move |pixels: f64| {
                let x = pixels / PIXELS_PER_DEGREE;
                a * (PI / b).sqrt() * (-PI * PI * x * x / b).exp()
            }
        };
        // In two dimensions each part is the product of its square roots across and down.
        let part = |a: f64, b: f64| {
            move |pixels: f64| {
                let x = pixels / PIXELS_PER_DEGREE;
                (a * (PI / b).sqrt()).sqrt() * (-PI * PI * x * x / b).exp()
            }
        };
        let (first, second) = (part(34.1, 0.04), part(13.5, 0.025));
        let sum = |weight: &dyn Fn(f64) -> f64| {
            weight(0.0) + 2.0 * (1..=WIDE).map(|i| weight(i as f64)).sum::<f64>()
        };
        let whole = sum(&first).hypot(sum(&second));
        let deviation = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
        let gauss = |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
        let slopes: f64 = (1..=FEATURE).map(|i| i as f64 * gauss(i as f64)).sum();
        let curve = |x: f64| (x * x / (deviation * deviation) - 1.0) * gauss(x);
        // The weights of one sign add up to 1.
        let curves = |sign: f64| {
            let both = |i: usize| if i == 0 { 1.0 } else { 2.0 };
            (0..=FEATURE).map(|i| both(i) * (sign * curve(i as f64)).max(0.0)).sum::<f64>()
        };
        let (up, low) = (curves(1.0), curves(-1.0));
        Self {
            achromatic: normalised(sensitivity(1.0, 0.0047)),
            red_green: normalised(sensitivity(1.0, 0.0053)),
            blue_yellow: [
                std::array::from_fn(|i| (first(i as f64) / whole) as f32),
                std::array::from_fn(|i| (second(i as f64) / whole) as f32),
            ],
            smooth: normalised(gauss),
            edge: std::array::from_fn(|i| (i as f64 * gauss(i as f64) / slopes) as f32),
            point: std::array::from_fn(|i| {
                let weight = curve(i as f64);
                (weight / if weight > 0.0 { up } else { low }) as f32
            }),
            from_xyz: inverse(TO_XYZ),
            largest: {
                let lab = |rgb| opposed(times(&TO_XYZ, rgb).map(f));
                let distance = hyab(lab([0.0, 1.0, 0.0]), lab([0.0, 0.0, 1.0]));
                distance.powf(COLOUR_EXPONENT)
            },
        }
    }
}

/// The inverse of a matrix.
fn inverse(m: [[f32; 3]; 3]) -> [[f32; 3]; 3] {
    let m = m.map(|row| row.map(f64::from));
    let minor = |r: usize, c: usize| {
        let at = |i: usize, j: usize| m[(r + i) % 3][(c + j) % 3];
        at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * minor(0, c)).sum();
    std::array::from_fn(|r| std::array::from_fn(|c| (minor(c, r) / determinant) as f32))
}

#[inline(always)]
fn times(m: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    [
        m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
        m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
        m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2],
    ]
}

/// The opponent channels of linear light: Y, X − Y and Y − Z, each relative to white.
#[inline(always)]
fn opponent(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = times(&TO_XYZ, rgb);
    [y, x - y, y - z]
}

/// The function of CIELAB.
#[inline(always)]
fn f(t: f32) -> f32 {
    const DELTA: f32 = 6.0 / 29.0;
    let root = cube_root(t);
    let line = t / (3.0 * DELTA * DELTA) + 4.0 / 29.0;
    if t > DELTA * DELTA * DELTA { root } else { line }
}

/// CIELAB from the function of X, Y and Z, with chroma scaled by lightness (Hunt effect).
#[inline(always)]
fn opposed([x, y, z]: [f32; 3]) -> [f32; 3] {
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// The colour distance: the sum of the distances in lightness and chroma.
#[inline(always)]
fn hyab(a: [f32; 3], b: [f32; 3]) -> f32 {
    let (da, db) = (a[1] - b[1], a[2] - b[2]);
    (a[0] - b[0]).abs() + (da * da + db * db).sqrt()
}

/// The memory of the calculation of a tile.
#[derive(Default)]
struct Scratch {
    opponents: [Plane<Padded>; 3],
    rows: [Plane<Rows>; 3],
    parts: [Plane<Tile>; 2],
    seen: [Seen; 2],
}

/// A picture as perceived.
#[derive(Default)]
struct Seen {
    /// The opponent channels, blurred.
    channels: [Plane<Tile>; 3],
    edges: Plane<Tile>,
    points: Plane<Tile>,
}

/// Reads the opponent channels of a picture.
#[inline(always)]
fn read(place: &Place<'_>, picture: usize, opponents: &mut [Plane<Padded>; 3]) {
    let linear = &*LINEAR;
    let [first, second, third] = opponents;
    let rows = first.iter_mut().zip(second.iter_mut()).zip(third.iter_mut());
    for (y, ((first, second), third)) in rows.enumerate() {
        let mut light = [[0.0; SIDE]; 3];
        for (x, codes) in place.padded(picture, y).iter().enumerate() {
            for c in 0..3 {
                light[c][x] = linear[usize::from(codes[c])];
            }
        }
        for x in 0..SIDE {
            [first[x], second[x], third[x]] = opponent([light[0][x], light[1][x], light[2][x]]);
        }
    }
}

/// ꟻLIP of the pixels of a tile.
#[inline(always)]
fn tile(place: &Place<'_>, scratch: &mut Scratch, out: &mut Tile) {
    let kernels = &*KERNELS;
    let Scratch { opponents, rows: [first, second, third], parts: [part, other], seen } = scratch;
    for (picture, seen) in seen.iter_mut().enumerate() {
        read(place, picture, opponents);
        let planes = &*opponents;
        let [luminance, red_green, blue_yellow] = &mut seen.channels;
        across(&planes[0], [&kernels.achromatic], [], [first], []);
        down(first, [&kernels.achromatic], [], [luminance], []);
        across(&planes[1], [&kernels.red_green], [], [first], []);
        down(first, [&kernels.red_green], [], [red_green], []);
        let [wide, narrow] = &kernels.blue_yellow;
        across(&planes[2], [wide, narrow], [], [first, second], []);
        down(first, [wide], [], [blue_yellow], []);
        down(second, [narrow], [], [part], []);
        for (sum, part) in blue_yellow.iter_mut().zip(part.iter()) {
            for (sum, part) in sum.iter_mut().zip(part) {
                *sum += part;
            }
        }

        let Kernels { smooth, edge, point, .. } = kernels;
        across(&planes[0], [smooth, point], [edge], [first, second], [third]);
        down(third, [smooth], [], [&mut seen.edges], []);
        down(second, [smooth], [], [&mut seen.points], []);
        down(first, [point], [edge], [other], [part]);
        lengths(&mut seen.edges, part);
        lengths(&mut seen.points, other);
    }

    let [a, b] = seen;
    for (y, out) in out.iter_mut().enumerate() {
        let colours = [&labs(a, y, kernels), &labs(b, y, kernels)];
        let features = [&a.edges[y], &b.edges[y], &a.points[y], &b.points[y]];
        joined(colours, features, kernels.largest, out);
    }
}

/// The numbers of a row of a tile.
type Line = [f32; TILE];

/// CIELAB of the blurred channels of a row. One step after the other, since the compiler calculates several pixels at once only
/// in short loops.
#[inline(always)]
fn labs(seen: &Seen, y: usize, kernels: &Kernels) -> [Line; 3] {
    let [luminance, red_green, blue_yellow] = &seen.channels;
    let (luminance, red_green, blue_yellow) = (&luminance[y], &red_green[y], &blue_yellow[y]);
    let mut out = [[0.0; TILE]; 3];
    let [first, second, third] = &mut out;
    for i in 0..TILE {
        let xyz = [luminance[i] + red_green[i], luminance[i], luminance[i] - blue_yellow[i]];
        // Blurred opponent channels may leave the range of displays.
        let [r, g, b] = times(&kernels.from_xyz, xyz);
        [first[i], second[i], third[i]] =
            times(&TO_XYZ, [r.clamp(0.0, 1.0), g.clamp(0.0, 1.0), b.clamp(0.0, 1.0)]);
    }
    for line in [&mut *first, &mut *second, &mut *third] {
        for value in line {
            *value = f(*value);
        }
    }
    for i in 0..TILE {
        [first[i], second[i], third[i]] = opposed([first[i], second[i], third[i]]);
    }
    out
}

/// ꟻLIP, from the colours, edges and points of both pictures.
#[inline(always)]
fn joined([a, b]: [&[Line; 3]; 2], features: [&Line; 4], largest: f32, out: &mut Line) {
    let [a_edges, b_edges, a_points, b_points] = features;
    let bend = BEND * largest;
    let (small, large) = (BEND_VALUE / bend, (1.0 - BEND_VALUE) / (largest - bend));
    for x in 0..TILE {
        let distance = hyab([a[0][x], a[1][x], a[2][x]], [b[0][x], b[1][x], b[2][x]]);
        let difference = power(distance, COLOUR_EXPONENT);
        let beyond = BEND_VALUE + (difference - bend) * large;
        let colour = if difference < bend { difference * small } else { beyond };
        let edges = (a_edges[x] - b_edges[x]).abs();
        let points = (a_points[x] - b_points[x]).abs();
        // The exponent q_f of features is ½.
        let features = (edges.max(points) * std::f32::consts::FRAC_1_SQRT_2).sqrt();
        out[x] = power(colour, 1.0 - features);
    }
}

/// The lengths of the vectors whose coordinates are given.
#[inline(always)]
fn lengths(x: &mut Tile, y: &Tile) {
    for (x, y) in x.iter_mut().zip(y) {
        for (x, y) in x.iter_mut().zip(y) {
            *x = (*x * *x + y * y).sqrt();
        }
    }
}
