//! The formatting of numbers in explanations.

use glam::Vec3;

use crate::text::{expression::Value, trimmed};

/// Significant digits: codes have eight bits.
pub(super) const DIGITS: usize = 4;

/// A number with up to four significant digits, without trailing zeros; `NaN` and `∞` are written as such.
#[must_use]
pub fn number(v: f32) -> String {
    rounded(v, DIGITS)
}

/// A number with up to this many significant digits.
#[must_use]
pub fn rounded(v: impl Into<f64>, digits: usize) -> String {
    let (v, digits) = (v.into(), digits.max(1));
    // The shortest digits that identify a 32-bit number, as in scene files.
    let v = match v as f32 {
        short if digits > 7 && f64::from(short) == v => short.to_string().parse().unwrap_or(v),
        _ => v,
    };
    if v.is_nan() {
        return "NaN".to_owned();
    }
    let sign = if v < 0.0 { "−" } else { "" };
    let size = v.abs();
    if size.is_infinite() {
        return format!("{sign}∞");
    }
    let whole = size.log10().floor() as i32;
    let text = match whole {
        _ if size == 0.0 => "0".to_owned(),
        -4..=5 => trimmed(format!("{size:.*}", (digits as i32 - 1 - whole).max(0) as usize)),
        _ => {
            let text = format!("{size:.*e}", digits - 1);
            let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
            format!("{}·10^{}", trimmed(digits.to_owned()), power.replace('-', "−"))
        }
    };
    format!("{sign}{text}")
}

/// A colour or a vector: `(0.5, 0.25, 0)`.
#[must_use]
pub fn triple(v: Vec3) -> String {
    rounded_triple(v, DIGITS)
}

/// A colour or a vector with up to this many significant digits.
#[must_use]
pub fn rounded_triple(v: Vec3, digits: usize) -> String {
    let [x, y, z] = v.to_array().map(|v| rounded(v, digits));
    format!("({x}, {y}, {z})")
}

/// A value of an equation: a number, an angle with its unit, or a colour.
#[must_use]
pub fn of_value(value: &Value, digits: usize) -> String {
    let unit = if value.degrees == 1 { "°" } else { "" };
    if !value.is_colour {
        return format!("{}{unit}", rounded(value.rgb[0], digits));
    }
    let [r, g, b] = value.rgb.map(|v| rounded(v, digits));
    format!("({r}, {g}, {b})")
}

/// A number if red, green and blue are equal, and otherwise all three.
#[must_use]
pub fn rounded_number_or_triple(v: Vec3, digits: usize) -> String {
    if v.x == v.y && v.y == v.z { rounded(v.x, digits) } else { rounded_triple(v, digits) }
}

/// A number, or three if they differ, with standard errors and the digits that these allow: `0.5123 ± 0.0031`.
#[must_use]
pub fn measured(v: Vec3, error: Vec3) -> String {
    let all: [[String; 2]; 3] = std::array::from_fn(|i| with_error(v[i], error[i]));
    match &all {
        [x, y, z] if x == y && y == z => format!("{} ± {}", x[0], x[1]),
        [x, y, z] => format!("({}, {}, {}) ± ({}, {}, {})", x[0], y[0], z[0], x[1], y[1], z[1]),
    }
}

/// A colour as used in equations.
pub(super) fn colour(v: Vec3) -> Value {
    Value::colour(v.to_array().map(f64::from))
}

/// The significant digits that a relative error leaves: from one to `most`.
pub(super) fn digits_within(relative: f32, most: usize) -> usize {
    match relative {
        r if r > 0.0 && r.is_finite() => ((-r.log10()).floor().max(0.0) as usize + 1).clamp(1, most),
        _ => most,
    }
}

/// Digits of a standard error.
const OF_ERROR: usize = 2;

/// A number and its standard error, both to the second digit of the error.
pub(super) fn with_error(value: f32, error: f32) -> [String; 2] {
    /// The digits of 32 bits.
    const MOST: i32 = 7;
    let (value, error) = (f64::from(value), f64::from(error));
    if error <= 0.0 || !error.is_finite() || !value.is_finite() {
        return [rounded(value, DIGITS), rounded(error, OF_ERROR)];
    }
    // Digits before the point are written whether they mean something or not, so both are rounded first.
    let error = format!("{error:.*e}", OF_ERROR - 1);
    let power: i32 = error.split_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or(0);
    let last = power + 1 - OF_ERROR as i32;
    let unit = 10f64.powi(last);
    let value = (value / unit).round() * unit;
    let place = if value == 0.0 { last } else { value.abs().log10().floor() as i32 };
    let digits = (place - last + 1).clamp(1, MOST);
    [rounded(value, digits as usize), rounded(error.parse().unwrap_or(f64::NAN), OF_ERROR)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits_and_no_idle_zeros() {
        for (v, expected) in [
            (0.0, "0"),
            (1.0, "1"),
            (-0.25, "−0.25"),
            (0.123_456, "0.1235"),
            (12.345_6, "12.35"),
            (9.999_96, "10"),
            (123_456.0, "123456"),
            (0.000_5, "0.0005"),
            (1.5e-7, "1.5·10^−7"),
            (-2e30, "−2·10^30"),
            (100.0, "100"),
        ] {
            assert_eq!(number(v), expected);
        }
    }

    #[test]
    fn fewer_digits_are_rounded() {
        for (v, expected) in [
            (0.123_456, "0.123"),
            (12.35_f32, "12.4"),
            (1234.5, "1234"),
            (0.999_6, "1"),
            (1.234e-7, "1.23·10^−7"),
        ] {
            assert_eq!(rounded(v, 3), expected);
        }
        assert_eq!(rounded_triple(Vec3::new(0.5, 1.0 / 3.0, 0.0), 3), "(0.5, 0.333, 0)");
        assert_eq!(rounded(0.25, 0), rounded(0.25, 1));
    }

    #[test]
    fn what_is_no_number_says_so() {
        assert_eq!(triple(Vec3::new(f32::NAN, f32::INFINITY, -f32::INFINITY)), "(NaN, ∞, −∞)");
        assert_eq!(rounded_number_or_triple(Vec3::splat(f32::NAN), DIGITS), "(NaN, NaN, NaN)");
        assert_eq!(rounded_number_or_triple(Vec3::splat(2.0), DIGITS), "2");
    }

    #[test]
    fn numbers_have_the_digits_that_their_errors_allow() {
        for (value, error, expected) in [
            (0.512_345, 0.0031, ["0.5123", "0.0031"]),
            (0.512_345, 0.0012, ["0.5123", "0.0012"]),
            (12.345, 2.0, ["12.3", "2"]),
            (12_345.0, 300.0, ["12350", "300"]),
            // A tenth of the value.
            (12_345.0, 1234.0, ["12300", "1200"]),
            (1_234_567.0, 123_456.0, ["1.23·10^6", "120000"]),
            (0.001_234_5, 0.000_123_4, ["0.00123", "0.00012"]),
            (0.01, 0.3, ["0.01", "0.3"]),
            (0.001, 0.3, ["0", "0.3"]),
            (0.512_345, 0.0996, ["0.51", "0.1"]),
            (0.3, 0.0, ["0.3", "0"]),
            (1.0 / 3.0, 0.0, ["0.3333", "0"]),
            (0.0, 0.1, ["0", "0.1"]),
        ] {
            assert_eq!(with_error(value, error), expected, "{value} {error}");
        }
        // The wrong twin has the usual digits, whatever the error.
        assert_ne!(rounded(12_345.0_f32, DIGITS), with_error(12_345.0, 1234.0)[0]);
        assert_eq!([1e-5, 0.003, 0.2, 3.0, 0.0].map(|r| digits_within(r, 4)), [4, 3, 1, 1, 4]);
    }
}
