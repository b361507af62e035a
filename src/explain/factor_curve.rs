//! A quantity of an equation as a function of the light's angle, for a small plot.

use glam::Vec3;

use super::{Geometry, Model, workings::Workings};
use crate::{
    optics::Terms,
    text::expression::{Expression, Value},
};

/// The direction that varies along the plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The light, in its plane with the normal.
    Light,
    /// The viewer, in its plane with the normal.
    Viewer,
}

/// A quantity as a function of an angle to the normal.
#[derive(Clone, Debug, PartialEq)]
pub struct FactorCurve {
    /// The direction that varies.
    pub along: Along,
    /// Angles from −90° to 90°, positive on the present side, with the values there; `None` where undefined.
    pub points: Vec<(f32, Option<[f32; 3]>)>,
    /// The present angle in degrees, and the value there.
    pub here: (f32, [f32; 3]),
}

/// Number of angles of a curve.
const STEPS: i32 = 60;
/// Largest angle, in degrees, just above the horizon, where cosines are not 0 yet.
const MOST: f64 = 89.9;

impl Model {
    /// A quantity of the equation, named as by [defines](super::Line::defines), while the light moves in its
    /// plane with the normal, or the viewer if the quantity does not depend on the light. `None` for a
    /// constant.
    #[must_use]
    pub fn curve_of(&self, name: &str, geometry: &Geometry) -> Option<FactorCurve> {
        let expression = Expression::read(name).ok()?;
        let at = |geometry: &Geometry| {
            let mut workings = Workings::new(self, Some(geometry), &Terms::default());
            expression.value(&mut workings).ok().map(|value: Value| value.rgb.map(|v| v as f32))
        };
        let here = at(geometry)?;
        [Along::Light, Along::Viewer].into_iter().find_map(|along| {
            let way = if along == Along::Light { geometry.l } else { geometry.v };
            let n = geometry.frame.n;
            let across = (way - n.dot(way) * n).try_normalize().unwrap_or(geometry.frame.t);
            let moved = |degrees: f64| {
                let (sin, cos) = degrees.to_radians().sin_cos();
                let way: Vec3 = cos as f32 * n + sin as f32 * across;
                match along {
                    Along::Light => Geometry::of(way, geometry.v, geometry.frame),
                    Along::Viewer => Geometry::of(geometry.l, way, geometry.frame),
                }
            };
            let angles = (-STEPS..=STEPS).map(|i| MOST * f64::from(i) / f64::from(STEPS));
            let points: Vec<_> = angles.map(|angle| (angle as f32, at(&moved(angle)))).collect();
            let values = || points.iter().filter_map(|(_, value)| *value);
            let most = values().flatten().fold(0.0f32, |most, v| most.max(v.abs()));
            let moves = values().any(|v| v.iter().zip(here).any(|(a, b)| (a - b).abs() > 1e-5 * most));
            let angle = n.cross(way).length().atan2(n.dot(way)).to_degrees();
            moves.then_some(FactorCurve { along, points, here: (angle, here) })
        })
    }
}
