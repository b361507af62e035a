//! The distance from the eye.

use super::{Declaration, Legend, Made, Shows};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "depth",
    name: "Depth",
    explanation: "The straight distance from the eye to the surface. The scale reaches from the nearest to the \
        farthest object of the scene, apart from those around the eye, such as a floor; what is nearer or \
        farther has the colour of the end.",
    legend: |about| {
        let [low, high] = about.range;
        let numbers = [low, rounded(0.5 * (low + high)), high].map(|x| x.to_string());
        Legend::new("Depth: distance from the eye, m").scale(numbers.each_ref().map(String::as_str))
    },
    range: Some(depths),
    shows: Shows::Geometry(
        |point| {
            let [low, high] = point.range;
            Made::Place((point.to_eye.length() - low) / (high - low))
        },
        include_str!("depth.wgsl"),
    ),
    ..Declaration::PLAIN
};

/// A number rounded to three digits.
fn rounded(x: f32) -> f32 {
    let digits = 2 - x.abs().max(1e-9).log10().floor() as i32;
    ((f64::from(x) * 10f64.powi(digits)).round() / 10f64.powi(digits)) as f32
}

/// A number rounded by a function to its two leading digits.
fn two_digits(x: f32, round: fn(f64) -> f64) -> f32 {
    if x <= 0.0 || !x.is_finite() {
        return 0.0;
    }
    let x = f64::from(x);
    let digits = 1 - x.log10().floor() as i32;
    (round(x * 10f64.powi(digits)) / 10f64.powi(digits)) as f32
}

/// The distances from the eye between which the objects are, rounded outwards so that a moving eye changes them rarely.
/// Objects that reach around the eye, such as a floor, count only if there are no others: they would leave those no colours.
fn depths(objects: &mut dyn Iterator<Item = [f32; 2]>) -> [f32; 2] {
    let apart = |[low, high]: [f32; 2], [near, far]: [f32; 2]| [low.min(near), high.max(far)];
    let (mut before, mut around) = ([f32::INFINITY, 0.0], [f32::INFINITY, 0.0]);
    for reach in objects {
        let of = if reach[0] > 0.0 { &mut before } else { &mut around };
        *of = apart(*of, reach);
    }
    let [near, far] = if before[1] > 0.0 { before } else { around };
    let (near, far) = (two_digits(near, f64::floor), two_digits(far, f64::ceil));
    if near < far { [near, far] } else { [0.0, 1.0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_outwards_to_two_digits() {
        assert_eq!([two_digits(0.123, f64::floor), two_digits(12.3, f64::ceil)], [0.12, 13.0]);
        assert_eq!([two_digits(-1.0, f64::floor), two_digits(f32::NAN, f64::ceil)], [0.0, 0.0]);
    }
}
