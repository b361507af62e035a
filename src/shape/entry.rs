//! A registered object type.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex},
};

use glam::Vec3;

use super::{Declaration, ObjectType, PolygonMesh};
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
}
