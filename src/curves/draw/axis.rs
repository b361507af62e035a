//! Axes: ranges and the positions of their labels.

use crate::text::superscript;

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity, with its unit.
    pub label: String,
    /// The smallest value.
    pub from: f64,
    /// The largest value.
    pub to: f64,
    /// True if the axis is logarithmic.
    pub log: bool,
    /// The approximate number of labels.
    pub ticks: usize,
}

/// Steps between angles, degrees.
const DEGREES: [f64; 8] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0];

impl Axis {
    /// An axis with a linear scale.
    #[must_use]
    pub fn new(label: &str, from: f64, to: f64, ticks: usize) -> Self {
        Self { label: label.to_owned(), from, to, log: false, ticks }
    }

    /// An axis with a logarithmic scale.
    #[must_use]
    pub fn log(label: &str, from: f64, to: f64) -> Self {
        let ticks = (to.log10() - from.log10()).ceil() as usize + 1;
        Self { label: label.to_owned(), from, to, log: true, ticks }
    }

    /// The position of a value: 0 at the start of the axis and 1 at its end.
    #[must_use]
    pub fn place(&self, v: f64) -> f64 {
        let at = |v: f64| match self.log {
            // Zero is far outside, and NaN stays NaN.
            true if v <= 0.0 => -30.0,
            true => v.log10(),
            false => v,
        };
        (at(v) - at(self.from)) / (at(self.to) - at(self.from))
    }

    /// The values with marks on the axis, each with its label, which may be empty.
    pub(super) fn marks(&self) -> Vec<(f64, String)> {
        if self.log { self.powers() } else { self.steps() }
    }

    fn steps(&self) -> Vec<(f64, String)> {
        let step = self.step();
        let count = ((self.to - self.from) / step).ceil() as i64 + 1;
        let first = (self.from / step).ceil() as i64;
        // Multiples of the step, so that 0 is 0.
        let values = (first..first + count).map(|i| i as f64 * step);
        values.filter(|v| *v <= self.to + 1e-6 * step).map(|v| (v, self.text(v))).collect()
    }

    /// The distance between labels.
    fn step(&self) -> f64 {
        let rough = (self.to - self.from).abs() / self.ticks.saturating_sub(1).max(1) as f64;
        if rough <= 0.0 || !rough.is_finite() {
            return 1.0;
        }
        let off = |step: &f64| (step / rough).ln().abs();
        let nearest = |steps: &[f64]| steps.iter().copied().min_by(|a, b| off(a).total_cmp(&off(b)));
        let power = 10f64.powf(rough.log10().floor());
        let decimal = [1.0, 2.0, 5.0, 10.0].map(|m| m * power);
        let steps: &[f64] = if self.label.contains("(°)") && rough > 1.0 { &DEGREES } else { &decimal };
        nearest(steps).unwrap_or(1.0)
    }

    fn powers(&self) -> Vec<(f64, String)> {
        let (low, high) = (self.from.log10(), self.to.log10());
        let every = if high - low > 9.0 { 2 } else { 1 };
        let within = |v: f64| (low - 1e-6..=high + 1e-6).contains(&v.log10());
        let mut marks = Vec::new();
        for power in low.floor() as i32..=high.ceil() as i32 {
            for digit in 1..10i32 {
                let value = f64::from(digit) * 10f64.powi(power);
                let labelled = if digit == 1 {
                    power % every == 0
                } else {
                    high - low < 2.0 && [2, 5].contains(&digit) && (-2..=2).contains(&power)
                };
                if within(value) && (every == 1 || digit == 1) {
                    let label = match (labelled, digit) {
                        (false, _) => String::new(),
                        (true, 1) => self.text(power.into()),
                        (true, _) => format!("{}", (value * 1e6).round() / 1e6),
                    };
                    marks.push((value, label));
                }
            }
        }
        marks
    }

    /// The label of a value; on a logarithmic axis, of a power of ten.
    pub(super) fn text(&self, at: f64) -> String {
        if !self.log {
            // 0.2, but 0.25: as many digits as the step has.
            let whole = |digits: &usize| {
                let scaled = self.step() * 10f64.powi(*digits as i32);
                (scaled - scaled.round()).abs() < 1e-6 * scaled
            };
            let digits = (0..9).find(whole).unwrap_or(9);
            return format!("{:.*}", digits, at + 0.0).replace('-', "−");
        }
        if (at - at.round()).abs() > 1e-6 {
            return String::new();
        }
        let power = at.round() as i32;
        // Numbers or powers, but not both on one axis, except near 1.
        let short = self.from > 0.000_99 && self.to < 1001.0;
        if short && (-3..=3).contains(&power) || (-1..=1).contains(&power) {
            return format!("{}", 10f64.powi(power));
        }
        format!("10{}", power.to_string().chars().map(superscript).collect::<String>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.marks().into_iter().map(|(_, label)| label).filter(|label| !label.is_empty()).collect()
    }

    #[test]
    fn logarithmic_axes_are_labelled_at_powers_of_ten() {
        let axis = Axis::log("f", 1e-4, 1e4);
        assert_eq!(
            ["10⁻²", "0.1", "1", "10³", "10⁻⁴", "10⁴", ""],
            [-2.0, -1.0, 0.0, 3.0, -4.0, 4.0, 0.5].map(|x| axis.text(x))
        );
        assert_eq!(labels(&Axis::log("f", 0.1, 1000.0)), ["0.1", "1", "10", "100", "1000"]);
        assert_eq!(
            labels(&Axis::log("f", 0.1, 2.0)),
            ["0.1", "0.2", "0.5", "1", "2"],
            "few decades, more labels"
        );
        assert_eq!(labels(&Axis::log("f", 1e-6, 1e6)).len(), 7, "many decades, every other one");
    }

    #[test]
    fn labels_are_round_numbers() {
        assert_eq!(Axis::new("θ (°)", -90.0, 90.0, 7).text(-30.0), "−30");
        assert_eq!(labels(&Axis::new("θ (°)", -90.0, 90.0, 7)), ["−90", "−60", "−30", "0", "30", "60", "90"]);
        assert_eq!(labels(&Axis::new("E", 0.0, 1.0, 6)), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(&Axis::new("f", 0.0, 2000.0, 5)), ["0", "500", "1000", "1500", "2000"]);
        assert_eq!(labels(&Axis::new("f", -0.05, 0.05, 3)), ["−0.05", "0.00", "0.05"]);
        assert_eq!(labels(&Axis::new("flat", 1.0, 1.0, 3)), ["1"]);
    }

    #[test]
    fn places_are_parts_of_the_axis() {
        let log = Axis::log("f", 0.01, 100.0);
        assert!((log.place(1.0) - 0.5).abs() < 1e-12 && log.place(0.0) < -5.0 && log.place(-1.0) < -5.0);
        assert!(log.place(f64::NAN).is_nan());
        assert!((Axis::new("x", -1.0, 1.0, 3).place(0.5) - 0.75).abs() < 1e-12);
    }
}
