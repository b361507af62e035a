//! Meshes for the renderer, shared by all objects of one type with equal parameters and tessellations.

use std::{
    cmp::Ordering,
    collections::{HashMap, HashSet, hash_map::Entry},
};

use bevy::{
    asset::{Assets, Handle, RenderAssetUsages},
    ecs::prelude::*,
    mesh::{Indices, Mesh, Mesh3d, PrimitiveTopology},
};

use rayon::prelude::*;

use super::{
    drawn::Drawn,
    facing,
    material::{Attachments, FACE_CENTRE, FACE_NORMAL, FACE_TANGENT, TANGENT, Vertices},
    shown::ShownObject,
};
use crate::{
    registry::Registry,
    scene::Object,
    shape::{MeshKey, PolygonMesh},
    text::plural,
};

/// The most that one mesh may take on the GPU, bytes. On the way there it is held up to three times.
pub const MESH_BUDGET: u64 = 1 << 30;
/// The most that the meshes of a window may take together, bytes: as they are held up to three times on the way, the whole
/// window takes about 1.5 GB then.
pub const WINDOW_BUDGET: u64 = 384 << 20;
/// The most bytes of meshes that are on the GPU at once where nobody waits for the next frame. Beyond it shapes are drawn
/// in batches: the same picture, later.
pub const BATCH: u64 = 64 << 20;
/// The meshes without objects that stay for a change back: at most so many, and so many bytes.
const SPARE: usize = 16;
const SPARE_BYTES: u64 = 64 << 20;
/// The meshes that are made at once, at most. Together they may go beyond the budget, before they are counted.
const AT_ONCE: usize = 16;

/// The meshes by object type, parameters and tessellation. Meshes are large, so each is made only in the form that its
/// shading model needs, and once the GPU has it, it is nowhere else.
#[derive(Resource)]
pub struct ShapeMeshes {
    known: HashMap<(MeshKey, Vertices), Known>,
    /// The bytes of all, the most that several may have, and the most that one may have alone.
    bytes: u64,
    together: u64,
    alone: u64,
    /// Those for which there was no room, and the objects that are not drawn for want of them.
    refused: HashSet<(MeshKey, Vertices)>,
    /// The bytes for which the last one was too large.
    reached: u64,
    left_out: Vec<Entity>,
    /// True if there is more room than when they were refused.
    room: bool,
    /// True if meshes were added since unused ones were last dropped.
    grown: bool,
}

/// How much a shape is needed: what no picture shows comes last, then what is farther away.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Need {
    /// No picture shows it.
    pub(super) hidden: bool,
    /// The distance from the camera, metres.
    pub(super) distance: f32,
}

impl Need {
    /// Those that are needed more come first.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        self.hidden.cmp(&other.hidden).then(self.distance.total_cmp(&other.distance))
    }
}

struct Known {
    mesh: Handle<Mesh>,
    bytes: u64,
}

impl Default for ShapeMeshes {
    fn default() -> Self {
        Self {
            known: HashMap::new(),
            bytes: 0,
            together: WINDOW_BUDGET,
            alone: MESH_BUDGET,
            refused: HashSet::new(),
            reached: WINDOW_BUDGET,
            left_out: Vec::new(),
            room: false,
            grown: false,
        }
    }
}

impl ShapeMeshes {
    /// Holds so many bytes of several meshes, or of one alone, instead of [`WINDOW_BUDGET`] and
    /// [`MESH_BUDGET`].
    pub fn limit(&mut self, together: u64, alone: u64) {
        (self.together, self.alone) = (together, alone);
    }

    /// The bytes of all meshes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// True if there is no mesh.
    pub(super) fn is_empty(&self) -> bool {
        self.known.is_empty()
    }

    /// Takes all meshes from objects and from the GPU. Those that were left out before can be tried once there is
    /// [room](Self::make_room).
    pub(super) fn clear(world: &mut World) {
        let mut drawn = world.query_filtered::<Entity, (With<Mesh3d>, With<Drawn>)>();
        for drawable in drawn.iter(world).collect::<Vec<_>>() {
            take_off(world, drawable);
        }
        let mut meshes = world.resource_mut::<Self>();
        meshes.known.clear();
        meshes.bytes = 0;
    }

    /// Tries the objects again that were left out.
    pub(super) fn make_room(&mut self) {
        self.room = true;
    }

    /// Tries all objects again.
    pub(super) fn restart(world: &mut World) {
        let mut objects = world.query::<&mut ShownObject>();
        objects.iter_mut(world).for_each(|mut object| object.set_changed());
        let mut meshes = world.resource_mut::<Self>();
        meshes.refused.clear();
        meshes.left_out.clear();
    }

    /// Makes the meshes of objects that are not yet known, as long as there is room: first those with the greatest need,
    /// which `need` tells of each object by its index.
    pub(super) fn make<'a>(
        &mut self,
        objects: impl Iterator<Item = (&'a Object, Vertices)>,
        need: impl Fn(usize) -> Need,
        registry: &Registry,
        assets: &mut Assets<Mesh>,
    ) {
        let mut places = HashMap::new();
        let mut missing: Vec<(Need, _)> = Vec::new();
        for (i, (object, vertices)) in objects.enumerate() {
            let Some(shape) = registry.shape(&object.object_type) else { continue };
            let key = (shape.key(&object.shape, object.tessellation), vertices);
            if self.known.contains_key(&key) || self.refused.contains(&key) {
                continue;
            }
            let need = need(i);
            match places.entry(key.clone()) {
                Entry::Vacant(place) => {
                    place.insert(missing.len());
                    missing.push((need, (key, shape, object)));
                }
                Entry::Occupied(place) => {
                    let known = &mut missing[*place.get()].0;
                    if need.order(known).is_lt() {
                        *known = need;
                    }
                }
            }
        }
        missing.sort_by(|a, b| a.0.order(&b.0));
        let missing: Vec<_> = missing.into_iter().map(|(_, shape)| shape).collect();
        self.grown |= !missing.is_empty();
        let mut missing = missing.into_iter();
        while !missing.as_slice().is_empty() {
            if !self.refused.is_empty() {
                self.refused.extend(missing.by_ref().map(|(key, ..)| key));
                return;
            }
            let made: Vec<_> = missing.by_ref().take(rayon::current_num_threads().min(AT_ONCE)).collect();
            let made: Vec<_> = made
                .into_par_iter()
                .map(|(key, shape, object)| {
                    let mesh = shape.mesh(&object.shape, shape.tessellation(object.tessellation));
                    let mut drawn = match key.1 {
                        Vertices::Shared => shared_mesh(&mesh),
                        Vertices::Apart => face_mesh(&mesh),
                    };
                    facing::tell(&mut drawn, &mesh, key.1);
                    (key, drawn)
                })
                .collect();
            for (key, mesh) in made {
                let bytes = size(&mesh);
                let most = if self.bytes == 0 { self.alone.max(self.together) } else { self.together };
                if self.bytes + bytes > most {
                    self.reached = most;
                    self.refused.insert(key);
                } else {
                    self.bytes += bytes;
                    self.known.insert(key, Known { mesh: assets.add(mesh), bytes });
                }
            }
        }
    }

    /// The mesh of an object, if it was made.
    pub(super) fn get(&self, key: MeshKey, vertices: Vertices) -> Option<Handle<Mesh>> {
        self.known.get(&(key, vertices)).map(|known| known.mesh.clone())
    }

    /// Leaves an object out, for which there is no mesh.
    pub(super) fn leave_out(&mut self, object: Entity) {
        self.left_out.push(object);
    }

    /// The objects that were left out, to be tried again if the scene is another one or others made room.
    pub(super) fn try_again(&mut self, scene_changed: bool) -> Vec<Entity> {
        if !scene_changed && !self.room {
            return Vec::new();
        }
        self.room = false;
        self.refused.clear();
        std::mem::take(&mut self.left_out)
    }

    /// The reason why objects are missing in the picture, if any are.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        let count = self.refused.len();
        (count > 0).then(|| {
            format!(
                "the shapes of this scene need more than the {} MiB of GPU memory that meshes may take: {} {} not drawn; \
                 give objects a lower tessellation or shapes that they share",
                self.reached >> 20,
                plural(count, "shape"),
                if count == 1 { "is" } else { "are" },
            )
        })
    }
}

/// Takes an object out of the picture. The material goes with the mesh: for the renderer an object with a new mesh and
/// the material of before is not a new one, and it would not be drawn again.
pub(super) fn take_off(world: &mut World, drawable: Entity) {
    let model = world.get::<Drawn>(drawable).map(Drawn::model);
    let attachment = model.and_then(|model| world.get_resource::<Attachments>()?.get(model));
    let Ok(mut entity) = world.get_entity_mut(drawable) else { return };
    entity.remove::<Mesh3d>();
    if let Some(attachment) = attachment {
        (attachment.detach)(&mut entity);
    }
}

/// The bytes of a mesh on the GPU.
fn size(mesh: &Mesh) -> u64 {
    (mesh.get_vertex_buffer_size() + mesh.get_index_buffer_bytes().map_or(0, <[u8]>::len)) as u64
}

/// The mesh for shading models that interpolate over shared vertices.
#[must_use]
pub fn shared_mesh(mesh: &PolygonMesh) -> Mesh {
    let indices = mesh.triangles().flat_map(|(_, corners)| corners).collect();
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
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
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD)
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

/// Drops meshes that no object uses: a slider over a parameter makes hundreds. Some are kept for a change back, unless
/// there is no room for others.
pub(super) fn forget_unused_meshes(world: &mut World) {
    if !std::mem::take(&mut world.resource_mut::<ShapeMeshes>().grown) {
        return;
    }
    let mut drawn = world.query::<&Mesh3d>();
    let used: HashSet<_> = drawn.iter(world).map(|mesh| mesh.id()).collect();
    let mut meshes = world.resource_mut::<ShapeMeshes>();
    let spare = meshes.known.values().filter(|known| !used.contains(&known.mesh.id()));
    let (count, bytes) = spare.fold((0, 0), |(count, bytes), known| (count + 1, bytes + known.bytes));
    let full = !meshes.refused.is_empty();
    if full || count > SPARE || bytes > SPARE_BYTES {
        meshes.known.retain(|_, known| used.contains(&known.mesh.id()));
        meshes.bytes -= bytes;
    }
    meshes.room = full && count > 0;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::Value;

    /// Different shapes: no two share a mesh.
    fn shapes(count: usize, tessellation: u32) -> Vec<Object> {
        let shape = |i: usize| {
            let mut object = Object { object_type: "superellipsoid".to_owned(), ..Object::default() };
            object.tessellation = Some(tessellation);
            object.shape.set("vertical_exponent", Value::Number(0.2 + 0.001 * i as f32));
            object
        };
        (0..count).map(shape).collect()
    }

    fn equal(_: usize) -> Need {
        Need::default()
    }

    #[test]
    fn shapes_with_the_greatest_need_get_the_room() {
        let registry = Registry::builtin();
        let (mut meshes, mut assets) = (ShapeMeshes::default(), Assets::default());
        let mut shapes = shapes(9, 8);
        meshes.make(
            shapes.iter().map(|shape| (shape, Vertices::Shared)).take(1),
            equal,
            &registry,
            &mut assets,
        );
        let one = meshes.bytes;
        meshes.limit(4 * one, 4 * one);
        // One more of the seventh shape, the nearest that is seen.
        shapes.push(shapes[6].clone());
        let need = |i: usize| Need { hidden: i < 5, distance: if i == 9 { 1.0 } else { 20.0 - i as f32 } };
        meshes.make(shapes.iter().map(|shape| (shape, Vertices::Shared)), need, &registry, &mut assets);
        let made: Vec<_> = (0..9)
            .filter(|i| {
                let shape = registry.shape("superellipsoid").expect("there is one");
                meshes.get(shape.key(&shapes[*i].shape, shapes[*i].tessellation), Vertices::Shared).is_some()
            })
            .collect();
        assert_eq!(made, [0, 6, 7, 8], "the first was there already");
        assert!(meshes.problem().is_some_and(|problem| problem.contains("5 shapes are not drawn")));
    }

    #[test]
    fn a_mesh_is_made_in_the_form_that_is_drawn() {
        let registry = Registry::builtin();
        let (mut meshes, mut assets) = (ShapeMeshes::default(), Assets::default());
        let shapes = shapes(3, 8);
        for (vertices, expected) in [(Vertices::Shared, 3), (Vertices::Shared, 3), (Vertices::Apart, 6)] {
            meshes.make(shapes.iter().map(|shape| (shape, vertices)), equal, &registry, &mut assets);
            assert_eq!((assets.len(), meshes.known.len()), (expected, expected));
        }
        let sizes: u64 = assets.iter().map(|(_, mesh)| size(mesh)).sum();
        assert!(meshes.bytes == sizes && sizes > 0, "{} are not {sizes}", meshes.bytes);
        assert!(assets.iter().all(|(_, mesh)| mesh.asset_usage == RenderAssetUsages::RENDER_WORLD));
    }

    #[test]
    fn meshes_beyond_the_budget_are_refused_with_the_remedy_until_there_is_room() {
        let registry = Registry::builtin();
        let (mut meshes, mut assets) = (ShapeMeshes::default(), Assets::default());
        let shapes = shapes(3 * AT_ONCE, 8);
        let all = || shapes.iter().map(|shape| (shape, Vertices::Shared));
        meshes.make(all().take(1), equal, &registry, &mut assets);
        // As much is taken already as leaves room for three more.
        let one = meshes.bytes;
        meshes.bytes = WINDOW_BUDGET - 3 * one;
        meshes.make(all(), equal, &registry, &mut assets);
        assert_eq!((meshes.known.len(), meshes.refused.len()), (4, 3 * AT_ONCE - 4));
        assert!(meshes.bytes <= WINDOW_BUDGET);
        let problem = meshes.problem().expect("there is no room");
        assert!(problem.contains("384 MiB") && problem.contains("44 shapes are not drawn"), "{problem}");
        assert!(problem.contains("lower tessellation"), "{problem}");

        let object = Entity::from_raw_u32(7).expect("an entity");
        meshes.leave_out(object);
        assert_eq!(meshes.try_again(false), [], "nothing has changed");
        meshes.room = true;
        meshes.bytes = 4 * one;
        assert_eq!(meshes.try_again(false), [object]);
        meshes.make(all(), equal, &registry, &mut assets);
        assert_eq!((meshes.problem(), meshes.known.len()), (None, shapes.len()));
    }
}
