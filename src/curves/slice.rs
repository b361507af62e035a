//! Image slices of BRDFs.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::{Channel, CurveError, Detail, Kind, Setup, Subject};
use crate::{optics::colour::srgb_encode8, progress::Progress};

/// `f` over the half angle θ_h, from left to right, and the difference angle θ_d, from bottom to top, at φ_d
/// = 90°: highlights are at the left, the Fresnel effect at the top, and retroreflection at the bottom.
///
/// B. Burley (2012), *Physically-Based Shading at Disney*; S. Rusinkiewicz (1998), *A New Change of Variables for
/// Efficient BRDF Representation*.
#[derive(Clone, Debug, PartialEq)]
pub struct Slice {
    /// The name of the subject.
    pub name: String,
    /// The number of pixels across and down.
    pub side: u32,
    /// The BRDF at the centre of each pixel, row by row from the top.
    pub values: Vec<Vec3>,
}

/// Directions to light and viewer, in 64 bits, for half and difference angle in degrees, at φ_d = 90°, with the half
/// vector at an azimuth.
pub(super) fn directions(theta_h: f64, theta_d: f64, phi: f64) -> (Vec3, Vec3) {
    let (sin_h, cos_h) = theta_h.to_radians().sin_cos();
    let (sin_d, cos_d) = theta_d.to_radians().sin_cos();
    let (sin, cos) = phi.rem_euclid(360.0).to_radians().sin_cos();
    let turned = |x: f64, y: f64, z: f64| DVec3::new(x * cos - y * sin, x * sin + y * cos, z).as_vec3();
    let along = cos_d * sin_h;
    (turned(along, sin_d, cos_d * cos_h), turned(along, -sin_d, cos_d * cos_h))
}

impl Slice {
    /// Half and difference angle in degrees at the centre of a pixel.
    #[must_use]
    pub fn angles(&self, pixel: usize) -> (f64, f64) {
        let side = self.side.max(1) as usize;
        let at = |i: usize| 90.0 * (i as f64 + 0.5) / side as f64;
        (at(pixel % side), at(side - 1 - (pixel / side).min(side - 1)))
    }

    /// The number of pixels without a finite value.
    #[must_use]
    pub fn missing(&self) -> usize {
        self.values.iter().filter(|f| !f.is_finite()).count()
    }

    /// The number of pixels that are brighter than white.
    pub(super) fn clipped(&self, channel: Option<Channel>) -> usize {
        self.values.iter().filter(|f| f.is_finite() && shown(**f, channel).max_element() > 1.0).count()
    }

    /// The slice as a picture of RGB bytes: π f, sRGB-encoded, white at 1; or log₁₀ π f from −2, black, to 2, white.
    /// Non-finite values are drawn as a pattern of magenta and black.
    #[must_use]
    pub fn rgb8(&self, channel: Option<Channel>, log: bool) -> Vec<u8> {
        let side = self.side.max(1) as usize;
        let pixel = |(i, f): (usize, &Vec3)| {
            if !f.is_finite() {
                return if (i % side / 3 + i / side / 3).is_multiple_of(2) { [255, 0, 255] } else { [0; 3] };
            }
            shown(*f, channel).to_array().map(|v| {
                if log {
                    let part = (v.max(f32::MIN_POSITIVE).log10() + LOG_RANGE) / (2.0 * LOG_RANGE);
                    (255.0 * part.clamp(0.0, 1.0)).round() as u8
                } else {
                    srgb_encode8(v)
                }
            })
        };
        self.values.iter().enumerate().flat_map(pixel).collect()
    }
}

/// The number of powers of ten from grey to white, and from grey to black.
pub(super) const LOG_RANGE: f32 = 2.0;

/// π f in the displayed channel.
fn shown(f: Vec3, channel: Option<Channel>) -> Vec3 {
    let f = channel.map_or(f, |channel| Vec3::splat(channel.of(f) as f32));
    std::f32::consts::PI * f
}

/// The image slice of a subject.
///
/// # Errors
/// Returns an error if the subject is a paint, if the CPU cannot run the model, or if the user cancels.
pub fn slice(
    subject: &Subject,
    setup: &Setup,
    detail: Detail,
    progress: &Progress,
) -> Result<Slice, CurveError> {
    subject.has(Kind::Slice)?;
    subject.runs()?;
    let side = if detail == Detail::Fine { 256 } else { 48 };
    // The number of rows between two checks for cancellation.
    let step = side / 16;
    let mut slice = Slice { name: subject.name.clone(), side, values: Vec::new() };
    for row in (0..side).step_by(step as usize) {
        progress.step(row as f32 / side as f32, "")?;
        let pixels = row * side..(row + step).min(side) * side;
        let rows: Vec<_> = pixels
            .into_par_iter()
            .map(|pixel| {
                let (theta_h, theta_d) = slice.angles(pixel as usize);
                let (l, v) = directions(theta_h, theta_d, setup.phi_i);
                subject.brdf(l, v)
            })
            .collect();
        slice.values.extend(rows);
    }
    subject.runs()?;
    Ok(slice)
}
