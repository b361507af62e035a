//! Exchanging models, modes, parameters and shapes at run time: the frame after the choice shows the
//! new one, and no frame is without the object.

use super::{
    entities::{CurrentScene, LitObject, SceneEntities},
    illumination::IlluminationBuffer,
    live::LiveShaders,
    material::{Attachments, FACE_CENTRE, FACE_NORMAL, FACE_TANGENT, MaterialInputs, TANGENT},
};
use crate::{
    optics::colour::Encoding,
    reflection::ModelEntry,
    registry::Registry,
    scene::{MAX_OBJECTS, shines_from_everywhere},
    shading::Stage,
    shape::PolygonMesh,
};
use std::{
    cell::LazyCell,
    collections::{HashMap, HashSet},
};

use bevy::{
    asset::{Assets, Handle, RenderAssetUsages},
    ecs::prelude::*,
    mesh::{Indices, Mesh, Mesh3d, MeshTag, PrimitiveTopology},
    render::storage::ShaderBuffer,
};
use rayon::prelude::*;

/// The parameters of all objects, one table for each model in use. The row of an object is its place in
/// the scene, the same in every table. A table that changed is uploaded whole: a buffer that never grows
/// is replaced without touching any material. So that a slider moves no megabytes in a room of few
/// objects, there is room for the next power of two above their number; when a scene outgrows that, all
/// tables are made anew, and every object takes its material again.
#[derive(Default, Resource)]
pub struct ParameterTables {
    /// By model, and by its declaration, from which the layout follows.
    tables: HashMap<(&'static str, [usize; 2]), Table>,
    rows: usize,
}

struct Table {
    bytes: Vec<u8>,
    buffer: Handle<ShaderBuffer>,
    changed: bool,
}

impl ParameterTables {
    /// Makes room for so many objects; whether all rows have to be written anew.
    fn hold(&mut self, objects: usize) -> bool {
        /// Of the smallest table.
        const ROWS: usize = 64;
        if objects <= self.rows {
            return false;
        }
        self.rows = objects.next_power_of_two().clamp(ROWS, MAX_OBJECTS);
        self.tables.clear();
        true
    }

    /// Writes the parameters of an object; the buffer of the table.
    fn set(
        &mut self,
        model: &ModelEntry,
        row: usize,
        parameters: &[u8],
        buffers: &mut Assets<ShaderBuffer>,
    ) -> Handle<ShaderBuffer> {
        let declaration =
            [std::ptr::from_ref(model.declaration) as usize, model.parameters.as_ptr() as usize];
        self.tables.retain(|(id, known), _| *id != model.declaration.id || *known == declaration);
        let table = self.tables.entry((model.declaration.id, declaration)).or_insert_with(|| {
            let bytes = vec![0; parameters.len() * self.rows];
            let buffer = buffers.add(ShaderBuffer::new(&bytes, RenderAssetUsages::default()));
            Table { bytes, buffer, changed: true }
        });
        let start = row * parameters.len();
        let place = &mut table.bytes[start..start + parameters.len()];
        if place != parameters {
            place.copy_from_slice(parameters);
            table.changed = true;
        }
        table.buffer.clone()
    }

    /// Hands what changed to the renderer.
    fn upload(&mut self, buffers: &mut Assets<ShaderBuffer>) {
        for table in self.tables.values_mut().filter(|t| t.changed) {
            table.changed = false;
            if let Some(mut buffer) = buffers.get_mut(&table.buffer) {
                buffer.data = Some(table.bytes.clone());
            }
        }
    }
}

/// The meshes by object type and tessellation: with shared vertices for modes that interpolate, with
/// the vertices of each polygon apart for modes that calculate per polygon. Both are made together, so
/// that changing the mode finds its mesh ready.
#[derive(Default, Resource)]
pub struct ShapeMeshes(HashMap<(&'static str, u32), MeshPair>);

#[derive(Clone)]
struct MeshPair {
    shared: Handle<Mesh>,
    faces: Handle<Mesh>,
}

/// The mesh for modes that interpolate over shared vertices.
#[must_use]
pub fn shared_mesh(mesh: &PolygonMesh) -> Mesh {
    let indices = mesh
        .polygons
        .iter()
        .flat_map(|p| p.triangles().iter().flatten().map(|&i| p.corners()[i]))
        .collect::<Vec<_>>();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, arrays(&mesh.positions))
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, arrays(&mesh.vertex_normals()))
        .with_inserted_attribute(TANGENT, arrays(&mesh.vertex_tangents()))
        .with_inserted_indices(Indices::U32(indices))
}

/// The mesh for modes that calculate per polygon: no vertex is shared, and each knows its polygon.
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

/// What an object is drawn with at present.
#[derive(Clone, Component, Debug, PartialEq)]
pub struct Drawn {
    model: String,
    mode: String,
    encoding: Encoding,
    everywhere: bool,
    /// What was known of the model: a file that is read again makes another.
    version: usize,
}

/// An object whose new shader is still being tried: it stays as it is for so long.
#[derive(Clone, Component, Copy, Debug, Default)]
pub struct AwaitsShader;

impl Drawn {
    /// Id of the reflection model.
    #[must_use]
    pub fn model(&self) -> &str {
        &self.model
    }

    /// Id of the shading mode.
    #[must_use]
    pub fn mode(&self) -> &str {
        &self.mode
    }
}

/// Gives every object whose shape, model, mode or parameters changed its mesh and its material. Exclusive, so that
/// mesh and material change in one step.
pub fn swap(world: &mut World) {
    let objects = world.resource::<SceneEntities>().objects.len().min(MAX_OBJECTS);
    let all = world.resource_mut::<ParameterTables>().bypass_change_detection().hold(objects);
    let pending = {
        let scene = world.resource_ref::<CurrentScene>();
        let scene_changed = scene.is_changed();
        let mut pending = Vec::new();
        let mut query = world.query::<(Ref<LitObject>, Option<&Drawn>, Has<AwaitsShader>)>();
        let scene = &world.resource::<CurrentScene>().0;
        let registry = world.resource_ref::<Registry>();
        let scene_changed = scene_changed || registry.is_changed();
        // Asked only where something changed: most frames change nothing.
        let everywhere = LazyCell::new(|| shines_from_everywhere(scene, world.resource::<Registry>()));
        // More objects than a table has rows are no legal scene; what is beyond is not drawn.
        for (row, &entity) in world.resource::<SceneEntities>().objects.iter().enumerate().take(MAX_OBJECTS) {
            let Ok((object, drawn, waits)) = query.get(world, entity) else { continue };
            let now = || Drawn {
                model: scene.model_of(&object.0).to_owned(),
                mode: scene.mode_of(&object.0).to_owned(),
                encoding: scene.display.encoding,
                everywhere: *everywhere,
                version: registry.model(scene.model_of(&object.0)).map_or(0, ModelEntry::version),
            };
            if all
                || waits
                || object.is_changed()
                || drawn.is_none()
                || (scene_changed && drawn != Some(&now()))
            {
                pending.push((row, entity, object.0.clone(), now()));
            }
        }
        pending
    };
    if pending.is_empty() {
        return;
    }
    let registry = world.resource::<Registry>().clone();
    let illumination = world.resource::<IlluminationBuffer>().0.clone();
    // Curves take about a millisecond each; equal parameters share one.
    let rows: Vec<_> = pending
        .par_iter()
        .map(|(_, _, object, now)| {
            let model = registry.model(&now.model)?;
            Some(model.row(&object.material, now.encoding, now.everywhere))
        })
        .collect();
    for ((row, entity, object, now), bytes) in pending.into_iter().zip(rows) {
        // The checker refuses scenes with unknown ids; should one come from elsewhere, the object
        // keeps what it has.
        let (Some(model), Some(mode), Some(shape), Some(bytes)) =
            (registry.model(&now.model), registry.mode(&now.mode), registry.shape(&object.kind), bytes)
        else {
            continue;
        };
        let tessellation = shape.tessellation(object.tessellation);
        let pair = world.resource_scope(|world, mut meshes: Mut<ShapeMeshes>| {
            meshes
                .0
                .entry((shape.declaration.id, tessellation))
                .or_insert_with(|| {
                    let mesh = shape.mesh(tessellation);
                    let mut assets = world.resource_mut::<Assets<Mesh>>();
                    MeshPair { shared: assets.add(shared_mesh(&mesh)), faces: assets.add(face_mesh(&mesh)) }
                })
                .clone()
        });
        let shader = world.resource_scope(|world, mut shaders: Mut<LiveShaders>| {
            shaders.get(world, model, mode, &registry)
        });
        let Some(shader) = shader else {
            world.entity_mut(entity).insert(AwaitsShader);
            continue;
        };
        let faces = mode.declaration.stage == Stage::Polygon;
        let table = world.resource_scope(|world, mut tables: Mut<ParameterTables>| {
            tables.set(model, row, &bytes, &mut world.resource_mut::<Assets<ShaderBuffer>>())
        });
        let ingredients =
            MaterialInputs { parameters: table, illumination: illumination.clone(), shader, faces };
        let attachments = world.resource::<Attachments>();
        let old = world
            .get::<Drawn>(entity)
            .filter(|d| d.model != now.model)
            .and_then(|d| attachments.get(d.model.as_str()));
        let Some(new) = attachments.get(now.model.as_str()) else { continue };
        let Ok(mut entity) = world.get_entity_mut(entity) else { continue };
        if let Some(old) = old {
            (old.detach)(&mut entity);
        }
        (new.attach)(&mut entity, ingredients);
        let mesh = if faces { pair.faces } else { pair.shared };
        if entity.get::<Mesh3d>().map(|m| &m.0) != Some(&mesh) {
            entity.insert(Mesh3d(mesh));
        }
        entity.insert((now, MeshTag(row as u32))).remove::<AwaitsShader>();
    }
    forget_unused_meshes(world, &registry);
    world.resource_scope(|world, mut tables: Mut<ParameterTables>| {
        tables.upload(&mut world.resource_mut::<Assets<ShaderBuffer>>());
    });
}

/// Lets go of meshes that no object has any more: a slider over the tessellation makes hundreds.
fn forget_unused_meshes(world: &mut World, registry: &Registry) {
    /// As many may stay for a change back.
    const SPARE: usize = 16;
    let mut query = world.query::<&LitObject>();
    let used: HashSet<_> = query
        .iter(world)
        .filter_map(|object| {
            let shape = registry.shape(&object.0.kind)?;
            Some((shape.declaration.id, shape.tessellation(object.0.tessellation)))
        })
        .collect();
    let mut meshes = world.resource_mut::<ShapeMeshes>();
    if meshes.0.len() > used.len() + SPARE {
        meshes.0.retain(|key, _| used.contains(key));
    }
}
