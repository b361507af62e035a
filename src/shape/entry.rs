//! A registered object type.

use std::{
    collections::HashMap,
    f32::consts::PI,
    sync::{Arc, LazyLock, Mutex},
};

use glam::Vec3;

use super::{Declaration, ObjectType, PolygonMesh, Take, register_builtin};
use crate::{
    caught::lock,
    declared::entry,
    optics::colour::Encoding,
    parameter::{Parameter, TypeComponent, Value, Values, words},
};

/// A tessellation fine enough to determine the bounds of a shape.
const COARSE: u32 = 8;
/// Maximum number of parameter sets with stored bounds: more than a scene has objects.
const KEPT: usize = 1 << 14;
/// Number of directions for the outermost points of a shape.
const WAYS: u16 = 64;

/// A registered object type, in the form used by the rest of the program.
#[derive(Clone)]
pub struct ShapeEntry {
    /// Name and tessellation.
    pub declaration: &'static Declaration,
    /// Parameters of the type.
    pub parameters: &'static [Parameter],
    /// Component of the type.
    pub component: TypeComponent,
    mesh: fn(&Values, u32) -> PolygonMesh,
    /// Bounds by parameters: they are requested for many objects in every frame.
    bounds: Arc<Mutex<HashMap<Vec<u32>, Bounds>>>,
    /// Outermost points by parameters.
    outermost: Arc<Mutex<HashMap<Vec<u32>, Arc<[Vec3]>>>>,
}

/// The identity of a mesh: objects with equal keys share one.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct MeshKey {
    object_type: &'static str,
    parameters: Vec<u32>,
    tessellation: u32,
}

/// The bounds of an object of size 1 around its position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounds {
    /// Half the extents of the bounding box.
    pub half: Vec3,
    /// Radius of the bounding sphere.
    pub radius: f32,
}

impl ShapeEntry {
    /// The entry of an object type.
    #[must_use]
    pub fn of<T: ObjectType>() -> Self {
        Self {
            declaration: const { &T::DECLARATION },
            parameters: T::PARAMETERS,
            component: TypeComponent::of::<T>(),
            mesh: |values, tessellation| T::from_values(values, Encoding::Srgb).mesh(tessellation),
            bounds: Arc::default(),
            outermost: Arc::default(),
        }
    }

    /// The tessellation of an object: the requested one, clamped to the legal range, or the default.
    #[must_use]
    pub fn tessellation(&self, wanted: Option<u32>) -> u32 {
        let range = &self.declaration.tessellation;
        wanted.unwrap_or(self.declaration.default_tessellation).clamp(*range.start(), *range.end())
    }

    /// The mesh for parameters and a tessellation, which is clamped to the legal range. Missing or illegal
    /// parameters have their defaults.
    #[must_use]
    pub fn mesh(&self, parameters: &Values, tessellation: u32) -> PolygonMesh {
        (self.mesh)(parameters, self.tessellation(Some(tessellation)))
    }

    /// The identity of the mesh of an object with these parameters and this tessellation.
    #[must_use]
    pub fn key(&self, parameters: &Values, tessellation: Option<u32>) -> MeshKey {
        MeshKey {
            object_type: self.declaration.id,
            parameters: self.words(parameters),
            tessellation: self.tessellation(tessellation),
        }
    }

    /// The bounds of an object with these parameters.
    #[must_use]
    pub fn bounds(&self, parameters: &Values) -> Bounds {
        let mut known = lock(&self.bounds);
        if known.len() >= KEPT {
            known.clear();
        }
        *known.entry(self.words(parameters)).or_insert_with(|| {
            let around = |bounds: Bounds, p: Vec3| Bounds {
                half: bounds.half.max(p.abs()),
                radius: bounds.radius.max(p.length()),
            };
            self.mesh(parameters, COARSE).positions.into_iter().fold(Bounds::default(), around)
        })
    }

    /// The points of an object of size 1 around its position that lie furthest out, in directions all around.
    #[must_use]
    pub fn outermost(&self, parameters: &Values) -> Arc<[Vec3]> {
        let mut known = lock(&self.outermost);
        if known.len() >= KEPT {
            known.clear();
        }
        let of_mesh = || furthest(&self.mesh(parameters, COARSE).positions);
        Arc::clone(known.entry(self.words(parameters)).or_insert_with(of_mesh))
    }

    /// The bits of the parameters as passed to the type; for files, the version of their numbers.
    fn words(&self, parameters: &Values) -> Vec<u32> {
        let mut words = words(self.parameters, parameters, Encoding::Srgb);
        for p in self.parameters.iter().filter(|p| p.kind.format().is_some()) {
            if let Value::File(file) = parameters.get(p) {
                words.extend([file.version() as u32, (file.version() >> 32) as u32]);
            }
        }
        words
    }
}

entry!(ShapeEntry);

/// The points that lie furthest out in directions spread evenly around the origin.
fn furthest(points: &[Vec3]) -> Arc<[Vec3]> {
    let way = |i: u16| {
        let y = 1.0 - (2.0 * f32::from(i) + 1.0) / f32::from(WAYS);
        let (sin, cos) = (PI * (3.0 - 5.0f32.sqrt()) * f32::from(i)).sin_cos();
        let around = (1.0 - y * y).sqrt();
        Vec3::new(around * cos, y, around * sin)
    };
    let last = |way: Vec3| points.iter().copied().max_by(|a, b| a.dot(way).total_cmp(&b.dot(way)));
    (0..WAYS).map(way).filter_map(last).collect()
}

/// The outermost points of an object of size 1 of a built-in type, for places that know no registry.
pub(crate) fn outermost(object_type: &str, parameters: &Values) -> Option<Arc<[Vec3]>> {
    struct All(Vec<ShapeEntry>);
    impl Take for All {
        fn take<T: ObjectType>(&mut self) {
            self.0.push(ShapeEntry::of::<T>());
        }
    }
    static BUILT_IN: LazyLock<Vec<ShapeEntry>> = LazyLock::new(|| {
        let mut all = All(Vec::new());
        register_builtin(&mut all);
        all.0
    });
    let entry = BUILT_IN.iter().find(|entry| entry.declaration.id == object_type)?;
    Some(entry.outermost(parameters))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{parameter::Value, shape::Torus};

    #[test]
    fn objects_share_a_mesh_if_they_look_alike() {
        let torus = ShapeEntry::of::<Torus>();
        let tube = |radius| Values([("tube_radius".into(), Value::Number(radius))].into());
        let key = |values: &Values, n| torus.key(values, n);
        let default = Values::default();
        assert_eq!(key(&default, None), key(&tube(0.15), Some(32)));
        assert_ne!(key(&default, None), key(&tube(0.16), None));
        assert_ne!(key(&default, None), key(&default, Some(33)));
        // Illegal values and those of other types are ignored.
        assert_eq!(key(&default, None), key(&tube(7.0), Some(32)));
        let other = Values([("cone_angle".into(), Value::Number(3.0))].into());
        assert_eq!(key(&default, None), key(&other, None));
    }

    #[test]
    fn bounds_follow_the_parameters() {
        let torus = ShapeEntry::of::<Torus>();
        for radius in [0.05, 0.2, 0.05] {
            let bounds = torus.bounds(&Values([("tube_radius".into(), Value::Number(radius))].into()));
            assert!((bounds.half - Vec3::new(0.5, 0.5, radius)).abs().max_element() < 1e-6, "{bounds:?}");
            assert!((bounds.radius - 0.5).abs() < 1e-6, "{bounds:?}");
        }
    }

    #[test]
    fn the_outermost_points_reach_about_as_far_as_the_shape() {
        let none = Values::default();
        for id in ["sphere", "cube", "torus", "teapot"] {
            let points = outermost(id, &none).expect(id);
            assert!(points.len() <= usize::from(WAYS), "{id}");
            let reach = points.iter().fold(Vec3::ZERO, |reach, p| reach.max(p.abs()));
            assert!((0.45..0.501).contains(&reach.max_element()), "{id}: {reach}");
        }
        let flat = outermost("torus", &none).expect("a torus");
        assert!(flat.iter().all(|p| p.z.abs() < 0.2), "a torus is flat: {flat:?}");
        assert_eq!(outermost("a guest's", &none), None);
    }
}
