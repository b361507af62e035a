use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{
    Declaration, LightRecord, LightType, Size,
    disc::RADIUS,
    extent::{self, Cone, Sample, Seen, VISIBLE},
};
use crate::{
    optics::{radiometry::SPHERE, sampling},
    parameters,
    shader::wgsl,
};

parameters! {
    /// **Sphere**: a globe lamp; the same luminance L, cd/m², from every point of it. The luminous flux is
    /// `Φ = 4π² r² L` lumen. A point within it gets no light.
    pub struct Sphere {
        /// The radius, metres.
        radius: number = RADIUS,
        /// True if it is to be seen in the picture.
        visible: flag = VISIBLE,
    }
}

impl Sphere {
    /// The sphere as seen from a point outside: direction and distance of the centre, the squared sine of the
    /// angular radius, and 1 minus its cosine.
    fn from(&self, light: &LightRecord, p: Vec3) -> Option<(Vec3, f32, f32, f32)> {
        let middle = light.position - p;
        let distance = middle.length();
        if distance.is_nan() || distance <= self.radius {
            return None;
        }
        let sine = self.radius / distance;
        let squared = sine * sine;
        let rise = squared / (1.0 + ((1.0 - sine) * (1.0 + sine)).sqrt());
        (rise > 0.0).then(|| (middle / distance, distance, squared, rise))
    }
}

impl LightType for Sphere {
    const DECLARATION: Declaration = Declaration::new("sphere", "Sphere light", wgsl!("light/sphere.wgsl"))
        .summary("A globe lamp: a sphere that is equally bright everywhere.")
        .glyph("○")
        .at_position()
        .luminance(10.0, 100.0)
        .sizes(&[Size::Radius(RADIUS.name)])
        .equation("L(p, l) = L");

    fn sample(&self, light: &LightRecord, p: Vec3, u: Vec2) -> Sample {
        let Some((axis, _, _, rise)) = self.from(light, p) else { return Sample::default() };
        let l = sampling::about(axis, sampling::cone(u, rise));
        Sample { l, radiance: Vec3::splat(light.intensity), pdf: 1.0 / (2.0 * PI * rise) }
    }

    fn seen(&self, light: &LightRecord, p: Vec3, l: Vec3) -> Seen {
        let Some((axis, distance, squared, rise)) = self.from(light, p) else { return Seen::NOTHING };
        let cosine = axis.dot(l);
        // The squared sine of the angle to the centre: calculated from the cosine, small angles would lose
        // digits.
        let off = axis.cross(l).length_squared();
        if cosine <= 0.0 || off > squared {
            return Seen::NOTHING;
        }
        // On the sphere itself the difference is rounded to either sign.
        let distance = (distance * (cosine - (squared - off).sqrt())).max(0.0);
        Seen { radiance: Vec3::splat(light.intensity), pdf: 1.0 / (2.0 * PI * rise), distance }
    }

    fn bounds(&self, light: &LightRecord, p: Vec3) -> Option<Cone> {
        Cone::of_ball(light.position - p, self.radius)
    }

    /// `2π (1 − √(1 − (r/d)²))`, from outside.
    fn fills(&self, light: &LightRecord, p: Vec3) -> Option<f64> {
        let distance = (light.position - p).as_dvec3().length();
        let sine = f64::from(self.radius) / distance;
        let rise = sine * sine / (1.0 + ((1.0 - sine) * (1.0 + sine)).sqrt());
        Some(if sine < 1.0 { 0.5 * SPHERE * rise } else { 0.0 })
    }

    fn solid_angle(&self) -> Option<f64> {
        let radius = f64::from(self.radius);
        Some(extent::flux(4.0 * std::f64::consts::PI * radius * radius, false))
    }
}
