//! Light with extent: what fills a part of the directions from which a point is lit.

use glam::{Vec2, Vec3};

use super::LightRecord;
use crate::parameter::{Parameter, ParameterKind};

/// A direction from a point to a light with extent, chosen at random.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Unit vector from the point to the light.
    pub l: Vec3,
    /// The radiance that arrives from there, cd/m², without the colour of the light.
    pub radiance: Vec3,
    /// The density of the direction per solid angle, 1/sr. Zero if there is none: the sample counts as dark.
    pub pdf: f32,
}

/// What a light with extent is in one direction from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The radiance that arrives, cd/m², without the colour of the light; zero beside it and behind it.
    pub radiance: Vec3,
    /// The density at which [`LightType::sample`](super::LightType::sample) gives the direction, 1/sr.
    pub pdf: f32,
    /// The distance of the light, metres; infinite for light from infinitely far away, zero where there is none.
    pub distance: f32,
}

impl Seen {
    /// Nothing: the direction leads past the light.
    pub const NOTHING: Self = Self { radiance: Vec3::ZERO, pdf: 0.0, distance: 0.0 };
}

/// A cone of directions from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The direction of its middle, unit vector.
    pub axis: Vec3,
    /// Half the angle that it fills, radians.
    pub half_angle: f32,
}

impl Cone {
    /// The directions of a ball around a place; none if the point may be within, where every direction leads to it.
    #[must_use]
    pub fn of_ball(middle: Vec3, radius: f32) -> Option<Self> {
        let distance = middle.length();
        // Rounding must leave nothing of the ball outside.
        let sine = 1.0001 * radius / distance;
        (sine < 0.999).then(|| Self { axis: middle / distance, half_angle: sine.asin() })
    }
}

/// The rectangle's sides for a unit vector in which it shines, and sine and cosine of its turn about it: without turn the second,
/// its height, points up as nearly as the direction allows; straight up or down it points to ∓z.
#[must_use]
pub fn sides(direction: Vec3, turn: Vec2) -> [Vec3; 2] {
    let across = Vec3::Y.cross(direction);
    let squared = across.length_squared();
    let x = if squared > 1e-12 { across / squared.sqrt() } else { Vec3::X };
    let y = direction.cross(x);
    [x * turn.y + y * turn.x, y * turn.y - x * turn.x]
}

/// Sine and cosine of no turn.
pub(super) const UNTURNED: Vec2 = Vec2::Y;

/// What the surface of a light sends towards a point that lies in this direction from it, for lights that shine to one side
/// or to both.
pub(super) fn shines(facing: f32, two_sided: bool) -> bool {
    facing > 0.0 || two_sided && facing < 0.0
}

/// Where a direction from a point meets the plane of a flat light with its middle there, if the light shines to that side: the
/// distance, and the way from the middle.
pub(super) fn on_plane(light: &LightRecord, p: Vec3, l: Vec3, two_sided: bool) -> Option<(f32, Vec3)> {
    let facing = -l.dot(light.direction);
    let middle = light.position - p;
    let distance = middle.dot(light.direction) / -facing;
    (shines(facing, two_sided) && distance > 0.0).then(|| (distance, l * distance - middle))
}

/// The most points of a sequence that a block of samples holds.
pub const BLOCK: usize = 8;

/// Directions of a model's lobes, and what arrives from them.
#[derive(Clone, Copy, Debug)]
pub struct Directions {
    /// Unit vectors in the room.
    pub l: [Vec3; BLOCK],
    /// Their densities, 1/sr.
    pub pdf: [f32; BLOCK],
    /// The radiance that arrives from all lights with extent, their colours included, each times the weight of the lobes.
    pub light: [Vec3; BLOCK],
}

/// True if it shines to the back as well.
pub(super) const TWO_SIDED: Parameter =
    Parameter::flag("two_sided", false).label("two-sided").help("It shines from its back as well.");

/// True if it is to be seen.
pub(super) const VISIBLE: Parameter =
    Parameter::flag("visible", true).help("It is to be seen in the picture; it lights objects in any case.");

/// The turn about the direction.
pub(super) const ROLL: Parameter = Parameter {
    name: "roll",
    symbol: "ρ",
    label: "roll",
    unit: "°",
    help: "Turns it about its direction.",
    kind: ParameterKind::Number { min: -360.0, max: 360.0, default: 0.0 },
    used_when: None,
};

/// The luminous flux over the luminance of an area that shines equally in all directions of one side, m² sr.
pub(super) fn flux(area: f64, two_sided: bool) -> f64 {
    std::f64::consts::PI * area * if two_sided { 2.0 } else { 1.0 }
}

/// The smallest size of a light, metres: a tenth of a millimetre, so that squares keep their digits.
pub(super) const SMALLEST: f32 = 1e-4;

/// A number that is derived from parameters: it has no range of its own.
pub(super) const fn number(name: &'static str) -> Parameter {
    Parameter::number(name, f32::MIN..=f32::MAX, 0.0)
}
