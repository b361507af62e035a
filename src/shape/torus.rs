use std::f32::consts::TAU;

use glam::Vec3;

use super::{Declaration, ObjectType, PolygonMesh};

/// Radius of the circle that the tube's centre follows.
const RING_RADIUS: f32 = 0.35;
/// Radius of the tube. Ring and tube together make the outer radius 0.5.
const TUBE_RADIUS: f32 = 0.15;

/// **Torus**, standing upright: the ring lies in the xy plane with its axis along z, so the default observer looks
/// through the hole. It is brushed around the ring.
#[derive(Clone, Copy, Debug)]
pub struct Torus;

impl ObjectType for Torus {
    const DECLARATION: Declaration = Declaration {
        id: "torus",
        name: "Torus",
        summary: "Curves outward on its outside and both ways on its inside: highlights stretch differently.",
        glyph: "◎",
        tessellation_help: "Segments around the tube; twice as many go around the ring.",
        tessellation: 3..=128,
        default_tessellation: 32,
    };

    fn mesh(tessellation: u32) -> PolygonMesh {
        let around_tube = tessellation.max(3);
        let around_ring = 2 * around_tube;
        let rows: Vec<Vec<Vec3>> = (0..around_ring)
            .map(|i| {
                let (sin_ring, cos_ring) = (TAU * i as f32 / around_ring as f32).sin_cos();
                (0..around_tube)
                    .map(|j| {
                        let (sin_tube, cos_tube) = (TAU * j as f32 / around_tube as f32).sin_cos();
                        let radius = RING_RADIUS + TUBE_RADIUS * cos_tube;
                        Vec3::new(radius * cos_ring, radius * sin_ring, TUBE_RADIUS * sin_tube)
                    })
                    .collect()
            })
            .collect();
        let mut mesh = PolygonMesh::default();
        mesh.append_loops(&rows, true);
        mesh.turn_on_lathe(Vec3::Z);
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worst(tessellation: u32) -> f32 {
        let mesh = Torus::mesh(tessellation);
        let normals = mesh.vertex_normals();
        mesh.positions
            .iter()
            .zip(normals)
            .map(|(p, n)| {
                // The offset from the nearest point of the ring's circle.
                let ring = RING_RADIUS * p.with_z(0.0).normalize();
                ((*p - ring).normalize() - n).length()
            })
            .fold(0.0, f32::max)
    }

    #[test]
    fn counts_are_segments_times_segments() {
        let mesh = Torus::mesh(12);
        assert_eq!(mesh.positions.len(), 12 * 24);
        assert_eq!(mesh.polygons.len(), 12 * 24);
    }

    #[test]
    fn vertex_normals_approach_those_of_the_torus() {
        let (coarse, fine) = (worst(8), worst(64));
        assert!(fine < 0.01, "{fine}");
        assert!(coarse > 4.0 * fine, "{coarse} {fine}");
    }

    #[test]
    fn it_is_brushed_around_the_ring() {
        let mesh = Torus::mesh(16);
        for (p, t) in mesh.positions.iter().zip(mesh.vertex_tangents()) {
            assert!((t - Vec3::Z.cross(*p).normalize()).length() < 1e-4, "{p} {t}");
        }
    }
}
