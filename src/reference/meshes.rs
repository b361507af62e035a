//! The meshes of a scene, each built once while it is needed.

use std::{
    collections::{HashMap, HashSet},
    ops::Range,
    sync::{Arc, OnceLock},
};

use bevy_platform::hash::RandomState;
use glam::Vec3;
use rayon::prelude::*;

use crate::{
    registry::Registry,
    scene::Object,
    shape::{
        Hierarchy, MeshKey, PolygonMesh, ShapeEntry,
        closed::{self, NotSolid},
        mesh::Polygon,
    },
};

/// Maximum number of polygons of meshes held at a time, about 100 bytes each: bounds the memory for scenes in
/// which every object has different parameters.
const POLYGONS_HELD: usize = 1 << 20;
/// Number of meshes built at a time.
const AT_ONCE: usize = 16;
/// Number of objects among which these are looked for.
const AHEAD: usize = 1024;

/// Number of neighbouring polygons of a patch: few, so that a patch is small, but enough to save more than its box costs.
const PATCH: usize = 32;

/// Neighbouring polygons of a mesh, in their box.
pub(super) struct Patch {
    polygons: Range<usize>,
    /// The place of the first triangle among all.
    first: usize,
    pub(super) centre: Vec3,
    /// Half the sides of the box.
    pub(super) half: Vec3,
}

impl Patch {
    pub(super) fn len(&self) -> usize {
        self.polygons.len()
    }

    /// All of a mesh.
    fn all(mesh: &PolygonMesh) -> Vec<Self> {
        let mut first = 0;
        let patch = |(i, polygons): (usize, &[Polygon])| {
            let corners = polygons.iter().flat_map(|polygon| polygon.corners());
            let [mut low, mut high] = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            for p in corners.map(|i| mesh.positions[*i as usize]) {
                (low, high) = (low.min(p), high.max(p));
            }
            let begin = first;
            first += polygons.iter().map(|polygon| polygon.triangles().len()).sum::<usize>();
            let polygons = i * PATCH..i * PATCH + polygons.len();
            Self { polygons, first: begin, centre: 0.5 * (low + high), half: 0.5 * (high - low) }
        };
        mesh.polygons.chunks(PATCH).enumerate().map(patch).collect()
    }
}

/// A mesh with its normals, shared by all objects with equal keys.
pub(crate) struct Prepared {
    pub(super) mesh: PolygonMesh,
    pub(super) polygon_normals: Vec<Vec3>,
    pub(super) polygon_centres: Vec<Vec3>,
    pub(super) vertex_normals: Vec<Vec3>,
    /// The tangents of polygons and vertices; only anisotropic models need them.
    tangents: OnceLock<[Vec<Vec3>; 2]>,
    /// The triangles of a closed mesh, for rays inside; only solid bodies need them.
    body: OnceLock<Result<Hierarchy, NotSolid>>,
    /// Triangles that an earlier one with the same corners hides, by their place among all.
    repeated: Vec<usize>,
    /// The polygons, some neighbours at a time: of many polygons in few pixels, most cover no sample.
    pub(super) patches: Vec<Patch>,
    /// Largest distance of a vertex from the origin.
    pub(super) radius: f32,
}

impl Prepared {
    fn new(mesh: PolygonMesh) -> Self {
        Self {
            polygon_normals: mesh.polygon_normals(),
            polygon_centres: mesh.polygon_centres(),
            vertex_normals: mesh.vertex_normals(),
            tangents: OnceLock::new(),
            body: OnceLock::new(),
            repeated: repeated(&mesh),
            patches: Patch::all(&mesh),
            radius: mesh.positions.iter().map(|p| p.length()).fold(0.0, f32::max),
            mesh,
        }
    }

    /// The triangles that can be seen: a file may have thousands in one place, each of which would be drawn.
    pub(super) fn triangles(&self) -> impl Iterator<Item = (usize, [u32; 3])> {
        self.patches.iter().flat_map(|patch| self.triangles_of(patch))
    }

    /// Those of a patch.
    pub(super) fn triangles_of(&self, patch: &Patch) -> impl Iterator<Item = (usize, [u32; 3])> {
        let repeated = &self.repeated[self.repeated.partition_point(|i| *i < patch.first)..];
        let mut repeated = repeated.iter().copied().peekable();
        let polygons = patch.polygons.clone().zip(&self.mesh.polygons[patch.polygons.clone()]);
        let all = polygons.flat_map(|(i, polygon)| {
            let corners = polygon.corners();
            polygon.triangles().iter().map(move |triangle| (i, triangle.map(|c| corners[c])))
        });
        let all = (patch.first..).zip(all);
        all.filter(move |(i, _)| repeated.next_if_eq(i).is_none()).map(|(_, triangle)| triangle)
    }

    /// The triangles, or the reason why the mesh is not a solid.
    pub(super) fn body(&self) -> Result<&Hierarchy, &NotSolid> {
        let closed = || {
            let hierarchy = Hierarchy::new(&self.mesh);
            closed::check(&self.mesh, &hierarchy).map(|_| hierarchy)
        };
        self.body.get_or_init(closed).as_ref()
    }

    pub(super) fn tangents(&self) -> &[Vec<Vec3>; 2] {
        self.tangents.get_or_init(|| [self.mesh.polygon_tangents(), self.mesh.vertex_tangents()])
    }
}

/// The triangles with the corners of an earlier one, in the same order.
fn repeated(mesh: &PolygonMesh) -> Vec<usize> {
    let mut known = HashSet::with_capacity_and_hasher(mesh.polygons.len(), RandomState::default());
    let repeated = mesh.triangles().enumerate().filter(|(_, (_, corners))| !known.insert(*corners));
    repeated.map(|(i, _)| i).collect()
}

/// Meshes kept from one picture to the next.
#[derive(Default)]
pub(crate) struct MeshStore {
    known: HashMap<MeshKey, Arc<Prepared>>,
    /// Number of polygons of all meshes.
    polygons: usize,
}

impl std::fmt::Debug for MeshStore {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("MeshStore").finish_non_exhaustive()
    }
}

/// The meshes of the objects that are being drawn.
pub(super) struct Meshes<'a> {
    pub(super) registry: &'a Registry,
    store: MeshStore,
}

impl<'a> Meshes<'a> {
    pub(super) fn new(registry: &'a Registry) -> Self {
        Self::with(registry, MeshStore::default())
    }

    /// Starts with known meshes.
    pub(super) fn with(registry: &'a Registry, store: MeshStore) -> Self {
        Self { registry, store }
    }

    /// Returns the known meshes.
    pub(super) fn into_store(self) -> MeshStore {
        self.store
    }

    /// The mesh of the first of several objects that are drawn one after the other; `None` if its type is
    /// unknown.
    pub(super) fn first(&mut self, objects: &[&Object]) -> Option<Arc<Prepared>> {
        let (_, key) = self.entry(objects.first()?)?;
        if !self.store.known.contains_key(&key) {
            self.make(objects);
        }
        self.store.known.get(&key).cloned()
    }

    fn entry(&self, object: &Object) -> Option<(&'a ShapeEntry, MeshKey)> {
        let entry = self.registry.shape(&object.object_type)?;
        Some((entry, entry.key(&object.shape, object.tessellation)))
    }

    /// Builds missing meshes of the first objects, in parallel.
    fn make(&mut self, objects: &[&Object]) {
        if self.store.polygons > POLYGONS_HELD {
            // Meshes that are still needed are held by their users.
            self.store.known.clear();
            self.store.polygons = 0;
        }
        let mut missing = HashMap::new();
        for object in objects.iter().take(AHEAD) {
            if let Some((entry, key)) =
                self.entry(object).filter(|(_, key)| !self.store.known.contains_key(key))
            {
                missing.entry(key).or_insert((entry, *object));
            }
            if missing.len() == AT_ONCE {
                break;
            }
        }
        let made: Vec<_> = missing
            .into_par_iter()
            .map(|(key, (entry, object))| {
                let mesh = entry.mesh(&object.shape, entry.tessellation(object.tessellation));
                (key, Arc::new(Prepared::new(mesh)))
            })
            .collect();
        self.store.polygons += made.iter().map(|(_, prepared)| prepared.mesh.polygons.len()).sum::<usize>();
        self.store.known.extend(made);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::Value;

    #[test]
    fn of_triangles_in_one_place_the_first_is_drawn() {
        let registry = Registry::builtin();
        let shape = registry.shape("sphere").expect("built in");
        let mesh = shape.mesh(&Default::default(), 8);
        let whole: Vec<_> = mesh.triangles().collect();
        assert_eq!(Prepared::new(mesh.clone()).triangles().collect::<Vec<_>>(), whole);
        let mut twice = mesh.clone();
        twice.polygons.extend(mesh.polygons.clone());
        assert_eq!(Prepared::new(twice).triangles().collect::<Vec<_>>(), whole);
        // From behind, another side is seen.
        let mut turned = mesh.clone();
        let (_, [a, b, c]) = whole[0];
        turned.polygons.extend([Polygon::triangle(c, b, a), Polygon::triangle(c, b, a)]);
        assert_eq!(Prepared::new(turned).triangles().count(), whole.len() + 1);
    }

    #[test]
    fn each_mesh_is_made_once_and_few_are_held() {
        let registry = Registry::builtin();
        let object = |tube: f32, count: u32| {
            let mut object =
                Object { object_type: "torus".to_owned(), tessellation: Some(count), ..Object::default() };
            object.shape.set("tube_radius", Value::Number(tube));
            object
        };
        let alike = [object(0.1, 8), object(0.1, 8), object(0.2, 8), object(0.1, 9)];
        let alike: Vec<_> = alike.iter().collect();
        let mut meshes = Meshes::new(&registry);
        let first: Vec<_> = (0..4).filter_map(|i| meshes.first(&alike[i..])).collect();
        assert!(Arc::ptr_eq(&first[0], &first[1]));
        assert!(!Arc::ptr_eq(&first[0], &first[2]) && !Arc::ptr_eq(&first[0], &first[3]));
        assert_eq!(meshes.store.polygons, 2 * 8 * 16 + 9 * 18);

        let different: Vec<_> = (0..200).map(|i| object(0.02 + 0.001 * i as f32, 64)).collect();
        let different: Vec<_> = different.iter().collect();
        let mut most = 0;
        for i in 0..different.len() {
            let mesh = meshes.first(&different[i..]).expect("known");
            let thickness = mesh.mesh.positions.iter().map(|p| p.z).fold(0.0, f32::max);
            assert!((thickness - (0.02 + 0.001 * i as f32)).abs() < 1e-4, "{i}: {thickness}");
            most = most.max(meshes.store.polygons);
        }
        let one = 64 * 128;
        assert!(most > POLYGONS_HELD / 2 && most <= POLYGONS_HELD + AT_ONCE * one, "{most}");
        let strange = Object { object_type: "dodecahedron".to_owned(), ..Object::default() };
        assert!(meshes.first(&[&strange]).is_none() && meshes.first(&[]).is_none());
    }
}
