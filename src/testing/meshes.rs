//! Checks meshes for the properties on which shading models rely.

use std::collections::HashMap;

use super::Outcome;
use crate::{
    parameter::{Parameter, Values},
    registry::check::mesh,
    shape::{PolygonMesh, ShapeEntry},
};

/// The properties of a mesh that passes [`mesh::check`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// The number of edges with a single polygon: 0 if the surface is closed.
    pub open_edges: usize,
    /// The enclosed volume.
    pub volume: f32,
    /// The number of polygons or vertices whose normal is not a unit vector: they have no area, or no
    /// polygons.
    pub no_normal: usize,
    /// The number of polygons with a vertex normal that faces backwards.
    pub folded: usize,
    /// The number of positions with more than one vertex: normals are interpolated only over shared ones.
    pub doubled: usize,
    /// The number of polygons whose tangent is not a unit vector in their plane.
    pub no_tangent: usize,
    /// The number of vertices without a tangent: poles, around which the surface is brushed.
    pub poles: usize,
    /// The number of vertices between polygons that are brushed at right angles or more.
    pub disputed: usize,
    /// The number of edges along which the tangent turns by more than a right angle.
    pub turned: usize,
    /// The largest component of a vertex tangent along the vertex normal.
    pub lean: f32,
}

impl Findings {
    /// Measures a mesh.
    #[must_use]
    pub fn of(mesh: &PolygonMesh) -> Self {
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
        let mut places: HashMap<_, u32> = HashMap::new();
        for p in &mesh.positions {
            *places.entry((*p * 1e6).round().as_ivec3().to_array()).or_default() += 1;
        }
        found.doubled = places.values().filter(|&&n| n > 1).count();
        found
    }
}

/// A mesh, and the values from which it was made.
#[derive(Clone, Debug)]
pub struct Case {
    /// The values of all parameters.
    pub values: Values,
    /// The tessellation.
    pub tessellation: u32,
    /// The mesh.
    pub mesh: PolygonMesh,
}

/// The meshes of an object type at both ends of its tessellations and at the default, each with its
/// parameters at the ends of their ranges and at their defaults: in all combinations, or one by one if there
/// are too many.
pub fn cases(shape: &ShapeEntry) -> impl Iterator<Item = Case> + '_ {
    let d = shape.declaration;
    combinations(shape.parameters).into_iter().flat_map(move |values| {
        [*d.tessellation.start(), d.default_tessellation, *d.tessellation.end()].map(|tessellation| Case {
            mesh: shape.mesh(&values, tessellation),
            values: values.clone(),
            tessellation,
        })
    })
}

/// Parameters at the ends of their ranges and at their defaults.
fn combinations(parameters: &[Parameter]) -> Vec<Values> {
    /// Maximum number of combinations.
    const MOST: usize = 243;
    let with = |values: &Values, p: &Parameter, value| {
        let mut values = values.clone();
        values.set(p.name, value);
        values
    };
    let defaults = Values::each(parameters, Parameter::default_value);
    if parameters.iter().map(|p| p.ends().len()).product::<usize>() > MOST {
        let ends = parameters.iter().flat_map(|p| p.ends().into_iter().map(move |end| (p, end)));
        return ends.map(|(p, end)| with(&defaults, p, end)).collect();
    }
    parameters.iter().fold(vec![defaults], |all, p| {
        all.iter().flat_map(|values| p.ends().into_iter().map(|end| with(values, p, end))).collect()
    })
}

/// Checks that each mesh passes [`mesh::check`], that every polygon and vertex has a normal and every polygon
/// a tangent, that vertex normals are on the outer side of their polygons, and that no position has two
/// vertices.
///
/// # Errors
/// Returns the first mesh that does not.
pub fn all(shape: &ShapeEntry) -> Outcome {
    cases(shape).try_for_each(|Case { values, tessellation, mesh }| {
        one(&mesh).map_err(|what| {
            let with = if values.0.is_empty() { String::new() } else { format!(" with {:?}", values.0) };
            format!("the mesh of tessellation {tessellation}{with}: {what}")
        })
    })
}

/// Checks one mesh.
///
/// # Errors
/// Returns the first violation.
pub fn one(mesh: &PolygonMesh) -> Outcome {
    /// Maximum number of vertices of a mesh whose positions are compared: those of a finer one may be as
    /// close as rounding.
    const MOST: usize = 10_000;
    mesh::check(mesh)?;
    let Findings { no_normal, folded, doubled, no_tangent, .. } = Findings::of(mesh);
    let doubled = if mesh.positions.len() > MOST { 0 } else { doubled };
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
