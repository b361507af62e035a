//! Meshes for the renderer, shared by all objects of one type with equal parameters and tessellations.

use std::{
    collections::{HashMap, HashSet},
    iter,
};

use bevy::{
    asset::{Assets, Handle, RenderAssetUsages},
    ecs::prelude::*,
    mesh::{Indices, Mesh, PrimitiveTopology},
};

use rayon::prelude::*;

use super::{
    material::{FACE_CENTRE, FACE_NORMAL, FACE_TANGENT, TANGENT},
    overrides::Overrides,
    shown::ShownObject,
};
use crate::{
    registry::Registry,
    scene::Object,
    shape::{MeshKey, PolygonMesh},
};

/// The meshes by object type, parameters and tessellation: with shared vertices for shading models that interpolate, with
/// the vertices of each polygon apart for shading models that calculate per polygon. Both are made together, so
/// that changing the shading model finds its mesh ready.
#[derive(Default, Resource)]
pub struct ShapeMeshes {
    known: HashMap<MeshKey, MeshPair>,
    /// True if meshes were added since unused ones were last dropped.
    grown: bool,
}

#[derive(Clone)]
pub(super) struct MeshPair {
    pub(super) shared: Handle<Mesh>,
    pub(super) faces: Handle<Mesh>,
}

impl ShapeMeshes {
    /// Makes the meshes of objects that are not yet known.
    pub(super) fn make<'a>(
        &mut self,
        objects: impl Iterator<Item = &'a Object>,
        registry: &Registry,
        assets: &mut Assets<Mesh>,
    ) {
        let mut missing = HashMap::new();
        for object in objects {
            if let Some(shape) = registry.shape(&object.object_type) {
                let key = shape.key(&object.shape, object.tessellation);
                if !self.known.contains_key(&key) {
                    missing.entry(key).or_insert((shape, object));
                }
            }
        }
        let made: Vec<_> = missing
            .into_par_iter()
            .map(|(key, (shape, object))| {
                let mesh = shape.mesh(&object.shape, shape.tessellation(object.tessellation));
                (key, shared_mesh(&mesh), face_mesh(&mesh))
            })
            .collect();
        self.grown |= !made.is_empty();
        for (key, shared, faces) in made {
            self.known.insert(key, MeshPair { shared: assets.add(shared), faces: assets.add(faces) });
        }
    }

    /// The meshes of an object, if they were made.
    pub(super) fn get(&self, key: &MeshKey) -> Option<MeshPair> {
        self.known.get(key).cloned()
    }
}

/// The mesh for shading models that interpolate over shared vertices.
#[must_use]
pub fn shared_mesh(mesh: &PolygonMesh) -> Mesh {
    let indices = mesh.triangles().flat_map(|(_, corners)| corners).collect();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, arrays(&mesh.positions))
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, arrays(&mesh.vertex_normals()))
        .with_inserted_attribute(TANGENT, arrays(&mesh.vertex_tangents()))
        .with_inserted_indices(Indices::U32(indices))
}

/// The mesh for shading models that calculate per polygon: no vertex is shared, and each knows its polygon.
#[must_use]
pub fn face_mesh(mesh: &PolygonMesh) -> Mesh {
    let (vertex_normals, vertex_tangents) = (mesh.vertex_normals(), mesh.vertex_tangents());
    let (polygon_normals, polygon_tangents) = (mesh.polygon_normals(), mesh.polygon_tangents());
    let mut positions = Vec::new();
    let mut normals = Vec::new();
    let mut tangents = Vec::new();
    let mut face_normals = Vec::new();
    let mut face_tangents = Vec::new();
    let mut face_centres = Vec::new();
    let mut indices = Vec::new();
    for (i, (polygon, centre)) in mesh.polygons.iter().zip(mesh.polygon_centres()).enumerate() {
        let first = positions.len() as u32;
        for &corner in polygon.corners() {
            positions.push(mesh.positions[corner as usize]);
            normals.push(vertex_normals[corner as usize]);
            tangents.push(vertex_tangents[corner as usize]);
            face_normals.push(polygon_normals[i]);
            face_tangents.push(polygon_tangents[i]);
            face_centres.push(centre);
        }
        indices.extend(polygon.triangles().iter().flatten().map(|&i| first + i as u32));
    }
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, arrays(&positions))
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, arrays(&normals))
        .with_inserted_attribute(TANGENT, arrays(&tangents))
        .with_inserted_attribute(FACE_NORMAL, arrays(&face_normals))
        .with_inserted_attribute(FACE_TANGENT, arrays(&face_tangents))
        .with_inserted_attribute(FACE_CENTRE, arrays(&face_centres))
        .with_inserted_indices(Indices::U32(indices))
}

fn arrays(vectors: &[glam::Vec3]) -> Vec<[f32; 3]> {
    vectors.iter().map(|v| v.to_array()).collect()
}

/// Drops meshes that no object uses: a slider over a parameter makes hundreds.
pub(super) fn forget_unused_meshes(world: &mut World, registry: &Registry) {
    /// The most that stay for a change back.
    const SPARE: usize = 16;
    if !std::mem::take(&mut world.resource_mut::<ShapeMeshes>().grown) {
        return;
    }
    // Views may have another tessellation.
    let mut views = world.query::<&Overrides>();
    let counts: Vec<_> = views.iter(world).filter_map(|overrides| overrides.tessellation).collect();
    let mut query = world.query::<&ShownObject>();
    let used: HashSet<_> = query
        .iter(world)
        .filter_map(|object| {
            let shape = registry.shape(&object.0.object_type)?;
            let of_views = counts.iter().map(|count| Some(shape.tessellation(Some(*count))));
            let counts = iter::once(object.0.tessellation).chain(of_views);
            Some(counts.map(|count| shape.key(&object.0.shape, count)).collect::<Vec<_>>())
        })
        .flatten()
        .collect();
    let mut meshes = world.resource_mut::<ShapeMeshes>();
    if meshes.known.len() > used.len() + SPARE {
        meshes.known.retain(|key, _| used.contains(key));
    }
}
