//! Conditions on objects that light goes through: Mitsuba follows it through everything in its way, the lab through one
//! body or one sheet.

use glam::Vec3;

use crate::{
    reference::inside::ORDERS,
    registry::Registry,
    scene::Object,
    shape::{Hierarchy, PolygonMesh, closed},
};

/// The path of the light that meets a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Through {
    /// It is reflected.
    Nowhere,
    /// Through a single surface.
    Sheet,
    /// Through the inside of the object.
    Body,
}

/// The integrator's largest number of ways between surfaces: from the observer, [`ORDERS`] inside, and to the light.
pub(super) const DEPTH: usize = ORDERS + 2;

/// Largest distance from the plane of a flat mesh, relative to its size.
const FLAT: f32 = 1e-5;

/// The reason why Mitsuba shows an object differently; `others` counts the other visible objects.
///
/// # Errors
/// Returns the reason.
pub(super) fn check(
    through: Through,
    object: &Object,
    registry: &Registry,
    others: usize,
) -> Result<(), String> {
    let Some(shape) = registry.shape(&object.object_type).filter(|_| through != Through::Nowhere) else {
        return Ok(());
    };
    if others > 0 {
        return Err("Mitsuba shows the other objects through this one; export it alone".to_owned());
    }
    let mesh = shape.mesh(&object.shape, shape.tessellation(object.tessellation));
    if through == Through::Sheet {
        let only = "Mitsuba shows the back of an object through its front; a counterpart is a flat mesh";
        return if is_flat(&mesh) { Ok(()) } else { Err(only.to_owned()) };
    }
    let solid = closed::check(&mesh, &Hierarchy::new(&mesh));
    solid.map(|_| ()).map_err(|why| format!("only a closed mesh has a counterpart in Mitsuba; {why}"))
}

/// True if all triangles lie in one plane.
fn is_flat(mesh: &PolygonMesh) -> bool {
    let Some(normal) = mesh.polygon_normals().into_iter().find(|n| *n != Vec3::ZERO) else { return false };
    let Some(first) = mesh.positions.first() else { return false };
    let size = mesh.positions.iter().map(|p| p.distance(*first)).fold(0.0, f32::max);
    mesh.positions.iter().all(|p| normal.dot(*p - *first).abs() <= FLAT * size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::mesh::Polygon;

    #[test]
    fn a_body_is_closed_a_sheet_flat_and_both_are_alone() {
        let registry = Registry::builtin();
        let object = |kind: &str| Object { object_type: kind.to_owned(), ..Object::default() };
        let said = |through, kind, others| check(through, &object(kind), &registry, others);
        assert_eq!(said(Through::Body, "sphere", 0), Ok(()));
        assert!(said(Through::Body, "teapot", 0).is_err_and(|why| why.contains("only a closed mesh")));
        assert!(said(Through::Sheet, "sphere", 0).is_err_and(|why| why.contains("a flat mesh")));
        assert!(said(Through::Body, "sphere", 2).is_err_and(|why| why.contains("the other objects")));
        assert_eq!(said(Through::Nowhere, "teapot", 2), Ok(()));
    }

    #[test]
    fn a_mesh_in_one_plane_is_flat() {
        let square = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 0.6, 0.8), Vec3::new(0.0, 0.6, 0.8)];
        let polygons = vec![Polygon::triangle(0, 1, 2), Polygon::triangle(0, 2, 3)];
        let mesh = PolygonMesh { positions: square.to_vec(), polygons };
        assert!(is_flat(&mesh));
        let mut bent = mesh.clone();
        bent.positions[3] += 0.01 * Vec3::Y;
        assert!(!is_flat(&bent));
    }
}
