//! The value of a parameter.

use std::{borrow::Cow, fmt};

use bevy::reflect::Reflect;
use serde::{Serialize, Serializer};

use super::file::NamedFile;

/// The value of a parameter, as in a scene file.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A real number.
    Number(f32),
    /// A whole number.
    Integer(i64),
    /// An sRGB-encoded colour.
    Colour([u8; 3]),
    /// A number for each of red, green and blue.
    Triple([f32; 3]),
    /// The name of a choice. Those of a flag, `true` and `false`, are written as booleans.
    Choice(#[serde(serialize_with = "choice")] Cow<'static, str>),
    /// A file.
    File(NamedFile),
}

impl Value {
    /// The value of a [flag](super::ParameterKind::flag).
    #[must_use]
    pub const fn flag(on: bool) -> Self {
        Self::Choice(Cow::Borrowed(if on { "true" } else { "false" }))
    }

    /// The value of a flag, or `None` if the value is not a flag's. No other choice has the names `true` and
    /// `false`.
    #[must_use]
    pub fn truth(&self) -> Option<bool> {
        match self {
            Self::Choice(id) => id.parse().ok(),
            _ => None,
        }
    }

    /// The distance to another value of the same type; infinite if no distance is defined.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        match (self, other) {
            (Self::Number(a), Self::Number(b)) => f64::from((a - b).abs()),
            (Self::Integer(a), Self::Integer(b)) => a.abs_diff(*b) as f64,
            (Self::Triple(a), Self::Triple(b)) => {
                a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).sum()
            }
            _ => f64::INFINITY,
        }
    }
}

/// A choice as scene files write it.
fn choice<S: Serializer>(id: &str, serializer: S) -> Result<S::Ok, S::Error> {
    match id.parse() {
        Ok(flag) => serializer.serialize_bool(flag),
        Err(_) => serializer.serialize_str(id),
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(v) => write!(f, "{v}"),
            Self::Integer(v) => write!(f, "{v}"),
            Self::Colour([r, g, b]) => write!(f, "{r},{g},{b}"),
            Self::Triple([r, g, b]) => write!(f, "{r},{g},{b}"),
            Self::Choice(v) => f.write_str(v),
            Self::File(v) => f.write_str(v.name()),
        }
    }
}

/// A value as scene files write it.
#[must_use]
pub fn json(value: &Value) -> serde_json::Value {
    match value {
        Value::Number(v) => crate::text::number(*v),
        Value::Integer(v) => (*v).into(),
        Value::Colour(rgb) => serde_json::json!(rgb),
        Value::Triple(v) => v.iter().map(|c| crate::text::number(*c)).collect(),
        Value::Choice(v) => value.truth().map_or_else(|| v.as_ref().into(), Into::into),
        Value::File(v) => v.name().into(),
    }
}
