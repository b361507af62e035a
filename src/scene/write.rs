//! A scene as it is written, by serde.

use serde::{Serialize, Serializer, ser::SerializeMap};

use super::{
    Scene,
    field::{Field, Kind},
    layout::{ShortNumbers, pretty},
    part::{Fields, Held, Key},
};
use crate::{
    parameter::{Parameter, Value, Values},
    registry::Registry,
};

/// The text of a scene file: the sections in the order of the CA, short values on one line, numbers as short
/// as possible without loss. `schema` is the value of `$schema`, if any.
///
/// Only valid scenes can be read back; [`save::write`](super::save::write()) checks, this function does not.
#[must_use]
pub fn to_json(scene: &Scene, schema: Option<&str>, registry: &Registry) -> String {
    let mut compact = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut compact, ShortNumbers);
    // Writing to memory, with text as keys, cannot fail.
    let materials: Vec<_> = registry.material_parameters().collect();
    let scene = scene.gathered(registry);
    let _ = Written { part: &*scene, schema, materials: &materials, registry }.serialize(&mut serializer);
    let compact = String::from_utf8_lossy(&compact);
    pretty(&compact).unwrap_or_else(|| compact.into_owned())
}

/// A part as written: fields equal to the default are left out, unless they are always written. Parameters are in the
/// order of their declarations.
pub(super) struct Written<'a> {
    pub(super) part: &'a dyn Fields,
    /// The address of the schema of a scene, if it gives one.
    pub(super) schema: Option<&'a str>,
    /// The parameters of materials.
    pub(super) materials: &'a [&'static Parameter],
    pub(super) registry: &'a Registry,
}

impl Serialize for Written<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        if let Some(schema) = self.schema {
            map.serialize_entry("$schema", schema)?;
        }
        let mut done = Ok(());
        self.part.each(&mut |field, held, default| {
            if done.is_ok() {
                done = self.field(&mut map, field, held, default);
            }
        });
        done?;
        map.end()
    }
}

impl<'a> Written<'a> {
    fn field<M: SerializeMap>(
        &self,
        map: &mut M,
        field: &'static Field,
        held: &'a dyn Held,
        default: &dyn Held,
    ) -> Result<(), M::Error> {
        let parts = || held.parts().into_iter().map(|part| Self { part, schema: None, ..*self });
        let value = held.value();
        match (field.kind, held.values()) {
            (Kind::Part, _) => parts()
                .filter(|written| field.always || differs(written.part))
                .try_for_each(|written| map.serialize_entry(field.key, &written)),
            (Kind::Parts, _) if field.always || parts().next().is_some() => {
                map.serialize_entry(field.key, &parts().collect::<Vec<_>>())
            }
            (Kind::List, _) if !held.list().is_empty() => map.serialize_entry(field.key, held.list()),
            (Kind::Parameters, Some(values)) => ordered(values, self.part.parameters(self.registry).iter())
                .into_iter()
                .try_for_each(|(name, value)| map.serialize_entry(name, value)),
            (Kind::Material, Some(values)) if !values.0.is_empty() => {
                map.serialize_entry(field.key, &Ordered(ordered(values, self.materials.iter().copied())))
            }
            _ if field.instead.is_some_and(|other| self.part.value(Key::Own(other)).is_some()) => Ok(()),
            _ if !field.always && value == default.value() => Ok(()),
            _ => match (field.kind, value) {
                // A name may be a word that would be a flag.
                (Kind::Text(_), Some(Value::Choice(text))) => map.serialize_entry(field.key, &text),
                (_, Some(value)) => map.serialize_entry(field.key, &value),
                (_, None) => Ok(()),
            },
        }
    }
}

/// The values in the order of the declarations; undeclared ones come last.
fn ordered(values: &Values, declared: impl Iterator<Item = &'static Parameter>) -> Vec<(&str, &Value)> {
    let mut ordered: Vec<_> = declared.filter_map(|p| Some((p.name, values.0.get(p.name)?))).collect();
    if ordered.len() < values.0.len() {
        for (name, value) in &values.0 {
            if !ordered.iter().any(|(n, _)| n == name) {
                ordered.push((name, value));
            }
        }
    }
    ordered
}

/// Parameters in this order.
struct Ordered<'a>(Vec<(&'a str, &'a Value)>);

impl Serialize for Ordered<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

/// True if any field of a part differs from its default.
fn differs(part: &dyn Fields) -> bool {
    let mut differs = false;
    part.each(&mut |_, held, default| differs |= held.value() != default.value());
    differs
}
