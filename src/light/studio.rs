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

/// The luminance, if it is the same in all directions between these.
pub(super) fn same_between(corners: &[Vec3; 4]) -> Option<f32> {
    /// Rounding of the corners and of the directions between them.
    const ROUNDING: f32 = 1e-5;
    let mut luminance = ROOM;
    for (softbox, placed) in SOFTBOXES.iter().zip(&*PLACED) {
        // The sides' planes: a convex part outside one of them misses the softbox.
        let [x, y] = [0, 1].map(|i| [placed.sides[i], -placed.sides[i]].map(|side| (side, softbox.half[i])));
        let beyond = x.into_iter().chain(y).map(|(side, half)| {
            let distances = corners.map(|d| d.dot(side) - half * d.dot(placed.axis));
            [distances.into_iter().fold(f32::MAX, f32::min), distances.into_iter().fold(f32::MIN, f32::max)]
        });
        let [nearest, farthest] = beyond.fold([f32::MIN; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        if farthest < -ROUNDING {
            luminance = softbox.luminance;
        } else if nearest < ROUNDING {
            return None;
        }
    }
    Some(luminance)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::sequence::Sequence;

    #[test]
    fn between_corners_of_the_same_luminance_it_is_that_everywhere() {
        let (mut room, mut softboxes, mut mixed) = (0, 0, 0);
        for i in 0..2000 {
            let middle = sampling::sphere(Sequence::new(1, 0).point(i));
            let side = middle.any_orthonormal_vector();
            let half = 0.002 + 0.2 * Sequence::new(1, 1).point(i).x;
            let corner = |x: f32, y: f32| (middle + half * (x * side + y * middle.cross(side))).normalize();
            let Some(same) =
                same_between(&[corner(-1.0, -1.0), corner(1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)])
            else {
                mixed += 1;
                continue;
            };
            if same == ROOM {
                room += 1
            } else {
                softboxes += 1
            }
            for x in -4..=4 {
                for y in -4..=4 {
                    let d = corner(x as f32 / 4.0, y as f32 / 4.0);
                    assert_eq!(seen(d).0, same, "{i} {middle} {half} {d}");
                }
            }
        }
        assert!(room > 500 && softboxes > 20 && mixed > 100, "{room} {softboxes} {mixed}");
    }
}
