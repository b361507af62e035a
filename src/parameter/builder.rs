//! Builder methods for declarations of parameters: adding a field to [`Parameter`] does not break existing
//! declarations.

use std::ops::RangeInclusive;

use super::{
    declaration::{Parameter, ParameterKind},
    file::FileFormat,
};

impl Parameter {
    /// A parameter whose symbol and label are its name, without unit and help.
    const fn new(name: &'static str, kind: ParameterKind) -> Self {
        Self { name, symbol: name, label: name, unit: "", help: "", kind, used_when: None }
    }

    /// A real number in a range. From [`ABOVE_ZERO`](super::ABOVE_ZERO) on it is greater than zero.
    ///
    /// ```
    /// use lights_camera_models::parameter::Parameter;
    /// const WIDTH: Parameter = Parameter::number("width", 0.0..=1.0, 0.5)
    ///     .symbol("w")
    ///     .unit("m")
    ///     .help("The width of the stripes.");
    /// assert_eq!(WIDTH.rule(), "between 0 and 1");
    /// ```
    #[must_use]
    pub const fn number(name: &'static str, range: RangeInclusive<f32>, default: f32) -> Self {
        Self::new(name, ParameterKind::Number { min: *range.start(), max: *range.end(), default })
    }

    /// A whole number in a range.
    #[must_use]
    pub const fn integer(name: &'static str, range: RangeInclusive<i64>, default: i64) -> Self {
        let (min, max) = (*range.start(), *range.end());
        Self::new(name, ParameterKind::Integer { min, max: Some(max), slider_max: max, default })
    }

    /// A whole number, that or more; `slider_max` is the end of its slider.
    #[must_use]
    pub const fn integer_from(name: &'static str, min: i64, slider_max: i64, default: i64) -> Self {
        Self::new(name, ParameterKind::Integer { min, max: None, slider_max, default })
    }

    /// A colour: three sRGB-encoded integers, 0–255.
    #[must_use]
    pub const fn colour(name: &'static str, default: [u8; 3]) -> Self {
        Self::new(name, ParameterKind::Colour { default }).unit("sRGB")
    }

    /// Three real numbers in a range, for red, green and blue.
    #[must_use]
    pub const fn triple(name: &'static str, range: RangeInclusive<f32>, default: [f32; 3]) -> Self {
        Self::new(name, ParameterKind::Triple { min: *range.start(), max: *range.end(), default })
    }

    /// One of several choices, the name of each in files and that in the window; the default is an index.
    #[must_use]
    pub const fn choice(
        name: &'static str,
        options: &'static [(&'static str, &'static str)],
        default: usize,
    ) -> Self {
        Self::new(name, ParameterKind::Choice { options, default })
    }

    /// Yes or no: `true` or `false` in scene files.
    ///
    /// ```
    /// use lights_camera_models::parameter::{Parameter, Value};
    /// const TWO_SIDED: Parameter = Parameter::flag("two_sided", true);
    /// assert_eq!(TWO_SIDED.parse("false"), Ok(Value::flag(false)));
    /// ```
    #[must_use]
    pub const fn flag(name: &'static str, default: bool) -> Self {
        Self::new(name, ParameterKind::flag(default))
    }

    /// A file of numbers, for light types and object types; the default is the name of a file that is shipped with the format.
    #[must_use]
    pub const fn file(name: &'static str, format: &'static FileFormat, default: &'static str) -> Self {
        Self::new(name, ParameterKind::File { format, default })
    }

    /// Sets the symbol for equations.
    #[must_use]
    pub const fn symbol(self, symbol: &'static str) -> Self {
        Self { symbol, ..self }
    }

    /// Sets the display label.
    #[must_use]
    pub const fn label(self, label: &'static str) -> Self {
        Self { label, ..self }
    }

    /// Sets the unit.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// Sets a sentence about the parameter's effect.
    #[must_use]
    pub const fn help(self, help: &'static str) -> Self {
        Self { help, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::Value;

    #[test]
    fn every_type_is_declared_with_its_default() {
        const ALL: [(Parameter, Value); 8] = [
            (Parameter::number("a", 0.0..=2.0, 1.5), Value::Number(1.5)),
            (Parameter::integer("b", 1..=16, 4), Value::Integer(4)),
            (Parameter::integer_from("c", 0, 512, 32), Value::Integer(32)),
            (Parameter::colour("d", [1, 2, 3]), Value::Colour([1, 2, 3])),
            (Parameter::triple("e", 0.0..=6.0, [1.0, 2.0, 3.0]), Value::Triple([1.0, 2.0, 3.0])),
            (
                Parameter::choice("f", &[("g", "G"), ("h", "H")], 1),
                Value::Choice(std::borrow::Cow::Borrowed("h")),
            ),
            (Parameter::flag("i", false), Value::flag(false)),
            (Parameter::flag("j", true), Value::flag(true)),
        ];
        for (p, value) in ALL {
            assert_eq!(p.default_value(), value, "{}", p.name);
            assert!(p.allows(&value), "{}", p.name);
        }
        let all = Parameter::number("a", 0.0..=2.0, 1.5).symbol("α").label("shine").unit("m").help("More.");
        assert_eq!((all.symbol, all.label, all.unit, all.help), ("α", "shine", "m", "More."));
    }
}
