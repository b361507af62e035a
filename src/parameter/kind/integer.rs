//! A whole number.

use std::ops::RangeInclusive;

use serde_json::json;

use super::{
    Cursor, Declarations, Header, Json, Kind, Limits, Parameter, ParameterKind, Payload, Place, Reader, Type,
    Value,
};
use crate::text::json;

/// The content of a value.
pub type Given = i64;
/// The field of a struct of parameters.
pub type Field = f32;

/// A whole number with a lower bound and perhaps an upper one.
#[derive(Clone, Debug, PartialEq)]
pub struct Integer {
    /// Smallest legal value.
    pub min: i64,
    /// Largest legal value, if there is one.
    pub max: Option<i64>,
    /// The end of a slider if there is no largest value.
    pub slider_max: i64,
    /// The value if the scene gives none.
    pub default: i64,
}

impl Parameter {
    /// A whole number in a range.
    #[must_use]
    pub const fn integer(name: &'static str, range: RangeInclusive<i64>, default: i64) -> Self {
        let (min, max) = (*range.start(), *range.end());
        Self::new(name, ParameterKind::Integer(Integer { min, max: Some(max), slider_max: max, default }))
    }

    /// A whole number, that or more; `slider_max` is the end of its slider.
    #[must_use]
    pub const fn integer_from(name: &'static str, min: i64, slider_max: i64, default: i64) -> Self {
        Self::new(name, ParameterKind::Integer(Integer { min, max: None, slider_max, default }))
    }
}

impl Kind for Integer {
    fn name(&self) -> &'static str {
        "integer"
    }

    fn default_value(&self) -> Value {
        Value::Integer(self.default)
    }

    fn rule(&self) -> String {
        let Self { min, max, .. } = self;
        match max {
            Some(max) => format!("a whole number between {min} and {max}"),
            None => format!("a whole number, {min} or more"),
        }
    }

    fn parse(&self, text: &str) -> Option<Value> {
        json::whole(text.trim()).map(Value::Integer)
    }

    fn excess(&self, text: &str) -> String {
        let beyond = text.trim().parse::<f64>().is_ok_and(|v| v > json::EXACT as f64);
        if beyond && self.max.is_none() { format!(" and at most {}", json::EXACT) } else { String::new() }
    }

    fn read(&self, reader: &mut dyn Reader, value: Cursor, rule: &str, _: Place) -> Option<Value> {
        let excess = self.excess(value.literal().unwrap_or_default());
        reader.integer(value, &format!("{rule}{excess}")).map(Value::Integer)
    }

    fn schema(&self) -> Json {
        let mut schema = json!({ "type": "integer", "minimum": self.min });
        if let Some(max) = self.max {
            schema["maximum"] = max.into();
        }
        schema
    }

    fn keys(&self) -> Vec<(&'static str, Json)> {
        vec![("min", self.min.into()), ("max", self.max.into()), ("slider_max", self.slider_max.into())]
    }

    fn check(&self) -> Result<(), String> {
        let (min, top) = (self.min, self.max.unwrap_or(self.slider_max));
        if min <= top {
            return Ok(());
        }
        Err(format!("its range is {min} to {top}, but the smaller one must be first"))
    }

    fn limits(&self) -> Option<Limits> {
        let Self { min, max, slider_max, .. } = *self;
        let slider = max.unwrap_or(slider_max).min(slider_max.max(min + 1));
        let limits = Limits::between(min as f64, max.map_or(f64::INFINITY, |max| max as f64)).whole();
        Some(Limits { slider_max: slider as f64, ..limits })
    }

    fn of_numbers(&self, [first, ..]: [f64; 3]) -> Value {
        Value::Integer(first.round() as i64)
    }

    fn caption(&self, _: &str, value: &Value) -> Option<String> {
        Some(value.to_string())
    }
}

/// The type in custom models.
pub(super) const TYPES: &[Type] = &[Type {
    name: "integer",
    keys: &["range", "min", "max", "slider_max"],
    fits: |_| false,
    read: declared,
}];

fn declared(header: &mut Header) -> Option<ParameterKind> {
    let known = match header.shared {
        Some(ParameterKind::Integer(known)) => Some(known),
        _ => None,
    };
    let limits = header.limits(known.map_or((0, None), |known| (known.min, known.max)), whole, None);
    let given = header.given("default", whole)?;
    let slider_given = header.given("slider_max", whole)?;
    let (min, max) = limits?;
    let inside = |v: &i64| *v >= min && max.is_none_or(|m| *v <= m);
    let default = given.or(known.map(|known| known.default).filter(inside)).unwrap_or(min);
    let slider = slider_given.or(known.map(|known| known.slider_max).filter(|s| *s > min));
    let slider_max =
        max.map_or_else(|| slider.unwrap_or(default.max(min) + 16), |m| slider.unwrap_or(m).min(m));
    if slider_max <= min {
        if let Some(value) = header.fields.get("slider_max") {
            let rule = format!("it must be greater than {min}, the start of the slider");
            header.reader.wrong(value, &rule);
        }
        return None;
    }
    header.within(ParameterKind::Integer(Integer { min, max, slider_max, default }))
}

/// An integer that a 32-bit float represents exactly, as in the shader.
fn whole(reader: &mut dyn Declarations, value: Cursor) -> Option<i64> {
    const EXACT: i64 = 1 << 24;
    let number = value.integer().filter(|n| (-EXACT..=EXACT).contains(n));
    if number.is_none() {
        reader.wrong(value, &format!("it must be a whole number between -{EXACT} and {EXACT}"));
    }
    number
}

impl Payload for i64 {
    fn text(&self) -> String {
        self.to_string()
    }

    fn json(&self) -> Json {
        (*self).into()
    }

    fn numbers(&self) -> [f64; 3] {
        [*self as f64; 3]
    }
}
