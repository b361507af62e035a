use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec2Swizzles as _};

use super::{Declaration, ObjectType, PolygonMesh};
use crate::parameters;

parameters! {
    /// **Sphere**, cut along parallels and meridians; its poles lie on the y axis.
    ///
    /// All vertices lie on the sphere of diameter 1, so the polygons cut the corners: the finer the tessellation, the
    /// closer the vertex normals come to the position divided by the radius. It is brushed along the parallels.
    pub struct Sphere {}
}

impl ObjectType for Sphere {
    const DECLARATION: Declaration = Declaration::new("sphere", "Sphere")
        .summary("Has every normal once: shows a whole reflection model at a glance.")
        .glyph("●")
        .tessellation(2..=256, 32, "Bands from pole to pole; twice as many segments go around.");

    fn mesh(&self, tessellation: u32) -> PolygonMesh {
        let bands = tessellation.max(2);
        let direction = |turn: f32| Vec2::from(turn.sin_cos());
        let parallel: Vec<_> =
            (0..2 * bands).map(|i| direction(TAU * i as f32 / (2 * bands) as f32).yx()).collect();
        let outline = (1..bands).map(|i| 0.5 * direction(PI * i as f32 / bands as f32));
        PolygonMesh::between_poles(outline, &parallel)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// The largest angle in radians between a vertex normal and the sphere's own.
    fn worst(tessellation: u32) -> f32 {
        let mesh = Sphere {}.mesh(tessellation);
        let normals = mesh.vertex_normals();
        mesh.positions.iter().zip(normals).map(|(p, n)| (p.normalize() - n).length()).fold(0.0, f32::max)
    }

    #[test]
    fn vertex_and_polygon_counts_are_those_of_parallels_and_meridians() {
        let mesh = Sphere {}.mesh(8);
        assert_eq!(mesh.positions.len(), 7 * 16 + 2);
        assert_eq!(mesh.polygons.len(), 8 * 16);
        assert_eq!(mesh.polygons.iter().filter(|p| p.corners().len() == 3).count(), 2 * 16);
    }

    #[test]
    fn vertex_normals_approach_those_of_the_sphere() {
        let (coarse, fine) = (worst(8), worst(64));
        assert!(fine < 0.01, "{fine}");
        assert!(coarse > 4.0 * fine, "{coarse} {fine}");
    }

    #[test]
    fn it_is_brushed_along_the_parallels() {
        let mesh = Sphere {}.mesh(16);
        let mut seen = 0;
        for (p, t) in mesh.positions.iter().zip(mesh.vertex_tangents()).filter(|(_, t)| *t != Vec3::ZERO) {
            assert!((t - Vec3::Y.cross(*p).normalize()).length() < 1e-4, "{p} {t}");
            seen += 1;
        }
        assert_eq!(seen, 15 * 32);
    }
}
