//! The values of parameters, by name.

use std::{borrow::Cow, collections::BTreeMap, ops::RangeInclusive};

use bevy::reflect::Reflect;
use glam::Vec3;
use serde::Serialize;

use super::{
    declaration::{Parameter, ParameterKind},
    file::Table,
    value::Value,
};
use crate::optics::colour::Encoding;

/// The components of a linear colour, which may be beyond their range by as much as 8 bits round it away.
const LINEAR: RangeInclusive<f32> = -0.5 / 255.0 / 12.92..=1.0 + 0.5 / 255.0;

/// The parameters given by a scene for one object, by name. Absent ones have their defaults; those not used by the
/// current model are kept.
#[derive(Clone, Debug, Default, PartialEq, Reflect, Serialize)]
#[serde(transparent)]
pub struct Values(pub BTreeMap<Cow<'static, str>, Value>);

impl Values {
    /// The value of a parameter: the scene's, or the declared default if the scene has none of a legal type and range.
    #[must_use]
    pub fn get(&self, parameter: &Parameter) -> Value {
        match self.0.get(parameter.name) {
            Some(value) if parameter.allows(value) => value.clone(),
            _ => parameter.default_value(),
        }
    }

    /// Sets a parameter.
    pub fn set(&mut self, name: impl Into<Cow<'static, str>>, value: Value) {
        self.0.insert(name.into(), value);
    }

    /// Those values that are legal for one of some parameters.
    #[must_use]
    pub fn legal(&self, parameters: &[Parameter]) -> Self {
        let legal = |p: &Parameter| {
            self.0.get_key_value(p.name).filter(|(_, v)| p.allows(v)).map(|(k, v)| (k.clone(), v.clone()))
        };
        Self(parameters.iter().filter_map(legal).collect())
    }

    /// Sets a parameter from the numbers for calculation: a linear colour is encoded to 8 bits, the index of a choice
    /// becomes its name. All but colours and triples read the first number. Numbers that are no colour become a triple, an
    /// index of no choice stays a number: neither is a legal value.
    pub fn put(&mut self, parameter: &Parameter, numbers: [f32; 3], encoding: Encoding) {
        let [first, ..] = numbers;
        let value = match &parameter.kind {
            ParameterKind::Number { .. } => Value::Number(first),
            ParameterKind::Integer { .. } => Value::Integer(first.round() as i64),
            ParameterKind::Colour { .. } if numbers.iter().all(|v| LINEAR.contains(v)) => {
                Value::Colour(encoding.encode(numbers.into()))
            }
            ParameterKind::Colour { .. } => Value::Triple(numbers),
            ParameterKind::Triple { .. } => Value::Triple(numbers),
            ParameterKind::Choice { options, .. } => match options.get(first as usize) {
                Some((id, _)) => Value::Choice((*id).into()),
                None => Value::Integer(first as i64),
            },
            ParameterKind::File { .. } => parameter.default_value(),
        };
        self.set(parameter.name, value);
    }

    /// The parameter as a number for calculation; of three numbers, the first.
    #[must_use]
    pub fn number(&self, parameter: &Parameter) -> f32 {
        match self.get(parameter) {
            Value::Number(v) => v,
            Value::Integer(v) => v as f32,
            Value::Colour([r, ..]) => f32::from(r),
            Value::Triple([r, ..]) => r,
            Value::Choice(_) => self.choice(parameter) as f32,
            Value::File(_) => 0.0,
        }
    }

    /// The parameter as a linear colour, or as its three numbers, for calculation; zero if it is neither.
    #[must_use]
    pub fn colour(&self, parameter: &Parameter, encoding: Encoding) -> Vec3 {
        match self.get(parameter) {
            Value::Colour(rgb) => encoding.decode(rgb),
            Value::Triple(v) => v.into(),
            _ => Vec3::ZERO,
        }
    }

    /// The file and its numbers; none if it is not a file.
    #[must_use]
    pub fn table(&self, parameter: &Parameter) -> Option<Table> {
        match self.get(parameter) {
            Value::File(file) => file.numbers().map(|numbers| Table { file: Some(file), numbers }),
            _ => None,
        }
    }

    /// The index of the chosen option; 0 if it is not a choice.
    #[must_use]
    pub fn choice(&self, parameter: &Parameter) -> u32 {
        match (&parameter.kind, self.get(parameter)) {
            (ParameterKind::Choice { options, .. }, Value::Choice(v)) => {
                options.iter().position(|(id, _)| *id == v.as_ref()).unwrap_or(0) as u32
            }
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::shared::K_D;

    #[test]
    fn values_outside_the_range_fall_back_to_the_default() {
        let mut values = Values::default();
        values.set("k_d", Value::Number(0.2));
        assert_eq!(values.get(&K_D), Value::Number(0.8));
        values.set("k_d", Value::Number(0.6));
        assert_eq!(values.get(&K_D), Value::Number(0.6));
        values.set("k_d", Value::Number(f32::NAN));
        assert_eq!(values.get(&K_D), Value::Number(0.8));
    }
}
