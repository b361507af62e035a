//! Meshes as binary PLY files.

use glam::{Vec2, Vec3};

use crate::shape::PolygonMesh;

/// The data that a mesh needs besides its positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Surface {
    /// True if vertices have normals; otherwise each triangle is flat.
    pub(super) smooth: bool,
    /// True if the surface has a brush direction.
    pub(super) brushed: bool,
}

/// A vertex: position, normal, texture coordinates.
type Vertex = (Vec3, Vec3, Vec2);

/// The PLY file of a mesh.
///
/// The brush direction of a surface is that of the texture coordinate u: each triangle has separate vertices,
/// with u along the mean of the tangents at its corners.
pub(super) fn ply(mesh: &PolygonMesh, surface: Surface) -> Vec<u8> {
    let normals = if surface.smooth { mesh.vertex_normals() } else { Vec::new() };
    let vertex = |i: u32| {
        let i = i as usize;
        (mesh.positions[i], normals.get(i).copied().unwrap_or_default(), Vec2::ZERO)
    };
    if !surface.brushed {
        let vertices: Vec<_> = (0..mesh.positions.len() as u32).map(vertex).collect();
        let triangles: Vec<_> = mesh.triangles().map(|(_, corners)| corners).collect();
        return file(&vertices, &triangles, surface);
    }
    let [of_polygons, of_vertices] = [mesh.polygon_tangents(), mesh.vertex_tangents()];
    let mut vertices = Vec::new();
    for (polygon, corners) in mesh.triangles() {
        let own = of_polygons[polygon];
        let sum: Vec3 = corners.iter().map(|i| of_vertices[*i as usize]).sum();
        let tangent = if surface.smooth { sum.try_normalize().unwrap_or(own) } else { own };
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let along = (tangent - normal * normal.dot(tangent)).normalize_or(normal.any_orthogonal_vector());
        let across = normal.cross(along);
        vertices.extend(corners.map(|i| {
            let (position, normal, _) = vertex(i);
            let from = position - a;
            (position, normal, Vec2::new(from.dot(along), from.dot(across)))
        }));
    }
    let own: Vec<_> = (0..vertices.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    file(&vertices, &own, surface)
}

fn file(vertices: &[Vertex], triangles: &[[u32; 3]], surface: Surface) -> Vec<u8> {
    let Surface { smooth, brushed } = surface;
    let given = [("x y z", true), ("nx ny nz", smooth), ("u v", brushed)];
    let names = given.iter().filter(|(_, given)| *given).flat_map(|(names, _)| names.split(' '));
    let properties: String = names.map(|name| format!("property float {name}\n")).collect();
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{properties}element face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        vertices.len(),
        triangles.len()
    )
    .into_bytes();
    for (position, normal, uv) in vertices {
        let numbers = position
            .to_array()
            .into_iter()
            .chain(normal.to_array().into_iter().filter(|_| smooth))
            .chain(uv.to_array().into_iter().filter(|_| brushed));
        numbers.for_each(|number| bytes.extend(number.to_le_bytes()));
    }
    for triangle in triangles {
        bytes.push(3);
        triangle.iter().for_each(|i| bytes.extend(i.to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{parameter::Values, registry::Registry};

    #[test]
    fn a_file_is_as_long_as_its_head_says() {
        let registry = Registry::builtin();
        let mesh = registry.shape("sphere").expect("built in").mesh(&Values::default(), 8);
        for (smooth, brushed, floats) in [(true, false, 6), (false, false, 3), (true, true, 8)] {
            let bytes = ply(&mesh, Surface { smooth, brushed });
            let end = b"end_header\n";
            let at = bytes.windows(end.len()).position(|w| w == end).expect("it has a head") + end.len();
            let head = String::from_utf8_lossy(&bytes[..at]).into_owned();
            let count = |element: &str| -> usize {
                let rest = head.split(&format!("element {element} ")).nth(1).expect("said");
                rest.lines().next().and_then(|n| n.parse().ok()).expect("a number")
            };
            assert_eq!(bytes.len() - at, count("vertex") * floats * 4 + count("face") * 13);
            if brushed {
                assert_eq!(count("vertex"), 3 * count("face"));
            }
        }
    }
}
