use std::collections::HashMap;

use glam::{UVec3, Vec3};

use super::{Declaration, ObjectType, PolygonMesh, mesh::Polygon};
use crate::parameters;

parameters! {
    /// **Cube** of edge 1, each face cut into n × n squares.
    ///
    /// Vertices on edges and corners belong to two and three faces at once, so their normals, which are means, point between the faces:
    /// Gouraud and Phong shading round off the outermost row of squares. The faces are brushed horizontally, top and bottom
    /// along x.
    pub struct Cube {}
}

impl ObjectType for Cube {
    const DECLARATION: Declaration = Declaration::new("cube", "Cube")
        .summary("Plane faces and sharp edges: shows what averaged vertex normals do to an edge.")
        .tessellation(1..=64, 16, "Squares along each edge.");

    fn mesh(&self, tessellation: u32) -> PolygonMesh {
        let n = tessellation.max(1);
        let mut mesh = PolygonMesh::default();
        // Vertices are identified by their position on a lattice, so neighbouring faces share them.
        let mut known: HashMap<UVec3, u32> = HashMap::new();
        for axis in 0..3 {
            for high in [false, true] {
                let mut vertex = |u: u32, v: u32| {
                    let mut place = UVec3::ZERO;
                    place[axis] = if high { n } else { 0 };
                    place[(axis + 1) % 3] = u;
                    place[(axis + 2) % 3] = v;
                    *known.entry(place).or_insert_with(|| {
                        mesh.positions.push(place.as_vec3() / n as f32 - Vec3::splat(0.5));
                        (mesh.positions.len() - 1) as u32
                    })
                };
                // Along x where that is in the face, so that most neighbours agree; otherwise horizontally.
                let along = if axis == 0 { Vec3::ZERO } else { Vec3::X };
                let mut squares = Vec::with_capacity((n * n) as usize);
                for u in 0..n {
                    for v in 0..n {
                        let [a, b, c, d] =
                            [vertex(u, v), vertex(u + 1, v), vertex(u + 1, v + 1), vertex(u, v + 1)];
                        // Axes in cyclic order turn anticlockwise seen from the axis' positive end.
                        let square = if high { Polygon::quad(a, b, c, d) } else { Polygon::quad(a, d, c, b) };
                        squares.push(square.brushed(along));
                    }
                }
                mesh.polygons.append(&mut squares);
            }
        }
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shading::normals::polygon_tangent;

    #[test]
    fn faces_share_the_vertices_of_their_edges() {
        for n in [1, 2, 5] {
            let mesh = Cube {}.mesh(n);
            assert_eq!(mesh.positions.len() as u32, 6 * n * n + 2);
            assert_eq!(mesh.polygons.len() as u32, 6 * n * n);
        }
    }

    #[test]
    fn corners_look_along_the_diagonal_and_the_middle_of_a_face_along_its_axis() {
        let mesh = Cube {}.mesh(4);
        let normals = mesh.vertex_normals();
        let at = |p: Vec3| {
            mesh.positions.iter().position(|q| *q == p).map(|i| normals[i]).expect("there is a vertex")
        };
        assert!((at(Vec3::splat(0.5)) - Vec3::splat(1.0).normalize()).length() < 1e-6);
        assert!((at(Vec3::new(0.0, 0.5, 0.0)) - Vec3::Y).length() < 1e-6);
        assert!((at(Vec3::new(0.0, 0.5, 0.5)) - Vec3::new(0.0, 1.0, 1.0).normalize()).length() < 1e-6);
    }

    #[test]
    fn each_face_is_brushed_in_one_direction_up_to_its_edges() {
        let mesh = Cube {}.mesh(4);
        let vertices = mesh.vertex_tangents();
        for (i, n) in mesh.polygon_normals().into_iter().enumerate() {
            let expected = if n.x.abs() > 0.5 { Vec3::Y.cross(n) } else { Vec3::X };
            assert!((mesh.polygon_tangents()[i] - expected).length() < 1e-5);
            let corners = mesh.polygons[i].corners();
            // In the centre of both triangles, including those without a vertex inside the face.
            for triangle in mesh.polygons[i].triangles() {
                let mean: Vec3 = triangle.iter().map(|&c| vertices[corners[c] as usize]).sum();
                assert!((polygon_tangent(mean, n) - expected).length() < 0.01, "{mean} {n}");
            }
        }
    }
}
