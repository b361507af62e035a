//! A light type with extent from outside the crate, complete: the ring lamp around a photographer's lens.
//!
//! `cargo run --release --example lamp` opens the window with it. `sample` and `seen` take the place of `incident`: a direction to
//! the lamp, and what the lamp is in a direction. `sizes` declares the radius as a size, which gives it its handle and the
//! lamp its outline. `lamp.wgsl` says the same for the GPU.
#![allow(missing_docs)]

use std::f32::consts::{PI, TAU};

use lights_camera_models::{
    bevy::prelude::*,
    light::{
        Size,
        extent::{Cone, Sample, Seen, sides},
    },
    optics::sampling::area_pdf,
    prelude::*,
};

const RADIUS: Parameter =
    Parameter::number("radius", 0.01..=10.0, 0.8).symbol("r").unit("m").help("Half its diameter.");
const HOLE: Parameter = Parameter::number("hole", 0.0..=0.95, 0.7)
    .symbol("h")
    .help("The radius of its hole, as a part of that of the lamp.");
const VISIBLE: Parameter = Parameter::flag("visible", true).help("It is to be seen in the picture.");

parameters! {
    /// A ring that shines evenly to its front.
    pub struct RingLamp {
        /// Half its diameter, metres.
        radius: number = RADIUS,
        /// The part of the radius that is dark.
        hole: number = HOLE,
        /// True if it is to be seen in the picture.
        visible: flag = VISIBLE,
    }
}

impl RingLamp {
    fn area(&self) -> f32 {
        PI * self.radius * self.radius * (1.0 - self.hole * self.hole)
    }
}

impl LightType for RingLamp {
    const DECLARATION: light::Declaration = light::Declaration::new(
        "ring_lamp",
        "Ring lamp",
        Source::new("lamp.wgsl", include_str!("lamp.wgsl")),
    )
    .summary("A ring that is equally bright everywhere, as photographers put around a lens.")
    .equation("L(p, l) = L")
    .glyph("◎")
    .at_position()
    .with_direction()
    .luminance(10.0, 100.0)
    .sizes(&[Size::Radius("radius")]);

    fn sample(&self, light: &LightRecord, p: Vec3, u: Vec2) -> Sample {
        let [x, y] = sides(light.direction, Vec2::Y);
        let away = self.radius * (self.hole * self.hole).lerp(1.0, u.x).sqrt();
        let (sin, cos) = (TAU * u.y).sin_cos();
        let at = light.position + away * (cos * x + sin * y) - p;
        if at.dot(light.direction) >= 0.0 {
            return Sample::default();
        }
        let radiance = Vec3::splat(light.intensity);
        Sample { l: at.normalize_or_zero(), radiance, pdf: area_pdf(at, light.direction, self.area()) }
    }

    fn seen(&self, light: &LightRecord, p: Vec3, l: Vec3) -> Seen {
        let (middle, facing) = (light.position - p, l.dot(light.direction));
        let distance = middle.dot(light.direction) / facing;
        let away = (l * distance - middle).length();
        if facing >= 0.0 || distance <= 0.0 || !(self.hole * self.radius..=self.radius).contains(&away) {
            return Seen::NOTHING;
        }
        let pdf = area_pdf(l * distance, light.direction, self.area());
        Seen { radiance: Vec3::splat(light.intensity), pdf, distance }
    }

    fn bounds(&self, light: &LightRecord, p: Vec3) -> Option<Cone> {
        Cone::of_ball(light.position - p, self.radius)
    }

    fn solid_angle(&self) -> Option<f64> {
        Some(f64::from(PI * self.area()))
    }
}

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/lamp.json");

pub fn main() -> AppExit {
    App::new().add_plugins(LabPlugins::default().scene(SCENE)).add_light_type::<RingLamp>().run()
}
