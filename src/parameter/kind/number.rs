//! A real number.

use std::ops::RangeInclusive;

use serde_json::json;

use super::{
    ABOVE_ZERO, Cursor, Declarations, Encoding, Header, Json, Kind, Limits, Member, Parameter, ParameterKind,
    Payload, Place, Reader, Type, Value, check_range, header, text::number,
};
use crate::parameter::limits::end;

/// The content of a value.
pub type Given = f32;
/// The field of a struct of parameters.
pub type Field = f32;

/// A real number in a closed range.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Smallest legal value.
    pub min: f32,
    /// Largest legal value.
    pub max: f32,
    /// The end of the slider.
    pub slider_max: f32,
    /// The value if the scene gives none.
    pub default: f32,
}

impl Parameter {
    /// A real number in a range. From [`ABOVE_ZERO`] on it is greater than zero.
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
        let (min, max) = (*range.start(), *range.end());
        Self::new(name, ParameterKind::Number(Number { min, max, slider_max: max, default }))
    }

    /// The parameter, a real number, with a slider that ends before its range; larger values are typed.
    ///
    /// ```
    /// use lights_camera_models::parameter::Parameter;
    /// const GLOW: Parameter = Parameter::number("glow", 0.0..=1e4, 0.1).slider_to(1.0);
    /// assert_eq!(GLOW.rule(), "between 0 and 10000");
    /// ```
    #[must_use]
    pub const fn slider_to(mut self, end: f32) -> Self {
        if let ParameterKind::Number(number) = &mut self.kind {
            number.slider_max = end;
        }
        self
    }
}

impl Kind for Number {
    fn name(&self) -> &'static str {
        "number"
    }

    fn default_value(&self) -> Value {
        Value::Number(self.default)
    }

    fn rule(&self) -> String {
        match self.min {
            ABOVE_ZERO => format!("greater than 0 and at most {}", end(self.max)),
            min => format!("between {} and {}", end(min), end(self.max)),
        }
    }

    fn parse(&self, text: &str) -> Option<Value> {
        text.trim().parse().ok().map(Value::Number)
    }

    fn read(&self, reader: &mut dyn Reader, value: Cursor, rule: &str, _: Place) -> Option<Value> {
        reader.number(value, rule).map(Value::Number)
    }

    fn schema(&self) -> Json {
        let whole = |v: f32| if v.fract() == 0.0 { (v as i64).into() } else { number(v) };
        let mut schema = match self.min {
            ABOVE_ZERO => json!({ "type": "number", "exclusiveMinimum": 0 }),
            min => json!({ "type": "number", "minimum": whole(min) }),
        };
        if self.max.is_finite() {
            schema["maximum"] = whole(self.max);
        }
        schema
    }

    fn keys(&self) -> Vec<(&'static str, Json)> {
        header::ends(self.min, self.max)
    }

    fn check(&self) -> Result<(), String> {
        check_range(self.min, self.max)
    }

    fn limits(&self) -> Option<Limits> {
        Some(Limits { slider_max: self.slider_max.into(), ..Limits::of(self.min, self.max) })
    }

    fn of_numbers(&self, [first, ..]: [f64; 3]) -> Value {
        Value::Number(first as f32)
    }
}

/// The type in custom models, also of declarations that name no type and fit no other.
pub(super) const TYPES: &[Type] =
    &[Type { name: "number", keys: &["range", "min", "max", "above"], fits: |_| false, read: declared }];

fn declared(header: &mut Header) -> Option<ParameterKind> {
    let usual = match header.shared {
        Some(ParameterKind::Number(known)) => Some((known.min, known.max, [known.default; 3])),
        _ => None,
    };
    let (min, max, [default, ..]) = header.real(usual, one)?;
    header.within(ParameterKind::Number(Number { min, max, slider_max: max, default }))
}

fn one(reader: &mut dyn Declarations, value: Cursor) -> Option<[f32; 3]> {
    Some([header::number(reader, value)?; 3])
}

impl Payload for f32 {
    fn text(&self) -> String {
        self.to_string()
    }

    fn json(&self) -> Json {
        number(*self)
    }

    fn numbers(&self) -> [f64; 3] {
        [f64::from(*self); 3]
    }
}

impl Member for f32 {
    fn of(kind: &ParameterKind, value: &Value, encoding: Encoding) -> Self {
        let index = || u32::of(kind, value, encoding) as Self;
        if kind.options().is_empty() { value.numbers()[0] as Self } else { index() }
    }

    fn numbers(&self) -> [f32; 3] {
        [*self; 3]
    }
}
