//! The legal values of numbers, for widgets, which check values while they are typed. Those of a field follow from its
//! [declaration](super::Field::limits); here are those that depend on other parts of the scene.

use glam::Vec3;

pub use super::range::{significant, tessellation};
use super::{Light, Object, Part, Scene, SceneSize, check};
pub use crate::parameter::limits::{Limits, number};
use crate::{light, optics::radiometry::SPHERE};

/// A coordinate of a position in a room: 0 < coordinate ≤ size. `axis` is 0 for x, 1 for y, 2 for z.
#[must_use]
pub fn position(size: SceneSize, axis: usize) -> Limits {
    let name = ["wide", "high", "deep"][axis.min(2)];
    let extent = f64::from(size.corner().to_array()[axis.min(2)]);
    let because = format!("the room is {} m {name}", number(extent));
    Limits { because: Some(because), ..Limits::above_zero(extent) }
}

/// The size of an object, metres, with a slider for the room.
#[must_use]
pub fn object_size(size: SceneSize) -> Limits {
    Object::size.limits().slider(0.0, f64::from(size.corner().max_element()))
}

/// The intensity of a light.
#[must_use]
pub fn intensity(light: &light::Declaration) -> Limits {
    Light::intensity.limits().slider(0.0, f64::from(light.slider_max))
}

/// The luminous flux of a light, lumen. The end of the slider corresponds to that of the intensity, for a
/// light that shines in every direction.
#[must_use]
pub fn luminous_flux(light: &light::Declaration) -> Limits {
    let end = f64::from(light.slider_max) * SPHERE;
    Light::luminous_flux.limits().slider(0.0, significant(end, 1))
}

/// An extent of the room, in metres: everything in the room must stay inside. `axis` is 0 for width, 1 for height, 2 for
/// depth; `name` returns the name of a part.
#[must_use]
pub fn extent(scene: &Scene, axis: usize, name: impl Fn(Part) -> String) -> Limits {
    let at = |p: Vec3| p.to_array()[axis.min(2)];
    let furthest = check::places(&scene.lights, &scene.objects, scene)
        .map(|(who, p)| (who, at(p)))
        .filter(|(_, c)| c.is_finite())
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let any = SceneSize::width.limits();
    match furthest {
        Some((who, c)) if c > 0.0 && any.allows(f64::from(c)) => Limits {
            because: Some(format!(
                "{} is at {} = {} m",
                name(who),
                ["x", "y", "z"][axis.min(2)],
                number(f64::from(c))
            )),
            ..Limits::between(f64::from(c), any.max).slider(0.0, any.max)
        },
        _ => any,
    }
}
