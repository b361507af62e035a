//! Rotations in scenes: Euler angles in degrees.

use glam::{EulerRot, Quat, Vec3};

/// The rotation of Euler angles in degrees: about the room's x first, then y, then z.
#[must_use]
pub fn rotation(degrees: Vec3) -> Quat {
    let r = degrees.map(f32::to_radians);
    Quat::from_euler(EulerRot::ZYX, r.z, r.y, r.x)
}

/// The Euler angles in degrees of a rotation, the inverse of [`rotation`].
#[must_use]
pub fn euler_degrees(rotation: Quat) -> Vec3 {
    let (z, y, x) = rotation.to_euler(EulerRot::ZYX);
    Vec3::new(x, y, z).map(f32::to_degrees)
}

/// The Euler angles in degrees of a rotation followed by one about an axis of the room, rounded to a
/// hundredth of a degree.
#[must_use]
pub fn turned(from: Quat, axis: Vec3, radians: f32) -> Vec3 {
    let degrees = euler_degrees(Quat::from_axis_angle(axis, radians) * from);
    // No −0.
    (degrees * 100.0).round() / 100.0 + Vec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_turn_about_x_first() {
        let r = rotation(Vec3::new(90.0, 90.0, 0.0));
        // y → z about x, then z → x about y.
        assert!((r * Vec3::Y - Vec3::X).length() < 1e-6);
    }

    #[test]
    fn euler_angles_and_rotations_are_inverse() {
        for degrees in [Vec3::ZERO, Vec3::new(10.0, 20.0, 30.0), Vec3::new(-70.0, 45.0, 170.0)] {
            let back = euler_degrees(rotation(degrees));
            assert!((back - degrees).length() < 1e-3, "{degrees} became {back}");
        }
    }

    #[test]
    fn turning_on_is_about_the_axes_of_the_room() {
        let from = rotation(Vec3::new(0.0, 30.0, 0.0));
        assert_eq!(turned(from, Vec3::Y, 15f32.to_radians()), Vec3::new(0.0, 45.0, 0.0));
        let about_x = rotation(turned(from, Vec3::X, 0.5));
        assert!((about_x * Vec3::X - Quat::from_rotation_x(0.5) * (from * Vec3::X)).length() < 1e-3);
        assert_eq!(turned(from, Vec3::Y, -30f32.to_radians()).to_string(), "[0, 0, 0]");
    }
}
