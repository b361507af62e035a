use std::f32::consts::TAU;

use glam::Vec3;

use super::{Declaration, ObjectType, PolygonMesh};
use crate::{parameter::Parameter, parameters};

/// The thickness of the tube. At 0.25 the hole would close.
const TUBE_RADIUS: Parameter = Parameter::number("tube_radius", 0.02..=0.24, 0.15)
    .symbol("r")
    .label("tube radius")
    .help("Radius of the tube as a fraction of the size: 0.02 is a thin ring, and at 0.24 the hole nearly closes.");

parameters! {
    /// **Torus**, standing upright: the ring lies in the xy plane with its axis along z, so the default observer looks
    /// through the hole. It is brushed around the ring.
    pub struct Torus {
        /// Radius of the tube; with that of the ring it makes the outer radius 0.5.
        tube_radius: number = TUBE_RADIUS,
    }
}

impl Torus {
    /// Radius of the circle along which the tube's centre runs.
    fn ring_radius(&self) -> f32 {
        0.5 - self.tube_radius
    }
}

impl ObjectType for Torus {
    const DECLARATION: Declaration = Declaration::new("torus", "Torus")
        .summary("Curves outward on its outside and both ways on its inside: highlights stretch differently.")
        .glyph("◎")
        .tessellation(3..=128, 32, "Segments around the tube; twice as many go around the ring.");

    fn mesh(&self, tessellation: u32) -> PolygonMesh {
        let (ring_radius, tube_radius) = (self.ring_radius(), self.tube_radius);
        let around_tube = tessellation.max(3);
        let around_ring = 2 * around_tube;
        let rows: Vec<Vec<Vec3>> = (0..around_ring)
            .map(|i| {
                let (sin_ring, cos_ring) = (TAU * i as f32 / around_ring as f32).sin_cos();
                (0..around_tube)
                    .map(|j| {
                        let (sin_tube, cos_tube) = (TAU * j as f32 / around_tube as f32).sin_cos();
                        let radius = ring_radius + tube_radius * cos_tube;
                        Vec3::new(radius * cos_ring, radius * sin_ring, tube_radius * sin_tube)
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

    /// The largest angle in radians between a vertex normal and the torus's own.
    fn worst(torus: &Torus, tessellation: u32) -> f32 {
        let mesh = torus.mesh(tessellation);
        let normals = mesh.vertex_normals();
        mesh.positions
            .iter()
            .zip(normals)
            .map(|(p, n)| {
                // The offset from the nearest point of the ring's circle.
                let ring = torus.ring_radius() * p.with_z(0.0).normalize();
                ((*p - ring).normalize() - n).length()
            })
            .fold(0.0, f32::max)
    }

    #[test]
    fn by_default_ring_and_tube_are_those_of_scenes_without_the_parameter() {
        let torus = Torus::default();
        assert_eq!((torus.ring_radius(), torus.tube_radius), (0.35, 0.15));
    }

    #[test]
    fn counts_are_segments_times_segments() {
        let mesh = Torus::default().mesh(12);
        assert_eq!(mesh.positions.len(), 12 * 24);
        assert_eq!(mesh.polygons.len(), 12 * 24);
    }

    #[test]
    fn vertex_normals_approach_those_of_the_torus() {
        for tube_radius in [0.02, 0.15, 0.2] {
            let torus = Torus { tube_radius };
            let (coarse, fine) = (worst(&torus, 8), worst(&torus, 64));
            assert!(fine < 0.01, "{fine}");
            assert!(coarse > 4.0 * fine, "{coarse} {fine}");
        }
    }

    #[test]
    fn it_is_brushed_around_the_ring() {
        let mesh = Torus::default().mesh(16);
        for (p, t) in mesh.positions.iter().zip(mesh.vertex_tangents()) {
            assert!((t - Vec3::Z.cross(*p).normalize()).length() < 1e-4, "{p} {t}");
        }
    }
}
