//! Checks meshes for the properties on which both renderers rely.

use std::collections::HashMap;

use glam::Vec3;

use crate::shape::PolygonMesh;

/// Maximum deviation of the extent from 1, and of the centre from the origin.
pub const TOLERANCE: f32 = 1e-3;

/// Checks that a mesh can be drawn as a scene requests it.
///
/// # Errors
/// Returns the first problem and its remedy.
pub fn check(mesh: &PolygonMesh) -> Result<(), String> {
    let count = mesh.positions.len();
    if count == 0 || mesh.polygons.is_empty() {
        let what = format!("has {count} vertices and {} polygons", mesh.polygons.len());
        return Err(format!("{what}, but must have at least three vertices and one polygon"));
    }
    if let Some(i) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Err(format!("vertex {i} is {}, but must be three finite numbers", mesh.positions[i]));
    }
    let beyond = |p: &crate::shape::mesh::Polygon| p.corners().iter().copied().find(|&c| c as usize >= count);
    if let Some((i, corner)) = mesh.polygons.iter().enumerate().find_map(|(i, p)| Some((i, beyond(p)?))) {
        return Err(format!(
            "polygon {i} has the corner {corner}, but there are {count} vertices, counted from 0"
        ));
    }
    if let Some(i) = mesh.polygons.iter().position(|p| p.corners().len() < 3) {
        return Err(format!("polygon {i} has fewer than three different corners"));
    }
    let (low, high) =
        mesh.positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    let extent = (high - low).max_element();
    if (extent - 1.0).abs() > TOLERANCE {
        return Err(format!(
            "its largest extent is {extent}, but must be 1: the scene sets the size; PolygonMesh::normalise scales it"
        ));
    }
    let centre = (low + high) / 2.0;
    if centre.abs().max_element() > TOLERANCE {
        return Err(format!(
            "its centre is at {centre}, but must be at the origin; PolygonMesh::normalise moves it"
        ));
    }
    let edges = edges(mesh)?;
    let closed = edges.keys().all(|&(a, b)| edges.contains_key(&(b, a)));
    let volume = volume(mesh);
    if closed && volume <= 0.0 {
        return Err(format!(
            "its polygons face inwards (they enclose {volume}): corners must run counter-clockwise seen from outside"
        ));
    }
    Ok(())
}

/// The edges of all polygons by their ends, in the order of the corners, each with its polygon.
///
/// # Errors
/// Returns an error if two polygons run along an edge in the same direction.
fn edges(mesh: &PolygonMesh) -> Result<HashMap<(u32, u32), usize>, String> {
    let mut edges = HashMap::with_capacity(4 * mesh.polygons.len());
    for (i, polygon) in mesh.polygons.iter().enumerate() {
        let corners = polygon.corners();
        for (k, &a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            if let Some(other) = edges.insert((a, b), i) {
                return Err(format!(
                    "polygons {other} and {i} both run from vertex {a} to {b}: one of them faces the other way, or \
                     they are the same; corners must run counter-clockwise seen from outside"
                ));
            }
        }
    }
    Ok(edges)
}

/// The volume that the polygons enclose; negative if they face inwards.
#[must_use]
pub fn volume(mesh: &PolygonMesh) -> f32 {
    let triangles = mesh.triangles().map(|(_, corners)| corners.map(|i| mesh.positions[i as usize]));
    triangles.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{parameter::Values, registry::Registry, shape::mesh::Polygon};

    /// The problem found in a cube after a change.
    fn said(change: impl FnOnce(&mut PolygonMesh)) -> String {
        let mut mesh = Registry::builtin().shape("cube").expect("built in").mesh(&Values::default(), 1);
        change(&mut mesh);
        check(&mesh).err().unwrap_or_default()
    }

    #[test]
    fn each_mistake_is_named_with_what_would_be_right() {
        assert_eq!(said(|_| {}), "");
        assert_eq!(
            said(|m| m.polygons.clear()),
            "has 8 vertices and 0 polygons, but must have at least three vertices and one polygon"
        );
        assert!(said(|m| m.positions[3].y = f32::NAN).contains("vertex 3 is"));
        assert_eq!(
            said(|m| m.polygons.push(Polygon::triangle(0, 1, 8))),
            "polygon 6 has the corner 8, but there are 8 vertices, counted from 0"
        );
        assert!(
            said(|m| m.polygons[2] = Polygon::quad(1, 1, 2, 2)).contains("polygon 2 has fewer than three")
        );
        assert!(
            said(|m| m.positions.iter_mut().for_each(|p| *p *= 40.0)).contains("its largest extent is 40,")
        );
        assert!(
            said(|m| m.positions.iter_mut().for_each(|p| p.x += 0.5))
                .contains("its centre is at [0.5, 0, 0]")
        );
        let back = |p: &Polygon| {
            let c = p.corners();
            Polygon::quad(c[3], c[2], c[1], c[0])
        };
        let inside_out = said(|m| m.polygons = m.polygons.iter().map(back).collect());
        assert!(inside_out.contains("face inwards (they enclose -"), "{inside_out}");
        let one_way = said(|m| m.polygons[0] = back(&m.polygons[0]));
        assert!(one_way.contains("one of them faces the other way"), "{one_way}");
        // An open surface encloses nothing.
        assert_eq!(said(|m| m.polygons.truncate(5)), "");
    }

    #[test]
    fn every_built_in_mesh_passes() {
        for shape in Registry::builtin().shapes() {
            let d = shape.declaration;
            for tessellation in [*d.tessellation.start(), d.default_tessellation, *d.tessellation.end()] {
                assert_eq!(
                    check(&shape.mesh(&Values::default(), tessellation)),
                    Ok(()),
                    "{} {tessellation}",
                    d.id
                );
            }
        }
    }
}
