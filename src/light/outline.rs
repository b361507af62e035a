//! The outline of a light with extent, derived from its type's declaration.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Vec2, Vec3};

use super::{LightEntry, LightRecord, Size, extent};
use crate::{
    optics::{colour::Encoding, sampling},
    parameter::Values,
};

/// Number of corners of a circle.
const CORNERS: usize = 96;

/// A circle about an axis.
fn circle(middle: Vec3, axis: Vec3, radius: f32) -> impl Iterator<Item = Vec3> {
    (0..CORNERS).map(move |k| {
        let (y, x) = (k as f32 / CORNERS as f32 * TAU).sin_cos();
        middle + radius * sampling::about(axis, Vec3::new(x, y, 0.0))
    })
}

/// The visible edge of a ball: a circle nearer to the eye than the centre. `None` from inside.
fn limb(middle: Vec3, radius: f32, eye: Vec3) -> Option<impl Iterator<Item = Vec3>> {
    let to_eye = eye - middle;
    let squared = to_eye.length_squared();
    let near = radius * radius / squared;
    (near < 1.0)
        .then(|| circle(middle + near * to_eye, to_eye / squared.sqrt(), radius * (1.0 - near).sqrt()))
}

impl LightEntry {
    /// The [sides](extent::sides) of a light with these parameters and direction.
    #[must_use]
    pub fn sides(&self, values: &Values, direction: Vec3) -> [Vec3; 2] {
        let roll = self.roll_parameter().map_or(0.0, |p| values.number(p));
        extent::sides(direction, Vec2::from(roll.to_radians().sin_cos()))
    }

    /// The diameter of a ball around all [sizes](super::Declaration::sizes) of a light, metres.
    #[must_use]
    pub fn span(&self, values: &Values) -> f32 {
        let half = |size: &Size| self.metres(size, values);
        2.0 * self.declaration.sizes.iter().filter_map(half).map(|half| half * half).sum::<f32>().sqrt()
    }

    fn metres(&self, size: &Size, values: &Values) -> Option<f32> {
        self.parameter(size.parameter()).map(|p| size.part() * values.number(p))
    }

    /// The outlines of a light with extent as seen from a position: lists of points in the room, whose convex
    /// hulls in the picture are the outlines. They follow from the [sizes](super::Declaration::sizes) of the
    /// type: width and height give a rectangle, a radius a circle, or a ball for a type without direction, a
    /// length with a radius a tube. For a type without sizes, it is the circle of its
    /// [bounds](super::LightType::bounds). Empty if the light is on all sides.
    #[must_use]
    pub fn outlines(&self, values: &Values, light: &LightRecord, eye: Vec3) -> Vec<Vec<Vec3>> {
        let declaration = self.declaration;
        if !declaration.extent {
            return Vec::new();
        }
        if declaration.sizes.is_empty() {
            let cone = (self.instantiate)(values, Encoding::default()).bounds(light, eye);
            let cone = cone.filter(|cone| cone.half_angle < FRAC_PI_2);
            let rim =
                |cone: extent::Cone| circle(eye + cone.axis, cone.axis, cone.half_angle.tan()).collect();
            return cone.map(rim).into_iter().collect();
        }
        let (mut half, mut radii) = (Vec3::ZERO, Vec::new());
        for size in declaration.sizes {
            let Some(metres) = self.metres(size, values) else { continue };
            match size {
                Size::Width(_) => half.x = metres,
                Size::Height(_) => half.y = metres,
                Size::Length(_) => half.z = metres,
                Size::Radius(_) => radii.push(metres),
            }
        }
        if radii.is_empty() {
            radii.push(0.0);
        }
        let [x, y] = self.sides(values, light.direction);
        let corners =
            (0..8).filter(|k: &u32| (0..3).all(|axis| half[axis] > 0.0 || k >> axis & 1 == 0)).map(|k| {
                let sign = |bit: u32| if k & bit == 0 { -1.0 } else { 1.0 };
                let [a, b, c] = (half * Vec3::new(sign(1), sign(2), sign(4))).to_array();
                light.position + a * x + b * y + c * light.direction
            });
        let corners: Vec<_> = corners.collect();
        let around = |radius: f32| -> Vec<Vec3> {
            let one = |middle: &Vec3| match radius {
                0.0 => vec![*middle],
                _ if declaration.has_direction => circle(*middle, light.direction, radius).collect(),
                _ => limb(*middle, radius, eye).into_iter().flatten().collect(),
            };
            corners.iter().flat_map(one).collect()
        };
        radii.into_iter().map(around).collect()
    }
}
