//! The values of parameters, by name.

use std::{borrow::Cow, collections::BTreeMap};

use bevy_reflect::Reflect;
use glam::Vec3;
use serde::Serialize;

use super::{
    Parameter,
    file::Table,
    kind::{Member, Value},
};
use crate::optics::colour::Encoding;

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

    /// A value for each of some parameters, in order.
    #[must_use]
    pub fn each<'p>(
        parameters: impl IntoIterator<Item = &'p Parameter>,
        mut value: impl FnMut(&Parameter) -> Value,
    ) -> Self {
        Self(parameters.into_iter().map(|p| (p.name.into(), value(p))).collect())
    }

    /// Sets a parameter.
    pub fn set(&mut self, name: impl Into<Cow<'static, str>>, value: Value) {
        self.0.insert(name.into(), value);
    }

    /// The values that are legal for one of some parameters.
    #[must_use]
    pub fn legal(&self, parameters: &[Parameter]) -> Self {
        let legal = |p: &Parameter| {
            self.0.get_key_value(p.name).filter(|(_, v)| p.allows(v)).map(|(k, v)| (k.clone(), v.clone()))
        };
        Self(parameters.iter().filter_map(legal).collect())
    }

    /// The parameter as a field of a struct of [`parameters!`](crate::parameters).
    #[must_use]
    pub fn field<T: Member>(&self, parameter: &Parameter, encoding: Encoding) -> T {
        T::of(&parameter.kind, &self.get(parameter), encoding)
    }

    /// The parameter as a number for calculation; of three numbers, the first.
    #[must_use]
    pub fn number(&self, parameter: &Parameter) -> f32 {
        self.field(parameter, Encoding::default())
    }

    /// The parameter as a linear colour, or as its three numbers, for calculation; zero if it is neither.
    #[must_use]
    pub fn colour(&self, parameter: &Parameter, encoding: Encoding) -> Vec3 {
        self.field(parameter, encoding)
    }

    /// The file and its numbers; none if it is not a file.
    #[must_use]
    pub fn table(&self, parameter: &Parameter) -> Option<Table> {
        Some(self.field(parameter, Encoding::default())).filter(|table: &Table| table.file.is_some())
    }

    /// The index of the chosen option; 0 if it is not a choice.
    #[must_use]
    pub fn choice(&self, parameter: &Parameter) -> u32 {
        self.field(parameter, Encoding::default())
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
