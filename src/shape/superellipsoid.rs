use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec2Swizzles as _};

use super::{Declaration, ObjectType, PolygonMesh};
use crate::{parameter::Parameter, parameters};

/// The exponent of the outline seen from the side.
const VERTICAL: Parameter = Parameter::number("vertical_exponent", 0.1..=3.0, 0.5)
    .symbol("ε_1")
    .label("vertical exponent")
    .help("The outline seen from the side: nearly a square at 0.1, a circle at 1, a diamond at 2, a star beyond.");

/// The exponent of the outline seen from above.
const HORIZONTAL: Parameter = Parameter {
    name: "horizontal_exponent",
    symbol: "ε_2",
    label: "horizontal exponent",
    help: "The outline seen from above: nearly a square at 0.1, a circle at 1, a diamond at 2, a star beyond.",
    ..VERTICAL
};

parameters! {
    /// **Superellipsoid** of A. Barr (1981), *Superquadrics and Angle-Preserving Transformations*, IEEE Computer Graphics
    /// and Applications 1(1), with the y axis from pole to pole: the points with
    /// `(|2x|^(2/ε₂) + |2z|^(2/ε₂))^(ε₂/ε₁) + |2y|^(2/ε₁) = 1`.
    ///
    /// The product of two superellipses, of which one turns about the axis along the other. Barr's own parameters crowd
    /// the points at the corners or at the poles; here both curves are cut at equal angles. With both exponents 1 this is
    /// the sphere, with the same points. It is brushed along the parallels.
    pub struct Superellipsoid {
        /// Exponent ε₁ of the meridians.
        vertical_exponent: number = VERTICAL,
        /// Exponent ε₂ of the parallels.
        horizontal_exponent: number = HORIZONTAL,
    }
}

/// The point of the superellipse `|x|^(2/ε) + |y|^(2/ε) = 1` in a direction.
fn on_superellipse(direction: Vec2, exponent: f32) -> Vec2 {
    let power = 2.0 / exponent;
    // The sine of a multiple of 90° is not quite zero, and roots make that large.
    let direction = Vec2::from_array(direction.to_array().map(|c| if c.abs() < 1e-6 { 0.0 } else { c }));
    let sum = direction.x.abs().powf(power) + direction.y.abs().powf(power);
    direction * sum.powf(-1.0 / power)
}

impl ObjectType for Superellipsoid {
    const DECLARATION: Declaration = Declaration::new("superellipsoid", "Superellipsoid")
        .summary("Everything between box, sphere and star: highlights shrink where it is bent and spread where it is flat.")
        .glyph("◆")
        .tessellation(2..=256, 32, "Bands from pole to pole; twice as many segments go around. Multiples of 4 meet the corners.");

    fn mesh(&self, tessellation: u32) -> PolygonMesh {
        let bands = tessellation.max(2);
        let direction = |turn: f32| Vec2::from(turn.sin_cos());
        let around = |i| direction(TAU * i as f32 / (2 * bands) as f32).yx();
        let parallel: Vec<_> =
            (0..2 * bands).map(|i| on_superellipse(around(i), self.horizontal_exponent)).collect();
        let outline = (1..bands)
            .map(|i| 0.5 * on_superellipse(direction(PI * i as f32 / bands as f32), self.vertical_exponent));
        PolygonMesh::between_poles(outline, &parallel)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::shape::Sphere;

    fn of(vertical_exponent: f32, horizontal_exponent: f32) -> Superellipsoid {
        Superellipsoid { vertical_exponent, horizontal_exponent }
    }

    /// Barr's inside–outside function: 1 on the surface.
    fn inside_outside(s: &Superellipsoid, p: Vec3) -> f64 {
        let [x, y, z] = p.to_array().map(|c| 2.0 * f64::from(c.abs()));
        let (e1, e2) = (f64::from(s.vertical_exponent), f64::from(s.horizontal_exponent));
        (x.powf(2.0 / e2) + z.powf(2.0 / e2)).powf(e2 / e1) + y.powf(2.0 / e1)
    }

    /// The normal of the surface: the gradient of that function.
    fn gradient(s: &Superellipsoid, p: Vec3) -> Vec3 {
        let [x, y, z] = p.to_array().map(|c| 2.0 * f64::from(c));
        let (e1, e2) = (f64::from(s.vertical_exponent), f64::from(s.horizontal_exponent));
        let across = (x.abs().powf(2.0 / e2) + z.abs().powf(2.0 / e2)).powf(e2 / e1 - 1.0);
        let along = |c: f64, e: f64| c.signum() * c.abs().powf(2.0 / e - 1.0);
        let n = [across * along(x, e2), along(y, e1), across * along(z, e2)];
        Vec3::from_array(n.map(|c| c as f32)).normalize_or_zero()
    }

    #[test]
    fn every_vertex_satisfies_the_equation_of_barr() {
        for vertical in [0.1, 0.5, 1.0, 2.0, 3.0] {
            for horizontal in [0.1, 0.7, 1.0, 2.0, 3.0] {
                let s = of(vertical, horizontal);
                let worst = |of: &Superellipsoid| {
                    let mesh = s.mesh(24);
                    mesh.positions.iter().map(|p| (inside_outside(of, *p) - 1.0).abs()).fold(0.0, f64::max)
                };
                assert!(worst(&s) < 2e-5, "{s:?}: {}", worst(&s));
                // The wrong twin: the exponents swapped.
                let twin = of(horizontal, vertical);
                assert!(s == twin || worst(&twin) > 0.01, "{s:?}");
            }
        }
    }

    #[test]
    fn with_exponents_of_one_it_is_the_sphere() {
        for n in [2, 7, 32] {
            let (mesh, sphere) = (of(1.0, 1.0).mesh(n), Sphere {}.mesh(n));
            assert_eq!(mesh.positions.len(), sphere.positions.len());
            for (p, q) in mesh.positions.iter().zip(&sphere.positions) {
                assert!((*p - *q).length() < 1e-6, "{p} {q}");
            }
            let corners =
                |mesh: &PolygonMesh| mesh.polygons.iter().map(|p| p.corners().to_vec()).collect::<Vec<_>>();
            assert_eq!(corners(&mesh), corners(&sphere));
        }
    }

    #[test]
    fn its_ends_are_a_box_and_an_octahedron() {
        let corner = of(0.1, 0.1).mesh(32).positions.iter().map(|p| p.length()).fold(0.0, f32::max);
        assert!(corner > 0.8 && corner < 0.75f32.sqrt(), "{corner}");
        for p in of(2.0, 2.0).mesh(32).positions {
            assert!((p.abs().element_sum() - 0.5).abs() < 1e-6, "{p}");
        }
    }

    #[test]
    fn vertex_normals_approach_those_of_the_surface() {
        for s in [of(0.5, 0.5), of(1.0, 0.5), of(0.6, 1.3)] {
            let mean = |n: u32| {
                let mesh = s.mesh(n);
                let normals = mesh.vertex_normals();
                let off = |(p, n): (&Vec3, &Vec3)| (gradient(&s, *p) - *n).length();
                mesh.positions.iter().zip(&normals).map(off).sum::<f32>() / normals.len() as f32
            };
            let (coarse, fine) = (mean(16), mean(128));
            assert!(fine < 0.01 && coarse > 4.0 * fine, "{s:?}: {coarse} {fine}");
        }
    }

    #[test]
    fn it_is_brushed_along_the_parallels() {
        let mesh = of(0.5, 1.0).mesh(16);
        let mut seen = 0;
        for (p, t) in mesh.positions.iter().zip(mesh.vertex_tangents()).filter(|(_, t)| *t != Vec3::ZERO) {
            assert!((t - Vec3::Y.cross(*p).normalize()).length() < 1e-4, "{p} {t}");
            seen += 1;
        }
        assert_eq!(seen, 15 * 32);
    }
}
