//! The chi-squared test: whether directions chosen at random have the density that is claimed for them.

use std::f64::consts::PI;

use glam::Vec3;

use super::sequence::hash;

/// The chi-squared statistic of samples against a density, over boxes of equal solid angle, and the number of boxes that
/// count. The density of a box is the mean over interior points. A sample without a direction counts, in no box.
pub fn chi_squared(
    sample: impl Fn(&mut dyn FnMut() -> f32) -> Option<Vec3>,
    pdf: impl Fn(Vec3) -> f32,
) -> (f64, f64) {
    over::<32>(sample, pdf)
}

/// [`chi_squared`] over another number of rows, each with twice as many boxes, and 64 samples for each box: a quarter of
/// the rows takes a sixteenth of the time.
pub fn over<const ROWS: usize>(
    sample: impl Fn(&mut dyn FnMut() -> f32) -> Option<Vec3>,
    pdf: impl Fn(Vec3) -> f32,
) -> (f64, f64) {
    let columns = 2 * ROWS;
    let count = 64 * ROWS * columns;
    let mut found = vec![0.0f64; ROWS * columns];
    // Plain random numbers, since a sequence is too evenly distributed for the test.
    let mut numbers = (0u32..).map(|i| (hash(i) >> 8) as f32 / (1 << 24) as f32);
    for _ in 0..count {
        let Some(l) = sample(&mut || numbers.next().unwrap_or_default()) else { continue };
        let row = ((0.5 + 0.5 * l.z) * ROWS as f32).clamp(0.0, ROWS as f32 - 1.0) as usize;
        let turn = (f64::from(l.y).atan2(f64::from(l.x)) / (2.0 * PI)).rem_euclid(1.0);
        let column = ((turn * columns as f64) as usize).min(columns - 1);
        found[row * columns + column] += 1.0;
    }
    let (mut sum, mut boxes, mut rest) = (0.0, 0.0, [0.0; 2]);
    for (i, found) in found.iter().enumerate() {
        // The mean and the largest density of a box, from `fine` times `fine` points.
        let density = |fine: usize| {
            let (mut sum, mut most) = (0.0, 0.0f64);
            for j in 0..fine * fine {
                let at = |k: usize, n: usize, whole: usize| {
                    (k as f64 + (n as f64 + 0.5) / fine as f64) / whole as f64
                };
                let z = 2.0 * at(i / columns, j / fine, ROWS) - 1.0;
                let phi = 2.0 * PI * at(i % columns, j % fine, columns);
                let sine = (1.0 - z * z).sqrt();
                let l = Vec3::new((sine * phi.cos()) as f32, (sine * phi.sin()) as f32, z as f32);
                let pdf = f64::from(pdf(l));
                (sum, most) = (sum + pdf, most.max(pdf));
            }
            (sum / (fine * fine) as f64, most)
        };
        let (coarse, most) = density(12);
        // Where it is steep, from more.
        let mean = if most > 3.0 * coarse { density(48).0 } else { coarse };
        let solid_angle = 4.0 * PI / (ROWS * columns) as f64;
        let expected = mean * solid_angle * count as f64;
        // Boxes with few samples are merged.
        if expected < 20.0 {
            rest[0] += found;
            rest[1] += expected;
        } else {
            sum += (found - expected).powi(2) / expected;
            boxes += 1.0;
        }
    }
    if rest[1] > 20.0 {
        sum += (rest[0] - rest[1]).powi(2) / rest[1];
        boxes += 1.0;
    }
    (sum, boxes)
}

/// True if chi-squared is as expected by chance, or slightly higher, for narrow lobes whose boxes are not captured by the
/// mean over points.
pub fn passes((sum, boxes): (f64, f64)) -> bool {
    sum < boxes + 6.0 * (2.0 * boxes).sqrt() + 10.0
}
