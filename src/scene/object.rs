//! The objects of a scene.

use std::sync::Arc;

use glam::{Mat4, Vec3};

use super::{
    Field, Repeat,
    field::{Ids, Kind},
    part::{self, Fields, Key, part},
    rotation::rotation,
};
use crate::{
    parameter::{ABOVE_ZERO, Value, Values},
    registry::Registry,
    shape::{self, ShapeEntry},
};

shape::fields!(part);

/// The part of an object in a row or a grid. Files have entries, scenes in memory their copies: see
/// [`Scene::expanded`](super::Scene::expanded).
#[derive(Clone, Debug, Default)]
pub enum Repetition {
    /// It is a single object.
    #[default]
    None,
    /// It stands for all copies, as in a file.
    Entry(Box<Repeat>),
    /// It is one of the copies.
    Copy {
        /// The object as in a file.
        entry: Arc<Object>,
        /// The number of the copy, from 0.
        number: u32,
    },
}

impl PartialEq for Repetition {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::None, Self::None) => true,
            (Self::Entry(a), Self::Entry(b)) => a == b,
            // Copies of one row share their entry.
            (Self::Copy { entry: a, number: i }, Self::Copy { entry: b, number: j }) => {
                i == j && (Arc::ptr_eq(a, b) || a == b)
            }
            _ => false,
        }
    }
}

impl part::Held for Repetition {
    /// The row of an entry; a copy alone is written as a single object.
    fn parts(&self) -> Vec<&dyn Fields> {
        match self {
            Self::Entry(repeat) => vec![&**repeat],
            Self::None | Self::Copy { .. } => Vec::new(),
        }
    }
}

impl Object {
    /// The transformation from the object's own coordinates to the room: unit mesh → size → rotation → position.
    #[must_use]
    pub fn room_from_object(&self) -> Mat4 {
        Mat4::from_scale_rotation_translation(Vec3::splat(self.size), rotation(self.rotation), self.position)
    }

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
