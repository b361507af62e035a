//! Light with extent: light that reaches a point from a range of directions.

use glam::{Vec2, Vec3};

use super::LightRecord;
use crate::parameter::Parameter;

/// A random direction from a point to a light with extent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Unit vector from the point to the light.
    pub l: Vec3,
    /// The radiance arriving from there, cd/m², without the colour of the light.
    pub radiance: Vec3,
    /// Probability density of the direction per solid angle, 1/sr. Zero for a failed sample, which counts as
    /// dark.
    pub pdf: f32,
}

/// A light with extent, seen in one direction from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The arriving radiance, cd/m², without the colour of the light; zero outside the light and behind it.
    pub radiance: Vec3,
    /// The density with which [`LightType::sample`](super::LightType::sample) returns this direction, 1/sr.
    pub pdf: f32,
    /// Distance of the light, in metres; infinite for infinitely distant light, zero outside the light.
    pub distance: f32,
}

impl Seen {
    /// The direction misses the light.
    pub const NOTHING: Self = Self { radiance: Vec3::ZERO, pdf: 0.0, distance: 0.0 };
}

/// A cone of directions from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Direction of the axis, a unit vector.
    pub axis: Vec3,
    /// Half angle, in radians.
    pub half_angle: f32,
}

impl Cone {
    /// The directions of a ball around a point; `None` if the observer may be inside, where every direction
    /// hits it.
    #[must_use]
    pub fn of_ball(middle: Vec3, radius: f32) -> Option<Self> {
        let distance = middle.length();
        // Rounding must not exclude any part of the ball.
        let sine = 1.0001 * radius / distance;
        (sine < 0.999).then(|| Self { axis: middle / distance, half_angle: sine.asin() })
    }
}

/// The rectangle's sides for the unit vector in which it shines, and sine and cosine of its rotation about
/// it. Without rotation the second side, its height, points up as nearly as the direction allows; for a
/// vertical direction it points to ∓z.
#[must_use]
pub fn sides(direction: Vec3, turn: Vec2) -> [Vec3; 2] {
    let across = Vec3::Y.cross(direction);
    let squared = across.length_squared();
    let x = if squared > 1e-12 { across / squared.sqrt() } else { Vec3::X };
    let y = direction.cross(x);
    [x * turn.y + y * turn.x, y * turn.y - x * turn.x]
}

/// Sine and cosine of zero rotation.
pub(super) const UNTURNED: Vec2 = Vec2::Y;

/// True if the surface of a one- or two-sided light shines towards a point in this direction from it.
pub(super) fn shines(facing: f32, two_sided: bool) -> bool {
    facing > 0.0 || two_sided && facing < 0.0
}

/// The intersection of a ray with the plane of a flat light, if the light shines to that side: the distance,
/// and the offset from the centre.
pub(super) fn on_plane(light: &LightRecord, p: Vec3, l: Vec3, two_sided: bool) -> Option<(f32, Vec3)> {
    let facing = -l.dot(light.direction);
    let middle = light.position - p;
    let distance = middle.dot(light.direction) / -facing;
    (shines(facing, two_sided) && distance > 0.0).then(|| (distance, l * distance - middle))
}

/// Maximum number of points of a sequence in a block of samples.
pub const BLOCK: usize = 8;

/// Directions of a model's lobes, and the light arriving from them.
#[derive(Clone, Copy, Debug)]
pub struct Directions {
    /// Unit vectors in the room.
    pub l: [Vec3; BLOCK],
    /// Probability densities, 1/sr.
    pub pdf: [f32; BLOCK],
    /// The radiance arriving from all lights with extent, including their colours, times the weight of the
    /// lobes.
    pub light: [Vec3; BLOCK],
}

/// True if the light also shines to the back.
pub(super) const TWO_SIDED: Parameter =
    Parameter::flag("two_sided", false).label("two-sided").help("It shines from its back as well.");

/// True if the light is visible in the picture.
pub(super) const VISIBLE: Parameter =
    Parameter::flag("visible", true).help("It is to be seen in the picture; it lights objects in any case.");

/// The rotation about the direction.
pub(super) const ROLL: Parameter = Parameter::number("roll", -360.0..=360.0, 0.0)
    .symbol("ρ")
    .unit("°")
    .help("Turns it about its direction.");

/// Luminous flux divided by luminance for an area that shines equally in all directions of one or both sides,
/// m² sr.
pub(super) fn flux(area: f64, two_sided: bool) -> f64 {
    std::f64::consts::PI * area * if two_sided { 2.0 } else { 1.0 }
}

/// Minimum size of a light, in metres: a tenth of a millimetre, so that squares keep their digits.
pub(super) const SMALLEST: f32 = 1e-4;

/// A number derived from parameters, without a range.
pub(super) const fn number(name: &'static str) -> Parameter {
    Parameter::number(name, f32::MIN..=f32::MAX, 0.0)
}
