//! The CIE general sky: CIE S 011 / ISO 15469 (2004), *Spatial Distribution of Daylight, CIE Standard General
//! Sky*, without the sun itself, over a diffusely reflecting ground.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use crate::optics::sampling;

/// Names of the types in scenes and in the window.
pub(super) const TYPES: [(&str, &str); 15] = [
    ("1", "1 overcast, steep"),
    ("2", "2 overcast, steep, brighter near the sun"),
    ("3", "3 overcast"),
    ("4", "4 overcast, brighter near the sun"),
    ("5", "5 uniform"),
    ("6", "6 partly cloudy, little brighter near the sun"),
    ("7", "7 partly cloudy, brighter near the sun"),
    ("8", "8 partly cloudy, distinct corona"),
    ("9", "9 partly cloudy, sun hidden"),
    ("10", "10 partly cloudy, sun bright"),
    ("11", "11 white-blue, distinct corona"),
    ("12", "12 clear"),
    ("13", "13 clear, polluted air"),
    ("14", "14 cloudless, turbid"),
    ("15", "15 white-blue, turbid, wide corona"),
];

/// The types whose luminance depends on the place of the sun: in the others, `c` is 0.
pub(super) const BRIGHTER_AT_SUN: [&str; 12] =
    ["2", "4", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15"];

/// Gradation `a`, `b` and indicatrix `c`, `d`, `e` of the type with this index.
fn coefficients(index: usize) -> [f32; 5] {
    let row = include_str!("sky.csv").lines().nth(index).unwrap_or_default();
    let mut numbers = row.split(", ").filter_map(|number| number.parse().ok());
    std::array::from_fn(|_| numbers.next().unwrap_or_default())
}

/// Fractions of the samples: towards the ground, around the sun, over the sky.
const GROUND_SHARE: f32 = 0.2;
const SUN_SHARE: f32 = 0.3;
const SKY_SHARE: f32 = 0.5;

/// Exponent of the cosine lobe in which samples around the sun are distributed.
const AROUND: f32 = 8.0;

/// A sky.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sky {
    /// `a` to `e` of the sky's type.
    pub coefficients: [f32; 5],
    /// Unit vector to the sun.
    pub sun: Vec3,
    /// Luminance of the zenith divided by gradation and indicatrix there.
    pub scale: f32,
    /// Luminance of the ground, which is uniform.
    pub ground: f32,
    /// exp(d π/2) of the indicatrix, which every direction needs.
    square: f32,
}

impl Sky {
    /// A sky of the type with this index, with the sun's elevation above the horizon and its azimuth from −z,
    /// clockwise as seen from above, in degrees; the luminance of the zenith, cd/m²; and the reflectance of
    /// the ground.
    #[must_use]
    pub fn new(index: usize, [elevation, azimuth]: [f32; 2], zenith: f32, reflectance: f32) -> Self {
        let (sine, cosine) = elevation.to_radians().sin_cos();
        let (east, north) = azimuth.to_radians().sin_cos();
        let sun = Vec3::new(east * cosine, sine, -north * cosine);
        let coefficients = coefficients(index.min(TYPES.len() - 1));
        let square = (0.5 * coefficients[3] * PI).exp();
        let mut sky = Self { coefficients, sun, scale: 1.0, ground: 0.0, square };
        sky.scale = zenith / sky.above(Vec3::Y);
        sky.ground = reflectance * sky.illuminance() / PI;
        sky
    }

    /// The illuminance of the ground, lx: by the midpoint rule over squared sines and azimuths.
    fn illuminance(&self) -> f32 {
        const ROWS: u32 = 48;
        const TURNS: u32 = 64;
        let mut sum = 0.0;
        for i in 0..ROWS {
            let squared = (i as f32 + 0.5) / ROWS as f32;
            let (sine, cosine) = (squared.sqrt(), (1.0 - squared).sqrt());
            for j in 0..TURNS {
                let (x, z) = (2.0 * PI * (j as f32 + 0.5) / TURNS as f32).sin_cos();
                sum += self.above(Vec3::new(sine * x, cosine, sine * z));
            }
        }
        sum * PI / (ROWS * TURNS) as f32
    }

    /// The luminance from a direction above the horizon: gradation `1 + a exp(b / cos Z)` times indicatrix `1
    /// + c (exp(d χ) − exp(d π/2)) + e cos² χ`, with Z from the zenith and χ from the sun, scaled.
    #[inline]
    fn above(&self, direction: Vec3) -> f32 {
        let [a, b, c, d, e] = self.coefficients;
        let gradation = 1.0 + a * (b / direction.y.max(0.01)).exp();
        let cosine = direction.dot(self.sun).clamp(-1.0, 1.0);
        let chi = sampling::arc_cosine(cosine);
        let indicatrix = 1.0 + c * ((d * chi).exp() - self.square) + e * cosine * cosine;
        self.scale * gradation * indicatrix
    }

    /// The luminance from a direction, and its sampling density.
    #[inline]
    #[must_use]
    pub fn seen(&self, direction: Vec3) -> (f32, f32) {
        let around = direction.dot(self.sun).max(0.0).powf(AROUND) * (AROUND + 1.0);
        let (luminance, share) =
            if direction.y > 0.0 { (self.above(direction), SKY_SHARE) } else { (self.ground, GROUND_SHARE) };
        (luminance, (share + SUN_SHARE * around) / (2.0 * PI))
    }

    /// A direction for a point of the unit square.
    #[must_use]
    pub fn sample(&self, u: Vec2) -> Vec3 {
        if u.x < GROUND_SHARE {
            let d = sampling::cone(Vec2::new(u.x / GROUND_SHARE, u.y), 1.0);
            return Vec3::new(d.x, -d.z, d.y);
        }
        let x = u.x - GROUND_SHARE;
        if x < SUN_SHARE {
            let cosine = (x / SUN_SHARE).powf(1.0 / (AROUND + 1.0));
            let d = sampling::cone(Vec2::new(1.0 - cosine, u.y), 1.0);
            return sampling::about(self.sun, d);
        }
        let d = sampling::cone(Vec2::new((x - SUN_SHARE) / SKY_SHARE, u.y), 1.0);
        Vec3::new(d.x, d.z, d.y)
    }
}
