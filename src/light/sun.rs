use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{
    Declaration, LightRecord, LightType,
    extent::{Cone, Sample, Seen, VISIBLE, number},
};
use crate::{
    optics::{radiometry::SPHERE, sampling},
    parameter::Parameter,
    parameters,
    shader::wgsl,
};

const DIAMETER: Parameter = Parameter::number("diameter", 0.01..=90.0, 0.53)
    .symbol("δ")
    .unit("°")
    .help("The angle that it fills; the sun as seen from the earth fills 0.53°.");

parameters! {
    /// **Sun**: a disc infinitely far away; E lux on a surface that faces it, so its luminance is `L = E / (π sin²(δ/2))`.
    pub struct Sun {
        /// The angle that it fills, degrees.
        diameter: number = DIAMETER,
        /// True if it is to be seen in the picture.
        visible: flag = VISIBLE,
    } derived {
        /// The squared sine of its angular radius.
        sine_squared: f32 = |sun: &Self| sun.radius().sin().powi(2),
        /// 1 minus the cosine of its angular radius.
        rise: f32 = |sun: &Self| 2.0 * (0.5 * sun.radius()).sin().powi(2),
    }
}

impl Sun {
    fn radius(&self) -> f32 {
        0.5 * self.diameter.to_radians()
    }

    fn luminance(&self, light: &LightRecord) -> Vec3 {
        Vec3::splat(light.intensity / (PI * self.sine_squared))
    }
}

impl LightType for Sun {
    const DECLARATION: Declaration = Declaration::new("sun", "Sun", wgsl!("light/sun.wgsl"))
        .summary("A disc infinitely far away, as the sun is: a directional light with extent.")
        .glyph("☉")
        .with_direction()
        .lux(1.0, 10.0)
        .with_extent()
        .equation("L(p, l) = I / (π sin(δ/2)^2)");

    const DERIVED: &'static [Parameter] = &[number("sine_squared"), number("rise")];

    fn derived(&self) -> Vec<f32> {
        vec![self.sine_squared, self.rise]
    }

    fn sample(&self, light: &LightRecord, _p: Vec3, u: Vec2) -> Sample {
        let l = sampling::about(-light.direction, sampling::cone(u, self.rise));
        Sample { l, radiance: self.luminance(light), pdf: 1.0 / (2.0 * PI * self.rise) }
    }

    fn seen(&self, light: &LightRecord, _p: Vec3, l: Vec3) -> Seen {
        // Calculated with the sine: with the cosine, small angles would lose digits.
        if light.direction.dot(l) >= 0.0 || light.direction.cross(l).length_squared() > self.sine_squared {
            return Seen::NOTHING;
        }
        let pdf = 1.0 / (2.0 * PI * self.rise);
        Seen { radiance: self.luminance(light), pdf, distance: f32::INFINITY }
    }

    fn bounds(&self, light: &LightRecord, _p: Vec3) -> Option<Cone> {
        Some(Cone { axis: -light.direction, half_angle: 1.0001 * self.radius() })
    }

    /// `4π sin²(δ/4)`, which is `2π (1 − cos(δ/2))`.
    fn fills(&self, _light: &LightRecord, _p: Vec3) -> Option<f64> {
        let sine = (0.25 * f64::from(self.diameter).to_radians()).sin();
        Some(SPHERE * sine * sine)
    }
}
