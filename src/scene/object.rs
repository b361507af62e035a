//! The objects of a scene.

use glam::Vec3;

use super::{
    Field,
    field::{Ids, Kind},
    part::{Fields as _, Key, part},
};
use crate::{
    parameter::{ABOVE_ZERO, Value, Values},
    registry::Registry,
    shape::{self, ShapeEntry},
};

shape::fields!(part);

impl Object {
    /// Changes the type. Parameters of both types are kept, but not the tessellation, which has a different
    /// meaning for each type.
    pub fn set_type(&mut self, to: &ShapeEntry) {
        self.shape = self.shape.legal(to.parameters);
        self.tessellation = None;
        to.declaration.id.clone_into(&mut self.object_type);
    }

    /// Sets a value within the object, as `put` does. A new type brings what it requires.
    pub(crate) fn set(&mut self, key: Key, value: Option<Value>, registry: &Registry) -> bool {
        if key == Self::object_type.into()
            && let Some(Value::Choice(id)) = &value
            && let Some(entry) = registry.shape(id)
        {
            self.set_type(entry);
            return true;
        }
        self.put(key, value)
    }
}
