//! The legal values of numbers.

use crate::text::trimmed;

/// The smallest legal value of a number that must be greater than zero.
pub const ABOVE_ZERO: f32 = f32::MIN_POSITIVE;

/// The legal values of a number, and the range of its slider.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// The smallest legal value.
    pub min: f64,
    /// The largest legal value; infinite if unlimited.
    pub max: f64,
    /// The lower end of the slider.
    pub slider_min: f64,
    /// The upper end of the slider.
    pub slider_max: f64,
    /// True if only whole numbers are legal.
    pub whole: bool,
    /// The reason for the limits, if the numbers alone do not explain it.
    pub because: Option<String>,
}

impl Limits {
    /// All numbers between two limits, inclusive.
    #[must_use]
    pub fn between(min: f64, max: f64) -> Self {
        Self { min, max, slider_min: min, slider_max: max, whole: false, because: None }
    }

    /// Greater than zero and at most `max`.
    #[must_use]
    pub fn above_zero(max: f64) -> Self {
        Self { min: f64::from(ABOVE_ZERO), ..Self::between(0.0, max) }
    }

    /// A declared range: from [`ABOVE_ZERO`] on its numbers are greater than zero.
    #[must_use]
    pub fn of(min: f32, max: f32) -> Self {
        let between = Self::between(min.into(), max.into());
        if min == ABOVE_ZERO { Self { slider_min: 0.0, ..between } } else { between }
    }

    /// The limits with a slider over part of the range.
    #[must_use]
    pub fn slider(mut self, min: f64, max: f64) -> Self {
        (self.slider_min, self.slider_max) = (min, max);
        self
    }

    /// The limits for integers.
    #[must_use]
    pub fn whole(mut self) -> Self {
        self.whole = true;
        self
    }

    /// The largest value, or the end of the slider if there is none.
    #[must_use]
    pub fn top(&self) -> f64 {
        if self.max.is_finite() { self.max } else { self.slider_max }
    }

    /// The largest value, or a very large one if there is none.
    #[must_use]
    pub fn far(&self) -> f64 {
        if self.max.is_finite() { self.max } else { 1e6 }
    }

    /// True if a value is legal.
    #[must_use]
    pub fn allows(&self, value: f64) -> bool {
        // In f32, as in the scene: 0.1 is legal if the limit is the f32 next to it.
        let within = value as f32 >= self.min as f32 && value as f32 <= self.max as f32;
        value.is_finite() && within && (!self.whole || value.fract() == 0.0)
    }

    /// True if all positive numbers up to the maximum are legal, but zero is not.
    #[must_use]
    pub fn is_above_zero(&self) -> bool {
        self.min == f64::from(ABOVE_ZERO)
    }

    /// The rule, as the end of "must be …".
    #[must_use]
    pub fn rule(&self) -> String {
        let what = if self.whole { "a whole number " } else { "" };
        let max = if self.max < 1e6 { number(self.max) } else { format!("{:e}", self.max) };
        let min = number(self.min);
        let range = match (self.is_above_zero(), self.min.is_finite(), self.max.is_finite()) {
            (true, _, true) => format!("{what}greater than 0 and at most {max}"),
            (true, _, false) => format!("{what}greater than 0"),
            (_, true, true) => format!("{what}between {min} and {max}"),
            (_, true, false) if self.whole => format!("a whole number, {min} or more"),
            (_, true, false) => format!("at least {min}"),
            (_, false, true) => format!("{what}of at most {max}"),
            (_, false, false) if self.whole => "a whole number".to_owned(),
            (_, false, false) => "a number".to_owned(),
        };
        let range = if self.whole { range } else { range.replacen("of at", "at", 1) };
        match &self.because {
            Some(because) => format!("{range} ({because})"),
            None => range,
        }
    }
}

/// The end of a range in a rule: far ends with a power of ten, the farthest of 32 bits as 3.4e38.
pub(super) fn end(value: f32) -> String {
    match value.abs() {
        f32::MAX => format!("{value:.1e}"),
        far if far >= 1e16 => format!("{value:e}"),
        _ => value.to_string(),
    }
}

/// A number in plain notation: at most four decimals, no trailing zeros, a true minus sign.
#[must_use]
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return if value.is_nan() {
            "–".to_owned()
        } else if value > 0.0 {
            "∞".to_owned()
        } else {
            "−∞".to_owned()
        };
    }
    let magnitude = value.abs();
    if magnitude != 0.0 && magnitude < 5e-5 {
        return format!("{value:.1e}").replace('-', "−");
    }
    let text = trimmed(format!("{value:.4}"));
    if text == "-0" { "0".to_owned() } else { text.replace('-', "−") }
}
