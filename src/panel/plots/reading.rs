//! The values under the pointer, or at the angle to which keys went.

use glam::Vec3;

use crate::{
    curves::{Curve, Sheet, Slice, draw::Ground},
    explain::measured,
    panel::explain::raised,
    text::superscript,
};

/// The place at which values are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reading {
    /// An angle of the horizontal axis, degrees.
    Angle(f64),
    /// Half and difference angle, degrees.
    Angles(f64, f64),
}

impl Reading {
    /// The place in a figure, where it has values; the horizontal axis goes from an angle to another.
    pub(super) fn at([x, y]: [f64; 2], ground: &Ground, [from, to]: [f64; 2]) -> Option<Self> {
        match ground {
            Ground::Plot([left, top, right, bottom]) => {
                let inside = (*left..=*right).contains(&x) && (*top..=*bottom).contains(&y);
                let part = (x - left) / (right - left);
                inside.then_some(Self::Angle(from + part * (to - from)))
            }
            Ground::Polar { centre, radius, around } => {
                let [across, up] = [x - centre[0], centre[1] - y];
                let inside = (up >= 0.0 || *around) && (4.0..=radius + 8.0).contains(&across.hypot(up));
                inside.then(|| Self::Angle(across.atan2(up).to_degrees()))
            }
            Ground::Slices(places) => {
                let [left, top, right, bottom] =
                    *places.iter().find(|p| (p[0]..p[2]).contains(&x) && (p[1]..p[3]).contains(&y))?;
                let half = 90.0 * (x - left) / (right - left);
                Some(Self::Angles(half, 90.0 * (bottom - y) / (bottom - top)))
            }
        }
    }

    /// The nearest angle at which a value was calculated or measured.
    pub(super) fn snapped(self, sheet: &Sheet) -> Self {
        let Self::Angle(angle) = self else { return self };
        let all = sheet.curves.iter().flat_map(|curve| &curve.points).map(|point| point.angle);
        let off = |a: &f64| (a - angle).abs();
        all.min_by(|a, b| off(a).total_cmp(&off(b))).map_or(self, Self::Angle)
    }

    /// In words.
    pub(super) fn name(self) -> String {
        match self {
            Self::Angle(angle) => format!("at {}", degrees(angle)),
            Self::Angles(half, difference) => {
                format!("at half angle {}, difference angle {}", degrees(half), degrees(difference))
            }
        }
    }
}

/// An angle in words.
pub(super) fn degrees(angle: f64) -> String {
    format!("{}°", (angle * 10.0).round() / 10.0 + 0.0).replace('-', "−")
}

/// The value of a curve at an angle, as the plot shows it; none where it has none, and not finite where that is so.
pub(super) fn of_curve(sheet: &Sheet, curve: &Curve, angle: f64) -> Option<f64> {
    /// Measured points count this far from their angle.
    const NEAR: f64 = 0.75;
    let value = |i: usize| sheet.value(curve.points[i].rgb);
    let next = curve.points.partition_point(|point| point.angle < angle);
    let off = |i: &usize| (curve.points[*i].angle - angle).abs();
    let around = [next.checked_sub(1), Some(next)].into_iter().flatten().filter(|i| *i < curve.points.len());
    let nearest = around.min_by(|a, b| off(a).total_cmp(&off(b)))?;
    if off(&nearest) < 1e-9 {
        return Some(value(nearest));
    }
    if curve.measured {
        return (off(&nearest) < NEAR).then(|| value(nearest));
    }
    let before = next.checked_sub(1).filter(|_| next < curve.points.len())?;
    let [a, b] = [before, next].map(|i| curve.points[i].angle);
    let part = (angle - a) / (b - a);
    Some(value(before) + part * (value(next) - value(before)))
}

/// The value of a slice: its luminance, or the channel that is shown.
pub(super) fn of_slice(sheet: &Sheet, slice: &Slice, [half, difference]: [f64; 2]) -> Option<f64> {
    let side = slice.side as usize;
    let index = |angle: f64| ((angle / 90.0 * side as f64) as usize).min(side.saturating_sub(1));
    let row = side.checked_sub(1)? - index(difference);
    slice.values.get(row * side + index(half)).map(|f| sheet.value(*f))
}

/// The value of a curve at an angle in words, with its uncertainty if that is known.
pub(super) fn curve_text(sheet: &Sheet, curve: &Curve, angle: f64) -> String {
    let said = |v: f64| match curve.sigma_at(angle) {
        Some(sigma) if v.is_finite() => with_error(v, sigma),
        _ => text(v),
    };
    of_curve(sheet, curve, angle).map_or_else(|| "–".to_owned(), said)
}

/// The longest of the values that can be read: the list keeps room for it, so that it does not move with the pointer.
pub(super) fn longest(sheet: &Sheet) -> String {
    /// Number of values of each curve that are looked at: neighbours have as many digits.
    const MOST: usize = 128;
    let step = |count: usize| count.div_ceil(MOST).max(1);
    let curves = sheet.curves.iter().flat_map(|curve| {
        let points = curve.points.iter().step_by(step(curve.points.len()));
        points.map(move |point| curve_text(sheet, curve, point.angle))
    });
    let slices = sheet.slices.iter().flat_map(|slice| {
        let values = slice.values.iter().step_by(step(slice.values.len()));
        values.map(move |value| text(sheet.value(*value)))
    });
    curves.chain(slices).max_by_key(|text| text.chars().count()).unwrap_or_default()
}

/// A value with so many digits as can be told apart.
pub(super) fn text(value: f64) -> String {
    if value.is_nan() {
        return "not a number".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞".to_owned() } else { "−∞".to_owned() };
    }
    let size = value.abs();
    let text = if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&size) {
        let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.digits$}")
    } else {
        let power = size.log10().floor();
        let digits: String = format!("{power}").chars().map(superscript).collect();
        format!("{:.3} × 10{digits}", value / 10f64.powf(power))
    };
    text.replace('-', "−")
}

/// A value and its uncertainty, both to the digits that this allows.
pub(super) fn with_error(value: f64, error: f64) -> String {
    let [value, error] = [value, error].map(|v| Vec3::splat(v as f32));
    raised(&measured(value, error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curves::{Kind, Point, Setup};

    fn curve(measured: bool) -> Curve {
        let point = |(angle, v)| Point { angle, rgb: Vec3::splat(v) };
        let points = [(-10.0, 1.0), (0.0, 2.0), (10.0, f32::NAN), (20.0, 4.0)].map(point).to_vec();
        Curve { name: "a".to_owned(), points, sigma: Vec::new(), measured, sharp: false, reflected: false }
    }

    #[test]
    fn curves_are_read_between_their_points_and_not_beyond() {
        let sheet = Sheet::new(Setup { kind: Kind::Brdf, theta_i: 0.0, phi_i: 0.0 });
        let at = |angle: f64| of_curve(&sheet, &curve(false), angle);
        assert_eq!((at(-10.0), at(0.0), at(20.0), at(-7.5)), (Some(1.0), Some(2.0), Some(4.0), Some(1.25)));
        assert!(at(10.0).is_some_and(f64::is_nan) && at(12.0).is_some_and(f64::is_nan));
        assert_eq!((at(-10.1), at(20.1)), (None, None));
        let at = |angle: f64| of_curve(&sheet, &curve(true), angle);
        assert_eq!((at(-9.5), at(-7.5), at(20.1)), (Some(1.0), None, Some(4.0)));
    }

    #[test]
    fn slices_are_read_where_their_pixels_are() {
        let sheet = Sheet::new(Setup { kind: Kind::Slice, theta_i: 0.0, phi_i: 0.0 });
        let values = (0..9u8).map(|i| Vec3::splat(i.into())).collect();
        let slice = Slice { name: "a".to_owned(), side: 3, values };
        for i in 0..9 {
            let (half, difference) = slice.angles(i);
            assert_eq!(of_slice(&sheet, &slice, [half, difference]), Some(i as f64));
        }
        assert_eq!(of_slice(&sheet, &slice, [90.0, 90.0]), Some(2.0));
    }

    #[test]
    fn the_longest_value_of_all_curves_is_known_before_any_is_read() {
        let mut sheet = Sheet::new(Setup { kind: Kind::Brdf, theta_i: 0.0, phi_i: 0.0 });
        assert_eq!(longest(&sheet), "");
        let of = |values: &[f32]| {
            let points = values.iter().zip([0.0, 10.0, 20.0]);
            let points = points.map(|(value, angle)| Point { angle, rgb: Vec3::splat(*value) });
            Curve { points: points.collect(), ..curve(false) }
        };
        sheet.curves = vec![of(&[1.0, 2.0]), of(&[0.5, 1.5e-7, 3.0]), of(&[12.3456])];
        assert_eq!(longest(&sheet), "1.500 × 10⁻⁷");
        sheet.curves[2].sigma = vec![0.0025];
        assert_eq!(longest(&sheet), "12.3456 ± 0.0025");
    }

    #[test]
    fn values_have_four_digits() {
        for (value, said) in [
            (0.0, "0"),
            (std::f64::consts::FRAC_1_PI, "0.3183"),
            (12.345_67, "12.35"),
            (123_456.0, "1.235 × 10⁵"),
            (-0.5, "−0.5000"),
            (f64::NAN, "not a number"),
            (f64::INFINITY, "∞"),
        ] {
            assert_eq!(text(value), said);
        }
        assert_eq!(text(1.5e-7), "1.500 × 10⁻⁷");
    }

    #[test]
    fn values_with_an_uncertainty_have_the_digits_that_it_allows() {
        assert_eq!(with_error(0.412_31, 0.031), "0.412 ± 0.031");
        assert_eq!(with_error(0.000_031_831, 0.000_003_1), "3.18·10⁻⁵ ± 3.1·10⁻⁶");
        assert_ne!(with_error(0.412_31, 0.031), format!("{} ± 0.031", text(0.412_31)), "the wrong twin");
    }

    #[test]
    fn places_are_angles() {
        let plot = Ground::Plot([100.0, 0.0, 280.0, 50.0]);
        assert_eq!(Reading::at([190.0, 10.0], &plot, [-90.0, 90.0]), Some(Reading::Angle(0.0)));
        assert_eq!(Reading::at([190.0, 10.0], &plot, [0.0, 90.0]), Some(Reading::Angle(45.0)));
        assert_eq!(Reading::at([99.0, 10.0], &plot, [-90.0, 90.0]), None);
        let polar = Ground::Polar { centre: [100.0, 100.0], radius: 80.0, around: false };
        let Some(Reading::Angle(angle)) = Reading::at([130.0, 70.0], &polar, [-90.0, 90.0]) else {
            panic!("inside")
        };
        assert!((angle - 45.0).abs() < 1e-9);
        assert_eq!(Reading::at([130.0, 101.0], &polar, [-90.0, 90.0]), None);
        let slices = Ground::Slices(vec![[0.0, 0.0, 90.0, 90.0]]);
        assert_eq!(Reading::at([30.0, 80.0], &slices, [0.0, 90.0]), Some(Reading::Angles(30.0, 10.0)));
    }
}
