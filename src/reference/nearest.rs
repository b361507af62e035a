//! The point of a surface nearest to another point.

use glam::Vec3;

use super::object::Face;
use crate::shape::PolygonMesh;

/// Distance, in units of the mesh, added to triangles that face another way: of the two sides of a thin
/// object, and of triangles that share an edge, the one that faces the right way is chosen.
const TURNED: f32 = 1e-4;

/// The triangle nearest to a point of a surface with this normal, and the weights of its corners there.
/// Triangles without area, which no pixel shows, are skipped.
pub(super) fn nearest(mesh: &PolygonMesh, point: Vec3, normal: Vec3) -> Option<(Face, Vec3)> {
    let mut best: Option<(f32, Face, Vec3)> = None;
    for (polygon, corners) in mesh.triangles() {
        let places @ [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
        let Some(faces) = (b - a).cross(c - a).try_normalize() else { continue };
        let weights = weights(places, point);
        let at = a * weights.x + b * weights.y + c * weights.z;
        let off = at.distance(point) + TURNED * (1.0 - faces.dot(normal));
        if off.is_finite() && best.is_none_or(|(least, ..)| off < least) {
            best = Some((off, (polygon as u32, corners), weights));
        }
    }
    best.map(|(_, face, weights)| (face, weights))
}

/// The weights of a triangle's corners at its point nearest to another one (C. Ericson 2005, *Real-Time
/// Collision Detection*, section 5.1.5).
fn weights([a, b, c]: [Vec3; 3], point: Vec3) -> Vec3 {
    let (ab, ac) = (b - a, c - a);
    let from = |corner: Vec3| (ab.dot(point - corner), ac.dot(point - corner));
    let (a_b, a_c) = from(a);
    if a_b <= 0.0 && a_c <= 0.0 {
        return Vec3::X;
    }
    let (b_b, b_c) = from(b);
    if b_b >= 0.0 && b_c <= b_b {
        return Vec3::Y;
    }
    let of_c = a_b * b_c - b_b * a_c;
    if of_c <= 0.0 && a_b >= 0.0 && b_b <= 0.0 {
        let t = a_b / (a_b - b_b);
        return Vec3::new(1.0 - t, t, 0.0);
    }
    let (c_b, c_c) = from(c);
    if c_c >= 0.0 && c_b <= c_c {
        return Vec3::Z;
    }
    let of_b = c_b * a_c - a_b * c_c;
    if of_b <= 0.0 && a_c >= 0.0 && c_c <= 0.0 {
        let t = a_c / (a_c - c_c);
        return Vec3::new(1.0 - t, 0.0, t);
    }
    let of_a = b_b * c_c - c_b * b_c;
    let (to_c, to_b) = (b_c - b_b, c_b - c_c);
    if of_a <= 0.0 && to_c >= 0.0 && to_b >= 0.0 {
        let t = to_c / (to_c + to_b);
        return Vec3::new(0.0, 1.0 - t, t);
    }
    Vec3::new(of_a, of_b, of_c) / (of_a + of_b + of_c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::random;

    #[test]
    fn no_other_point_of_the_triangle_is_nearer() {
        let mut seed = 3;
        for _ in 0..300 {
            let mut place = || Vec3::from([(); 3].map(|()| random(&mut seed) - 0.5));
            let (corners, point) = ([place(), place(), place()], 2.0 * place());
            let at = |w: Vec3| corners[0] * w.x + corners[1] * w.y + corners[2] * w.z;
            let found = weights(corners, point);
            assert!(found.min_element() >= -1e-4 && (found.element_sum() - 1.0).abs() < 1e-4, "{found}");
            let least = at(found).distance(point);
            for i in 0..=20u8 {
                for k in 0..=20 - i {
                    let other = Vec3::new(f32::from(i), f32::from(k), f32::from(20 - i - k)) / 20.0;
                    assert!(at(other).distance(point) > least - 1e-4, "{other} instead of {found}");
                }
            }
        }
    }
}
