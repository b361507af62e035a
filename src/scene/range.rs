//! Limits of declared numbers, and their rounding.

use crate::{parameter::limits::Limits, shape};

/// The tessellation of an object.
#[must_use]
pub fn tessellation(shape: &shape::Declaration) -> Limits {
    let range = &shape.tessellation;
    Limits::between(f64::from(*range.start()), f64::from(*range.end())).whole()
}

/// A number rounded to this number of significant digits.
#[must_use]
pub fn significant(value: f64, digits: usize) -> f64 {
    // In decimal, so that the result is the number nearest to what people read.
    format!("{value:.0$e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        parameter::limits::number,
        scene::{Light, Object},
    };

    #[test]
    fn numbers_read_as_people_write_them() {
        assert_eq!(number(0.8), "0.8");
        assert_eq!(number(f64::from(0.1f32)), "0.1");
        assert_eq!(number(-2.0), "−2");
        assert_eq!(number(-0.0), "0");
        assert_eq!(number(1e-7), "1.0e−7");
    }

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        assert_eq!(significant(251.327, 3), 251.0);
        assert_eq!(significant(2513.27, 1), 3000.0);
        assert_eq!(significant(0.076_349, 2), 0.076);
        assert_eq!(significant(-1.6e-7, 1), -2e-7);
        assert_eq!(significant(0.0, 3), 0.0);
    }

    #[test]
    fn rules_are_sentences() {
        assert_eq!(Limits::between(0.5, 1.0).rule(), "between 0.5 and 1");
        assert_eq!(Object::size.limits().rule(), "greater than 0 and at most 1e9");
        assert_eq!(Limits::above_zero(90.0).rule(), "greater than 0 and at most 90");
        assert_eq!(Limits::between(0.0, f64::INFINITY).whole().rule(), "a whole number, 0 or more");
        assert_eq!(Limits::between(0.0, f64::INFINITY).rule(), "at least 0");
    }

    #[test]
    fn limits_exclude_what_they_say() {
        assert!(!Limits::above_zero(1.0).allows(0.0));
        assert!(!Limits::between(0.0, 9.0).whole().allows(1.5));
        assert!(!Light::direction.limits().allows(f64::NAN));
    }
}
