//! A number for each of red, green and blue.

use std::ops::RangeInclusive;

use serde_json::json;

use super::{
    Cursor, Declarations, Encoding, Header, Json, Kind, Limits, Member, Parameter, ParameterKind, Payload,
    Place, Reader, Type, Value, Vec3, check_range, header, joined,
    text::{self, number},
};
use crate::parameter::limits::end;

/// The content of a value.
pub type Given = [f32; 3];
/// The field of a struct of parameters.
pub type Field = Vec3;

/// Three real numbers in a closed range, for red, green and blue. Files may give one number for all three.
#[derive(Clone, Debug, PartialEq)]
pub struct Triple {
    /// Smallest legal value.
    pub min: f32,
    /// Largest legal value.
    pub max: f32,
    /// The value if the scene gives none.
    pub default: [f32; 3],
}

impl Parameter {
    /// Three real numbers in a range, for red, green and blue.
    #[must_use]
    pub const fn triple(name: &'static str, range: RangeInclusive<f32>, default: [f32; 3]) -> Self {
        let (min, max) = (*range.start(), *range.end());
        Self::new(name, ParameterKind::Triple(Triple { min, max, default }))
    }
}

impl Kind for Triple {
    fn name(&self) -> &'static str {
        "triple"
    }

    fn default_value(&self) -> Value {
        Value::Triple(self.default)
    }

    fn rule(&self) -> String {
        let [min, max] = [self.min, self.max].map(end);
        format!("three numbers between {min} and {max}, [red, green, blue], or one for all")
    }

    fn parse(&self, text: &str) -> Option<Value> {
        match text::numbers(text)?[..] {
            [all] => Some(Value::Triple([all; 3])),
            [r, g, b] => Some(Value::Triple([r, g, b])),
            _ => None,
        }
    }

    fn read(&self, reader: &mut dyn Reader, value: Cursor, rule: &str, _: Place) -> Option<Value> {
        match value.list() {
            None if value.number().is_some() => value.number().map(|v| Value::Triple([v; 3])),
            Some(list) if list.len() == 3 => {
                let mut triple = [Some(0.0); 3];
                for (to, element) in triple.iter_mut().zip(list) {
                    *to = reader.number(value.holding(element.value), rule);
                }
                let [r, g, b] = triple;
                Some(Value::Triple([r?, g?, b?]))
            }
            _ => {
                reader.wrong(value, rule);
                None
            }
        }
    }

    fn schema(&self) -> Json {
        let one = json!({ "type": "number", "minimum": number(self.min), "maximum": number(self.max) });
        json!({ "oneOf": [one, { "type": "array", "items": one, "minItems": 3, "maxItems": 3 }] })
    }

    fn keys(&self) -> Vec<(&'static str, Json)> {
        header::ends(self.min, self.max)
    }

    fn check(&self) -> Result<(), String> {
        check_range(self.min, self.max)
    }

    fn limits(&self) -> Option<Limits> {
        Some(Limits::between(self.min.into(), self.max.into()))
    }

    fn of_numbers(&self, numbers: [f64; 3]) -> Value {
        Value::Triple(numbers.map(|v| v as f32))
    }

    fn wgsl(&self) -> &'static str {
        "vec3<f32>"
    }

    fn linear(&self, value: &Value, _: Encoding) -> Option<Vec3> {
        let Value::Triple(v) = value else { return None };
        Some((*v).into())
    }
}

/// The type in custom models.
pub(super) const TYPES: &[Type] = &[Type {
    name: "triple",
    keys: &["range", "min", "max", "above"],
    fits: header::has_list,
    read: declared,
}];

fn declared(header: &mut Header) -> Option<ParameterKind> {
    let usual = match header.shared {
        Some(ParameterKind::Triple(known)) => Some((known.min, known.max, known.default)),
        _ => None,
    };
    let (min, max, default) = header.real(usual, three)?;
    header.within(ParameterKind::Triple(Triple { min, max, default }))
}

/// Three numbers, or one for all three.
fn three(reader: &mut dyn Declarations, value: Cursor) -> Option<[f32; 3]> {
    match value.list() {
        None if value.number().is_some() => Some([header::number(reader, value)?; 3]),
        Some(list) if list.len() == 3 => {
            let mut triple = [0.0; 3];
            for (to, element) in triple.iter_mut().zip(list) {
                *to = header::number(reader, value.holding(element.value))?;
            }
            Some(triple)
        }
        _ => {
            reader.wrong(value, "it must be three numbers, [red, green, blue], or one for all");
            None
        }
    }
}

impl Payload for [f32; 3] {
    fn text(&self) -> String {
        joined(self)
    }

    fn json(&self) -> Json {
        self.iter().map(|v| number(*v)).collect()
    }

    fn numbers(&self) -> [f64; 3] {
        self.map(f64::from)
    }
}

impl Member for Vec3 {
    fn of(kind: &ParameterKind, value: &Value, encoding: Encoding) -> Self {
        kind.linear(value, encoding).unwrap_or_default()
    }

    fn numbers(&self) -> [f32; 3] {
        self.to_array()
    }
}
