//! Object types: the shapes of objects.
//!
//! **To add one**: write `shape/x.rs` and add its name to [`register_builtin`].

use std::ops::RangeInclusive;

use bevy_ecs::component::Component;
use bevy_reflect::Reflectable;

use crate::{declared::take_each, parameter::ParameterSet};

pub mod closed;
mod entry;
mod fields;
pub mod hierarchy;
pub mod mesh;
pub mod mesh_file;

mod builder;
mod cube;
mod sphere;
mod superellipsoid;
mod teapot;
mod torus;
mod vertices;

pub use cube::Cube;
pub(crate) use entry::outermost;
pub use entry::{Bounds, MeshKey, ShapeEntry};
pub(crate) use fields::fields;
pub use hierarchy::Hierarchy;
pub use mesh::PolygonMesh;
pub use mesh_file::MeshFile;
pub use sphere::Sphere;
pub use superellipsoid::Superellipsoid;
pub use teapot::Teapot;
pub use torus::Torus;
pub use vertices::{Says, Vertices};

/// Receives object types one after the other.
pub trait Take {
    /// Receives the next one.
    fn take<T: ObjectType>(&mut self);
}

/// Registers the built-in object types, in the order of all lists.
pub fn register_builtin(to: &mut impl Take) {
    take_each!(to: Sphere Cube Torus Superellipsoid Teapot MeshFile);
}

/// The name and the legal tessellations of an object type.
#[derive(Debug)]
#[non_exhaustive]
pub struct Declaration {
    /// Name in scene files.
    pub id: &'static str,
    /// Display name.
    pub name: &'static str,
    /// One sentence: the shape and its use.
    pub summary: &'static str,
    /// A glyph for lists.
    pub glyph: &'static str,
    /// The reason why the mesh is not closed, for solid models; empty if it is.
    pub open: &'static str,
    /// The meaning of the tessellation number.
    pub tessellation_help: &'static str,
    /// The legal tessellations.
    pub tessellation: RangeInclusive<u32>,
    /// Default tessellation.
    pub default_tessellation: u32,
}

/// An object type: a parameter struct, defined with [`parameters!`](crate::parameters), that creates a mesh
/// of polygons whose largest extent is 1, centred on the origin. It is a component of the entities of the
/// type.
pub trait ObjectType: ParameterSet + Component + Reflectable {
    /// Name and tessellation.
    const DECLARATION: Declaration;

    /// The mesh for legal parameters and a legal tessellation. Coincident vertices are shared, since vertex normals are
    /// means over shared vertices; corners run counter-clockwise seen from outside. Polygons are brushed
    /// horizontally unless the shape sets another direction; see [`Polygon::brushed`](mesh::Polygon::brushed).
    fn mesh(&self, tessellation: u32) -> PolygonMesh;
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use crate::{
        parameter::{Value, Values},
        registry::{Registry, check},
        testing::meshes::{self, Case, Findings},
    };

    /// Visits every type at both ends of the ranges of its tessellation and of its parameters, at their
    /// defaults, and at all combinations of these; with a name for the case.
    fn each(mut visit: impl FnMut(&str, &str, &Case)) {
        for shape in Registry::builtin().shapes() {
            let id = shape.declaration.id;
            for case in meshes::cases(shape) {
                visit(&format!("{id} {} {:?}", case.tessellation, case.values.0), id, &case);
            }
        }
    }

    fn number(values: &Values, parameter: &str) -> f32 {
        match values.0.get(parameter) {
            Some(Value::Number(v)) => *v,
            other => panic!("{parameter} is {other:?}"),
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
        each(|name, _, Case { mesh, .. }| {
            let low = mesh.positions.iter().copied().reduce(Vec3::min).expect("has vertices");
            let high = mesh.positions.iter().copied().reduce(Vec3::max).expect("has vertices");
            assert!(((high - low).max_element() - 1.0).abs() < 1e-6, "{name}: {low} {high}");
            assert!((high + low).abs().max_element() < 1e-6, "{name}: {low} {high}");
        });
    }

    #[test]
    fn surfaces_are_closed_face_outwards_and_turn_smoothly() {
        each(|name, id, Case { values, tessellation, mesh }| {
            let n = *tessellation;
            assert_eq!(check::mesh::check(mesh), Ok(()), "{name}");
            let found = Findings::of(mesh);
            let teapot = id == "teapot";
            let coarse_teapot = teapot && n == 2;
            // The teapot's lid and rim (4 n each) and the ends of handle and spout (2 n each).
            assert_eq!(found.open_edges as u32, if teapot { 16 * n } else { 0 }, "{name}");
            // A thin torus contains little of it.
            let least = if id == "torus" && number(values, "tube_radius") < 0.1 { 0.001 } else { 0.03 };
            assert!(found.volume > least, "{name}: {}", found.volume);
            assert_eq!((found.no_normal, found.no_tangent), (0, 0), "{name}");
            // The lip of a very coarse teapot folds over within one polygon.
            assert!(found.folded <= if coarse_teapot { 16 } else { 0 }, "{name}: {}", found.folded);
            // The teapot's handle touches the body in one vertex; they are different surfaces.
            if n <= 64 {
                assert!(found.doubled <= usize::from(teapot), "{name}: {}", found.doubled);
            }
            // Where the lip folds, so do its vertices.
            if coarse_teapot {
                return;
            }
            let expected = match id {
                // All edges except the four along x.
                "cube" => (0, 8 * n as usize),
                // Four vertices around: their polygons face four sides.
                "sphere" => (2, if n == 2 { 4 } else { 0 }),
                // The four ridges from pole to pole are as sharp as those of a diamond, or sharper.
                "superellipsoid" if number(values, "horizontal_exponent") >= 2.0 => (2, 4 * (n as usize - 1)),
                "superellipsoid" => (2, if n == 2 { 4 } else { 0 }),
                "teapot" => (2, 0),
                _ => (0, 0),
            };
            assert_eq!((found.poles, found.disputed), expected, "{name}");
            // At edges of the cube they are tilted against the vertex's plane, or perpendicular to it; nowhere else.
            assert!(found.lean <= if id == "cube" { 1.001 } else { 0.15 }, "{name}: {}", found.lean);
            assert_eq!(found.turned, 0, "{name}");
            for t in mesh.vertex_tangents() {
                let length = t.length();
                assert!([0.0, 1e-3, 1.0].iter().any(|l| (length - l).abs() <= 1e-4 * l), "{name}: {t}");
            }
        });
    }
}
