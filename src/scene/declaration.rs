//! The declaration of a value of a scene, whether a part declares it or a model: what paths of
//! [sweeps](super::at::Place) and values of [rows](super::rows::Variable) share.

use super::{Field, Key, field::Kind, part::Fields};
use crate::{
    parameter::{
        Parameter, Value,
        limits::{Limits, number},
    },
    registry::Registry,
};

/// The declaration of a value.
#[derive(Clone, Copy, Debug)]
pub enum Declared {
    /// A field of a part.
    Field(&'static Field),
    /// A parameter of a type or of a material.
    Parameter(&'static Parameter),
}

impl Declared {
    /// The name for people: "roughness".
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Field(field) => field.label(),
            Self::Parameter(parameter) => parameter.label,
        }
    }

    /// The symbol; empty if it has none, or if its values are words that need none.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Parameter(parameter) if parameter.kind.options().is_empty() => parameter.symbol,
            _ => "",
        }
    }

    /// Number of its components.
    #[must_use]
    pub fn components(self) -> usize {
        match self {
            Self::Field(field) => field.kind.entries().len().max(1),
            Self::Parameter(parameter) => parameter.kind.components(),
        }
    }

    /// True for colours.
    #[must_use]
    pub fn is_colour(self) -> bool {
        match self {
            Self::Field(field) => matches!(field.kind, Kind::Colour),
            Self::Parameter(parameter) => parameter.kind.owns(&Value::Colour([0; 3])),
        }
    }

    /// True for whole numbers, and for colours, which consist of them.
    #[must_use]
    pub fn is_whole(self) -> bool {
        match self {
            Self::Field(field) if matches!(field.kind, Kind::Count(_)) => true,
            Self::Parameter(parameter) if parameter.kind.owns(&Value::Integer(0)) => true,
            _ => self.is_colour(),
        }
    }

    /// The value with a number; `None` if it is not a number.
    #[must_use]
    pub fn of_number(self, v: f64) -> Option<Value> {
        match self {
            Self::Field(Field { kind: Kind::Number { .. }, .. }) => Some(Value::Number(v as f32)),
            Self::Field(Field { kind: Kind::Count(_), .. }) => Some(Value::Integer(v.round() as i64)),
            Self::Field(_) => None,
            Self::Parameter(p) => p.kind.is_number().then(|| p.kind.of_numbers([v; 3])),
        }
    }

    /// The legal numbers, if it is a number.
    #[must_use]
    pub fn limits(self) -> Option<Limits> {
        self.of_number(0.0)?;
        match self {
            Self::Field(field) => Some(field.limits()),
            Self::Parameter(p) => p.kind.limits(),
        }
    }

    /// The value that a part has under a key with this declaration, given or by default.
    #[must_use]
    pub fn held(self, part: &dyn Fields, key: Key) -> Option<Value> {
        let given = part.value(key);
        match self {
            Self::Parameter(parameter) => Some(given.unwrap_or_else(|| parameter.default_value())),
            Self::Field(_) => given,
        }
    }

    /// A value in words, with its unit.
    #[must_use]
    pub fn shown(self, value: &Value, registry: &Registry) -> String {
        let numbers = value.numbers().map(number);
        let listed = |unit: &str| match value {
            Value::Triple(_) | Value::Colour(_) => format!("({}){unit}", numbers.join(", ")),
            _ => format!("{}{unit}", numbers[0]),
        };
        match (self, value) {
            (Self::Field(field), Value::Choice(_)) => field.shown(value, registry),
            (Self::Parameter(parameter), Value::Choice(_)) => {
                parameter.kind.caption(parameter.label, value).unwrap_or_else(|| value.to_string())
            }
            (Self::Parameter(parameter), _) => listed(&parameter.suffix()),
            (Self::Field(field), _) => match field.unit {
                "" | "sRGB" => listed(""),
                "°" => listed("°"),
                unit => listed(&format!(" {unit}")),
            },
        }
    }
}
