//! The coordinates of a search: parameters mapped to numbers from 0 to 1.

use crate::parameter::{Parameter, Value};

/// Maximum tried for a parameter without a legal maximum: an exponent whose highlight is a quarter of a
/// degree wide.
const LARGEST: f64 = 100_000.0;

/// Ratio of the ends of a range above which the range is searched logarithmically.
const WIDE: f64 = 50.0;

/// Step of derivatives, as a fraction of the range: far above the rounding of the models' 32 bits.
const STEP: f64 = 2e-4;

/// Half the distance of the two values of a derivative that tells whether parameters do the same: their rounding would count as a
/// difference if they were nearer.
const SPAN: f64 = 2e-3;

/// A coordinate: a number of a parameter, scaled to 0–1.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// Channel, for colours and triples.
    pub(super) channel: usize,
    low: f64,
    high: f64,
    /// Offset added to the value before taking its logarithm.
    logarithm: Option<f64>,
    /// True for integers.
    pub(super) whole: bool,
}

impl Axis {
    /// The axes of a parameter, which several models may declare with different ranges; `now` is the present
    /// value. Empty for choices and files.
    pub(super) fn of(declarations: &[&'static Parameter], now: &Value) -> Vec<Self> {
        let Some(first) = declarations.first() else { return Vec::new() };
        // Legal for all models.
        let ranges = declarations.iter().filter_map(|p| p.kind.limits()).map(|range| (range.min, range.max));
        let range = ranges.reduce(|a, b| (a.0.max(b.0), a.1.min(b.1)));
        let Some((low, high)) = range.filter(|(low, high)| low < high) else { return Vec::new() };
        let endless = high == f64::INFINITY;
        let top = if endless { LARGEST.max(now.numbers()[0]) } else { high };
        let logarithm = match low {
            _ if endless => Some(1.0 - low),
            low if low > 0.0 && top / low >= WIDE => Some(0.0),
            _ => None,
        };
        let whole = first.kind.limits().is_some_and(|range| range.whole);
        let axis = |channel| Self { channel, low, high: top, logarithm, whole };
        (0..first.kind.components()).map(axis).collect()
    }

    /// The legal value at a coordinate.
    pub(super) fn value(&self, at: f64) -> f64 {
        let at = at.clamp(0.0, 1.0);
        let value = match self.logarithm {
            Some(plus) => {
                let (from, to) = ((self.low + plus).ln(), (self.high + plus).ln());
                (from + at * (to - from)).exp() - plus
            }
            None => self.low + at * (self.high - self.low),
        };
        self.legal(value)
    }

    /// The nearest legal value to a number, as passed to the models.
    pub(super) fn legal(&self, value: f64) -> f64 {
        if self.whole {
            return value.round().clamp(self.low.ceil(), self.high.floor());
        }
        f64::from((value as f32).clamp(self.low as f32, self.high as f32))
    }

    /// The coordinate of a value.
    pub(super) fn coordinate(&self, value: f64) -> f64 {
        let value = value.clamp(self.low, self.high);
        match self.logarithm {
            Some(plus) => {
                let (from, to) = ((self.low + plus).ln(), (self.high + plus).ln());
                ((value + plus).ln() - from) / (to - from)
            }
            None => (value - self.low) / (self.high - self.low),
        }
    }

    /// Legal values below and above another, for a difference between them; at an end of the range, one of them is the value itself.
    pub(super) fn around(&self, value: f64) -> [f64; 2] {
        let at = self.coordinate(value);
        [-1.0, 1.0].map(|sign: f64| {
            let there = self.value(at + sign * SPAN);
            // Whole numbers may be farther apart.
            if self.whole && there == value { self.legal(value + sign) } else { there }
        })
    }

    /// A legal value next to another, for a finite difference.
    pub(super) fn beside(&self, value: f64) -> f64 {
        let at = self.coordinate(value);
        let sign = if at + STEP <= 1.0 { 1.0 } else { -1.0 };
        let there = self.value(at + sign * STEP);
        if there != value {
            return there;
        }
        let next = self.legal(value + sign);
        if next == value { self.legal(value - sign) } else { next }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        parameter::{ALPHA, ALPHA_X, BASE_COLOUR, IOR, K_D},
        registry::Registry,
    };

    #[test]
    fn every_coordinate_is_a_legal_value_and_leads_back() {
        let registry = Registry::builtin();
        let mut seen = 0;
        for parameter in registry.material_parameters() {
            for (i, axis) in Axis::of(&[parameter], &parameter.default_value()).iter().enumerate() {
                assert_eq!(axis.channel, i);
                for step in 0..=10 {
                    let value = axis.value(f64::from(step) / 10.0);
                    let name = parameter.name;
                    assert!(parameter.allows(&parameter.kind.of_numbers([value; 3])), "{name} {value}");
                    assert!(
                        (axis.value(axis.coordinate(value)) - value).abs() <= 1e-5 * value.abs(),
                        "{name}"
                    );
                    let beside = axis.beside(value);
                    assert!(beside != value, "{name} {value}");
                    assert!(parameter.allows(&parameter.kind.of_numbers([beside; 3])), "{name} {beside}");
                    let [below, above] = axis.around(value);
                    assert!(below <= value && value <= above && below < above, "{name} {value}");
                    for there in [below, above] {
                        assert!(parameter.allows(&parameter.kind.of_numbers([there; 3])), "{name} {there}");
                    }
                    seen += 1;
                }
            }
        }
        assert!(seen > 300);
    }

    #[test]
    fn exponents_and_roughness_are_searched_in_logarithms() {
        let axis = |p: &'static Parameter| Axis::of(&[p], &p.default_value()).remove(0);
        // The distance from 100 to 1000 equals that from 1000 to 10 000.
        let at = |v: f64| axis(&ALPHA).coordinate(v);
        assert!(((at(999.0) - at(99.0)) - (at(9999.0) - at(999.0))).abs() < 1e-9);
        let at = |v: f64| axis(&ALPHA_X).coordinate(v);
        assert!(((at(0.1) - at(0.01)) - (at(1.0) - at(0.1))).abs() < 1e-6);
        let at = |v: f64| axis(&K_D).coordinate(v);
        assert!((at(0.75) - 0.5).abs() < 1e-9);
        assert_eq!(Axis::of(&[&IOR], &IOR.default_value()).len(), 3);
        assert_eq!(Axis::of(&[&BASE_COLOUR], &BASE_COLOUR.default_value()).len(), 3);
        assert_eq!(Axis::of(&[&ALPHA], &Value::Integer(1_000_000))[0].value(1.0), 1e6);
    }

    #[test]
    fn a_parameter_of_several_models_stays_legal_for_all_of_them() {
        const NARROW: Parameter = Parameter::number("k_d", 0.25..=0.75, 0.6);
        let axis = &Axis::of(&[&K_D, &NARROW], &Value::Number(0.6))[0];
        assert_eq!((axis.value(0.0), axis.value(1.0)), (0.5, 0.75));
        const APART: Parameter = Parameter::number("k_d", 0.0..=0.25, 0.0);
        assert!(Axis::of(&[&K_D, &APART], &Value::Number(0.6)).is_empty());
    }
}
