//! The way from the room to the picture, and back.

use bevy_egui::egui::{Pos2, Rect, Vec2, vec2};
use glam::{Quat, Vec3};

use crate::panel::state::Session;

/// Anything nearer to the camera is not drawn, metres.
const NEAR: f32 = 0.05;

/// A line of sight: from the eye, in a unit direction.
#[derive(Clone, Copy, Debug)]
pub(in crate::panel) struct Ray {
    pub(in crate::panel) eye: Vec3,
    pub(in crate::panel) way: Vec3,
}

impl Ray {
    /// The place on an axis through a point that is nearest to the line of sight, metres from the point.
    pub(in crate::panel) fn along(self, from: Vec3, axis: Vec3) -> Option<f32> {
        let cos = axis.dot(self.way);
        let (to, less) = (self.eye - from, 1.0 - cos * cos);
        let t = (to.dot(axis) - cos * to.dot(self.way)) / less;
        // Beyond the vanishing point the two meet behind the camera.
        let ahead = (from + t * axis - self.eye).dot(self.way) > 0.0;
        (less > 1e-5 && ahead).then_some(t)
    }
}

/// The mapping from the room to the picture and back, as the camera of the window shows the room in a rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// The place of the camera.
    pub(in crate::panel) eye: Vec3,
    to_camera: Quat,
    /// The rectangle of the picture.
    pub(in crate::panel) rect: Rect,
    /// Points per unit of the tangent.
    scale: f32,
}

impl Lens {
    /// The camera of the window.
    #[must_use]
    pub fn of(session: &Session, rect: Rect) -> Self {
        let angle = session.document.view_angle().vertical(rect.width() / rect.height().max(1.0));
        Self {
            eye: session.facts.eye,
            to_camera: session.facts.camera.inverse(),
            rect,
            scale: 0.5 * rect.height() / (0.5 * angle).tan(),
        }
    }

    /// A point of the room as the camera sees it: x to the right, y up, −z ahead.
    pub(super) fn seen(&self, p: Vec3) -> Vec3 {
        self.to_camera * (p - self.eye)
    }

    fn flat(&self, seen: Vec3) -> Pos2 {
        self.rect.center() + vec2(seen.x, -seen.y) * (self.scale / -seen.z)
    }

    /// The place of a point in the picture or beside it; none behind the camera.
    #[must_use]
    pub fn project(&self, p: Vec3) -> Option<Pos2> {
        let seen = self.seen(p);
        (seen.z < -NEAR).then(|| self.flat(seen))
    }

    /// The length in metres, at a point of the room, of so many points of the picture.
    pub(in crate::panel) fn metres(&self, p: Vec3, points: f32) -> f32 {
        points * (-self.seen(p).z).max(NEAR) / self.scale
    }

    /// The direction at right angles to another one in which a step at a point moves most to the side.
    pub(in crate::panel) fn across(&self, p: Vec3, direction: Vec3) -> Vec3 {
        let ahead = p - self.eye;
        let right = self.to_camera.inverse() * Vec3::X;
        direction.cross(ahead).try_normalize().unwrap_or(right)
    }

    /// The point of the room at a place of the picture, so many metres ahead.
    pub(super) fn at(&self, place: Pos2, ahead: f32) -> Vec3 {
        let sideways = (place - self.rect.center()) * (ahead / self.scale);
        self.eye + self.to_camera.inverse() * Vec3::new(sideways.x, -sideways.y, -ahead)
    }

    /// The line of sight through a place of the picture.
    pub(in crate::panel) fn ray(&self, place: Pos2) -> Ray {
        Ray { eye: self.eye, way: (self.at(place, 1.0) - self.eye).normalize() }
    }

    /// The directions of the picture in the room: to its right, to its top, and ahead.
    pub(in crate::panel) fn axes(&self) -> [Vec3; 3] {
        [Vec3::X, Vec3::Y, Vec3::NEG_Z].map(|axis| self.to_camera.inverse() * axis)
    }

    /// The direction in the picture in which a point outside it lies.
    pub(super) fn towards(&self, p: Vec3) -> Vec2 {
        let seen = self.seen(p);
        let sideways = vec2(seen.x, -seen.y);
        if sideways.length() > 1e-4 { sideways.normalized() } else { vec2(0.0, 1.0) }
    }

    /// The convex hull of points of the room in the picture, of which nothing behind the camera counts.
    pub(in crate::panel) fn hull(&self, points: &[Vec3]) -> Vec<Pos2> {
        let seen = points.iter().map(|p| self.seen(*p));
        let (mut ahead, behind): (Vec<_>, Vec<_>) = seen.partition(|p| p.z < -NEAR);
        let border = |a: &Vec3, b: &Vec3| a.lerp(*b, (-NEAR - a.z) / (b.z - a.z)).with_z(-NEAR);
        let borders: Vec<_> = ahead.iter().flat_map(|a| behind.iter().map(|b| border(a, b))).collect();
        ahead.extend(borders);
        convex(ahead.into_iter().map(|p| self.flat(p)).collect())
    }

    /// A line through the room as lines in the picture, without the part behind the camera.
    pub(in crate::panel) fn path(&self, points: &[Vec3]) -> Vec<Vec<Pos2>> {
        let mut runs = vec![Vec::new()];
        let mut last: Option<Vec3> = None;
        for point in points {
            let seen = self.seen(*point);
            let ahead = |p: Vec3| p.z < -NEAR;
            if let Some(last) = last.filter(|last| ahead(*last) != ahead(seen)) {
                let t = (-NEAR - last.z) / (seen.z - last.z);
                let border = self.flat(last.lerp(seen, t).with_z(-NEAR));
                runs.last_mut().into_iter().for_each(|run| run.push(border));
                if ahead(last) {
                    runs.push(Vec::new());
                }
            }
            if ahead(seen) {
                let at = self.flat(seen);
                runs.last_mut().into_iter().for_each(|run| run.push(at));
            }
            last = Some(seen);
        }
        runs.retain(|run| run.len() > 1);
        runs
    }
}

/// The convex hull of points: A. Andrew (1979), *Another Efficient Algorithm for Convex Hulls in Two Dimensions*.
fn convex(mut points: Vec<Pos2>) -> Vec<Pos2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let turns = |a: Pos2, b: Pos2, c: Pos2| {
        let way = |p: Pos2| [f64::from(p.x) - f64::from(a.x), f64::from(p.y) - f64::from(a.y)];
        let ([bx, by], [cx, cy]) = (way(b), way(c));
        bx * cy - by * cx > 0.0
    };
    let half = |points: &mut dyn Iterator<Item = Pos2>| {
        let mut hull: Vec<Pos2> = Vec::new();
        for p in points {
            while let [.., a, b] = hull[..]
                && !turns(a, b, p)
            {
                hull.pop();
            }
            hull.push(p);
        }
        // It is the first one of the other half.
        hull.pop();
        hull
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::pos2;

    use super::*;
    use crate::scene::Scene;

    fn lens(scene: Scene) -> Lens {
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(800.0, 450.0));
        Lens::of(&Session::new(scene), rect)
    }

    #[test]
    fn the_lens_is_that_of_the_observer() {
        let lens = lens(Scene::default());
        assert_eq!(lens.project(Vec3::splat(5.0)), Some(pos2(500.0, 275.0)));
        // 45° from bottom to top, at a distance of 4.5 m.
        let top = lens.project(Vec3::new(5.0, 5.0 + 4.5 * 22.5f32.to_radians().tan(), 5.0));
        assert!(top.is_some_and(|p| (p.y - 50.0).abs() < 0.01), "{top:?}");
        assert_eq!(lens.project(Vec3::new(5.0, 5.0, 9.9)), None, "behind the camera");
        let there = lens.at(pos2(500.0, 50.0), 4.5);
        assert!(lens.project(there).is_some_and(|p| p.distance(pos2(500.0, 50.0)) < 0.01), "{there}");
    }

    #[test]
    fn the_line_of_sight_through_the_place_of_a_point_meets_the_point() {
        let mut session = Session::new(Scene::default());
        session.facts.camera = Quat::from_rotation_y(0.4) * Quat::from_rotation_x(-0.3);
        let lens = Lens::of(&session, Rect::from_min_size(pos2(30.0, 20.0), vec2(640.0, 360.0)));
        for ahead in [0.5, 3.0, 12.0] {
            let place = pos2(200.0, 310.0);
            let (point, ray) = (lens.at(place, ahead), lens.ray(place));
            assert!((point - ray.eye).normalize().distance(ray.way) < 1e-5);
            assert!(lens.project(ray.eye + 2.0 * ray.way).is_some_and(|p| p.distance(place) < 0.01));
            assert!((point - ray.eye).normalize().distance(lens.ray(pos2(201.0, 310.0)).way) > 1e-4);
        }
    }

    #[test]
    fn a_line_that_passes_the_camera_is_cut_off_there() {
        let lens = lens(Scene::default());
        let ahead = Vec3::new(5.0, 5.5, 5.0);
        let runs = lens.path(&[ahead, Vec3::new(5.0, 5.5, 9.9), ahead]);
        assert_eq!(runs.len(), 2);
        assert!(runs.iter().flatten().all(|p| p.y < 275.0 && p.x == 500.0), "{runs:?}");
        assert!(lens.path(&[Vec3::new(1.0, 1.0, 9.9), Vec3::new(2.0, 1.0, 9.9)]).is_empty());
    }

    #[test]
    fn arrows_point_to_where_the_light_is() {
        let lens = lens(Scene::default());
        for (light, way) in [
            (Vec3::new(9.9, 5.0, 5.0), vec2(1.0, 0.0)),
            (Vec3::new(5.0, 9.9, 5.0), vec2(0.0, -1.0)),
            (Vec3::new(0.1, 5.0, 9.9), vec2(-1.0, 0.0)),
        ] {
            assert!(lens.project(light).is_none_or(|at| !lens.rect.contains(at)));
            assert!((lens.towards(light) - way).length() < 1e-3, "{light}");
        }
    }

    #[test]
    fn a_hull_is_around_its_points_and_ends_at_the_camera() {
        let lens = lens(Scene::default());
        let square = [(4.0, 4.0), (6.0, 4.0), (6.0, 6.0), (4.0, 6.0), (5.0, 5.0), (5.5, 4.2)];
        let points = square.map(|(x, y)| Vec3::new(x, y, 5.0));
        let hull = lens.hull(&points);
        assert_eq!(hull.len(), 4, "{hull:?}");
        assert!(points[..4].iter().all(|p| hull.contains(&lens.project(*p).expect("seen"))), "{hull:?}");
        // A strip on the floor that goes on behind the camera reaches below the picture.
        let strip = [(4.0, 2.0), (6.0, 2.0), (6.0, 12.0), (4.0, 12.0)].map(|(x, z)| Vec3::new(x, 0.0, z));
        let hull = lens.hull(&strip);
        let far = lens.project(strip[0]).expect("seen");
        assert!(hull.contains(&far) && hull.iter().all(|p| p.y >= far.y), "{hull:?}");
        assert!(hull.iter().any(|p| p.y > 1e4), "{hull:?}");
        assert!(lens.hull(&[Vec3::new(5.0, 5.0, 9.9)]).is_empty(), "behind the camera");
    }
}
