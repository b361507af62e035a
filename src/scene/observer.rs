//! The observer: placing the camera.

use glam::{Mat3, Mat4, Quat, Vec3};

use super::Observer;

/// Distance of the near plane from the eye, metres. Anything nearer is clipped.
pub const NEAR: f32 = 0.01;

/// The orientation of a camera that looks along `direction` with y up: columns right, up, backward (cameras look along
/// −z). Straight up or down, where y gives no up direction, it is the room's −z.
#[must_use]
pub fn orientation(direction: Vec3) -> Mat3 {
    let backward = -direction.normalize_or(Vec3::NEG_Z);
    let right = Vec3::Y.cross(backward).try_normalize().unwrap_or(Vec3::X);
    Mat3::from_cols(right, backward.cross(right), backward)
}

/// [`orientation`] as a rotation.
#[must_use]
pub fn rotation(direction: Vec3) -> Quat {
    Quat::from_mat3(&orientation(direction))
}

/// From room coordinates to clip space, for a picture of the given width/height: perspective with
/// reversed depth and no far plane (1 at [`NEAR`], 0 at infinity).
#[must_use]
pub fn clip_from_room(observer: &Observer, aspect: f32) -> Mat4 {
    let axes = orientation(observer.direction);
    let view = Mat4::from_mat3(axes.transpose()) * Mat4::from_translation(-observer.position);
    Mat4::perspective_infinite_reverse_rh(observer.field_of_view.to_radians(), aspect, NEAR) * view
}

/// Width/height for which scenes are composed.
pub const WIDE: f32 = 16.0 / 9.0;

/// The vertical field of view in radians of a picture of the given width/height.
#[must_use]
pub fn vertical_field_of_view(degrees: f32, aspect: f32, fits_width: bool) -> f32 {
    let radians = degrees.to_radians();
    if !fits_width || aspect >= WIDE || aspect <= 0.0 {
        return radians;
    }
    2.0 * ((radians * 0.5).tan() * WIDE / aspect).atan()
}

impl Observer {
    /// The same for a picture of this size that fits widths, drawn by a renderer that takes the field of view as the vertical
    /// one.
    #[must_use]
    pub fn fitting_width(self, [width, height]: [u32; 2]) -> Self {
        let aspect = width as f32 / height as f32;
        let field_of_view = vertical_field_of_view(self.field_of_view, aspect, true).to_degrees();
        Self { field_of_view, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_observer_looks_at_is_in_the_middle_and_up_is_up() {
        let observer = Observer {
            position: Vec3::new(1.0, 2.0, 3.0),
            direction: Vec3::new(2.0, 0.0, -1.0),
            field_of_view: 60.0,
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
        let observer = Observer { position: Vec3::ZERO, direction: Vec3::NEG_Z, field_of_view: 90.0 };
        let clip = clip_from_room(&observer, 2.0);
        assert!((clip.project_point3(Vec3::new(0.0, 1.0, -1.0)).y - 1.0).abs() < 1e-5);
        assert!((clip.project_point3(Vec3::new(2.0, 0.0, -1.0)).x - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_narrow_window_shows_what_a_wide_picture_shows_at_the_sides() {
        let half_width = |aspect: f32| (vertical_field_of_view(45.0, aspect, true) * 0.5).tan() * aspect;
        assert!((half_width(1.1) - half_width(WIDE)).abs() < 1e-6);
        assert!((half_width(0.5) - half_width(WIDE)).abs() < 1e-6);
        assert_eq!(vertical_field_of_view(45.0, 2.5, true), 45f32.to_radians());
        assert_eq!(vertical_field_of_view(45.0, 1.1, false), 45f32.to_radians());
    }
}
