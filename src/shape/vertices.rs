//! The vertices of a mesh as they are drawn: shared by polygons, or separate for each.

use glam::Vec3;

use super::PolygonMesh;

/// The meaning of an attribute of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Says {
    /// The position.
    Position,
    /// The normal of the surface.
    Normal,
    /// The tangent of the surface.
    Tangent,
    /// The normal of the polygon.
    FaceNormal,
    /// The tangent of the polygon.
    FaceTangent,
    /// The centre of the polygon.
    FaceCentre,
}

impl Says {
    /// The name in shaders.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Normal => "normal",
            Self::Tangent => "tangent",
            Self::FaceNormal => "face_normal",
            Self::FaceTangent => "face_tangent",
            Self::FaceCentre => "face_centre",
        }
    }
}

/// The vertices of a mesh, and its triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Vertices {
    /// Three numbers for each vertex, by attribute, in the order of shaders.
    pub attributes: Vec<(Says, Vec<[f32; 3]>)>,
    /// Three vertices for each triangle, counter-clockwise seen from outside.
    pub indices: Vec<u32>,
}

impl Vertices {
    /// The vertices for shading models that interpolate over shared ones.
    #[must_use]
    pub fn shared(mesh: &PolygonMesh) -> Self {
        let attributes = vec![
            (Says::Position, arrays(&mesh.positions)),
            (Says::Normal, arrays(&mesh.vertex_normals())),
            (Says::Tangent, arrays(&mesh.vertex_tangents())),
        ];
        Self { attributes, indices: mesh.triangles().flat_map(|(_, corners)| corners).collect() }
    }

    /// The vertices for shading models that calculate per polygon: no vertex is shared, and each has the data of its
    /// polygon.
    #[must_use]
    pub fn apart(mesh: &PolygonMesh) -> Self {
        let corners = || {
            let all = mesh.polygons.iter().enumerate();
            all.flat_map(|(i, polygon)| polygon.corners().iter().map(move |corner| (i, *corner as usize)))
        };
        let of_vertices =
            |of: &[Vec3]| corners().map(|(_, vertex)| of[vertex].to_array()).collect::<Vec<_>>();
        let of_polygons = |of: &[Vec3]| corners().map(|(i, _)| of[i].to_array()).collect::<Vec<_>>();
        let (mut first, mut indices) = (0, Vec::new());
        for polygon in &mesh.polygons {
            indices.extend(polygon.triangles().iter().flatten().map(|&i| first + i as u32));
            first += polygon.corners().len() as u32;
        }
        let attributes = vec![
            (Says::Position, of_vertices(&mesh.positions)),
            (Says::Normal, of_vertices(&mesh.vertex_normals())),
            (Says::Tangent, of_vertices(&mesh.vertex_tangents())),
            (Says::FaceNormal, of_polygons(&mesh.polygon_normals())),
            (Says::FaceTangent, of_polygons(&mesh.polygon_tangents())),
            (Says::FaceCentre, of_polygons(&mesh.polygon_centres())),
        ];
        Self { attributes, indices }
    }
}

fn arrays(vectors: &[Vec3]) -> Vec<[f32; 3]> {
    vectors.iter().map(|v| v.to_array()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Cube, ObjectType as _};

    #[test]
    fn vertices_are_shared_or_have_the_data_of_their_polygon() {
        let cube = Cube::default().mesh(1);
        let (shared, apart) = (Vertices::shared(&cube), Vertices::apart(&cube));
        let counts = |of: &Vertices| of.attributes.iter().map(|(_, values)| values.len()).collect::<Vec<_>>();
        assert_eq!((counts(&shared), counts(&apart)), (vec![8; 3], vec![24; 6]));
        assert_eq!((shared.indices.len(), apart.indices.len()), (36, 36));
        // The corners of triangles are in the same places.
        let corners =
            |of: &Vertices| of.indices.iter().map(|i| of.attributes[0].1[*i as usize]).collect::<Vec<_>>();
        assert_eq!(corners(&shared), corners(&apart));
        let (normals, of_faces) = (&apart.attributes[1], &apart.attributes[3]);
        assert_eq!((normals.0.name(), of_faces.0.name()), ("normal", "face_normal"));
        assert_ne!(normals.1, of_faces.1, "vertex normals are means");
        assert!(of_faces.1.iter().all(|n| Vec3::from_array(*n).abs().max_element() > 0.999), "{of_faces:?}");
    }
}
