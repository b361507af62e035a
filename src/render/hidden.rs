//! Objects that nobody sees, because a large one is before them: where thousands are drawn in batches, they would cost time
//! for nothing.

use std::collections::HashSet;

use bevy::prelude::*;

use crate::{scene::observer::NEAR, shape::PolygonMesh};

/// Margin for the rounding of a driver, which moves corners by a part of a pixel: a share of the distance.
const MARGIN: f32 = 0.005;
/// The largest sine with which a way still leads through the edge of a triangle.
const ROUNDING: f32 = 1e-4;

/// The space behind the largest ball around the centre of a closed body, as seen from one place.
#[derive(Debug)]
pub(super) struct Shade {
    eye: Vec3,
    /// The direction of the ball, and its distance.
    axis: Vec3,
    distance: f32,
    /// Sine and cosine of the angle between the axis and the edge of the ball.
    sine: f32,
    cosine: f32,
}

impl Shade {
    /// The shade of a body at a place. `None` if the body is open or has sides that do not face away from its centre, if the
    /// eye is inside, or if the lens cuts the body.
    pub(super) fn new(mesh: &PolygonMesh, place: &Transform, eye: &Transform) -> Option<Self> {
        let centre = place.translation - eye.translation;
        let (axis, distance) = (centre.try_normalize()?, centre.length());
        let sine = ball(mesh)? * place.scale.min_element() / distance;
        let forward = *eye.forward();
        let mut is_outside = false;
        for (_, corners) in mesh.triangles() {
            let corners =
                corners.map(|i| place.transform_point(mesh.positions[i as usize]) - eye.translation);
            let [a, b, c] = corners;
            if (b - a).cross(c - a).dot(a) >= 0.0 {
                // It faces away, and is not drawn.
                continue;
            }
            if corners.iter().any(|corner| corner.dot(forward) < 2.0 * NEAR) {
                return None;
            }
            // From the centre to the eye, the way leads out of the body if it leads through a side that faces the eye.
            let [a, b, c] = corners.map(|corner| corner - centre);
            let sides = [a.cross(b), b.cross(c), c.cross(a)].map(Vec3::normalize_or_zero);
            is_outside |= sides.iter().all(|side| side.dot(axis) <= ROUNDING);
        }
        let cosine = (1.0 - sine * sine).max(0.0).sqrt();
        let is_ball = sine > 0.0 && sine < 1.0;
        (is_outside && is_ball).then_some(Self { eye: eye.translation, axis, distance, sine, cosine })
    }

    /// True if everything within a sphere is in the shade.
    pub(super) fn covers(&self, centre: Vec3, radius: f32) -> bool {
        let at = centre - self.eye;
        let along = at.dot(self.axis);
        let across = (at - along * self.axis).length();
        let radius = radius + MARGIN * at.length();
        along >= self.distance + radius && along * self.sine - across * self.cosine >= radius
    }
}

/// The radius of the largest ball around the centre that touches no side. `None` if the mesh is open, or if the centre does not
/// see the inside of all sides.
fn ball(mesh: &PolygonMesh) -> Option<f32> {
    let mut radius = f32::INFINITY;
    // Each edge lies between two triangles, which pass it in opposite directions.
    let mut edges = HashSet::new();
    for (_, corners) in mesh.triangles() {
        let [a, b, c] = corners;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if !edges.remove(&(to, from)) && !edges.insert((from, to)) {
                return None;
            }
        }
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        if normal != Vec3::ZERO {
            radius = radius.min(normal.dot(a));
        }
    }
    (edges.is_empty() && radius > 0.0 && radius.is_finite()).then_some(radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{parameter::Values, registry::Registry};

    fn mesh(shape: &str) -> PolygonMesh {
        let registry = Registry::builtin();
        let shape = registry.shape(shape).expect("built in");
        shape.mesh(&Values::default(), shape.tessellation(None))
    }

    #[test]
    fn bodies_around_their_centre_have_a_ball_and_others_have_none() {
        assert!(ball(&mesh("cube")).is_some_and(|radius| (radius - 0.5).abs() < 1e-5));
        assert!(ball(&mesh("sphere")).is_some_and(|radius| radius > 0.49 && radius < 0.5));
        assert_eq!(ball(&mesh("torus")), None);
        let mut open = mesh("cube");
        open.polygons.pop();
        assert_eq!(ball(&open), None);
    }

    #[test]
    fn a_body_hides_what_is_wholly_behind_its_ball() {
        let eye = Transform::from_xyz(5.0, 5.0, 9.0);
        let at = |z: f32, size: f32| Transform::from_xyz(5.0, 5.0, z).with_scale(Vec3::splat(size));
        for shape in ["cube", "sphere"] {
            let shade = Shade::new(&mesh(shape), &at(6.0, 2.0), &eye).expect("it is a body before the eye");
            assert!(shade.covers(Vec3::new(5.0, 5.0, 3.0), 0.5), "{shape}");
            assert!(!shade.covers(Vec3::new(5.0, 5.0, 6.0), 0.9), "{shape}: itself");
            assert!(!shade.covers(Vec3::new(5.0, 5.0, 5.6), 0.5), "{shape}: in part before its centre");
            assert!(!shade.covers(Vec3::new(5.0, 5.0, 8.0), 0.1), "{shape}: before it");
            // The ball of radius 1 at a distance of 3 is seen at an angle whose tangent is 0.354; at 6, this is 2.12.
            let beside = |x: f32| shade.covers(Vec3::new(5.0 + x, 5.0, 3.0), 0.2);
            assert!(beside(1.8) && !beside(1.95) && !beside(2.5), "{shape}: at the edge");
        }
    }

    #[test]
    fn a_body_that_reaches_the_eye_hides_nothing() {
        let eye = Transform::from_xyz(5.0, 5.0, 9.0);
        for (z, size) in [(8.0, 3.0), (9.0, 1.0), (8.49, 1.0), (12.0, 2.0)] {
            let place = Transform::from_xyz(5.0, 5.0, z).with_scale(Vec3::splat(size));
            for shape in ["cube", "sphere"] {
                assert!(Shade::new(&mesh(shape), &place, &eye).is_none(), "{shape} at {z}");
            }
        }
    }

    /// No ray from the eye to a hidden sphere misses the body, and all of them enter it before they reach the sphere.
    #[test]
    fn every_ray_to_what_is_hidden_meets_the_body_before() {
        let eye = Transform::from_xyz(1.0, 2.0, 9.0).looking_at(Vec3::new(4.0, 4.0, 4.0), Vec3::Y);
        let place = Transform::from_xyz(4.0, 4.0, 4.0)
            .with_scale(Vec3::splat(3.0))
            .with_rotation(Quat::from_rotation_x(0.4) * Quat::from_rotation_y(1.1));
        let mesh = mesh("cube");
        let shade = Shade::new(&mesh, &place, &eye).expect("a body");
        let triangles: Vec<[Vec3; 3]> = mesh
            .triangles()
            .map(|(_, corners)| corners.map(|i| place.transform_point(mesh.positions[i as usize])))
            .collect();
        let meets = |to: Vec3| {
            let way = to - eye.translation;
            triangles.iter().any(|&[a, b, c]| {
                let normal = (b - a).cross(c - a);
                let share = normal.dot(a - eye.translation) / normal.dot(way);
                let at = eye.translation + share * way;
                let within = |a: Vec3, b: Vec3| (b - a).cross(at - a).dot(normal) >= -1e-6;
                share > 0.0 && share < 1.0 && within(a, b) && within(b, c) && within(c, a)
            })
        };
        let mut hidden = 0;
        for i in 0..1000 {
            let [x, y, z] = [i % 10, i / 10 % 10, i / 100].map(|n| n as f32 - 0.5);
            let centre = Vec3::new(x, y, z);
            if !shade.covers(centre, 0.3) {
                continue;
            }
            hidden += 1;
            for side in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z] {
                assert!(meets(centre + 0.3 * side), "{centre}");
            }
        }
        assert!(hidden > 10, "{hidden}");
    }
}
