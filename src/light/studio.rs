//! A calculated photo studio: three infinitely distant softboxes in a dark room.

use std::{f32::consts::PI, sync::LazyLock};

use glam::{Vec2, Vec3};

use super::extent::{UNTURNED, sides};
use crate::optics::sampling::{self, SphericalRectangle};

/// Luminance of the room.
const ROOM: f32 = 0.04;

/// Fraction of the samples towards the room.
const ROOM_SHARE: f32 = 0.1;

/// A softbox.
struct Softbox {
    /// Direction of the centre, not normalised.
    middle: Vec3,
    /// Tangents of the half angles.
    half: Vec2,
    luminance: f32,
    /// Fraction of the samples.
    share: f32,
}

/// A large softbox from the upper left, a tall one from the right, and a narrow, bright one from behind.
const SOFTBOXES: [Softbox; 3] = [
    Softbox { middle: Vec3::new(-0.6, 0.6, 0.55), half: Vec2::new(0.55, 0.4), luminance: 1.8, share: 0.45 },
    Softbox { middle: Vec3::new(0.9, 0.15, 0.35), half: Vec2::new(0.25, 0.8), luminance: 0.7, share: 0.25 },
    Softbox { middle: Vec3::new(0.3, 0.8, -0.75), half: Vec2::new(0.8, 0.2), luminance: 2.4, share: 0.2 },
];

/// A softbox prepared for calculation: direction of the centre, sides, the rectangle a metre away, solid
/// angle.
struct Placed {
    axis: Vec3,
    sides: [Vec3; 2],
    rectangle: SphericalRectangle,
    pdf: f32,
}

static PLACED: LazyLock<[Placed; 3]> = LazyLock::new(|| {
    SOFTBOXES.map(|softbox| {
        let axis = softbox.middle.normalize();
        let sides = sides(-axis, UNTURNED);
        let rectangle = SphericalRectangle::new(axis, sides, softbox.half);
        Placed { axis, sides, rectangle, pdf: rectangle.pdf(axis) }
    })
});

/// True if a direction hits a softbox.
#[inline]
fn is_in(softbox: &Softbox, placed: &Placed, d: Vec3) -> bool {
    let along = d.dot(placed.axis);
    let [x, y] = placed.sides.map(|side| d.dot(side).abs());
    along > 0.0 && x <= softbox.half.x * along && y <= softbox.half.y * along
}

/// The luminance from a direction, and its sampling density.
#[inline]
pub(super) fn seen(d: Vec3) -> (f32, f32) {
    let (mut luminance, mut pdf) = (ROOM, ROOM_SHARE / (4.0 * PI));
    for (softbox, placed) in SOFTBOXES.iter().zip(&*PLACED) {
        if is_in(softbox, placed, d) {
            luminance = softbox.luminance;
            pdf += softbox.share * placed.pdf;
        }
    }
    (luminance, pdf)
}

/// A direction for a point of the unit square.
pub(super) fn sample(u: Vec2) -> Vec3 {
    let mut x = u.x;
    for (softbox, placed) in SOFTBOXES.iter().zip(&*PLACED) {
        if x < softbox.share {
            return placed.rectangle.sample(Vec2::new(x / softbox.share, u.y)).normalize();
        }
        x -= softbox.share;
    }
    sampling::sphere(Vec2::new(x / ROOM_SHARE, u.y))
}
