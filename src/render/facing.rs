//! Corners whose triangles all face away from the observer. Nothing is drawn there, so shading models that
//! calculate light at corners can skip them.
//!
//! Shaders normalise normals, so their lengths are free to encode how far the triangles at a corner deviate
//! from the normal there: by at most asin(1 / length). With the observer's direction **v** they all face away
//! if **n**·**v** < −1 / length. Lengths are powers of two, which cause no rounding; 1 encodes nothing.

use bevy::mesh::{Mesh, MeshVertexAttribute, VertexAttributeValues};
use glam::Vec3;

use super::material::{FACE_NORMAL, Vertices};
use crate::shape::PolygonMesh;

/// Margin for the rounding of a driver, which snaps corners to a grid in the picture and may flip small
/// triangles at the rim.
const MARGIN: f32 = 0.1;

/// Writes the lengths into the normals of a mesh made of these polygons: the normals with which corners are
/// lit.
pub(super) fn tell(mesh: &mut Mesh, polygons: &PolygonMesh, vertices: Vertices) {
    match vertices {
        Vertices::Shared => {
            let normals = polygons.vertex_normals();
            let mut cosines = vec![1.0; normals.len()];
            for (_, corners) in polygons.triangles() {
                let normal = normal_of(polygons, corners);
                for corner in corners.map(|corner| corner as usize) {
                    cosines[corner] = least(cosines[corner], normal, normals[corner]);
                }
            }
            stretch(mesh, Mesh::ATTRIBUTE_NORMAL, cosines.into_iter());
        }
        Vertices::Apart => {
            let normals = polygons.polygon_normals();
            let mut cosines = vec![1.0; normals.len()];
            for (polygon, corners) in polygons.triangles() {
                cosines[polygon] = least(cosines[polygon], normal_of(polygons, corners), normals[polygon]);
            }
            let counts = polygons.polygons.iter().map(|polygon| polygon.corners().len());
            let each = counts.zip(cosines).flat_map(|(count, cosine)| std::iter::repeat_n(cosine, count));
            stretch(mesh, FACE_NORMAL, each);
        }
    }
}

fn normal_of(polygons: &PolygonMesh, corners: [u32; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|corner| polygons.positions[corner as usize]);
    (b - a).cross(c - a).normalize_or_zero()
}

/// The cosine of the larger of two angles: the maximum so far, and that of a triangle. A triangle without
/// area is not drawn.
fn least(so_far: f32, triangle: Vec3, normal: Vec3) -> f32 {
    if triangle == Vec3::ZERO { so_far } else { so_far.min(triangle.dot(normal)) }
}

/// The length which states that no triangle deviates by more than the angle with this cosine.
fn length(cosine: f32) -> f32 {
    let sine = if cosine > 0.0 { (1.0 - cosine * cosine).max(0.0).sqrt() } else { 1.0 };
    [8.0, 4.0, 2.0].into_iter().find(|length| (sine + MARGIN) * length <= 1.0).unwrap_or(1.0)
}

fn stretch(mesh: &mut Mesh, attribute: MeshVertexAttribute, cosines: impl Iterator<Item = f32>) {
    if let Some(VertexAttributeValues::Float32x3(normals)) = mesh.attribute_mut(attribute) {
        for (normal, cosine) in normals.iter_mut().zip(cosines) {
            *normal = normal.map(|n| n * length(cosine));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        registry::Registry,
        render::meshes::{face_mesh, shared_mesh},
    };

    /// The corners that the shader leaves out, seen from a place, and those of them with a triangle that faces it by more
    /// than the margin; with lengths that are so many times too large.
    fn omitted(polygons: &PolygonMesh, vertices: Vertices, eye: Vec3, times: f32) -> [usize; 2] {
        let (mut mesh, attribute) = match vertices {
            Vertices::Shared => (shared_mesh(polygons), Mesh::ATTRIBUTE_NORMAL),
            Vertices::Apart => (face_mesh(polygons), FACE_NORMAL),
        };
        tell(&mut mesh, polygons, vertices);
        let read = |attribute| match mesh.attribute(attribute) {
            Some(VertexAttributeValues::Float32x3(values)) => {
                values.iter().copied().map(Vec3::from).collect()
            }
            _ => Vec::new(),
        };
        let (positions, normals) = (read(Mesh::ATTRIBUTE_POSITION), read(attribute));
        let indices: Vec<_> = mesh.indices().expect("indexed").iter().collect();
        let away = |i: usize| {
            normals[i].normalize_or_zero().dot((eye - positions[i]).normalize()) * normals[i].length() * times
                < -1.0
        };
        let mut wrong = vec![false; positions.len()];
        for corners in indices.as_chunks::<3>().0 {
            let [a, b, c] = corners.map(|i| positions[i]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let faces = normal.dot((eye - a).normalize()) > 0.0;
            corners.iter().filter(|_| faces).for_each(|i| wrong[*i] = true);
        }
        let all: Vec<_> = (0..positions.len()).filter(|i| away(*i)).collect();
        [all.len(), all.into_iter().filter(|i| wrong[*i]).count()]
    }

    fn eyes() -> impl Iterator<Item = Vec3> {
        (0..24).map(|i| {
            let (turn, up) = (i as f32 * 2.4, (i as f32 + 0.5) / 12.0 - 1.0);
            let around = (1.0 - up * up).sqrt();
            Vec3::new(around * turn.cos(), up, around * turn.sin()) * (1.0 + 0.4 * i as f32)
        })
    }

    #[test]
    fn no_corner_of_a_triangle_that_faces_the_observer_is_left_out() {
        let mut twin = 0;
        for shape in Registry::builtin().shapes() {
            for tessellation in [2, 5, 16, 48].map(|t| shape.tessellation(Some(t))) {
                let polygons = shape.mesh(&crate::parameter::Values::default(), tessellation);
                for (vertices, eye) in [Vertices::Shared, Vertices::Apart]
                    .into_iter()
                    .flat_map(|vertices| eyes().map(move |eye| (vertices, eye)))
                {
                    let [_, wrong] = omitted(&polygons, vertices, eye, 1.0);
                    let id = shape.declaration.id;
                    assert_eq!(wrong, 0, "{id} {tessellation} {vertices:?} from {eye}");
                    twin += omitted(&polygons, vertices, eye, 4.0)[1];
                }
            }
        }
        assert!(twin > 100, "lengths that promise too much are found out: {twin}");
    }

    #[test]
    fn much_of_a_sphere_is_left_out() {
        let registry = Registry::builtin();
        let sphere = registry.shape("sphere").expect("built in");
        let polygons = sphere.mesh(&crate::parameter::Values::default(), 32);
        for vertices in [Vertices::Shared, Vertices::Apart] {
            let [out, _] = omitted(&polygons, vertices, Vec3::new(3.0, 20.0, 9.0), 1.0);
            let all = match vertices {
                Vertices::Shared => polygons.positions.len(),
                Vertices::Apart => polygons.polygons.iter().map(|p| p.corners().len()).sum(),
            };
            let share = out as f32 / all as f32;
            assert!((0.3..0.5).contains(&share), "{vertices:?}: {share}");
        }
    }

    #[test]
    fn lengths_are_powers_of_two_and_promise_little_where_corners_are_sharp() {
        assert_eq!([1.0, 0.99, 0.93, 0.8, 0.0, -1.0].map(length), [8.0, 4.0, 2.0, 1.0, 1.0, 1.0]);
    }
}
