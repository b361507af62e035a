//! The observer and its camera.

use glam::{Mat3, Mat4, Quat, Vec3};

use super::{Field, Object, Scene, field::Kind, part::part, rows::Row};
use crate::shape;

/// Passes the declaration to a macro: [`part!`], or that of the component.
macro_rules! observer {
    ($with:ident) => {
        $with! {
            /// The observer: the camera of the scene.
            #[derive(Copy)]
            pub struct Observer("the observer") {
                /// Position: [x, y, z] in metres, inside the room, not at the position of a light or an object.
                position: Vec3 = Field::of("a position", Kind::Position).unit("m").required("the observer needs one"), Vec3::new(5.0, 5.0, 9.5);
                /// Direction of view: [x, y, z], of any length.
                direction: Vec3 = Field::of("a direction", Kind::Direction).required("the observer needs one"), Vec3::NEG_Z;
                /// Vertical field of view, degrees.
                field_of_view: f32 = Field::number("the field of view", 1.0..=170.0).unit("°").always(), 45.0;
            }
        }
    };
}
pub(crate) use observer;

observer!(part);

/// The distance of the near plane from the eye, metres. Anything nearer is clipped.
pub const NEAR: f32 = 0.01;

/// The orientation of a camera that looks along `direction` with y up: columns right, up, backward (cameras look along
/// −z). Straight up or down, where y gives no up direction, it is the room's −z.
#[must_use]
pub fn orientation(direction: Vec3) -> Mat3 {
    let backward = -direction.normalize_or(Vec3::NEG_Z);
    let right = Vec3::Y.cross(backward).try_normalize().unwrap_or(Vec3::X);
    Mat3::from_cols(right, backward.cross(right), backward)
}

/// The [`orientation`] as a rotation.
#[must_use]
pub fn rotation(direction: Vec3) -> Quat {
    Quat::from_mat3(&orientation(direction))
}

/// The transformation from room coordinates to clip space, for a picture with this ratio of width to height:
/// perspective with reversed depth and no far plane (1 at [`NEAR`], 0 at infinity).
#[must_use]
pub fn clip_from_room(observer: &Observer, aspect: f32) -> Mat4 {
    let axes = orientation(observer.direction);
    let view = Mat4::from_mat3(axes.transpose()) * Mat4::from_translation(-observer.position);
    Mat4::perspective_infinite_reverse_rh(observer.field_of_view.to_radians(), aspect, NEAR) * view
}

/// The ratio of width to height of a picture of this size.
#[must_use]
pub fn aspect(size: [u32; 2]) -> f64 {
    f64::from(size[0].max(1)) / f64::from(size[1].max(1))
}

/// The tangents of half the angles of view of a picture with a vertical field of view in radians, across and up.
#[must_use]
pub fn half_tangents(size: [u32; 2], vertical: f32) -> [f64; 2] {
    let up = f64::from(0.5 * vertical).tan();
    [up * aspect(size), up]
}

/// The line of sight through the centre of a pixel of such a picture: the tangents of the angles to the right
/// of and above the direction of view.
#[must_use]
pub fn line_of_sight(pixel: [u32; 2], size: [u32; 2], vertical: f32) -> [f32; 2] {
    let [across, up] = half_tangents(size, vertical);
    let part = |i: usize| 2.0 * (f64::from(pixel[i]) + 0.5) / f64::from(size[i].max(1)) - 1.0;
    [(part(0) * across) as f32, (-part(1) * up) as f32]
}

/// The ratio of width to height for which scenes are composed.
pub const WIDE: f32 = 16.0 / 9.0;

/// The width of a picture around the objects in it, as a multiple of theirs.
const MARGIN: f32 = 1.1;

/// The tangent of the angle between the direction of view and the outer edge of a sphere that is aside of it.
/// The depth is greater than the radius.
fn outer_edge(aside: f32, depth: f32, radius: f32) -> f32 {
    let [a, d, r] = [aside.abs(), depth, radius];
    (a * d + r * (a * a + d * d - r * r).sqrt()) / (d * d - r * r)
}

/// The largest tangents across and up of an object's outermost points, where `seen` takes points around its position to the
/// camera's coordinates; infinite if they are not known or beside the eye.
fn extent(object: &Object, seen: impl Fn(Vec3) -> Vec3) -> [f32; 2] {
    let Some(points) = shape::outermost(&object.object_type, &object.shape) else {
        return [f32::INFINITY; 2];
    };
    let own = object.room_from_object();
    points.iter().fold([0.0f32; 2], |[across, high], p| {
        let at = seen(own.transform_vector3(*p));
        let tangent = |side: f32| if -at.z > NEAR { side.abs() / -at.z } else { f32::INFINITY };
        [across.max(tangent(at.x)), high.max(tangent(at.y))]
    })
}

/// The field of view of pictures in a window, which can have any shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewAngle {
    /// The field of view of the observer, degrees.
    pub degrees: f32,
    /// The ratio of width to height below which a picture keeps the horizontal extent of its content, and
    /// shows more above and below.
    pub keeps: f32,
}

impl ViewAngle {
    /// The vertical field of view in radians of a picture with this ratio of width to height.
    #[must_use]
    pub fn vertical(self, aspect: f32) -> f32 {
        let radians = self.degrees.to_radians();
        if aspect >= self.keeps || aspect <= 0.0 {
            return radians;
        }
        2.0 * ((radians * 0.5).tan() * self.keeps / aspect).atan()
    }
}

impl Scene {
    /// The field of view of the scene's pictures in a window. A single picture shows at the sides what a wide
    /// picture shows; in views side by side the smaller side has the observer's angle, so that objects keep
    /// their size, or as much more as the objects and rows of the scene need.
    #[must_use]
    pub fn view_angle(&self) -> ViewAngle {
        ViewAngle {
            degrees: self.observer.field_of_view,
            keeps: if self.is_beside() {
                self.width_of_objects().max(self.width_of_rows()).clamp(1.0, WIDE)
            } else {
                WIDE
            },
        }
    }

    /// True if views stand beside each other.
    fn is_beside(&self) -> bool {
        self.comparison.layout.is_beside() && !self.variants.is_empty()
    }

    /// The ratio of width to height that views beside each other keep at least for an object at a position;
    /// `None` for other views.
    pub(crate) fn widened_by(&self, position: Vec3, object: &Object) -> Option<f32> {
        self.is_beside().then(|| self.width_around(std::iter::once((position, object))).clamp(1.0, WIDE))
    }

    fn width_of_objects(&self) -> f32 {
        let objects = self.objects.iter().filter(|object| object.visible);
        self.width_around(objects.map(|object| (object.position, object)))
    }

    /// The ratio of width to height of a picture that shows objects at positions from side to side, with a
    /// margin: those that a wide picture shows from top to bottom. Floors and backdrops reach beyond it, and do not count.
    fn width_around<'o>(&self, objects: impl Iterator<Item = (Vec3, &'o Object)>) -> f32 {
        let to_eye = orientation(self.observer.direction).transpose();
        let up = (0.5 * self.observer.field_of_view.to_radians()).tan();
        let of_object = |(position, object): (Vec3, &Object)| {
            let seen = to_eye * (position - self.observer.position);
            let (depth, radius) = (-seen.z, 0.5 * object.size);
            if depth <= radius + NEAR || seen.x.abs() > WIDE * up * depth {
                return 0.0;
            }
            if outer_edge(seen.y, depth, radius) <= up {
                return outer_edge(seen.x, depth, radius);
            }
            // Out of the picture above or below.
            if seen.y.abs() > up * depth {
                return 0.0;
            }
            // Something flat, like a teapot, is lower than the sphere around it.
            let [across, high] = extent(object, |p| seen + to_eye * p);
            if high <= up && across <= WIDE * up { across } else { 0.0 }
        };
        MARGIN * objects.map(of_object).fold(0.0, f32::max) / up
    }

    /// The ratio of width to height of a picture that shows the rows from side to side, with a margin.
    fn width_of_rows(&self) -> f32 {
        let to_eye = orientation(self.observer.direction).transpose();
        let up = (0.5 * self.observer.field_of_view.to_radians()).tan();
        let of_row = |row: Row| {
            let ends = [row.first, row.first + row.count - 1].map(|i| self.objects[i].size);
            let reach = 0.5 * ends[0].max(ends[1]);
            let sides = row.corners().map(|p| {
                let seen = to_eye * (p - self.observer.position);
                let depth = -seen.z - reach;
                if depth > NEAR { (seen.x.abs() + reach) / (depth * up) } else { f32::INFINITY }
            });
            sides.into_iter().fold(0.0, f32::max)
        };
        self.rows().filter(|row| row.entry.visible).map(of_row).fold(0.0, f32::max)
    }
}

impl Observer {
    /// The default observer at a position, looking in a direction.
    #[must_use]
    pub fn at(position: Vec3, direction: Vec3) -> Self {
        Self { position, direction, ..Self::default() }
    }

    /// This observer with the angle of view of a picture of this size, for a renderer that takes the field of
    /// view as the vertical one.
    #[must_use]
    pub fn fitting(self, [width, height]: [u32; 2], angle: ViewAngle) -> Self {
        Self { field_of_view: angle.vertical(width as f32 / height as f32).to_degrees(), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        registry::Registry,
        scene::{Object, Repeat, Repetition, comparison::Layout},
    };

    #[test]
    fn what_the_observer_looks_at_is_in_the_middle_and_up_is_up() {
        let observer = Observer {
            position: Vec3::new(1.0, 2.0, 3.0),
            direction: Vec3::new(2.0, 0.0, -1.0),
            ..Observer::default()
        };
        let clip = clip_from_room(&observer, 1.5);
        let ahead = clip.project_point3(observer.position + 4.0 * observer.direction);
        assert!(ahead.x.abs() < 1e-5 && ahead.y.abs() < 1e-5 && ahead.z > 0.0 && ahead.z < 1.0);
        let above = clip.project_point3(observer.position + 4.0 * observer.direction + Vec3::Y);
        assert!(above.y > 0.0 && above.x.abs() < 1e-5);
    }

    #[test]
    fn looking_straight_up_and_down_is_possible() {
        for direction in [Vec3::Y, Vec3::NEG_Y] {
            let axes = orientation(direction);
            assert!((axes.determinant() - 1.0).abs() < 1e-5);
            assert!((axes * Vec3::NEG_Z - direction).length() < 1e-6);
        }
    }

    #[test]
    fn the_field_of_view_is_vertical() {
        let observer = Observer { position: Vec3::ZERO, field_of_view: 90.0, ..Observer::default() };
        let clip = clip_from_room(&observer, 2.0);
        assert!((clip.project_point3(Vec3::new(0.0, 1.0, -1.0)).y - 1.0).abs() < 1e-5);
        assert!((clip.project_point3(Vec3::new(2.0, 0.0, -1.0)).x - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_narrow_window_shows_what_a_wide_picture_shows_at_the_sides() {
        let window = ViewAngle { degrees: 45.0, keeps: WIDE };
        let half_width = |aspect: f32| (window.vertical(aspect) * 0.5).tan() * aspect;
        assert!((half_width(1.1) - half_width(WIDE)).abs() < 1e-6);
        assert!((half_width(0.5) - half_width(WIDE)).abs() < 1e-6);
        assert_eq!(window.vertical(2.5), 45f32.to_radians());
    }

    #[test]
    fn beside_each_other_the_smaller_side_has_the_angle_of_the_observer() {
        let mut scene = Scene::default();
        scene.comparison.layout = Layout::SideBySide;
        assert_eq!(scene.view_angle().keeps, WIDE, "of one view there is nothing beside it");
        scene.variants.push(crate::scene::Variant::default());
        let angle = scene.view_angle();
        assert_eq!(angle.vertical(1.2), 45f32.to_radians());
        let half_width = (angle.vertical(0.6) * 0.5).tan() * 0.6;
        assert!((half_width - 22.5f32.to_radians().tan()).abs() < 1e-6);
        scene.comparison.layout = Layout::Wipe;
        assert_eq!(scene.view_angle().keeps, WIDE);
    }

    #[test]
    fn beside_each_other_views_show_whole_the_objects_that_a_wide_picture_shows_whole() {
        let object =
            |x: f32, size: f32| Object { position: Vec3::new(x, 5.0, 5.0), size, ..Object::default() };
        let of = |objects: Vec<Object>| {
            let mut scene = Scene { objects, ..Scene::default() };
            scene.comparison.layout = Layout::SideBySide;
            scene.variants.push(crate::scene::Variant::default());
            scene
        };
        // As the ball and the ring of the shipped comparison of tone mappings.
        let scene = of(vec![object(3.6, 2.6), object(6.6, 2.6)]);
        for size in [[360, 280], [300, 560], [640, 360]] {
            let view = scene.observer.fitting(size, scene.view_angle());
            let [across, up] = half_tangents(size, view.field_of_view.to_radians());
            for x in [1.4f64, 1.6] {
                // The silhouette of a sphere of radius 1.3 at a depth of 4.5.
                let reach = (x / 4.5f64).atan() + (1.3 / x.hypot(4.5)).asin();
                assert!(
                    reach.tan() <= across && (1.3 / 4.5f64).asin().tan() < up,
                    "{size:?}: {reach} {across}"
                );
            }
        }
        let keeps = |objects| of(objects).view_angle().keeps;
        assert!((1.2..1.3).contains(&keeps(vec![object(4.0, 2.0)])), "no more than it needs");
        assert_eq!(keeps(vec![object(5.0, 2.0)]), 1.0, "there is room already");
        assert_eq!(keeps(vec![object(5.0, 2.0), object(9.0, 2.0)]), 1.0, "beyond the wide picture");
        assert_eq!(keeps(vec![object(6.0, 4.0)]), 1.0, "higher than the picture");
        assert_eq!(keeps(vec![object(5.0, 10.0)]), 1.0, "around the eye");
        assert_eq!(keeps(vec![Object { visible: false, ..object(7.0, 1.0) }]), 1.0, "hidden");
        assert_eq!(keeps(vec![object(7.5, 2.0)]), WIDE, "no more than a wide picture");
    }

    #[test]
    fn a_flat_object_in_a_sphere_higher_than_the_picture_is_whole_at_the_sides() {
        let registry = Registry::builtin();
        let example =
            crate::scene::examples::EXAMPLES.iter().find(|e| e.file == "portrait.json").expect("shipped");
        let mut scene = example.scene(&registry).expect("it is valid");
        scene.comparison.layout = Layout::SideBySide;
        scene.variants = vec![crate::scene::Variant::default(); 2];
        let Observer { position, direction, field_of_view } = scene.observer;
        let teapot = &scene.objects[0];
        let to_eye = orientation(direction).transpose();
        let up = (0.5 * field_of_view.to_radians()).tan();
        let seen = to_eye * (teapot.position - position);
        assert!(outer_edge(seen.y, -seen.z, 0.5 * teapot.size) > up, "nothing is tested");
        let mesh = registry.shape("teapot").expect("built in").mesh(&teapot.shape, 16);
        let own = teapot.room_from_object();
        // The views of a presentation of three in a window of 1920 × 1080 pixels.
        let view = scene.observer.fitting([640, 704], scene.view_angle());
        let [across, _] = half_tangents([640, 704], view.field_of_view.to_radians());
        for p in mesh.positions {
            let at = to_eye * (own.transform_point3(p) - position);
            assert!(f64::from(at.x.abs() / -at.z) < 0.97 * across, "{p} is cut");
        }
        assert!(scene.view_angle().keeps < 1.5, "no more than it needs");
        scene.objects[0].rotation = Vec3::new(0.0, 0.0, 90.0);
        assert_eq!(scene.view_angle().keeps, 1.0, "upright, it is higher than the picture");
    }

    #[test]
    fn beside_each_other_views_show_a_row_from_side_to_side() {
        let of = |columns: u32| {
            let repeat = Repeat { columns, spacing: Vec3::X, ..Repeat::default() };
            let entry = Object {
                position: Vec3::new(5.0 - 0.5 * (columns - 1) as f32, 5.0, 5.0),
                size: 0.8,
                repeat: Repetition::Entry(Box::new(repeat)),
                ..Object::default()
            };
            let mut scene = Scene { objects: vec![entry], ..Scene::default() };
            scene.comparison.layout = Layout::SideBySide;
            scene.variants.push(crate::scene::Variant::default());
            scene.expanded(&Registry::builtin()).expect("a row")
        };
        // The middle of the outermost sphere, and its silhouette, in a view that is higher than wide.
        let scene = of(5);
        let narrow = scene.observer.fitting([600, 800], scene.view_angle());
        let clip = clip_from_room(&narrow, 0.75);
        for side in [-1.0, 1.0] {
            let p = clip.project_point3(Vec3::new(5.0 + 2.4 * side, 5.0, 5.0));
            assert!((0.8..0.99).contains(&(side * p.x)), "{p}");
        }
        assert_eq!(of(3).view_angle().keeps, 1.0, "there is room already");
        assert_eq!(of(9).view_angle().keeps, WIDE, "no more than a wide picture");
    }
}
