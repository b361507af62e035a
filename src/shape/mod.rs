//! Object types: the shapes of objects.
//!
//! **To add one**: write `shape/x.rs` and add its name to [`register_builtin`].

use std::{fmt, ops::RangeInclusive};

pub mod mesh;

mod builder;
mod cube;
mod sphere;
mod teapot;
mod torus;

pub use cube::Cube;
pub use mesh::PolygonMesh;
pub use sphere::Sphere;
pub use teapot::Teapot;
pub use torus::Torus;

/// Receives object types one after the other.
pub trait Take {
    /// Receives the next one.
    fn take<T: ObjectType>(&mut self);
}

/// The built-in object types, in the order of all lists: the one list.
pub fn register_builtin(to: &mut impl Take) {
    to.take::<Sphere>();
    to.take::<Cube>();
    to.take::<Torus>();
    to.take::<Teapot>();
}

/// The name and the legal tessellations of an object type.
#[derive(Debug)]
#[non_exhaustive]
pub struct Declaration {
    /// The name in scene files.
    pub id: &'static str,
    /// The name shown to people.
    pub name: &'static str,
    /// One sentence: its shape and its use.
    pub summary: &'static str,
    /// A glyph for lists.
    pub glyph: &'static str,
    /// The meaning of the tessellation number.
    pub tessellation_help: &'static str,
    /// The legal tessellations.
    pub tessellation: RangeInclusive<u32>,
    /// The tessellation if the scene gives none.
    pub default_tessellation: u32,
}

/// An object type: creates a mesh of polygons whose largest extent is 1, centred on the origin.
pub trait ObjectType: Send + Sync + 'static {
    /// Name and tessellation.
    const DECLARATION: Declaration;

    /// The mesh for a legal tessellation. Coincident vertices are shared, since vertex normals are means over shared
    /// vertices (CA DD9); corners run counter-clockwise seen from outside. Polygons are brushed horizontally unless the
    /// shape sets another direction; see [`Polygon::brushed`](mesh::Polygon::brushed).
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

    /// The tessellation of an object: the requested one, clamped to the legal range, or the default.
    #[must_use]
    pub fn tessellation(&self, wanted: Option<u32>) -> u32 {
        let range = &self.declaration.tessellation;
        wanted.unwrap_or(self.declaration.default_tessellation).clamp(*range.start(), *range.end())
    }

    /// The mesh for a tessellation, clamped to the legal range.
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

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{
        registry::{Registry, check},
        testing::meshes::{self, Findings},
    };

    /// Every type at both ends of its range and at its default.
    fn each(mut visit: impl FnMut(&str, u32, &PolygonMesh)) {
        for shape in Registry::builtin().shapes() {
            for (tessellation, mesh) in meshes::each(shape) {
                visit(shape.declaration.id, tessellation, &mesh);
            }
        }
    }

    #[test]
    fn every_mesh_passes_the_tests_for_those_of_other_crates() {
        for shape in Registry::builtin().shapes() {
            // The teapot's handle touches the body, and the lip of a very coarse one folds over: see below.
            if shape.declaration.id != "teapot" {
                assert_eq!(meshes::all(shape), Ok(()), "{}", shape.declaration.id);
            }
        }
    }

    #[test]
    fn the_largest_extent_is_one_and_the_middle_is_the_origin() {
        each(|id, tessellation, mesh| {
            let low = mesh.positions.iter().copied().reduce(Vec3::min).expect("has vertices");
            let high = mesh.positions.iter().copied().reduce(Vec3::max).expect("has vertices");
            assert!(((high - low).max_element() - 1.0).abs() < 1e-6, "{id} {tessellation}: {low} {high}");
            assert!((high + low).abs().max_element() < 1e-6, "{id} {tessellation}: {low} {high}");
        });
    }

    #[test]
    fn surfaces_are_closed_face_outwards_and_turn_smoothly() {
        each(|id, n, mesh| {
            let case = format!("{id} {n}");
            assert_eq!(check::mesh::check(mesh), Ok(()), "{case}");
            let found = Findings::of(mesh);
            let teapot = id == "teapot";
            let coarse_teapot = teapot && n == 2;
            // The teapot's lid and rim (4 n each) and the ends of handle and spout (2 n each).
            assert_eq!(found.open_edges as u32, if teapot { 16 * n } else { 0 }, "{case}");
            assert!(found.volume > 0.03, "{case}: {}", found.volume);
            assert_eq!((found.no_normal, found.no_tangent), (0, 0), "{case}");
            // The lip of a very coarse teapot folds over within one polygon.
            assert!(found.folded <= if coarse_teapot { 16 } else { 0 }, "{case}: {}", found.folded);
            // The teapot's handle touches the body in one vertex; they are different surfaces.
            assert!(found.doubled <= usize::from(teapot), "{case}: {}", found.doubled);
            // With the lip fold its vertices.
            if coarse_teapot {
                return;
            }
            let expected = match id {
                // All edges but the four along x.
                "cube" => (0, 8 * n as usize),
                // Four vertices around: their polygons face four sides.
                "sphere" => (2, if n == 2 { 4 } else { 0 }),
                "teapot" => (2, 0),
                _ => (0, 0),
            };
            assert_eq!((found.poles, found.disputed), expected, "{case}");
            // At edges of the cube they are tilted against the vertex's plane, or perpendicular to it; nowhere else.
            assert!(found.lean <= if id == "cube" { 1.001 } else { 0.15 }, "{case}: {}", found.lean);
            assert_eq!(found.turned, 0, "{case}");
            for t in mesh.vertex_tangents() {
                let length = t.length();
                assert!([0.0, 1e-3, 1.0].iter().any(|l| (length - l).abs() <= 1e-4 * l), "{case}: {t}");
            }
        });
    }
}
