//! Adaptive sampling of a function: points are denser where it bends.

use glam::Vec3;
use rayon::prelude::*;

use super::Point;
use crate::progress::{Cancelled, Progress};

/// Maximum number of passes that halve steps.
const PASSES: u32 = 14;
/// Maximum number of points of a curve.
const MOST: usize = 6000;
/// The largest error of a straight line between two points, as a fraction of the largest value.
const OF_LARGEST: f32 = 0.0015;
/// The largest error on logarithmic axes, as a fraction of the value, for values not much smaller than the
/// largest.
const OF_VALUE: f32 = 0.01;
const SMALLEST: f32 = 1e-7;

/// The values of a function at increasing angles.
pub(super) fn at(
    angles: &[f64],
    function: &(impl Fn(f64) -> Vec3 + Sync),
    progress: &Progress,
) -> Result<Vec<Point>, Cancelled> {
    /// The number of points between two checks for cancellation.
    const CHUNK: usize = 8;
    let mut points = Vec::with_capacity(angles.len());
    for chunk in angles.chunks(CHUNK) {
        progress.step(points.len() as f32 / angles.len().max(1) as f32, "")?;
        points.par_extend(chunk.par_iter().map(|angle| Point { angle: *angle, rgb: function(*angle) }));
    }
    Ok(points)
}

/// Halves the steps between points until straight lines between them approximate the curve.
pub(super) fn refined(
    mut points: Vec<Point>,
    function: &(impl Fn(f64) -> Vec3 + Sync),
    progress: &Progress,
) -> Result<Vec<Point>, Cancelled> {
    // True for the steps, each from a point to the next, that may have to be halved.
    let mut open = vec![true; points.len().saturating_sub(1)];
    for pass in 0..PASSES {
        progress.step(pass as f32 / PASSES as f32, "")?;
        let count = open.iter().filter(|o| **o).count();
        if count == 0 || points.len() + count > MOST {
            break;
        }
        let finite = points.iter().filter(|p| p.rgb.is_finite());
        let largest = finite.map(|p| p.rgb.abs().max_element()).fold(0.0, f32::max);
        let steps: Vec<_> =
            points.windows(2).zip(&open).map(|(pair, open)| (pair[0], pair[1], *open)).collect();
        let middles: Vec<_> = steps
            .par_iter()
            .map(|(a, b, open)| {
                let angle = 0.5 * (a.angle + b.angle);
                open.then(|| Point { angle, rgb: function(angle) })
            })
            .collect();
        let (mut denser, mut next) = (Vec::new(), Vec::new());
        for ((a, b, _), middle) in steps.iter().zip(middles) {
            denser.push(*a);
            match middle {
                None => next.push(false),
                Some(middle) => {
                    denser.push(middle);
                    next.extend([bends(*a, middle, *b, largest); 2]);
                }
            }
        }
        denser.extend(points.last());
        (points, open) = (denser, next);
    }
    Ok(points)
}

/// True if the point in the middle is not on the line between the others.
fn bends(a: Point, middle: Point, b: Point, largest: f32) -> bool {
    let kinds = [a, middle, b].map(|p| p.rgb.is_finite());
    if kinds != [true; 3] {
        // The edge of a gap has been found; its inside needs no points.
        return kinds != [false; 3];
    }
    (0..3).any(|channel| {
        let [a, middle, b] = [a, middle, b].map(|p| p.rgb[channel]);
        let off = (middle - 0.5 * (a + b)).abs();
        off > OF_LARGEST * largest || off > OF_VALUE * middle.abs() && middle.abs() > SMALLEST * largest
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Vec<f64> {
        (-9..=9).map(|i| f64::from(i) * 10.0).collect()
    }

    #[test]
    fn a_needle_is_followed_and_a_line_is_left_alone() {
        let needle = |x: f64| Vec3::splat((-(x * 50.0).powi(2)).exp() as f32);
        let coarse = at(&grid(), &needle, &Progress::NONE).expect("not cancelled");
        let fine = refined(coarse.clone(), &needle, &Progress::NONE).expect("not cancelled");
        assert!(fine.len() > 60 && fine.len() < 600, "{}", fine.len());
        let line = |points: &[Point], x: f64| {
            let i = points.partition_point(|p| p.angle < x).max(1);
            let (a, b) = (points[i - 1], points[i]);
            let t = ((x - a.angle) / (b.angle - a.angle)) as f32;
            a.rgb.x + t * (b.rgb.x - a.rgb.x)
        };
        let worst = |points: &[Point]| {
            (-1000..1000)
                .map(|i| f64::from(i) * 1e-4)
                .map(|x| (line(points, x) - needle(x).x).abs())
                .fold(0.0, f32::max)
        };
        assert!(worst(&fine) < 0.004 && worst(&coarse) > 0.5, "{} {}", worst(&fine), worst(&coarse));
        let straight = |x: f64| Vec3::splat(x as f32 + 200.0);
        let points = at(&grid(), &straight, &Progress::NONE).expect("not cancelled");
        assert_eq!(refined(points, &straight, &Progress::NONE).expect("not cancelled").len(), 2 * 19 - 1);
    }

    #[test]
    fn the_edges_of_a_gap_are_found() {
        let broken = |x: f64| if (3.3..40.0).contains(&x) { Vec3::NAN } else { Vec3::ONE };
        let points = at(&grid(), &broken, &Progress::NONE).expect("not cancelled");
        let fine = refined(points, &broken, &Progress::NONE).expect("not cancelled");
        let missing: Vec<_> = fine.iter().filter(|p| p.rgb.is_nan()).map(|p| p.angle).collect();
        assert!((missing[0] - 3.3).abs() < 0.01 && missing.last().is_some_and(|a| (a - 40.0).abs() < 0.01));
    }

    #[test]
    fn work_that_nobody_wants_stops() {
        let stop = Progress { tell: &|_, _| (), cancelled: &|| true };
        assert_eq!(at(&grid(), &|_| Vec3::ONE, &stop), Err(Cancelled));
        assert_eq!(refined(Vec::new(), &|_| Vec3::ONE, &stop), Err(Cancelled));
    }
}
