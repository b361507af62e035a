//! The objects of a scene.

use std::sync::Arc;

use glam::Vec3;

use super::{
    Field, Repeat,
    field::{Ids, Kind},
    part::{self, Fields, Key, part},
};
use crate::{
    parameter::{ABOVE_ZERO, Value, Values},
    registry::Registry,
    shape::ShapeEntry,
};

part! {
    /// An object.
    pub struct Object("an object") {
        /// Object type.
        object_type["type"]: String = Field::of("the type", Kind::Id(Ids::ObjectType)).required(""), "sphere".to_owned();
        /// Name of the object.
        name: Option<String> = Field::of("the name", Kind::Text(None)), None;
        /// False if hidden.
        visible: bool = Field::of("visible", Kind::Flag(["Hide", "Show"])), true;
        /// Position of the centre: [x, y, z] in metres, inside the room, not at the position of a light or the observer.
        position: Vec3 = Field::of("a position", Kind::Position).unit("m").required("an object needs one"), Vec3::splat(5.0);
        // Far beyond a million kilometres, the squares of distances and of their derivatives overflow on GPUs, and the
        // two renderers could not agree on a picture.
        /// Largest extent, metres.
        size: f32 = Field::number("a size", ABOVE_ZERO..=1e9).unit("m").always(), 2.0;
        /// Rotation in degrees about x, then y, then z.
        rotation: Vec3 = Field::of("a rotation", Kind::Rotation).unit("°"), Vec3::ZERO;
        /// Tessellation: how finely the shape is divided into polygons.
        tessellation: Option<u32> = Field::of("the tessellation", Kind::Count(0)), None;
        /// Parameters declared by the type; absent ones have their defaults.
        shape[""]: Values = Field::of("", Kind::Parameters), Values::default();
        /// Override of the scene's reflection model.
        reflection_model: Option<String> = Field::of("the reflection model", Kind::Id(Ids::ReflectionModel)), None;
        /// Override of the scene's shading model.
        shading_model: Option<String> = Field::of("the shading model", Kind::Id(Ids::ShadingModel)), None;
        /// Parameters of the reflection model and of the shading model, by name. One material serves every model: values not
        /// used by the current
        /// model are kept for the others.
        material: Values = Field::of("the material", Kind::Material), Values::default();
        /// Row or grid: the object stands for so many copies, which may differ in some values.
        repeat: Repetition = Field::of("the row", Kind::Part).always(), Repetition::None;
    }
}

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
    /// That of an entry; a copy alone is written as a single object.
    fn parts(&self) -> Vec<&dyn Fields> {
        match self {
            Self::Entry(repeat) => vec![&**repeat],
            Self::None | Self::Copy { .. } => Vec::new(),
        }
    }
}

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
