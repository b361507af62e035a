//! Meshes for the renderer, shared by all objects of one type with equal parameters and tessellations.

use std::{
    cmp::Ordering,
    collections::{HashMap, HashSet, hash_map::Entry},
};

use bevy::{
    asset::RenderAssetUsages,
    ecs::{lifecycle::HookContext, world::DeferredWorld},
    mesh::{Indices, MeshVertexAttribute, PrimitiveTopology},
    prelude::*,
};

use rayon::prelude::*;

use super::{
    drawn::Drawn,
    facing,
    material::{FACE_CENTRE, FACE_NORMAL, FACE_TANGENT, TANGENT, Vertices, detach},
    shown::ShownObject,
};
use crate::{
    declared::with_defaults,
    registry::Registry,
    scene::Object,
    shape::{self, MeshKey, PolygonMesh, Says},
    text::plural,
};

/// Maximum size of a mesh on the GPU, in bytes. On the way there up to three copies of it exist.
pub const MESH_BUDGET: u64 = 1 << 30;
/// Maximum total size of a window's meshes, in bytes: since up to three copies exist on the way, the whole
/// window then takes about 1.5 GB.
pub const WINDOW_BUDGET: u64 = 384 << 20;
/// Maximum size of meshes on the GPU at once when nobody waits for the next frame, in bytes. If exceeded,
/// shapes are drawn in batches: the same picture, later.
pub const BATCH: u64 = 32 << 20;
/// Maximum number of triangles that a window draws in one frame.
pub const WINDOW_TRIANGLES: u64 = 1 << 27;
/// The same without a GPU: two cores draw 20 million in some seconds, and a window that takes longer does not answer.
pub const SOFTWARE_TRIANGLES: u64 = 1 << 25;
/// Maximum number of triangles in a frame of a single picture without a GPU: the driver keeps those that it has prepared,
/// about 360 bytes each with four samples, until its threads have drawn them, 2.3 GB of them if nobody waits.
pub const PICTURE_TRIANGLES: u64 = 1 << 18;
/// Maximum number and size of unused meshes kept in case they are needed again.
const SPARE: usize = 16;
const SPARE_BYTES: u64 = 64 << 20;
/// Maximum number of meshes built at once. Together they may exceed the budget before they are counted.
const AT_ONCE: usize = 16;

with_defaults! {
    /// The meshes by object type, parameters and tessellation. Meshes are large, so each is built only in the
    /// form that its shading model needs, and exists only on the GPU once it is there.
    #[derive(Resource)]
    pub struct ShapeMeshes {
        known: HashMap<(MeshKey, Vertices), Known> = HashMap::new(),
        /// The size of all in bytes, the maximum for several, and the maximum for a single one.
        bytes: u64 = 0,
        together: u64 = WINDOW_BUDGET,
        alone: u64 = MESH_BUDGET,
        /// The triangles of all objects in all views, and their maximum.
        triangles: u64 = 0,
        most_triangles: u64 = WINDOW_TRIANGLES,
        /// True if objects beyond that maximum are drawn later, with the meshes that are there.
        in_batches: bool = false,
        /// True if objects were not drawn because others hide them.
        hidden: bool = false,
        /// Meshes that did not fit, and the objects that are not drawn without them.
        refused: HashSet<(MeshKey, Vertices)> = HashSet::new(),
        /// The total size that the last rejected mesh would have reached, in bytes.
        reached: u64 = WINDOW_BUDGET,
        /// With their triangles if these did not fit, and otherwise with 0.
        omitted: Vec<(Entity, u64)> = Vec::new(),
        omissions: u64 = 0,
        /// True if there is more room than when they were refused.
        room: bool = false,
        /// True if meshes were added since unused ones were last dropped.
        grown: bool = false,
    }
}

/// The priority of a shape: shapes outside all pictures come last, and nearer ones before others.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Need {
    /// True if no picture shows it.
    pub(super) hidden: bool,
    /// Distance from the camera, in metres.
    pub(super) distance: f32,
}

impl Need {
    /// Orders shapes by priority, highest first.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        self.hidden.cmp(&other.hidden).then(self.distance.total_cmp(&other.distance))
    }
}

struct Known {
    mesh: Handle<Mesh>,
    bytes: u64,
    triangles: u64,
    /// The largest distance of a corner from the centre.
    radius: f32,
}

/// The number of triangles of an object in a view, counted in [`ShapeMeshes`] as long as it is drawn.
#[derive(Component)]
#[component(immutable, on_insert = count, on_discard = discount)]
struct Triangles(u64);

fn count(world: DeferredWorld, context: HookContext) {
    let add = |sum: u64, own: u64| sum + own;
    update(world, context, add);
}

fn discount(world: DeferredWorld, context: HookContext) {
    update(world, context, u64::saturating_sub);
}

fn update(mut world: DeferredWorld, context: HookContext, with: fn(u64, u64) -> u64) {
    let Some(own) = world.get::<Triangles>(context.entity).map(|triangles| triangles.0) else { return };
    if let Some(mut meshes) = world.get_resource_mut::<ShapeMeshes>() {
        meshes.triangles = with(meshes.triangles, own);
    }
}

impl ShapeMeshes {
    /// Limits the meshes to this many bytes together and for a single one, instead of [`WINDOW_BUDGET`] and
    /// [`MESH_BUDGET`], and no longer limits the triangles: whoever asks for one picture waits for it.
    pub fn limit(&mut self, together: u64, alone: u64) {
        (self.together, self.alone, self.most_triangles) = (together, alone, u64::MAX);
    }

    /// Limits the triangles to this many in one frame, instead of [`WINDOW_TRIANGLES`].
    pub fn limit_triangles(&mut self, most: u64) {
        self.most_triangles = most;
    }

    /// Limits the triangles to this many in one frame, and keeps the meshes of the objects beyond for later frames; without a
    /// limit for [`u64::MAX`].
    pub(super) fn draw_in_batches(&mut self, most: u64) {
        (self.most_triangles, self.in_batches) = (most, most < u64::MAX);
    }

    /// The size of all meshes, in bytes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// True if there are no meshes.
    pub(super) fn is_empty(&self) -> bool {
        self.known.is_empty()
    }

    /// The objects that are not drawn, as their meshes or their triangles do not fit. One that several views leave out
    /// comes several times.
    pub fn left_out(&self) -> impl Iterator<Item = Entity> {
        self.omitted.iter().map(|(object, _)| *object)
    }

    /// The number of changes of these objects since the start.
    #[must_use]
    pub fn omissions(&self) -> u64 {
        self.omissions
    }

    /// The number of omitted objects.
    pub(super) fn omitted(&self) -> usize {
        self.omitted.len()
    }

    /// True if objects were omitted because of their triangles.
    pub(super) fn is_crowded(&self) -> bool {
        self.omitted.iter().any(|(_, triangles)| *triangles > 0)
    }

    /// True if these meshes have more triangles than may be drawn at once.
    pub(super) fn are_too_many(&self, keys: impl Iterator<Item = (MeshKey, Vertices)>) -> bool {
        let triangles = keys.filter_map(|key| self.known.get(&key)).map(|known| known.triangles);
        self.most_triangles < u64::MAX && triangles.sum::<u64>() > self.most_triangles
    }

    /// The largest distance of a corner of a mesh from its centre, if the mesh is there.
    pub(super) fn radius(&self, key: &(MeshKey, Vertices)) -> Option<f32> {
        self.known.get(key).map(|known| known.radius)
    }

    /// True if objects beyond the triangles of a frame are drawn later.
    pub(super) fn are_in_batches(&self) -> bool {
        self.in_batches
    }

    /// Notes that objects are not drawn because others hide them from the camera where it is.
    pub(super) fn note_hidden(&mut self) {
        self.hidden = true;
    }

    /// True if objects were not drawn because others hide them, since all were [tried](Self::restart).
    pub(super) fn hides(&self) -> bool {
        self.hidden
    }

    /// Removes all meshes from objects and from the GPU. Objects that were omitted can be tried again once
    /// there is [room](Self::make_room).
    pub(super) fn clear(world: &mut World) {
        Self::take_all_off(world);
        let mut meshes = world.resource_mut::<Self>();
        meshes.known.clear();
        meshes.bytes = 0;
    }

    /// Removes all meshes from objects; they stay on the GPU.
    pub(super) fn take_all_off(world: &mut World) {
        let mut drawn = world.query_filtered::<Entity, (With<Mesh3d>, With<Drawn>)>();
        for drawable in drawn.iter(world).collect::<Vec<_>>() {
            take_off(world, drawable);
        }
    }

    /// Allows omitted objects to be tried again.
    pub(super) fn make_room(&mut self) {
        self.room = true;
    }

    /// Tries all objects again.
    pub(super) fn restart(world: &mut World) {
        let mut objects = world.query::<&mut ShownObject>();
        objects.iter_mut(world).for_each(|mut object| object.set_changed());
        let mut meshes = world.resource_mut::<Self>();
        meshes.refused.clear();
        meshes.omitted.clear();
        meshes.omissions += 1;
        meshes.hidden = false;
    }

    /// Builds missing meshes of objects, as long as there is room, and no more than are drawn at once: those with
    /// the highest priority first, which `need` returns for the index of an object.
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
        let mut built = 0;
        while !missing.as_slice().is_empty() {
            if !self.refused.is_empty() || built > self.most_triangles {
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
                    (key, drawn, mesh.positions.iter().map(|corner| corner.length()).fold(0.0, f32::max))
                })
                .collect();
            for (key, mesh, radius) in made {
                let bytes = size(&mesh);
                let most = if self.bytes == 0 { self.alone.max(self.together) } else { self.together };
                if self.bytes + bytes > most {
                    self.reached = most;
                    self.refused.insert(key);
                } else {
                    self.bytes += bytes;
                    let triangles = mesh.indices().map_or(0, |indices| indices.len() as u64 / 3);
                    built += triangles;
                    self.known.insert(key, Known { mesh: assets.add(mesh), bytes, triangles, radius });
                }
            }
        }
    }

    /// The mesh of an object, if it was built, and if there is room for its triangles; they count from now on. There is room for
    /// those of one object alone, and for those of objects that no view shows.
    ///
    /// # Errors
    /// Returns the number of triangles without room; 0 without a mesh.
    pub(super) fn put_on(
        world: &mut World,
        drawable: Entity,
        key: MeshKey,
        vertices: Vertices,
        is_seen: bool,
    ) -> Result<Handle<Mesh>, u64> {
        let before = world.get::<Triangles>(drawable).map_or(0, |triangles| triangles.0);
        let meshes = world.resource::<Self>();
        let known = meshes.known.get(&(key, vertices)).ok_or(0u64)?;
        let (mesh, triangles) = (known.mesh.clone(), if is_seen { known.triangles } else { 0 });
        let others = meshes.triangles - before;
        if others > 0 && triangles > 0 && others + triangles > meshes.most_triangles {
            return Err(triangles);
        }
        if triangles != before {
            world.get_entity_mut(drawable).map_err(|_| 0u64)?.insert(Triangles(triangles));
        }
        Ok(mesh)
    }

    /// Omits an object without a mesh, or with so many triangles that they do not fit.
    pub(super) fn leave_out(&mut self, object: Entity, triangles: u64) {
        self.omitted.push((object, triangles));
        self.omissions += 1;
    }

    /// The omitted objects, to be tried again: all if the scene has changed. If memory was freed, those whose triangles fit,
    /// and if there are none, those without meshes.
    pub(super) fn try_again(&mut self, scene_changed: bool) -> Vec<Entity> {
        if !scene_changed && !self.room {
            return Vec::new();
        }
        self.room = false;
        let (mut triangles, most) = (self.triangles, self.most_triangles);
        let fits = |own: u64| {
            let fits = own > 0 && (triangles == 0 || triangles + own <= most);
            triangles += if fits { own } else { 0 };
            fits
        };
        if !scene_changed {
            let next = self.take_out(fits);
            if !next.is_empty() {
                return next;
            }
        }
        self.refused.clear();
        self.take_out(|own| scene_changed || own == 0)
    }

    /// Those omitted objects whose triangles are chosen; the others stay omitted.
    fn take_out(&mut self, mut is_chosen: impl FnMut(u64) -> bool) -> Vec<Entity> {
        let (chosen, others): (Vec<_>, _) =
            std::mem::take(&mut self.omitted).into_iter().partition(|(_, own)| is_chosen(*own));
        self.omitted = others;
        self.omissions += u64::from(!chosen.is_empty());
        chosen.into_iter().map(|(object, _)| object).collect()
    }

    /// The reason why objects are missing in the picture, if any.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        let count = self.refused.len();
        if count == 0 && self.is_crowded() {
            return Some(format!(
                "the objects of this scene have more than the {} million triangles that a window draws: {} {} not drawn; \
                 give objects a lower tessellation",
                self.most_triangles / 1_000_000,
                plural(self.omitted.len(), "object"),
                if self.omitted.len() == 1 { "is" } else { "are" },
            ));
        }
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

/// Removes an object from the picture. The material is removed with the mesh: the renderer would not treat an
/// object with a new mesh and the previous material as new, and would not draw it again.
pub(super) fn take_off(world: &mut World, drawable: Entity) {
    let Ok(mut entity) = world.get_entity_mut(drawable) else { return };
    entity.remove::<(Mesh3d, Triangles)>();
    detach(&mut entity);
}

/// The size of a mesh on the GPU, in bytes.
fn size(mesh: &Mesh) -> u64 {
    (mesh.get_vertex_buffer_size() + mesh.get_index_buffer_bytes().map_or(0, <[u8]>::len)) as u64
}

/// The mesh for shading models that interpolate over shared vertices.
#[must_use]
pub fn shared_mesh(mesh: &PolygonMesh) -> Mesh {
    drawn(shape::Vertices::shared(mesh))
}

/// The mesh for shading models that calculate per polygon: no vertex is shared, and each has the data of its
/// polygon.
#[must_use]
pub fn face_mesh(mesh: &PolygonMesh) -> Mesh {
    drawn(shape::Vertices::apart(mesh))
}

fn drawn(vertices: shape::Vertices) -> Mesh {
    let mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::RENDER_WORLD);
    let with = |mesh: Mesh, (says, values)| mesh.with_inserted_attribute(attribute(says), values);
    vertices.attributes.into_iter().fold(mesh, with).with_inserted_indices(Indices::U32(vertices.indices))
}

fn attribute(says: Says) -> MeshVertexAttribute {
    match says {
        Says::Position => Mesh::ATTRIBUTE_POSITION,
        Says::Normal => Mesh::ATTRIBUTE_NORMAL,
        Says::Tangent => TANGENT,
        Says::FaceNormal => FACE_NORMAL,
        Says::FaceTangent => FACE_TANGENT,
        Says::FaceCentre => FACE_CENTRE,
    }
}

/// Drops unused meshes: dragging the slider of a parameter makes hundreds. Some are kept in case they are
/// needed again, unless others need the memory.
pub(super) fn forget_unused_meshes(world: &mut World) {
    let mut meshes = world.resource_mut::<ShapeMeshes>();
    if meshes.in_batches && meshes.is_crowded() || !std::mem::take(&mut meshes.grown) {
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
    meshes.room = full && count > 0 && !meshes.in_batches;
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
        // One more of the seventh shape, the nearest visible one.
        shapes.push(shapes[6].clone());
        let need = |i: usize| Need { hidden: i < 5, distance: if i == 9 { 1.0 } else { 20.0 - i as f32 } };
        meshes.make(shapes.iter().map(|shape| (shape, Vertices::Shared)), need, &registry, &mut assets);
        let made: Vec<_> = (0..9)
            .filter(|i| {
                let shape = registry.shape("superellipsoid").expect("there is one");
                let key = shape.key(&shapes[*i].shape, shapes[*i].tessellation);
                meshes.known.contains_key(&(key, Vertices::Shared))
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
        // Enough is taken to leave room for three more.
        let one = meshes.bytes;
        meshes.bytes = WINDOW_BUDGET - 3 * one;
        meshes.make(all(), equal, &registry, &mut assets);
        assert_eq!((meshes.known.len(), meshes.refused.len()), (4, 3 * AT_ONCE - 4));
        assert!(meshes.bytes <= WINDOW_BUDGET);
        let problem = meshes.problem().expect("there is no room");
        assert!(problem.contains("384 MiB") && problem.contains("44 shapes are not drawn"), "{problem}");
        assert!(problem.contains("lower tessellation"), "{problem}");

        let object = Entity::from_raw_u32(7).expect("an entity");
        meshes.leave_out(object, 0);
        assert_eq!(meshes.try_again(false), [], "nothing has changed");
        meshes.room = true;
        meshes.bytes = 4 * one;
        assert_eq!(meshes.try_again(false), [object]);
        meshes.make(all(), equal, &registry, &mut assets);
        assert_eq!((meshes.problem(), meshes.known.len()), (None, shapes.len()));
    }

    #[test]
    fn objects_with_more_triangles_than_a_window_draws_wait_for_room() {
        let registry = Registry::builtin();
        let (mut meshes, mut assets) = (ShapeMeshes::default(), Assets::default());
        let shape = shapes(1, 8).remove(0);
        meshes.make(std::iter::once((&shape, Vertices::Shared)), equal, &registry, &mut assets);
        let entry = registry.shape("superellipsoid").expect("there is one");
        let key = || entry.key(&shape.shape, shape.tessellation);
        let one = meshes.known.values().next().expect("it was made").triangles;
        assert!(one > 0);
        meshes.most_triangles = 2 * one;
        let mut world = World::new();
        world.insert_resource(meshes);
        let objects = [(); 3].map(|()| world.spawn_empty().id());
        let put_on = |world: &mut World, i: usize| {
            let put_on = ShapeMeshes::put_on(world, objects[i], key(), Vertices::Shared, true);
            if let Err(triangles) = put_on {
                world.resource_mut::<ShapeMeshes>().leave_out(objects[i], triangles);
            }
            put_on.is_ok()
        };
        assert!(put_on(&mut world, 0) && put_on(&mut world, 1) && !put_on(&mut world, 2));
        assert!(put_on(&mut world, 1), "its triangles count once");
        let problem = world.resource::<ShapeMeshes>().problem().expect("it is full");
        assert!(
            problem.contains("million triangles") && problem.contains("1 object is not drawn; give objects"),
            "{problem}"
        );
        let left_out: Vec<_> = world.resource::<ShapeMeshes>().left_out().collect();
        assert_eq!(left_out, [objects[2]]);

        take_off(&mut world, objects[0]);
        world.despawn(objects[1]);
        assert_eq!(world.resource::<ShapeMeshes>().triangles, 0);
        assert_eq!(world.resource_mut::<ShapeMeshes>().try_again(true), [objects[2]]);
        assert!(put_on(&mut world, 2) && world.resource::<ShapeMeshes>().problem().is_none());

        take_off(&mut world, objects[2]);
        world.resource_mut::<ShapeMeshes>().limit_triangles(one - 1);
        assert!(put_on(&mut world, 0) && !put_on(&mut world, 2), "one alone may have more");
        let unseen = ShapeMeshes::put_on(&mut world, objects[2], key(), Vertices::Shared, false);
        assert!(unseen.is_ok(), "what no view shows has none");
    }

    #[test]
    fn of_the_objects_left_out_those_that_fit_come_next_and_those_without_meshes_last() {
        let mut meshes = ShapeMeshes::default();
        meshes.limit_triangles(100);
        let objects: Vec<_> = (1..6).map(|i| Entity::from_raw_u32(i).expect("an entity")).collect();
        for (object, triangles) in objects.iter().zip([60, 0, 30, 60, 300]) {
            meshes.leave_out(*object, triangles);
        }
        let known = meshes.omissions();
        assert_eq!((meshes.try_again(false), meshes.omissions()), (vec![], known), "there is no more room");
        let mut next = || {
            let known = meshes.omissions();
            meshes.make_room();
            let next = meshes.try_again(false);
            assert_eq!(meshes.omissions() > known, !next.is_empty());
            next
        };
        assert_eq!(next(), [objects[0], objects[2]]);
        assert_eq!(next(), [objects[3]]);
        assert_eq!(next(), [objects[4]], "one alone may have more");
        assert_eq!(next(), [objects[1]]);
        assert_eq!(next(), []);
    }
}
