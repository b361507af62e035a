//! The error of an approximated picture.

use glam::{Vec3, Vec4};

use crate::{optics::colour::luminance, reference::Picture};

/// Width of the bins of viewing angles, in degrees.
const BIN: f64 = 10.0;

/// The difference of a picture from the converged one, in the luminance of the pixels that objects cover
/// fully and that are lit in either. Differences are relative to the root mean square of the converged one
/// there.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Measured {
    /// The root mean square of the difference.
    pub(super) rms: f64,
    /// The mean of the picture, relative to that of the converged one.
    pub(super) mean: f64,
    /// The largest signed difference.
    pub(super) largest: f64,
    /// Location of that difference: the angle of view, in degrees, and the direction from the centre of the
    /// ball as on a clock.
    pub(super) at: (f64, u32),
    /// The root mean square by angle of view, in degrees.
    pub(super) by_angle: Vec<(f64, f64)>,
}

/// The data of a point for [`Measured`]: the cosine of the angle of view, and the normal to the right and up.
pub(super) fn place(observer: Vec3, p: Vec3, n: Vec3) -> Vec3 {
    Vec3::new(n.dot((observer - p).normalize_or_zero()), n.x, n.y)
}

/// The hour on a clock face in this direction.
fn hour([right, up]: [f32; 2]) -> u32 {
    let hour = (right.atan2(up).to_degrees() / 30.0).round().rem_euclid(12.0) as u32;
    if hour == 0 { 12 } else { hour }
}

/// The luminance of the pixels that objects cover fully, if lit.
fn lit(picture: &Picture) -> Vec<f64> {
    let covered = picture.pixels.iter().filter(|p| p.w > 0.999);
    covered.map(|p| f64::from(luminance(p.truncate()))).filter(|y| *y > 0.0).collect()
}

/// The mean luminance of these pixels.
pub(super) fn mean_luminance(picture: &Picture) -> f64 {
    let lit = lit(picture);
    lit.iter().sum::<f64>() / lit.len().max(1) as f64
}

/// The root mean square luminance of these pixels.
pub(super) fn rms_luminance(picture: &Picture) -> f64 {
    let lit = lit(picture);
    (lit.iter().map(|y| y * y).sum::<f64>() / lit.len().max(1) as f64).sqrt()
}

/// Measures a picture, with a picture of [`place`]s.
pub(super) fn measure(picture: &Picture, converged: &Picture, places: &Picture) -> Measured {
    let light = |p: &Vec4| f64::from(luminance(p.truncate()));
    let lit: Vec<_> = picture
        .pixels
        .iter()
        .zip(&converged.pixels)
        .zip(&places.pixels)
        .filter(|((_, c), _)| c.w > 0.999)
        .map(|((a, c), place)| (light(a), light(c), *place))
        .filter(|(a, c, _)| *a > 0.0 || *c > 0.0)
        .collect();
    let count = lit.len().max(1) as f64;
    let size = (lit.iter().map(|(_, c, _)| c * c).sum::<f64>() / count).sqrt();
    let sum = |of: fn(&(f64, f64, Vec4)) -> f64| lit.iter().map(of).sum::<f64>();
    let off: Vec<_> = lit
        .iter()
        .map(|(a, c, place)| {
            let angle = f64::from(place.x).clamp(0.0, 1.0).acos().to_degrees();
            ((a - c) / size.max(1e-12), angle, hour([place.y, place.z]))
        })
        .collect();
    let rms = |of: &dyn Fn(f64) -> bool| {
        let squares: Vec<f64> = off.iter().filter(|o| of(o.1)).map(|o| o.0 * o.0).collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    };
    let (largest, angle, hour) =
        off.iter().copied().max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).unwrap_or_default();
    let bins = (0..(90.0 / BIN) as u32).map(|i| BIN * f64::from(i));
    Measured {
        rms: rms(&|_| true),
        mean: sum(|(a, ..)| *a) / sum(|(_, c, _)| *c).max(1e-12),
        largest,
        at: (angle, hour),
        by_angle: bins
            .map(|from| (from + 0.5 * BIN, rms(&|angle| (from..from + BIN).contains(&angle))))
            .filter(|(_, rms)| rms.is_finite())
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(pixels: &[[f32; 2]]) -> Picture {
        let pixels: Vec<_> = pixels.iter().map(|[y, w]| Vec4::new(*y, *y, *y, *w)).collect();
        Picture { width: pixels.len() as u32, height: 1, pixels }
    }

    #[test]
    fn errors_are_those_of_the_definition() {
        // A rim, and pixels that are dark in both, do not count.
        let converged = picture(&[[1.0, 1.0], [3.0, 1.0], [9.0, 0.5], [0.0, 1.0]]);
        let other = picture(&[[1.5, 1.0], [2.0, 1.0], [0.0, 0.5], [0.0, 1.0]]);
        let view = |degrees: f32, right: f32, up: f32| Vec4::new(degrees.to_radians().cos(), right, up, 1.0);
        let places = Picture {
            pixels: vec![
                view(5.0, 0.0, 0.1),
                view(45.0, 0.7, 0.0),
                view(85.0, 0.0, 1.0),
                view(5.0, 0.0, 0.0),
            ],
            ..converged.clone()
        };
        let found = measure(&other, &converged, &places);
        // Differences of ½ and −1, where the root mean square is √5.
        let size = 5f64.sqrt();
        assert!((found.rms - (0.5f64 * (0.25 + 1.0)).sqrt() / size).abs() < 1e-6, "{found:?}");
        assert!((found.mean - 0.875).abs() < 1e-6 && (found.largest + 1.0 / size).abs() < 1e-6, "{found:?}");
        assert!(
            (rms_luminance(&converged) - size).abs() < 1e-6
                && (mean_luminance(&converged) - 2.0).abs() < 1e-6
        );
        assert!((found.at.0 - 45.0).abs() < 1e-3 && found.at.1 == 3, "{found:?}");
        assert_eq!(found.by_angle.iter().map(|(a, _)| *a).collect::<Vec<_>>(), [5.0, 45.0]);
        assert!((found.by_angle[0].1 - 0.5 / size).abs() < 1e-6);
        assert_eq!(measure(&converged, &converged, &places).rms, 0.0);
        assert_eq!(
            [[0.0, 1.0], [1.0, 1.8], [0.0, -1.0], [-1.0, 0.0]].map(hour),
            [12, 1, 6, 9],
            "12 is up, 3 right"
        );
    }
}
