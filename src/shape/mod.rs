//! Object types: what is lit.
//!
//! **To add one**: write `shape/x.rs` and add its name to [`register_builtin`].

use std::{fmt, ops::RangeInclusive};

use crate::registry::Register;

pub mod mesh;

mod cube;
mod sphere;
mod teapot;
mod torus;

pub use cube::Cube;
pub use mesh::PolygonMesh;
pub use sphere::Sphere;
pub use teapot::Teapot;
pub use torus::Torus;

/// The built-in object types, in the order in which choosers list them. The one list.
pub fn register_builtin(to: &mut impl Register) {
    to.add_object_type::<Sphere>();
    to.add_object_type::<Cube>();
    to.add_object_type::<Torus>();
    to.add_object_type::<Teapot>();
}

/// What an object type is called and how finely it can be cut.
#[derive(Debug)]
pub struct Declaration {
    /// The name in scene files.
    pub id: &'static str,
    /// The name that people read.
    pub name: &'static str,
    /// One sentence: what it is and what it shows.
    pub summary: &'static str,
    /// A glyph for lists.
    pub glyph: &'static str,
    /// What the number of the tessellation counts.
    pub tessellation_help: &'static str,
    /// The legal tessellations.
    pub tessellation: RangeInclusive<u32>,
    /// The tessellation when the scene does not give one.
    pub default_tessellation: u32,
}

/// An object type: makes a mesh of polygons whose largest extent is 1, centred on the origin.
pub trait ObjectType: Send + Sync + 'static {
    /// Name and tessellation.
    const DECLARATION: Declaration;

    /// The mesh for a legal tessellation. Vertices that coincide are shared, since vertex normals are
    /// means over shared vertices (DD9); corners run counter-clockwise seen from outside.
    fn mesh(tessellation: u32) -> PolygonMesh;
}

/// A registered object type.
#[derive(Clone, Copy)]
pub struct ShapeEntry {
    /// Name and tessellation.
    pub declaration: &'static Declaration,
    mesh: fn(u32) -> PolygonMesh,
}

impl ShapeEntry {
    /// The entry of an object type.
    #[must_use]
    pub fn of<T: ObjectType>() -> Self {
        Self { declaration: const { &T::DECLARATION }, mesh: T::mesh }
    }

    /// The tessellation that an object gets: what it asks for, brought into the legal range, or the
    /// default.
    #[must_use]
    pub fn tessellation(&self, wanted: Option<u32>) -> u32 {
        let range = &self.declaration.tessellation;
        wanted.unwrap_or(self.declaration.default_tessellation).clamp(*range.start(), *range.end())
    }

    /// The mesh for a tessellation, brought into the legal range.
    #[must_use]
    pub fn mesh(&self, tessellation: u32) -> PolygonMesh {
        (self.mesh)(self.tessellation(Some(tessellation)))
    }
}

impl fmt::Debug for ShapeEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ShapeEntry").field(&self.declaration.id).finish()
    }
}
