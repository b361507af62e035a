//! Meshes: what shading models rely on.

use std::collections::HashMap;

use super::Outcome;
use crate::{
    registry::check::mesh,
    shape::{PolygonMesh, ShapeEntry},
};

/// The properties of a mesh that [`mesh::check`] passes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// The number of edges that only one polygon has: 0 if the surface is closed.
    pub open_edges: usize,
    /// The volume that it encloses.
    pub volume: f32,
    /// The number of polygons or vertices whose normal is no unit vector: they have no area, or no polygons.
    pub no_normal: usize,
    /// The number of polygons with a corner whose vertex normal is behind it.
    pub folded: usize,
    /// The number of places with more than one vertex: normals are interpolated over shared ones only.
    pub doubled: usize,
    /// The number of polygons whose tangent is no unit vector in their plane.
    pub no_tangent: usize,
    /// The number of vertices without a tangent: poles, around which the surface is brushed.
    pub poles: usize,
    /// The number of vertices between polygons that are brushed at right angles or more.
    pub disputed: usize,
    /// The number of edges along which the tangent turns by more than a right angle.
    pub turned: usize,
    /// The largest part of a vertex tangent along the vertex normal.
    pub lean: f32,
}

impl Findings {
    /// Measures a mesh. Of very fine ones places are not compared.
    #[must_use]
    pub fn of(mesh: &PolygonMesh) -> Self {
        /// The most vertices whose places are compared.
        const MOST: usize = 1 << 17;
        let (faces, normals) = (mesh.polygon_normals(), mesh.vertex_normals());
        let (face_tangents, tangents) = (mesh.polygon_tangents(), mesh.vertex_tangents());
        let mut edges = HashMap::new();
        let mut found = Self { volume: mesh::volume(mesh), ..Self::default() };
        for polygon in &mesh.polygons {
            let corners = polygon.corners();
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                edges.insert((a, b), ());
                found.turned += usize::from(tangents[a as usize].dot(tangents[b as usize]) < -1e-6);
            }
        }
        found.open_edges = edges.keys().filter(|&&(a, b)| !edges.contains_key(&(b, a))).count();
        let off = |length: f32| (length - 1.0).abs() >= 1e-4 || length.is_nan();
        found.no_normal = faces.iter().chain(&normals).filter(|n| off(n.length())).count();
        let behind = |(polygon, face): &(&crate::shape::mesh::Polygon, &glam::Vec3)| {
            polygon.corners().iter().any(|&c| normals[c as usize].dot(**face) <= 0.0)
        };
        found.folded = mesh.polygons.iter().zip(&faces).filter(behind).count();
        let beside = |(t, n): &(&glam::Vec3, &glam::Vec3)| off(t.length()) || t.dot(**n).abs() >= 1e-4;
        found.no_tangent = face_tangents.iter().zip(&faces).filter(beside).count();
        for (t, n) in tangents.iter().zip(&normals) {
            let length = t.length();
            found.poles += usize::from(length == 0.0);
            found.disputed += usize::from(length > 0.0 && length < 0.5);
            if length > 0.0 {
                found.lean = found.lean.max(t.dot(*n).abs() / length);
            }
        }
        if mesh.positions.len() <= MOST {
            let mut places: HashMap<_, u32> = HashMap::new();
            for p in &mesh.positions {
                *places.entry((*p * 1e6).round().as_ivec3().to_array()).or_default() += 1;
            }
            found.doubled = places.values().filter(|&&n| n > 1).count();
        }
        found
    }
}

/// Each mesh of an object type: at both ends of its tessellations, and at the default.
pub fn each(shape: &ShapeEntry) -> impl Iterator<Item = (u32, PolygonMesh)> + '_ {
    let d = shape.declaration;
    [*d.tessellation.start(), d.default_tessellation, *d.tessellation.end()]
        .into_iter()
        .map(|tessellation| (tessellation, shape.mesh(tessellation)))
}

/// Each mesh passes [`mesh::check`], every polygon and vertex has a normal and every polygon a tangent, vertex normals
/// are on the outer side of their polygons, and no place has two vertices.
///
/// # Errors
/// The first that does not.
pub fn all(shape: &ShapeEntry) -> Outcome {
    each(shape).try_for_each(|(tessellation, mesh)| {
        one(&mesh).map_err(|what| format!("the mesh of tessellation {tessellation}: {what}"))
    })
}

/// The same for one mesh.
///
/// # Errors
/// The first thing that is wrong.
pub fn one(mesh: &PolygonMesh) -> Outcome {
    mesh::check(mesh)?;
    let Findings { no_normal, folded, doubled, no_tangent, .. } = Findings::of(mesh);
    for (count, what) in [
        (no_normal, "polygons or vertices have no normal: each polygon needs an area, each vertex a polygon"),
        (folded, "polygons face away from the normal at one of their corners: the surface folds over"),
        (doubled, "places have two vertices or more: polygons that meet must share their corners"),
        (no_tangent, "polygons have no tangent in their plane"),
    ] {
        if count > 0 {
            return Err(format!("{count} {what}"));
        }
    }
    Ok(())
}
