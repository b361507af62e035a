//! The directional albedo `E = ∫ f cos θ dω` by the angle of the viewer.

use glam::{DVec3, Vec3};

use super::{Declaration, Horizontal, Kind};
use crate::curves::angles::{GRAZING, grid};

pub(super) static KIND: Declaration = Declaration {
    id: "albedo",
    name: "directional albedo E",
    row: "the directional albedo by the angle of the viewer: of the light from above, what is reflected",
    choice: [
        "Directional albedo E",
        "The part of the light that is reflected when light comes evenly from everywhere above the surface, by the angle of the viewer. Light that passes through the surface does not count. More than 1 means that energy is made from nothing.",
    ],
    quantity: "E",
    column: "e",
    symbols: |_| &["E", "E_V"],
    horizontal: Horizontal {
        columns: ("angle,mu", |_, angle| format!("{angle},{}", angle.to_radians().cos())),
        ..Horizontal::from_normal("angle of the viewer (°)")
    },
    is_reflected: true,
    has_light: false,
    up_to_one: true,
    rises: |_| true,
    value: |subject, setup, angle| {
        let v = view(angle, setup.phi_i);
        subject.directional_albedo(v)
    },
    angles: |_, fine| match fine {
        true => grid(0, 88, 2, &[87.0, 88.5, 89.0, 89.5, GRAZING]),
        false => grid(0, 84, 6, &[87.0, 89.0, GRAZING]),
    },
    is_refined: false,
    tried: Some((Kind::Brdf, 45.0)),
    ..Declaration::UNMEASURED
};

/// The direction from which the albedo is seen, with the cosine μ in 64 bits, as in `lcm albedo`.
fn view(angle: f64, phi: f64) -> Vec3 {
    let mu = angle.to_radians().cos();
    let sin = (1.0 - mu * mu).max(0.0).sqrt();
    let (y, x) = phi.rem_euclid(360.0).to_radians().sin_cos();
    DVec3::new(sin * x, sin * y, mu).as_vec3()
}
