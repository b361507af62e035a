//! Object types: the shapes of objects.
//!
//! **To add one**: write `shape/x.rs` and add its name to [`register_builtin`].

use std::ops::RangeInclusive;

use bevy::ecs::component::Component;

use crate::parameter::ParameterSet;

mod entry;
pub mod mesh;

mod cube;
mod sphere;
mod superellipsoid;
mod teapot;
mod torus;

pub use cube::Cube;
pub use entry::{Bounds, MeshKey, ShapeEntry};
pub use mesh::PolygonMesh;
pub use sphere::Sphere;
pub use superellipsoid::Superellipsoid;
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
    to.take::<Superellipsoid>();
    to.take::<Teapot>();
}

/// The name and the legal tessellations of an object type.
#[derive(Debug)]
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

/// An object type: a struct of parameters, written by [`parameters!`](crate::parameters), that creates a mesh of
/// polygons whose largest extent is 1, centred on the origin.
pub trait ObjectType: ParameterSet + Component {
    /// Name and tessellation.
    const DECLARATION: Declaration;

    /// The mesh for legal parameters and a legal tessellation. Coincident vertices are shared, since vertex normals are means over shared
    /// vertices (CA DD9); corners run counter-clockwise seen from outside. Polygons are brushed horizontally unless the
    /// shape sets another direction; see [`Polygon::brushed`](mesh::Polygon::brushed).
    fn mesh(&self, tessellation: u32) -> PolygonMesh;
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use glam::Vec3;

    use super::*;
    use crate::{
        parameter::{Value, Values},
        registry::Registry,
    };

    /// A mesh, and what it was made from.
    struct Case {
        d: &'static Declaration,
        values: Values,
        tessellation: u32,
        mesh: PolygonMesh,
    }

    impl Case {
        fn name(&self) -> String {
            format!("{} {} {:?}", self.d.id, self.tessellation, self.values.0)
        }

        fn number(&self, parameter: &str) -> f32 {
            match self.values.0.get(parameter) {
                Some(Value::Number(v)) => *v,
                other => panic!("{parameter} is {other:?}"),
            }
        }
    }

    /// Every type at both ends of the ranges of its tessellation and of its parameters, at their defaults, and at all
    /// that can be made of these.
    fn cases() -> Vec<Case> {
        let mut all = Vec::new();
        for shape in Registry::builtin().shapes() {
            let d = shape.declaration;
            let mut choices = vec![Values::default()];
            for p in shape.parameters {
                choices = (choices.iter())
                    .flat_map(|values| {
                        p.ends().into_iter().map(|value| {
                            let mut values = values.clone();
                            values.set(p.name, value);
                            values
                        })
                    })
                    .collect();
            }
            for values in choices {
                for tessellation in [*d.tessellation.start(), d.default_tessellation, *d.tessellation.end()] {
                    let mesh = shape.mesh(&values, tessellation);
                    all.push(Case { d, values: values.clone(), tessellation, mesh });
                }
            }
        }
        all
    }

    #[test]
    fn the_largest_extent_is_one_and_the_middle_is_the_origin() {
        for case in cases() {
            let Case { ref mesh, .. } = case;
            let name = case.name();
            let low = mesh.positions.iter().copied().reduce(Vec3::min).expect("has vertices");
            let high = mesh.positions.iter().copied().reduce(Vec3::max).expect("has vertices");
            assert!(((high - low).max_element() - 1.0).abs() < 1e-6, "{name}: {low} {high}");
            assert!((high + low).abs().max_element() < 1e-6, "{name}: {low} {high}");
        }
    }

    #[test]
    fn every_edge_is_shared_by_two_polygons_that_go_along_it_in_opposite_directions() {
        for case in cases() {
            let Case { d, tessellation, ref mesh, .. } = case;
            let name = case.name();
            let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
            for polygon in &mesh.polygons {
                let c = polygon.corners();
                for (i, &a) in c.iter().enumerate() {
                    *edges.entry((a, c[(i + 1) % c.len()])).or_default() += 1;
                }
            }
            assert!(edges.values().all(|&n| n == 1), "{name}: an edge is used twice one way");
            let open = edges.keys().filter(|&&(a, b)| !edges.contains_key(&(b, a))).count() as u32;
            // The teapot's lid and rim (4 n each) and the ends of handle and spout (2 n each).
            let expected = if d.id == "teapot" { 16 * tessellation } else { 0 };
            assert_eq!(open, expected, "{name}");
        }
    }

    #[test]
    fn polygons_look_outward() {
        for case in cases() {
            let Case { d, ref mesh, .. } = case;
            let name = case.name();
            let volume: f32 = mesh
                .polygons
                .iter()
                .flat_map(|p| p.triangles().iter().map(|t| t.map(|i| p.corners()[i] as usize)))
                .map(|[a, b, c]| mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c])) / 6.0)
                .sum();
            // A thin torus has little of it.
            let least = if d.id == "torus" && case.number("tube_radius") < 0.1 { 0.001 } else { 0.03 };
            assert!(volume > least, "{name}: {volume}");
        }
    }

    #[test]
    fn every_normal_is_a_unit_vector_on_the_side_of_its_polygons() {
        for case in cases() {
            let Case { d, tessellation, ref mesh, .. } = case;
            let name = case.name();
            let faces = mesh.polygon_normals();
            let vertices = mesh.vertex_normals();
            for n in faces.iter().chain(&vertices) {
                assert!((n.length() - 1.0).abs() < 1e-4, "{name}: {n}");
            }
            let behind = mesh.polygons.iter().zip(&faces).filter(|(polygon, face)| {
                polygon.corners().iter().any(|&c| vertices[c as usize].dot(**face) <= 0.0)
            });
            // The lip of a very coarse teapot folds over within one polygon.
            let allowed = if d.id == "teapot" && tessellation == 2 { 16 } else { 0 };
            let count = behind.count();
            assert!(count <= allowed, "{name}: {count}");
        }
    }

    #[test]
    fn every_place_occurs_once_within_a_part() {
        for case in cases() {
            let Case { d, tessellation, ref mesh, .. } = case;
            let name = case.name();
            if tessellation > 64 {
                continue;
            }
            let mut places: HashMap<[i32; 3], u32> = HashMap::new();
            for p in &mesh.positions {
                *places.entry((*p * 1e6).round().as_ivec3().to_array()).or_default() += 1;
            }
            let doubled = places.values().filter(|&&n| n > 1).count();
            // The teapot's handle touches the body in one vertex; they are different surfaces.
            let expected = usize::from(d.id == "teapot");
            assert!(doubled <= expected, "{name}: {doubled}");
        }
    }

    #[test]
    fn tangents_lie_in_the_surface_and_turn_smoothly() {
        for case in cases() {
            let Case { d, tessellation, ref mesh, .. } = case;
            let name = case.name();
            for (t, n) in mesh.polygon_tangents().into_iter().zip(mesh.polygon_normals()) {
                assert!((t.length() - 1.0).abs() < 1e-4 && t.dot(n).abs() < 1e-4, "{name}: {t} {n}");
            }
            // The lip of a very coarse teapot folds over, with its vertices.
            if d.id == "teapot" && tessellation == 2 {
                continue;
            }
            let (mut poles, mut disputed) = (0, 0);
            let tangents = mesh.vertex_tangents();
            for (t, n) in tangents.iter().zip(mesh.vertex_normals()) {
                let length = t.length();
                poles += u32::from(length == 0.0);
                disputed += u32::from(length > 0.0 && length < 0.5);
                // At edges of the cube they are tilted against the vertex's plane, or perpendicular to it; nowhere
                // else.
                let lean = if d.id == "cube" { 1.001 } else { 0.15 };
                assert!(t.dot(n).abs() <= lean * length, "{name}: {t} {n}");
                assert!([0.0, 1e-3, 1.0].iter().any(|l| (length - l).abs() <= 1e-4 * l), "{name}: {t}");
            }
            let n = tessellation;
            let expected = match d.id {
                // All edges but the four along x.
                "cube" => (0, 8 * n),
                // Four vertices around: their polygons face four sides.
                "sphere" => (2, if n == 2 { 4 } else { 0 }),
                // The four ridges from pole to pole are as sharp as those of a diamond, or sharper.
                "superellipsoid" if case.number("horizontal_exponent") >= 2.0 => (2, 4 * (n - 1)),
                "superellipsoid" => (2, if n == 2 { 4 } else { 0 }),
                "teapot" => (2, 0),
                _ => (0, 0),
            };
            assert_eq!((poles, disputed), expected, "{name}");
            for polygon in &mesh.polygons {
                let c = polygon.corners();
                for (i, &a) in c.iter().enumerate() {
                    let (t, next) = (tangents[a as usize], tangents[c[(i + 1) % c.len()] as usize]);
                    assert!(t.dot(next) >= -1e-6, "{name}: {t} beside {next}");
                }
            }
        }
    }
}
